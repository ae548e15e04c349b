"""Six futures: after half a second of each action the network flies on, and lands or not; a little in every frame."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.copilot.futures import LONGEST, roomy
from ai.environment import Doubles
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.moment import Moment
from ai.lander.route import Route
from ai.lander.rules import ACTION_SHARES
from engine import DT
from game.flight.networks import Policy, decision_steps

COUNT: Final = len(ACTION_SHARES)
HELD: Final = 0.5  # seconds for which each action is held: after less, the six are hardly told apart
_EVERY: Final = 2  # decisions between two places of a path


class SixFutures:
    """What comes of each action at one moment, for whoever asks; the flight itself is not touched.

    Args:
        policy: the network that has the stick after the action.
        route: how it is led around rock on a leg of a descent; None in any other flight.

    Attributes:
        paths: where the craft goes, positions (k, 2) for each action, of the last moment that was flown to its end.
        lands: whether it lands, for each action; None before that is known.

    """

    def __init__(self, policy: Policy, route: Route | None = None) -> None:
        self._policy, self._route = policy, route
        self.paths: list[Doubles] = []
        self.lands: list[bool | None] = [None] * COUNT
        self._env: LanderEnv | None = None
        self._kept: LanderEnv | None = None
        self._places: list[Doubles] = []

    def begin(self, env: LanderEnv) -> None:
        """Begin at the present moment of one lander, and forget what was begun before."""
        moment = Moment.of(env).take(np.zeros(COUNT, dtype=np.intp))
        self._kept = ahead = self._kept or roomy(COUNT, moment)  # building one takes longer than a frame
        self._env = ahead
        moment.put(ahead)
        ahead.frame_skip = decision_steps(self._policy)
        self._places = [ahead.position.copy()]

    @property
    def under_way(self) -> bool:
        """Whether a moment is being flown."""
        return self._env is not None

    def follow(self, decisions: int) -> None:
        """Fly some decisions further; once all have ended, paths and landings are those of the moment begun last."""
        for _ in range(decisions):
            if self._env is None:
                return
            self._fly(self._env)

    def _fly(self, ahead: LanderEnv) -> None:
        number = len(self._places) - 1
        if number * ahead.frame_skip * DT < HELD:
            action = np.arange(COUNT)
        else:
            seen = self._route.observe(ahead, self._policy) if self._route else ahead.observe_for(self._policy)
            action = self._policy.act(seen, held=ahead.actions).copy()
        ahead.fly(action, ACTION_SHARES[action])
        self._places.append(ahead.position.copy())
        longest = number * ahead.frame_skip * DT > LONGEST
        if longest or (ahead.outcome != Outcome.FLYING).all():
            way = np.array(self._places)  # (k, 6, 2)
            self.paths = [way[::_EVERY, slot] for slot in range(COUNT)]
            self.lands = (ahead.outcome == Outcome.LANDED).tolist()
            self._env = None
