"""Rest: bodies that lie still fall asleep, and wake as soon as anything about them changes (as in Box2D).

Bodies that touch, and those that they touch in turn, are an island, and an island sleeps and wakes as one: none of
its bodies could move without the others. What holds it up, a body that no force can move, links no islands. An
island falls asleep once all its bodies have been still for half a second and something holds it up, so that a body
that floats, or has only begun to slide, is never stopped. Asleep, it costs nothing: it is not moved, nor tried for
contacts with what sleeps or stands, and its contacts stay as they were.

Nothing has to be told to wake: what sleeps is compared with what it was after the last step. So a new place, a
velocity, a force, a body taken out, a floor moved away and another gravity wake alike, whoever has set them.
"""

from __future__ import annotations

import copy
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from engine.contact_set import Contacts
from engine.state import BodyParams, BodyState, span
from engine.vector import Array, Bools, Ints

STILL: Final = 0.01  # m/s and rad/s below which a body is still
DRIFT: Final = 0.0005  # metres and radians that it may creep meanwhile: what has only begun to slide creeps farther
STEPS: Final = 30  # for which it has to be still, half a second
_FEW: Final = 2000  # numbers of an array below which bytes are compared


class Rest:
    """Which bodies of every world sleep, and what is needed to let them sleep and wake.

    Attributes:
        asleep: whether each body sleeps, (batch, bodies).
        contacts: contacts of the sleeping bodies, as they were when they fell asleep; None if there are none.
        woken: those of bodies that have woken since the last step, whose impulses the next one begins with.
        awake: whether each body moves or was moved by hand, (batch, bodies), and so may run into others; None if no
            body sleeps.

    """

    def __init__(self, params: BodyParams, batch: int) -> None:
        self._dynamic = params.dynamic
        self._fixed = span(~params.dynamic)
        shape = (batch, len(params.group))
        self.asleep: Bools = np.zeros(shape, dtype=bool)
        self.awake: Bools | None = None
        self.contacts: Contacts | None = None
        self.woken: Contacts | None = None
        self._steps: Ints = np.zeros(shape, dtype=np.intp)  # for which each body has been still
        self._place: Array = np.zeros((*shape, 3))  # where it was when it came to be still
        self._counts = False  # whether any has been still for a step or more
        self._gravity: Array = np.zeros(2)
        self._known: tuple[NDArray[Any], ...] | None = None  # the worlds after the last step; None if nothing sleeps
        self._all_asleep = False

    def copy(self) -> Rest:
        """Return a copy that later steps do not change."""
        return copy.deepcopy(self)

    def undisturbed(self, state: BodyState, gravity: Array) -> bool:
        """Wake what has changed since the last step; return whether everything sleeps on, and a step does nothing."""
        if self._known is None:
            return False
        if (
            not np.count_nonzero(state.force)
            and all(map(_same_bits, _parts(state), self._known))
            and _same_bits(np.asarray(gravity), self._gravity)
        ):
            return self._all_asleep
        self.wake(self._changed(state, np.asarray(gravity)))
        return False

    def wake(self, chosen: Bools) -> None:
        """Wake the chosen bodies (batch, bodies) and their islands; a fixed body wakes what lies on it."""
        kept = self.contacts
        woken = self._spread(chosen, kept.world, kept.body) if kept else chosen
        self.asleep &= ~woken
        self._all_asleep = False
        if kept:
            sleeping = self._sleep(kept)
            self.contacts = kept.resting(np.flatnonzero(sleeping))
            self.woken = Contacts.join(self.woken, kept.resting(np.flatnonzero(~sleeping)))
        if self.awake is not None:
            self.awake |= woken

    def wake_touched(self, world: Ints, body: Ints) -> bool:
        """Wake the sleeping ones of touching pairs, `world` (n,) and `body` (n, 2); return whether there were any."""
        if self.awake is None or not (hit := self.asleep[world[:, None], body]).any():
            return False
        chosen = np.zeros_like(self.asleep)
        chosen[world.repeat(2), body.ravel()] = hit.ravel()
        self.wake(chosen)
        return True

    def settle(self, state: BodyState, contacts: Contacts | None, gravity: Array) -> Contacts | None:
        """Let fall asleep what has been still for long enough; return the contacts of what slept before."""
        kept = self.contacts
        if contacts is None and not self._counts and self._known is None:
            return None
        if contacts is not None:
            # The last of an island's bodies to be still for long enough asks for it, and asks again now and then.
            due = self._count(state, contacts)
            if len(due) and self._fall_asleep(state, contacts, due):
                fallen = contacts.resting(np.flatnonzero(self._sleep(contacts)))
                self.contacts = Contacts.join(fallen, kept)
        elif self._counts:
            self._steps[:] = 0
            self._counts = False
        if self.asleep.any():
            self._know(state)
            self._gravity = np.array(gravity)
            self.awake = self._dynamic & ~self.asleep | self._lifts(state)
            self._all_asleep = not (self.awake & state.active).any()
        else:
            self._known = self.awake = None
        return kept

    def _know(self, state: BodyState) -> None:
        """Note how everything is; worlds that the step has left alone are known, and in a large batch they are many."""
        if self._known is None or self.awake is None:
            self._known = tuple(part.copy() for part in _parts(state))
            return
        moved = np.flatnonzero(self.awake.any(axis=1))
        for known, part in zip(self._known, _parts(state), strict=True):
            known[moved] = part[moved]

    def _count(self, state: BodyState, contacts: Contacts) -> Ints:
        """Count the steps for which each touching body has been still; return worlds where one has been for long."""
        bodies = len(self._dynamic)
        world, body = np.divmod(np.unique(contacts.world[:, None] * bodies + contacts.body), bodies)
        world, body = world[self._dynamic[body]], body[self._dynamic[body]]
        pose = state.pose[world, body]
        calm = (np.abs(state.velocity[world, body]) < STILL).all(axis=1)
        near = calm & (np.abs(pose - self._place[world, body]) < DRIFT).all(axis=1)
        left = ~near
        self._place[world[left], body[left]] = pose[left]
        count = np.where(near, self._steps[world, body] + 1, 0)
        self._steps[:] = 0
        self._steps[world, body] = count
        self._counts = True
        return np.unique(world[(count > 0) & (count % STEPS == 0)])

    def _fall_asleep(self, state: BodyState, contacts: Contacts, due: Ints) -> bool:
        """Put to sleep every island that lies on something, in the worlds that are `due`; return whether there was one.

        Each of its bodies has to have been still for long enough.
        """
        row = np.full(len(self.asleep), -1)
        row[due] = np.arange(len(due))
        here = np.flatnonzero(row[contacts.world] >= 0)
        world, body = row[contacts.world[here]], contacts.body[here]
        lies = self._steps[due] >= STEPS
        lifts = self._lifts(state)[due]
        restless = self._spread(self._dynamic & ~lies | lifts, world, body)
        held = self._spread(~self._dynamic & ~lifts, world, body)
        tired = self._dynamic & lies & held & ~restless
        worlds, bodies = tired.nonzero()
        worlds = due[worlds]
        self.asleep[worlds, bodies] = True
        self._steps[worlds, bodies] = 0
        state.velocity[worlds, bodies] = 0.0
        return bool(len(worlds))

    def _lifts(self, state: BodyState) -> Bools:
        """Whether each body moves though no force can move it, (batch, bodies)."""
        lifts = np.zeros_like(self.asleep)
        speeds = state.velocity[:, self._fixed]
        if speeds.any():
            lifts[:, self._fixed] = speeds.any(axis=2)
        return lifts

    def _sleep(self, contacts: Contacts) -> Bools:
        """Whether no body of each contact is awake, (m,)."""
        asleep: Bools = self.asleep[contacts.world[:, None], contacts.body] | ~self._dynamic[contacts.body]
        return asleep[:, 0] & asleep[:, 1]

    def _spread(self, chosen: Bools, world: Ints, body: Ints) -> Bools:
        """Return the chosen bodies (worlds, bodies), and all that pairs link to them: `world` (n,), `body` (n, 2).

        Bodies that no force can move link to others only if they are chosen.
        """
        links = chosen | self._dynamic
        a, b = body.T
        reached, before = chosen.copy(), -1
        while before < (count := int(reached.sum())):
            before = count
            met = np.flatnonzero(reached[world, a] | reached[world, b])
            reached[world[met], a[met]] = reached[world[met], b[met]] = True
            reached &= links
        return reached

    def _changed(self, state: BodyState, gravity: Array) -> Bools:
        """Return which bodies, (batch, bodies), are not as they were after the last step."""
        assert self._known is not None
        pose, velocity, active = (np.not_equal(*pair) for pair in zip(self._known, _parts(state), strict=True))
        before, after = (np.broadcast_to(each, (len(active), 2)) for each in (self._gravity, gravity))
        fall: Bools = np.any(before != after, axis=1)
        changed: Bools = np.any(pose | velocity | np.not_equal(state.force, 0.0), axis=2) | active
        changed |= fall[:, None] & self.asleep
        return changed


def _parts(state: BodyState) -> tuple[NDArray[Any], ...]:
    return state.pose, state.velocity, state.active


def _same_bits(a: NDArray[Any], b: NDArray[Any]) -> bool:
    """Whether two arrays are equal, NaN to NaN."""
    if a.size < _FEW or a.dtype != float:
        return a.tobytes() == b.tobytes()  # many times as fast for few numbers, but copies of many have to be made
    return bool(np.all(a.view(np.int64) == b.view(np.int64)))
