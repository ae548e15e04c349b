"""Where a network would take a flight from here, worked out a little in every frame."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.env import Doubles, Floats
from ai.ground import Ground
from ai.lander import LanderEnv, Outcome
from game.flight import DECISION_STEPS, surface_height
from game.networks import Flyer

# Metres above the ground at which to stop: the touchdown itself costs more than the way there.
_CLEAR: Final = 0.3


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

    def follow(self, env: LanderEnv, decisions: int = 2) -> None:
        """Fly so many decisions further ahead of `env`, beginning anew from where it is once the ground is reached."""
        ahead = self._ahead
        for _ in range(decisions):
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
