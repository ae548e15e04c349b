"""Spawns: named distributions of starts, and the curriculum that moves from one to the next.

A spawn is drawn as x, y, vx, vy, angle, spin: metres from the middle of the pad, metres above the ground
line's zero, m/s, radians, rad/s.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from ai.environment import Doubles
from ai.lander.craft import lowest
from ai.lander.ground import Ground
from ai.lander.rules import Limits

Spawn = Callable[[np.random.Generator], Doubles]

_MIDDLE: Final = np.array([0.0, 14.5, 0.0, -1.0, 0.0, 0.0])
_REACH: Final = np.array([15.0, 5.5, 3.0, 2.0, np.radians(35), 0.5])
_HARD_REACH: Final = np.array([15.0, 5.5, 3.0, 2.0, np.radians(90), 1.0])
_WIDE_REACH: Final = np.array([17.0, 6.5, 4.0, 2.5, np.radians(50), 0.8])
_EASY: Final = np.array([0.0, 4.0, 0.0, -0.3, 0.0, 0.0])
_EASY_REACH: Final = np.array([1.0, 0.5, 0.3, 0.2, 0.05, 0.05])
_NEAR: Final = np.array([0.0, 4.5, 0.0, -0.4, 0.0, 0.0])
_NEAR_REACH: Final = np.array([5.0, 1.9, 1.2, 0.8, 0.35, 0.4])


_BOTTOM: Final = np.array([0.0, 7.0, 0.0, -0.3, 0.0, 0.0])
_BOTTOM_REACH: Final = np.array([0.5, 0.5, 0.2, 0.2, 0.03, 0.03])
_RUNGS: Final = 10


def _around(middle: Doubles, reach: Doubles) -> Spawn:
    def draw(rng: np.random.Generator) -> Doubles:
        return middle + reach * (2.0 * rng.random(6) - 1.0)

    return draw


def _at(height: float) -> Spawn:
    def draw(_: np.random.Generator) -> Doubles:
        return np.array([0.0, height, 0.0, 0.0, 0.0, 0.0])

    return draw


def _graded(rng: np.random.Generator) -> Doubles:
    """Draw any start between an easy one above the pad and a fully random one."""
    difficulty = rng.random()
    middle = _EASY + difficulty * (_MIDDLE - _EASY)
    reach = _EASY_REACH + difficulty * (_REACH - _EASY_REACH)
    return _around(middle, reach)(rng)


def _mixed(near: float, graded: float, others: str) -> Spawn:
    """Return starts for training: shares of them close to the pad and past its edges, and graded; and `others`.

    Without the close starts, random play never once touches the pad, and nothing is learned.
    """

    def draw(rng: np.random.Generator) -> Doubles:
        kind = rng.random()
        return SPAWNS["near" if kind < near else "graded" if kind < near + graded else others](rng)

    return draw


def _away(rng: np.random.Generator) -> Doubles:
    """Draw a hard start that leads away from the pad: speed, lean and spin all to the side it is on already."""
    x, y, vx, vy, angle, spin = SPAWNS["hard"](rng)
    side = np.copysign(1.0, x)
    return np.array([x, y, side * abs(vx), vy, -side * abs(angle), -side * abs(spin)])


def _far(rng: np.random.Generator) -> Doubles:
    """Draw a start for one that lands already: three flights in ten begin as hard as in the hardest tests.

    Half of those lead away from the pad, as nearly all do that such a network still loses: it leaves the area.
    """
    kind = rng.random()
    return _away(rng) if kind < 0.15 else SPAWNS["hard" if kind < 0.3 else "thorough"](rng)


def _rung(share: float) -> Spawn:
    """Return starts that are `share` of the way from the bottom of the ladder to random ones."""
    return _around(_BOTTOM + share * (_MIDDLE - _BOTTOM), _BOTTOM_REACH + share * (_REACH - _BOTTOM_REACH))


# The ladder that a person learns on: above the pad at first, each rung a little farther from it.
RUNGS: Final = {f"rung_{number}": _rung((number - 1) / _RUNGS) for number in range(1, _RUNGS + 1)}
SPAWNS: Final[dict[str, Spawn]] = {
    "fixed": _at(8.0),
    "higher": _at(12.0),
    "highest": _at(17.0),
    "near": _around(_NEAR, _NEAR_REACH),
    "graded": _graded,
    "random": _around(_MIDDLE, _REACH),
    "hard": _around(_MIDDLE, _HARD_REACH),
    "wide": _around(_MIDDLE, _WIDE_REACH),
    "practice": _mixed(0.25, 0.25, "random"),
    "thorough": _mixed(0.2, 0.2, "wide"),  # for a long run: most flights begin a little beyond what is tested
    "mixed": _mixed(0.35, 0.35, "wide"),  # for a quick run: most ways to the pad are short, and each ends in a touch
    "far": _far,
    **RUNGS,
}


def checked_start(start: Doubles, ground: Ground, limits: Limits) -> Doubles:
    """Return a start above the ground and inside the area, as an array; raises ValueError for any other."""
    start = np.asarray(start, dtype=float)
    if start.shape != (6,) or not np.isfinite(start).all():
        raise ValueError(f"a start is six finite numbers, not {start}")
    x, y, angle = start[[0, 1, 4]].tolist()
    if abs(x) > limits.half_width or y > limits.ceiling:
        raise ValueError(f"a flight begins inside the area, not at ({x:.2f}, {y:.2f})")
    if y < lowest(ground, x, angle):
        raise ValueError(f"a flight begins above the ground, not at ({x:.2f}, {y:.2f})")
    return start


@dataclass(frozen=True)
class Curriculum:
    """Curriculum: the spawn to use from each number of landings on; the thresholds rise from 0."""

    stages: tuple[tuple[int, str], ...] = ((0, "fixed"), (100, "higher"), (200, "highest"), (300, "random"))

    def __post_init__(self) -> None:
        thresholds = [threshold for threshold, _ in self.stages]
        unknown = [name for _, name in self.stages if name not in SPAWNS]
        if not thresholds or thresholds[0] != 0 or thresholds != sorted(set(thresholds)) or unknown:
            raise ValueError(f"a curriculum needs rising thresholds from 0 and known spawns, not {self.stages}")

    def stage(self, landings: int) -> int:
        """Index of the stage that `landings` successes have led to."""
        return sum(landings >= threshold for threshold, _ in self.stages) - 1

    def stage_of(self, spawn: str) -> int:
        """Index of the stage that has this spawn; raises ValueError if none has."""
        return [name for _, name in self.stages].index(spawn)

    def spawn(self, landings: int) -> str:
        """Name of the spawn of that stage."""
        return self.stages[self.stage(landings)][1]


# Ways to begin flights that change as a run lands; those of training, by name.
CURRICULA: Final = {"curriculum": Curriculum(), "widening": Curriculum(((0, "mixed"), (1000, "far")))}
TEACH_HARD: Final = ("far", "widening")  # where a lander that lands already begins as in the hardest tests, too
LADDER: Final = Curriculum(tuple(enumerate((*RUNGS, "random"))))
