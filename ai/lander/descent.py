"""Descent: an endless chain of legs from pad to pad, as data. A leg follows from a seed, its number and what is left.

Each leg is an ordinary flight: it begins on the feet on the last pad, with the fuel that is left, and ends at the
next. Legs become longer, windier and end on smaller pads, behind ground that must be flown around. Distances are in
metres from the middle of the leg's own world.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Final

import numpy as np

from ai.environment import Doubles
from ai.lander.conditions import Conditions
from ai.lander.environment import LIMITS, PARAMS, LanderEnv, Limits
from ai.lander.ground import Ground, Hill, Pad, Roof, knoll

MOST_LEGS: Final = 10_000  # of a descent: nobody flies so many
TANK: Final = 16.0  # seconds of main engine that the tank holds
_REFILL: Final = (5.0, 7.0)  # seconds for any landing on a pad, and more for a perfect one
_PERFECT: Final = 100  # points
_FIRST: Final = ("open", "ridge", "canyon", "overhang", "cave")  # the first legs, to meet each kind of ground once
_OPEN, _DOUBLE = 0.1, 9  # share of later legs over open ground; the leg from which two obstacles may follow
_HARDEST: Final = 16  # leg from which nothing grows any more but two obstacles
_LENGTH: Final = (17.0, 38.0)  # from pad to pad
_WIDTH: Final = (6.0, 3.4)  # of a pad
_WIND: Final = (0.22, 0.22)  # N, the strongest steady wind and gusts
_CALM: Final = 3  # legs without any wind
_LIGHT: Final = 0.4  # share of the strongest wind that is the least
_LEVEL: Final = 3.6  # width of a flat spot
_DARE: Final = 3  # factor on the points for landing there
_EDGE: Final = 0.06  # metres that a flat spot is higher than the rock around it: feet must touch the spot first
_OVER: Final = 3.2  # metres above rock at which to cross it
_HALF_WAY: Final = (0.47, 0.4)  # share of the way at which a ridge stands, alone and before another obstacle
_STEEP: Final = 1.5  # metres of height for every metre of a ridge's flank
AREA: Final[Limits] = replace(LIMITS, half_width=26.0, time=100.0)


@dataclass(frozen=True)
class LegStart:
    """Start of a leg, all that it follows from besides the descent's seed.

    Attributes:
        number: which leg of the descent, from 1.
        tank: fuel at its start, in seconds of main engine.
        bare: whether the last landing was on a flat spot without a pad.

    """

    number: int = 1
    tank: float = TANK
    bare: bool = False

    def after(self, fuel: float, score: int, *, bare: bool) -> LegStart:
        """Return the next leg's start after a landing that burnt `fuel` seconds and earned `score` points."""
        left = max(0.0, self.tank - fuel)
        return LegStart(self.number + 1, round(min(TANK, left + refill(score, bare=bare)), 3), bare)


def refill(score: int, *, bare: bool) -> float:
    """Return the fuel, in seconds of main engine, that a landing brings: none without a pad, most for a good one."""
    least, more = _REFILL
    return 0.0 if bare else least + more * min(1.0, score / _PERFECT)


@dataclass(frozen=True)
class Leg:
    """One leg: its ground, with the goal as the first pad and the start as the last, and how to fly it.

    Attributes:
        kinds: what must be flown around, keys of `texts.DESCENT_KINDS`.
        conditions: the wind, without the tank.
        route: points (k, 2) in the air from above the start to above the goal, clear of all rock.

    """

    kinds: tuple[str, ...]
    ground: Ground
    conditions: Conditions
    route: tuple[tuple[float, float], ...]

    @property
    def start(self) -> Doubles:
        """The start: x, y, vx, vy, angle, spin of a craft that stands on the last pad."""
        pad = self.ground.pads[-1]
        return np.array([pad.x, pad.top + PARAMS.stand, 0.0, 0.0, 0.0, 0.0])

    def begin(self, tank: float, frame_skip: int = 1) -> LanderEnv:
        """Return a lander on its feet at the start, with that much fuel."""
        conditions = replace(self.conditions, tank=tank)
        env = LanderEnv(1, 0, frame_skip=frame_skip, ground=self.ground, limits=AREA, conditions=conditions)
        env.reset()
        env.place(np.ones(1, dtype=bool), self.start[None])
        return env


