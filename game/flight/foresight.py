"""Where a flight goes from a moment, flown a little in every frame: a preview of its path, and six futures of it."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np

from ai.copilot.futures import DECISION_STEPS, Flying, Lookahead, Plan
from ai.environment import Doubles
from ai.lander.environment import LanderEnv
from ai.lander.ground import Ground
from ai.lander.moment import Moment
from ai.lander.pilots import COAST
from ai.lander.push import KEYS
from ai.lander.route import Route
from engine import DT
from game.flight.networks import Policy, decision_steps

HELD: Final = 0.5  # seconds for which each action is held: after less, the six are hardly distinguished
_DECISIONS: Final = round(HELD / (DECISION_STEPS * DT))
_EVERY: Final = 2  # decisions between two places of a path
_STRIDE: Final = 6  # steps between two places of a path without thrust
_PLACES: Final = 250  # of a preview, at most
REACH, HEIGHT_STEP = 34.0, 0.02  # metres to both sides for which the ground's height is kept, and between two heights
_CLEAR: Final = 0.1  # metres above the ground at which a preview ends: the touchdown itself is not predicted


class Preview:
    """Path of a flight under a network, or without thrust, by the physics of the flight itself but without contacts.

    Finding contacts takes most of the time of a step.

    Attributes:
        path: positions (k, 2) of the latest one that was flown to the ground; empty at first.

    """

    def __init__(self, env: LanderEnv, policy: Policy | None = None) -> None:
        self.path: Doubles = np.empty((0, 2))
        self._env, self._policy = env, policy
        self._ahead = LanderEnv(1, 0, frame_skip=decision_steps(policy) if policy else _STRIDE, ground=env.ground)
        self._places: list[Doubles] = []

    def follow(self, places: int) -> None:
        """Predict so many places further; start again from the flight's own once the ground is reached."""
        ahead, coasts = self._ahead, np.array([COAST])
        for _ in range(places):
            if not self._places:
                Moment.of(self._env).put(ahead)
            self._places.append(ahead.position[0].copy())
            if self._arrived():
                self.path, self._places = np.array(self._places), []
                continue
            policy = self._policy
            ahead.glide(policy.act(ahead.observe_for(policy), held=ahead.actions) if policy else coasts)

    @property
    def ahead(self) -> Doubles:
        """The path without the part that the flight has already passed."""
        passed = np.hypot(*(self.path - self._env.position[0]).T)
        return self.path[int(passed.argmin()) :] if len(passed) else self.path

    def _arrived(self) -> bool:
        """Whether the prediction is down, which is then its last place, or outside, or long enough."""
        ahead, limits, place = self._ahead, self._ahead.limits, self._places[-1]
        low = surface_height(ahead, float(place[0])) + ahead.params.stand
        if place[1] < low + _CLEAR:
            place[1] = max(place[1], low)
            return True
        outside = abs(place[0]) > limits.half_width or place[1] > limits.ceiling or len(self._places) >= _PLACES
        return bool(outside or ahead.ground.roofed(place[None])[0])


class SixFutures:
    """What comes of each action if the network then has the stick, flown ahead without touching the flight itself.

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
        self._begun = -1  # steps of the flight at the moment begun last
        self.paths: list[Doubles] = []
        self.lands: list[bool | None] = [None] * len(KEYS)

    def follow(self, env: LanderEnv, decisions: int) -> None:
        """Fly some decisions further; once all have ended, begin anew at the present moment, unless nothing moved."""
        steps = int(env.steps[0])
        if self._flying is None and self._begun != steps:
            self._begun = steps
            self._flying = self._lookahead.ways(Moment.of(env), [(0, (key,) * _DECISIONS) for key in KEYS])
        for _ in range(decisions):
            if self._flying is None:
                return
            try:
                next(self._flying)
            except StopIteration as end:
                self._flying = None
                self.paths = [way.states[::_EVERY, :2] for way, _ in end.value]
                self.lands = [landed for _, landed in end.value]


def surface_height(env: LanderEnv, x: float) -> float:
    """Return the height in metres of the surface at x: a pad, a hill or the plain; for drawing, many times a frame."""
    ground, known = _Latest.seen
    if ground is not env.ground:
        ground, known = _Latest.seen = env.ground, heights(env.ground)
    if env.conditions.moves:  # one pad on a plain
        x -= float(env.pad_shift[0])
    return known[min(max(round((x + REACH) / HEIGHT_STEP), 0), len(known) - 1)]


class _Latest:
    """The ground that was asked about last, and its heights: to look it up by value takes longer than the rest."""

    seen: tuple[Ground | None, list[float]] = None, []


@lru_cache(maxsize=8)
def heights(ground: Ground) -> list[float]:
    """Return the ground's height at even steps, `HEIGHT_STEP` metres apart, from `REACH` to the left on."""
    return list(ground.height(np.arange(-REACH, REACH, HEIGHT_STEP)).tolist())
