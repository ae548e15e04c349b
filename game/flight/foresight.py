"""What would come of a moment if the network had the stick: six futures of it."""

from __future__ import annotations

from typing import Final

from ai.copilot.futures import DECISION_STEPS, Flying, Lookahead, Plan
from ai.environment import Doubles
from ai.lander.environment import LanderEnv
from ai.lander.moment import Moment
from ai.lander.push import KEYS
from ai.lander.route import Route
from engine import DT
from game.flight.networks import Policy

HELD: Final = 0.5  # seconds for which each action is held: after less, the six are hardly distinguished
_DECISIONS: Final = round(HELD / (DECISION_STEPS * DT))
_EVERY: Final = 2  # decisions between two places of a path


class SixFutures:
    """What comes of each action at one moment, flown a little in every frame; the flight itself is not touched.

    Args:
        policy: the network that has the stick after half a second of the action.
        route: how it is led around rock on a leg of a descent; None in any other flight.

    Attributes:
        paths: where the craft goes, positions (k, 2) for each action, of the last moment that was flown to its end.
        lands: whether it lands, for each action; None before that is known.

    """

    def __init__(self, policy: Policy, route: Route | None = None) -> None:
        self._lookahead = Lookahead(policy, route)
        self._flying: Flying[list[tuple[Plan, bool]]] | None = None
        self.paths: list[Doubles] = []
        self.lands: list[bool | None] = [None] * len(KEYS)

    def begin(self, env: LanderEnv) -> None:
        """Begin at the present moment of one lander, and forget what was begun before."""
        self._flying = self._lookahead.ways(Moment.of(env), [(0, (key,) * _DECISIONS) for key in KEYS])

    @property
    def under_way(self) -> bool:
        """Whether a moment is being flown."""
        return self._flying is not None

    def follow(self, decisions: int) -> None:
        """Fly some decisions further; once all have ended, paths and landings are those of the moment begun last."""
        for _ in range(decisions):
            if self._flying is None:
                return
            try:
                next(self._flying)
            except StopIteration as end:
                self._flying = None
                self.paths = [way.states[::_EVERY, :2] for way, _ in end.value]
                self.lands = [landed for _, landed in end.value]