def leg_of(seed: int, start: LegStart) -> Leg:
    """Return the leg that begins so, of the descent with that seed."""
    return leg(seed, start.number, start.bare)


def can_begin(seed: int, start: LegStart) -> bool:
    """Whether a leg of the descent with that seed can begin so: full at first, and on a flat spot only after one."""
    if start.number == 1:
        return start == LegStart()
    pads_before = leg(seed, start.number - 1).ground.pads
    return any(pad.bare for pad in pads_before) if start.bare else start.tank >= _REFILL[0]


@lru_cache(maxsize=8)
def leg(seed: int, number: int, bare: bool = False) -> Leg:
    """Return leg `number` of the descent with that seed; `bare` is whether it begins on a flat spot."""
    rng = np.random.default_rng((seed, number))
    hard = min(1.0, (number - 1) / (_HARDEST - 1))
    length = _between(_LENGTH, hard) + rng.uniform(-1.0, 1.0)
    rise = rng.uniform(0.0, 1.2)
    first = Pad(-length / 2, PARAMS.pad_top, _LEVEL if bare else _between(_WIDTH, max(0.0, hard - 1 / 15)), 0, bare)
    goal = Pad(length / 2, PARAMS.pad_top + rise, _between(_WIDTH, hard))
    kinds = _kinds(number, rng)
    rock = _Rock(first, goal, _HALF_WAY[len(kinds) - 1])
    for kind in kinds:
        getattr(rock, f"_{kind}")(hard, rng)
    windy = max(hard, _LIGHT) * (number > _CALM)
    wind, gust = (most * windy * rng.uniform(0.5, 1.0) for most in _WIND)
    conditions = Conditions(wind=round(float(wind * rng.choice((-1, 1))), 3), gust=round(float(gust), 3))
    return Leg(kinds, rock.ground, conditions, rock.route)


def _between(ends: tuple[float, float], share: float) -> float:
    return ends[0] + share * (ends[1] - ends[0])


def _kinds(number: int, rng: np.random.Generator) -> tuple[str, ...]:
    """Return what stands in the way of a leg: each kind once at first, then any, then two at once."""
    if number <= len(_FIRST):
        return (_FIRST[number - 1],)
    at_goal = str(rng.choice(_FIRST[2:]))
    if number >= _DOUBLE and rng.random() < 0.5:
        return ("ridge", at_goal)
    kind = str(rng.choice(("ridge", at_goal)))
    return ("open",) if rng.random() < _OPEN else (kind,)


