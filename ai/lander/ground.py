"""Ground: a plain, hills on it, and one pad or several to land on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, Final

import numpy as np

from ai.environment import Bools, Doubles
from ai.lander.rules import PARAMS, LanderParams
from engine import Body, Polygon, World

_PLAIN: Final = (80.0, 10.0)  # metres wide and deep
_BUMP: Final = np.linspace(-1.0, 1.0, 9)  # corners of a hill, from foot to foot
_RIM: Final = 0.5  # metres that a knoll is wider than its pad, to each side
_LIP: Final = 0.3  # and how much lower
_SLOPE: Final = 1.2  # metres that its flank is wide for every metre of height


@dataclass(frozen=True)
class Pad:
    """Landing pad; the score of a landing on it is multiplied by `factor`, and with 0 it ends no flight.

    A `bare` one is level rock: a flat spot without a pad.
    """

    x: float  # metres, of its middle
    top: float
    width: float
    factor: int = 1
    bare: bool = False

    @property
    def left(self) -> float:
        """Left edge, metres."""
        return self.x - self.width / 2

    @property
    def right(self) -> float:
        """Right edge, metres."""
        return self.x + self.width / 2


PADS: Final = ((6.0, 1), (4.4, 3), (3.6, 5))  # width in metres, factor; the feet span 2.1

Hill = tuple[tuple[float, float], ...]  # its surface from left foot to right, convex from above
Roof = tuple[tuple[float, float], ...]  # corners, counter-clockwise, of a convex rock with air under it


@dataclass(frozen=True)
class Ground:
    """A plain at height `base`, convex hills on it, rocks over it, and pads; metres.

    With `in_turn`, the pads may lie in one place, and a slot has one of them, its target.
    """

    pads: tuple[Pad, ...]
    hills: tuple[Hill, ...] = ()
    base: float = PARAMS.ground
    in_turn: bool = False
    roofs: tuple[Roof, ...] = ()

    def __post_init__(self) -> None:
        if not self.pads:
            raise ValueError("there must be a pad to land on")
        if any(pad.width <= 0 or pad.top <= self.base for pad in self.pads):
            raise ValueError(f"a pad is wider than nothing and higher than the plain at {self.base} m")
        rows = sorted(self.pads, key=lambda pad: pad.x)
        if not self.in_turn and any(left.right > right.left for left, right in pairwise(rows)):
            raise ValueError("pads must not overlap")

    @classmethod
    def flat(cls, params: LanderParams = PARAMS) -> Ground:
        """One pad in the middle of a plain, as networks are trained on."""
        return cls((Pad(0.0, params.pad_top, params.pad_width),), base=params.ground)

    @cached_property
    def text(self) -> str:
        """Text that is the same for equal grounds alone."""
        return repr(self)

    @cached_property
    def at_once(self) -> int:
        """How many pads a slot has."""
        return 1 if self.in_turn else len(self.pads)

    @cached_property
    def middles(self) -> Doubles:
        """Middle of every pad's top, (pads, 2)."""
        return np.array([(pad.x, pad.top) for pad in self.pads])

    @cached_property
    def widths(self) -> Doubles:
        """Width of every pad, metres, (pads,)."""
        return np.array([pad.width for pad in self.pads])

    @cached_property
    def ends(self) -> Bools:
        """Whether standing on each pad ends a flight, (pads,)."""
        return np.array([pad.factor > 0 for pad in self.pads])

    def height(self, x: Doubles | float) -> Doubles:
        """Height in metres of what lies under x, of any shape: a pad's top, a hill, or the plain, below any roof."""
        height = np.full(np.shape(x), self.base)
        for hill in self.hills:
            across, up = np.array(hill).T
            height = np.maximum(height, np.interp(x, across, up))
        for pad in self.pads:
            height = np.where((pad.left <= np.asarray(x)) & (np.asarray(x) <= pad.right), pad.top, height)
        return height

    def roofed(self, place: Doubles) -> Bools:
        """Whether places (k, 2) lie inside a roof, (k,)."""
        inside = np.zeros(len(place), dtype=bool)
        for roof in self.roofs:
            edges = np.array([half_plane(a, b) for a, b in pairwise((*roof, roof[0]))])
            inside |= (place @ edges[:, :2].T <= edges[:, 2]).all(axis=1)
        return inside

    def build(self, world: World, **surface: Any) -> list[Body]:
        """Put the ground into a world; return the pads. What else there is comes after them."""
        pads = []
        for pad, shape in zip(self.pads, self._decks, strict=True):
            pads.append(world.add(shape, (pad.x, pad.top), static=True, **surface))
        world.add(self._land, (0.0, self._depth), static=True, **surface)
        return pads

    @cached_property
    def _decks(self) -> list[Polygon]:
        """Shapes of the pads, the middle of each top at the origin."""
        heights = [(pad.width, pad.top - self.base) for pad in self.pads]
        return [Polygon.box(width, height, (0.0, -height / 2)) for width, height in heights]

    @cached_property
    def _land(self) -> list[Polygon]:
        """Shapes of the plain, a deep box, and of hills and roofs, from that box's middle; cached, as slow to make."""
        rocks = [Polygon(np.array(rock) - (0.0, self._depth)) for rock in (*self.hills, *self.roofs)]
        return [Polygon.box(*_PLAIN), *rocks]

    @property
    def _depth(self) -> float:
        """Height of the plain's middle."""
        return self.base - _PLAIN[1] / 2


