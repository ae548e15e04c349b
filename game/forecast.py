"""Where a flight goes from here, by itself and with a network, worked out a little in every frame."""

from __future__ import annotations

from itertools import islice
from typing import Final

import numpy as np

from ai.env import Doubles, Floats
from ai.ground import Ground
from ai.lander import LanderEnv, Outcome
from game.flight import DECISION_STEPS, coast_path, down_to_ground, drift, surface_height
from game.networks import Flyer

# Metres above the ground at which to stop: the touchdown itself costs more than the way there.
_CLEAR: Final = 0.3
_DRIFT_STEPS: Final = 20  # of the way by itself, in every frame: a path is whole after a few


class Drift:
    """Where a flight goes if nobody touches anything.

    Attributes:
        path: positions (k, 2), as far as the ground.

    """

    def __init__(self, env: LanderEnv) -> None:
        self.path = coast_path(env)
        self._env = env
        self._ahead, self._places = drift(env), list[Doubles]()

    def follow(self) -> None:
        """Look a bit further ahead, beginning anew from where the flight is once the ground is reached."""
        places = list(islice(self._ahead, _DRIFT_STEPS))
        self._places += places
        if len(places) < _DRIFT_STEPS:
            self.path = down_to_ground(self._env.ground, self._places)
            self._ahead, self._places = drift(self._env), []


class Forecast:
    """Flies ahead of a flight in an environment of its own, and so never disturbs it.

    Attributes:
        path: positions (k, 2) of the latest flight ahead, as far as the ground; empty until there is one.

    """

    def __init__(self, flyer: Flyer, ground: Ground | None = None) -> None:
        self.path: Doubles = np.empty((0, 2))
        self._flyer = flyer
        self._ahead = LanderEnv(1, 0, frame_skip=DECISION_STEPS, ground=ground)
        self._observation: Floats = self._ahead.reset()
        self._places: list[Doubles] = []
        self._frame = 0

    def follow(self, env: LanderEnv) -> None:
        """Fly some decisions further ahead of `env`, beginning anew from where it is once the ground is reached."""
        ahead = self._ahead
        self._frame += 1
        among_hills = bool(ahead.ground.hills)  # which cost more, so there it goes more slowly
        for _ in range(1 if among_hills and self._frame % 2 else 2):
            if not self._places:
                ahead.restore(env.snapshot())
                self._observation = ahead.observe()
            self._places.append(ahead.position[0].copy())
            x, y = ahead.position[0].tolist()
            down = y < surface_height(ahead, x) + ahead.params.stand + _CLEAR
            if down or ahead.outcome[0] != Outcome.FLYING:
                self.path, self._places = np.array(self._places), []
                continue
            self._observation = ahead.step(self._flyer.act(self._observation, held=ahead.actions)).observation
        self._leave_behind(env.position[0])

    def _leave_behind(self, position: Doubles) -> None:
        """Drop the part of the path that the flight has passed meanwhile."""
        if len(self.path):
            nearest = int(np.hypot(*(self.path - position).T).argmin())
            self.path = self.path[nearest:]