class _Rock:
    """The rock of a leg while it is made, and the route around it."""

    def __init__(self, first: Pad, goal: Pad, half_way: float) -> None:
        self.first, self.goal, self.base = first, goal, PARAMS.ground
        self._half_way = half_way
        self._spots: list[Pad] = []
        self._hills: list[Hill] = [knoll(pad, self.base) for pad in (first, goal) if not pad.bare]
        self._roofs: list[Roof] = []
        if first.bare:
            self._hills.append(self._ledge(first.x, first.top - _EDGE, first.width + 0.4))
        self._above = (first.x, first.top + _OVER + 1.6)
        self._way: list[tuple[float, float]] = []
        self._last = (goal.x, goal.top + 4.5)

    @property
    def ground(self) -> Ground:
        """The ground, its goal first and its start last."""
        return Ground((self.goal, *self._spots, self.first), tuple(self._hills), self.base, roofs=tuple(self._roofs))

    @property
    def route(self) -> tuple[tuple[float, float], ...]:
        """Points from above the start to above the goal."""
        return (self._above, *sorted(self._way), self._last)

    def _open(self, hard: float, rng: np.random.Generator) -> None:  # noqa: ARG002
        """A low hill or two, that no sensible path comes near."""
        for share in (0.35, 0.62):
            x = self.first.x + (self.goal.x - self.first.x) * (share + rng.uniform(-0.05, 0.05))
            self._hills.append(self._ledge(x, self.base + rng.uniform(0.6, 1.4), 0.4, 2.2))

    def _ridge(self, hard: float, rng: np.random.Generator) -> None:
        """A high ridge half way, with a flat spot on one of its flanks."""
        x = self.first.x + self._half_way * (self.goal.x - self.first.x) + rng.uniform(-0.6, 0.6)
        room = min(x - self.first.right, self.goal.left - x) - 2.4  # its foot keeps clear of both knolls
        top = self.base + min(_between((4.5, 10.0), hard) + rng.uniform(0.0, 1.0), _STEEP * room)
        self._hills.append(self._ledge(x, top, 0.7, 1 / _STEEP))
        side = float(rng.choice((-1, 1)))
        level = self.base + rng.uniform(0.4, 0.55) * (top - self.base)
        flank = 0.35 + (top - level) / _STEEP
        middle = x + side * (flank + _LEVEL / 2 - 0.1)
        if min(abs(middle - pad.x) - pad.width / 2 for pad in (self.first, self.goal)) > _LEVEL / 2 + 0.8:
            self._hills.append(self._ledge(middle, level, _LEVEL + 0.4, 0.5))
            self._dare(middle, level)
        self._way += [(x - 2.0, top + _OVER), (x + 2.0, top + _OVER)]

    def _canyon(self, hard: float, rng: np.random.Generator) -> None:
        """Two steep table mountains, with the goal between them, and a flat spot on the nearer one."""
        goal, gap = self.goal, self.goal.width / 2 + _between((2.4, 1.5), hard)
        top = goal.top + _between((3.0, 6.0), hard)
        width = 5.0
        for side in (-1, 1):
            middle = goal.x + side * (gap + width / 2 + 0.5)
            self._hills.append(self._ledge(middle, top + rng.uniform(0.0, 0.8) * (side > 0), width, 0.12))
        near = goal.x - gap - width / 2 - 0.5
        self._dare(near, top)
        self._way.append((near - width / 2 - 1.0, top + _OVER))
        self._last = (goal.x, top + _OVER)

    def _overhang(self, hard: float, rng: np.random.Generator, reach: float = 3.4) -> None:
        """A wall behind the goal, with a slab of rock that hangs over it."""
        goal = self.goal
        wall = goal.right + _between((2.6, 1.8), hard)
        bottom = goal.top + _between((7.0, 5.6), hard) + rng.uniform(0.0, 0.4)
        top = bottom + 2.4
        self._hills.append(((wall, self.base), (wall + 0.3, top), (wall + 3.2, top + 0.6), (wall + 5.6, self.base)))
        lip = goal.x - reach
        under = (lip, bottom + 0.9), (lip + 0.7, bottom + 0.2), (wall + 1.0, bottom)
        self._roofs.append((*under, (wall + 1.0, top), (lip + 1.0, bottom + 1.7)))
        self._way.append((lip - 3.5, goal.top + 3.6))
        self._last = (goal.x - 0.5, goal.top + 3.2)

    def _cave(self, hard: float, rng: np.random.Generator) -> None:
        """A longer overhang, behind a sill that closes the lower part of its mouth."""
        self._overhang(hard, rng, reach=6.4)
        lip = self.goal.x - 6.4
        sill = self.base + _between((1.2, 2.0), hard)
        self._hills.append(self._ledge(lip - 0.4, sill, 0.5, 0.5))
        self._way[-1] = (lip - 3.0, self.goal.top + 3.4)
        self._way.append((lip + 0.5, self.goal.top + 3.2))

    def _dare(self, x: float, top: float) -> None:
        """Make level rock a flat spot to land on; a leg has one at most, and the last counts."""
        self._spots = [Pad(x, top + _EDGE, _LEVEL, _DARE, bare=True)]

    def _ledge(self, x: float, top: float, width: float, flank: float = 1.2) -> Hill:
        """Return a hill with a level top `width` metres wide, and flanks `flank` metres wide for each of height."""
        foot = width / 2 + flank * (top - self.base)
        return (x - foot, self.base), (x - width / 2, top), (x + width / 2, top), (x + foot, self.base)
