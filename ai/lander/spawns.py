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


@dataclass(frozen=True, eq=False)
class _Box:
    """Starts spread evenly around one; `reach` is how far to each side."""

    middle: Doubles
    reach: Doubles

    def __call__(self, rng: np.random.Generator) -> Doubles:
        return self.middle + self.reach * (2.0 * rng.random(6) - 1.0)

    def toward(self, other: _Box, share: float) -> _Box:
        """Return the box that is `share` of the way to another."""
        return _Box(self.middle + share * (other.middle - self.middle), self.reach + share * (other.reach - self.reach))


def _box(height: float, rise: float, *reach: float) -> _Box:
    """Return starts above the pad, `height` up and at `rise` m/s, and as far from that as each `reach`."""
    return _Box(np.array([0.0, height, 0.0, rise, 0.0, 0.0]), np.array(reach))


_RANDOM: Final = _box(14.5, -1.0, 15.0, 5.5, 3.0, 2.0, np.radians(35), 0.5)
_EASY: Final = _box(4.0, -0.3, 1.0, 0.5, 0.3, 0.2, 0.05, 0.05)
_BOTTOM: Final = _box(7.0, -0.3, 0.5, 0.5, 0.2, 0.2, 0.03, 0.03)
_RUNGS: Final = 10


def _at(height: float) -> Spawn:
    return lambda _: np.array([0.0, height, 0.0, 0.0, 0.0, 0.0])


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


# The ladder that a person learns on: above the pad at first, each rung a little farther from it.
RUNGS: Final = {f"rung_{number}": _BOTTOM.toward(_RANDOM, (number - 1) / _RUNGS) for number in range(1, _RUNGS + 1)}
SPAWNS: Final[dict[str, Spawn]] = {
    "fixed": _at(8.0),
    "higher": _at(12.0),
    "highest": _at(17.0),
    "near": _box(4.5, -0.4, 5.0, 1.9, 1.2, 0.8, 0.35, 0.4),
    "graded": lambda rng: _EASY.toward(_RANDOM, rng.random())(rng),  # from easy ones above the pad to random ones
    "random": _RANDOM,
    "hard": _box(14.5, -1.0, 15.0, 5.5, 3.0, 2.0, np.radians(90), 1.0),
    "wide": _box(14.5, -1.0, 17.0, 6.5, 4.0, 2.5, np.radians(50), 0.8),
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
