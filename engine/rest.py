"""Rest: bodies that lie still fall asleep, and wake as soon as anything about them changes (as in Box2D).

Bodies that touch, and those that they touch in turn, are an island, and an island sleeps and wakes as one: none of its
bodies could move without the others. What holds it up, a body that no force can move, links no islands. An island
sleeps while each of its bodies has been still for half a second and something holds it up, so that a body that floats,
or has only begun to slide, is never stopped. Asleep, it costs nothing: it is not moved, nor tried for contacts with
what sleeps or stands, and its contacts stay as they were.

Nothing has to be told to wake: what sleeps is compared with what it was after the last step. So a new place, a
velocity, a force, a body taken out, a floor moved away and another gravity wake alike, whoever has set them.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from engine.contacts import Contacts
from engine.state import BodyParams, BodyState, span
from engine.vector import Array, Bools, Ints

STILL: Final = 0.01  # m/s and rad/s below which a body is still
DRIFT: Final = 0.0005  # metres and radians that it may creep meanwhile: what has only begun to slide creeps farther
STEPS: Final = 30  # for which it has to be still, half a second


class Rest:
    """Which bodies of every world sleep.

    Attributes:
        asleep: whether each body sleeps, (batch, bodies).

    """

    def __init__(self, params: BodyParams, state: BodyState, gravity: Array) -> None:
        self._dynamic, self._moving = params.dynamic, span(params.dynamic)
        self.asleep: Bools = np.zeros(state.active.shape, dtype=bool)
        self._place: Array = state.pose[:, self._moving].copy()  # where each moving body was when it came to be still
        self._still: Ints = np.zeros(self._place.shape[:2], dtype=np.intp)  # for how many steps it has been
        self._note(state, gravity)

    def _note(self, state: BodyState, gravity: Array) -> None:
        """Keep what the next step is compared with."""
        self._pose, self._velocity, self._active = state.pose.copy(), state.velocity.copy(), state.active.copy()
        self._gravity = gravity

    def wake_disturbed(self, state: BodyState, gravity: Array, contacts: Contacts | None) -> Bools | None:
        """Wake what is not as the last step left it; return which bodies are awake, None if all are.

        A body that forces do not move is awake if it moves by itself or was moved: it may run into those that sleep.
        """
        if not self.asleep.any():
            return None
        disturbed = (state.pose != self._pose) | (state.velocity != self._velocity) | (state.force != 0)
        changed = disturbed.any(axis=2) | (state.active != self._active)
        changed |= self.asleep & np.any(gravity != self._gravity, axis=-1, keepdims=True)
        self.wake(changed, state, contacts)
        return self._dynamic & ~self.asleep | ~self._dynamic & (changed | state.velocity.any(axis=2))

    def wake(self, chosen: Bools, state: BodyState, contacts: Contacts | None) -> None:
        """Wake the chosen bodies (batch, bodies) and their islands; a fixed body wakes what lies on it."""
        self._still[chosen[:, self._moving]] = 0
        self._find_sleepers(state, contacts, chosen)

    def settle(self, state: BodyState, gravity: Array, contacts: Contacts | None) -> None:
        """Let fall asleep what has been still for long enough, and wake what something that moves has touched."""
        pose, velocity = state.pose[:, self._moving], state.velocity[:, self._moving]
        still = ((np.abs(velocity) < STILL) & (np.abs(pose - self._place) < DRIFT)).all(axis=2)
        self._place[~still] = pose[~still]
        self._still = (self._still + 1) * still
        if (self._still >= STEPS).any():
            self._find_sleepers(state, contacts, np.zeros_like(self.asleep))
            state.velocity[self.asleep] = 0.0
        self._note(state, gravity)

    def _find_sleepers(self, state: BodyState, contacts: Contacts | None, disturbed: Bools) -> None:
        """Let sleep every island that lies on something, and has no body that is not still."""
        moves = disturbed | ~self._dynamic & state.velocity.any(axis=2)
        moves[:, self._moving] |= self._still < STEPS
        held = ~self._dynamic & ~moves
        if contacts is None:
            self.asleep[:] = False
        else:
            self.asleep = self._dynamic & self._spread(held, contacts) & ~self._spread(moves, contacts)

    def _spread(self, chosen: Bools, contacts: Contacts) -> Bools:
        """Return the chosen bodies (batch, bodies), and all that contacts link to them.

        Bodies that no force can move link to others only if they are chosen.
        """
        world, (a, b) = contacts.world, contacts.body.T
        links = chosen | self._dynamic
        reached, before = chosen.copy(), -1
        while before < (count := int(reached.sum())):
            before = count
            met = np.flatnonzero(reached[world, a] | reached[world, b])
            reached[world[met], a[met]] = reached[world[met], b[met]] = True
            reached &= links
        return reached
