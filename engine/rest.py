"""Rest: bodies that lie still fall asleep, and wake as soon as anything about them changes (as in Box2D).

Bodies that touch, and those that they touch in turn, are an island, and an island sleeps and wakes as one: none of its
bodies could move without the others. What holds it up, a body that no force can move, links no islands. An island
sleeps once each of its bodies has been still for half a second, without being pushed and without gaining speed, and
something holds it up. So a body that floats, has only begun to slide, or stands at its turning point is never stopped.
Asleep, it costs nothing: it is not moved, nor tried for contacts with what sleeps or stands, and its contacts stay as
they were.

Nothing is woken by name: what sleeps is compared with what it was after the last step. So a new place, a
velocity, a force, a body taken out and a floor moved away wake alike, whoever has set them.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from engine.contacts import Contacts
from engine.state import BodyParams, BodyState
from engine.vector import Array, Bools, Ints

STILL: Final = 0.01  # m/s and rad/s up to which a body is still
DRIFT: Final = 0.0005  # metres and radians that it may creep meanwhile
GAIN: Final = 1e-4  # m/s and rad/s by which its velocity may change meanwhile: what slides or turns back changes more
STEPS: Final = 30  # for which it has to be still, half a second


class Rest:
    """Which bodies of every world sleep; if it is not `allowed`, none ever does.

    Attributes:
        asleep: whether each body sleeps, (batch, bodies).
        awake: whether each body moves, or was moved by hand, and so may run into others; None if no body sleeps.

    """

    def __init__(self, state: BodyState, params: BodyParams, allowed: bool) -> None:
        self._dynamic, self._allowed = params.dynamic, allowed
        self._slow = np.where(params.dynamic, STILL, 0.0)[:, None]  # a fixed body that moves carries others along
        self.asleep: Bools = np.zeros(state.active.shape, dtype=bool)
        self.awake: Bools | None = None
        self._place: Array = state.pose.copy()  # where each body was when it came to be still
        self._pace: Array = state.velocity.copy()  # and its velocity then
        self._still: Ints = np.zeros(state.active.shape, dtype=np.intp)  # for how many steps it has been
        self._seen = state.pose, state.velocity, state.active  # after the last step in which a body slept

    def wake_disturbed(self, state: BodyState, contacts: Contacts | None) -> None:
        """Wake what is not as the last step left it, and all that the last step's `contacts` link to it."""
        if not self._allowed:
            return
        pushed = state.force.any(axis=2)
        self._still[pushed] = 0  # what is pushed is not still
        if self.awake is None:
            return
        pose, velocity, active = self._seen
        moved = (state.pose != pose) | (state.velocity != velocity)
        disturbed = pushed | moved.any(axis=2) | (state.active != active)
        if disturbed.any():
            self.wake(disturbed, contacts)

    def wake_touched(self, found: Contacts | None, contacts: Contacts | None) -> bool:
        """Wake sleeping bodies that this step has `found` to be touched; return whether there were any."""
        if self.awake is None or found is None:
            return False
        places = found.world[:, None], found.body
        touched = np.zeros_like(self.asleep)
        touched[places] = self.asleep[places]
        if touched.any():
            self.wake(touched, contacts)
        return bool(touched.any())

    def contacts_of_sleepers(self, contacts: Contacts | None) -> Contacts | None:
        """Return those of the last step's contacts that this step has not looked for: of bodies that sleep."""
        if contacts is None or self.awake is None:
            return None
        asleep = ~self.awake[contacts.world[:, None], contacts.body].any(axis=1)
        if not asleep.any():
            return None
        slept = contacts.take(np.flatnonzero(asleep))
        slept.approach = np.zeros_like(slept.approach)
        return slept

    def wake(self, chosen: Bools, contacts: Contacts | None) -> None:
        """Wake the chosen bodies (batch, bodies) and their islands; a fixed body wakes what lies on it."""
        self._still[chosen] = 0
        self._find_sleepers(contacts)

    def fall_asleep(self, state: BodyState, contacts: Contacts | None) -> None:
        """Let fall asleep what has been still for long enough."""
        if not self._allowed:
            return
        steady = (np.abs(state.pose - self._place) < DRIFT) & (np.abs(state.velocity - self._pace) < GAIN)
        still = (steady & (np.abs(state.velocity) <= self._slow)).all(axis=2)
        self._place[~still], self._pace[~still] = state.pose[~still], state.velocity[~still]
        self._still = (self._still + 1) * still
        if ((self._still >= STEPS) & self._dynamic & ~self.asleep).any():
            self._find_sleepers(contacts)
            state.velocity[self.asleep] = 0.0
        if self.awake is not None:
            self._seen = state.pose.copy(), state.velocity.copy(), state.active.copy()

    def _find_sleepers(self, contacts: Contacts | None) -> None:
        """Let sleep every island that something fixed holds up, and that nothing restless touches."""
        restless = self._still < STEPS
        self.asleep = np.zeros_like(restless)
        if contacts is not None:
            supported = _linked(~restless & ~self._dynamic, contacts, self._dynamic)
            disturbed = _linked(restless, contacts, self._dynamic)
            self.asleep = supported & ~disturbed & self._dynamic
        self.awake = ~self.asleep & (self._dynamic | restless) if self.asleep.any() else None


def _linked(start: Bools, contacts: Contacts, dynamic: Bools) -> Bools:
    """Return the bodies of `start` (batch, bodies), and all that contacts link to them: a flood fill.

    It does not pass through bodies that no force can move, `dynamic` (bodies,), but may start from them.
    """
    world, (a, b) = contacts.world, contacts.body.T
    linked, count = start.copy(), -1
    while count < (now := int(linked.sum())):
        count = now
        met = np.flatnonzero(linked[world, a] | linked[world, b])
        linked[world[met], a[met]] = linked[world[met], b[met]] = True
        linked &= start | dynamic
    return linked
