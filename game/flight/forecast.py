"""Forecast of a flight's path, without thrust and with a network, computed a little in every frame.

Both paths use the physics of the flight itself, but without contacts with the ground, where they end: finding
contacts takes most of the time of a step.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from itertools import islice
from typing import Final

import numpy as np

from ai.environment import Doubles
from ai.lander.environment import PARAMS, LanderEnv
from ai.lander.ground import Ground
from engine import DT
from engine.integrate import integrate_velocity
from game.flight.networks import Policy, decision_steps

_CLEAR: Final = 0.3  # metres above the ground at which to stop: the touchdown itself is not predicted
_DECISIONS: Final = 2  # decisions of the network per frame
_STRIDE: Final = 10  # physics steps between positions of the path without thrust, computed at once
_STRIDES: Final = 12  # positions per frame, so that a path is complete after a few
_SECONDS: Final = 9.0
REACH, HEIGHT_STEP = 34.0, 0.02  # metres to both sides for which the ground's height is kept, and between two heights


class Drift:
    """Predicted path of a flight without thrust.

    Attributes:
        path: positions (k, 2), as far as the ground.

    """

    def __init__(self, env: LanderEnv) -> None:
        self.path = coast_path(env)
        self._env = env
        self._ahead, self._places = drift(env), list[Doubles]()

    def follow(self) -> None:
        """Extend the path by one frame's share; start again from the flight's position once it reaches the ground."""
        places = list(islice(self._ahead, _STRIDES))
        self._places += places
        if len(places) < _STRIDES:
            self.path = _down_to_ground(self._env.ground, self._places)
            self._ahead, self._places = drift(self._env), []

    def after(self, seconds: float) -> Doubles:
        """Return the position (2,) on the path so many seconds from its beginning."""
        times = np.arange(len(self.path)) * (_STRIDE * DT)
        return np.array([np.interp(seconds, times, along) for along in self.path.T])


class Forecast:
    """Predicted path of a flight under a network, in a separate environment that does not disturb the flight.

    Attributes:
        path: positions (k, 2) of the latest prediction, as far as the ground; empty at first.

    """

    def __init__(self, policy: Policy, ground: Ground | None = None) -> None:
        self.path: Doubles = np.empty((0, 2))
        self._policy = policy
        self._ahead = LanderEnv(1, 0, frame_skip=decision_steps(policy), ground=ground)
        self._ahead.reset()
        self._places: list[Doubles] = []

    def follow(self, env: LanderEnv, decisions: int = _DECISIONS) -> None:
        """Predict some decisions further; start again from the state of `env` once the ground is reached."""
        ahead = self._ahead
        for _ in range(decisions):
            if not self._places:
                ahead.restore(env.snapshot())
            self._places.append(ahead.position[0].copy())
            if self._arrived():
                self.path, self._places = np.array(self._places), []
                continue
            ahead.glide(self._policy.act(ahead.observe_for(self._policy), held=ahead.actions))
        if len(self.path):  # the part that the flight has already passed is dropped
            self.path = self.path[int(np.hypot(*(self.path - env.position[0]).T).argmin()) :]

    def _arrived(self) -> bool:
        """Whether the prediction is almost down, or has left the area or run out of time."""
        ahead, limits = self._ahead, self._ahead.limits
        x, y = ahead.position[0].tolist()
        if abs(x) > limits.half_width or y > limits.ceiling or ahead.time[0] > limits.time:
            return True
        return bool(y < surface_height(ahead, x) + ahead.params.stand + _CLEAR)


def coast_path(env: LanderEnv) -> Doubles:
    """Return a lander's path without thrust: positions (k, 2), every 1/6 s, down to the ground."""
    return _down_to_ground(env.ground, list(drift(env)))


def drift(env: LanderEnv) -> Iterator[Doubles]:
    """Yield a lander's future positions without thrust, (2,) every 1/6 s, down to the plain."""
    world, body, span = env.world, env.lander.index, _STRIDE * DT
    state = replace(
        world.state,
        velocity=world.state.velocity[:1].copy(),
        force=np.zeros_like(world.state.force[:1]),
        active=world.state.active[:1].copy(),
    )
    velocity, place = state.velocity[0, body, :2], env.position[0].copy()
    time, lowest = float(env.time[0]), env.ground.base + PARAMS.stand
    yield place.copy()
    for stride in range(round(_SECONDS / span)):
        before = velocity.copy()
        if env.conditions.pushes:
            state.force[0, body, 0] = env.conditions.push(np.array(time + (stride + 0.5) * span))
        integrate_velocity(state, world.params, world.movers, world.gravity, span)
        # Closed form of many short steps at constant acceleration, each moved by the speed at its end.
        place += span / 2 * (before + velocity) + DT / 2 * (velocity - before)
        yield place.copy()
        x, y = place.tolist()
        if y < lowest or abs(x) > env.limits.half_width:
            return


def _down_to_ground(ground: Ground, places: list[Doubles]) -> Doubles:
    """Return a path (k, 2), cut where the feet would reach the ground."""
    way = np.array(places)
    clear = way[:, 1] - ground.height(way[:, 0]) - PARAMS.stand
    if ground.roofs and (struck := np.flatnonzero(ground.roofed(way))).size:
        way, clear = way[: struck[0] + 1], clear[: struck[0] + 1]
    low = np.flatnonzero(clear[1:] < 0)
    if not len(low):
        return way
    last = int(low[0]) + 1
    above, below = max(float(clear[last - 1]), 0.0), float(clear[last])
    touch = way[last - 1] + above / (above - below) * (way[last] - way[last - 1])
    return np.concatenate([way[:last], touch[None]])


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