def half_plane(start: tuple[float, float], end: tuple[float, float]) -> tuple[float, float, float]:
    """Return nx, ny, far of an edge of a rock whose corners run counter-clockwise: outside, nx·x + ny·y > far."""
    across, up = end[0] - start[0], end[1] - start[1]
    long = math.hypot(across, up)
    nx, ny = up / long, -across / long
    return nx, ny, nx * start[0] + ny * start[1]


def hilly(rng: np.random.Generator, pads: Sequence[tuple[float, int]] = PADS) -> Ground:
    """Make hills, and pads of these widths and factors in random order on knolls among them.

    Networks learn on a plain, and come in low over the last metres. So everything stays below the paths on
    which they approach any of the pads.
    """
    base, count = PARAMS.ground, len(pads)
    gap = 9.5
    rows = []
    for row, pick in enumerate(rng.permutation(count)):
        width, factor = pads[pick]
        x = gap * (row - (count - 1) / 2) + rng.uniform(-0.7, 0.7)
        rows.append(Pad(float(x), float(PARAMS.pad_top + rng.uniform(0.0, 1.4)), width, factor))
    knolls = [knoll(pad, base) for pad in rows]
    edge = gap * count / 2
    crests = [gap * (row - count / 2) for row in range(1, count)]  # between pads, and some beyond them
    crests += [-edge - 1.0, edge + 1.0, -edge - 5.0, edge + 5.0]
    hills = [_hill(crest + rng.uniform(-0.8, 0.8), rng.uniform(0.55, 1.0), rows, rng) for crest in crests]
    return Ground(tuple(rows), tuple(knolls + [hill for hill in hills if hill]), base)


def knoll(pad: Pad, base: float) -> Hill:
    """Return the knoll that lifts a pad off the plain: flat under it, with flanks on both sides."""
    top = pad.top - _LIP
    foot = _SLOPE * (top - base)
    return (
        (pad.left - _RIM - foot, base),
        (pad.left - _RIM, top),
        (pad.right + _RIM, top),
        (pad.right + _RIM + foot, base),
    )


def _hill(crest: float, share: float, pads: Sequence[Pad], rng: np.random.Generator) -> Hill | None:
    """Return a hill `share` as high as may be, or None where there is no room for one."""
    base = PARAMS.ground
    x = crest + _BUMP * rng.uniform(2.2, 3.4)
    x += 0.5 * (1 - _BUMP**2) * rng.uniform(-1.0, 1.0)  # leans to one side
    bump = 1.0 - _BUMP**2
    room = np.min([pad.top + clearance(x - pad.x) for pad in pads], axis=0) - base
    height = share * float((room[1:-1] / bump[1:-1]).min())
    if height < 0.3:
        return None
    return tuple(zip(x.tolist(), (base + height * bump).tolist(), strict=True))


def clearance(away: Doubles) -> Doubles:
    """Metres above a pad's top that a network's approach leaves free, `away` metres to the side of its middle.

    A little less than the lowest of 1,000 flights of the network that comes with the game.
    """
    clear: Doubles = np.minimum(2.6, 0.6 * (np.abs(away) - 2.4))
    return clear
