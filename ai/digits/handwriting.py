"""Digits that simulated hands write, to learn from beside MNIST's: as the world writes, and as a mouse reports it.

A style is a way to write a digit, given by the few points that a pen goes through. A hand writes it in its own manner:
wide or narrow, slanted, turned, bent, with round or sharp corners, sure or unsure of where points lie, and in haste
or not, which decides how many of them a mouse reports. Few of MNIST's writers give a 1 a long flag: here it is common.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np

from ai.digits.preprocessing import Image, preprocess_strokes
from ai.digits.strokes import Points

Style = tuple[tuple[tuple[float, float], ...], ...]  # strokes of points

# Points in percent of a box, x to the right and y down. A point that comes twice is a corner.
STYLES: Final[dict[int, tuple[Style, ...]]] = {
    0: (
        (((60, 3), (30, 4), (8, 28), (6, 66), (30, 96), (66, 97), (92, 70), (94, 32), (74, 6), (50, 4)),),
        (((40, 6), (16, 30), (12, 72), (42, 98), (78, 82), (90, 46), (76, 12), (44, 2), (24, 14)),),
        (((36, 2), (70, 6), (93, 40), (84, 82), (50, 99), (16, 82), (6, 44), (22, 10), (46, 2)),),
        (((78, 14), (48, 0), (14, 22), (6, 62), (36, 98), (76, 86), (96, 46), (82, 10), (60, 10), (50, 22)),),
        (((56, 2), (22, 10), (4, 50), (24, 92), (58, 98), (90, 72), (94, 30), (58, 2)),),
    ),
    1: (
        (((48, 0), (52, 100)),),
        (((56, 0), (50, 50), (46, 100)),),
        (((36, 16), (54, 0), (54, 0), (54, 100)),),
        (((24, 24), (58, 0), (58, 0), (56, 100)),),
        (((12, 30), (40, 16), (66, 0), (66, 0), (64, 100)),),
        (((2, 44), (36, 24), (68, 0), (68, 0), (66, 100)),),
        (((0, 58), (38, 30), (74, 0), (74, 0), (72, 50), (72, 100)),),
        (((6, 36), (44, 24), (72, 0), (72, 0), (70, 100)),),
        (((26, 20), (54, 0), (54, 0), (52, 100)), ((24, 99), (82, 98))),
        (((10, 40), (58, 0), (58, 0), (56, 98)), ((22, 99), (92, 99))),
        (((14, 32), (54, 0), (54, 0), (54, 99), (54, 99), (20, 100), (20, 100), (90, 99)),),
    ),
    2: (
        (((10, 28), (24, 6), (60, 0), (82, 20), (66, 54), (6, 98), (6, 98), (50, 98), (92, 97)),),
        (((14, 20), (50, 0), (84, 22), (58, 62), (8, 96), (8, 96), (92, 94)),),
        (((8, 18), (46, 2), (76, 22), (60, 58), (22, 92), (6, 84), (24, 74), (56, 92), (94, 90)),),
        (((12, 6), (60, 0), (86, 18), (70, 48), (10, 99), (10, 99), (94, 99)),),
        (((20, 30), (16, 10), (46, 0), (78, 14), (76, 44), (40, 78), (4, 98), (4, 98), (34, 90), (66, 98), (98, 88)),),
    ),
    3: (
        (((10, 10), (46, 0), (80, 14), (74, 38), (40, 46), (40, 46), (82, 60), (84, 86), (46, 100), (6, 92)),),
        (((14, 18), (40, 0), (76, 10), (72, 36), (36, 48), (74, 56), (86, 80), (54, 100), (10, 86)),),
        (((8, 2), (84, 2), (84, 2), (40, 42), (40, 42), (76, 50), (86, 76), (58, 98), (6, 94)),),
        (((6, 6), (50, 0), (76, 20), (52, 44), (34, 50), (44, 40), (72, 54), (88, 78), (60, 99), (8, 96)),),
        (((16, 4), (78, 0), (78, 0), (48, 38), (48, 38), (82, 60), (70, 92), (30, 100), (8, 86)),),
    ),
    4: (
        (((14, 0), (8, 52), (8, 52), (92, 56)), ((78, 8), (74, 100))),
        (((26, 4), (14, 40), (20, 58), (56, 58), (88, 50)), ((76, 2), (72, 50), (70, 100))),
        (((60, 0), (8, 60), (8, 60), (96, 60)), ((62, 30), (60, 100))),
        (((72, 0), (2, 68), (2, 68), (94, 70)), ((72, 0), (70, 100))),
        (((64, 100), (66, 0), (66, 0), (2, 70), (2, 70), (94, 68)),),
        (((20, 2), (4, 62), (4, 62), (96, 62)), ((62, 38), (58, 100))),
        (((10, 8), (14, 46), (48, 54), (80, 44)), ((84, 0), (84, 50), (80, 100))),
    ),
    5: (
        (((18, 0), (14, 42), (14, 42), (50, 34), (86, 56), (78, 88), (38, 100), (6, 88)), ((18, 2), (86, 4))),
        (((84, 2), (20, 0), (20, 0), (16, 46), (16, 46), (58, 36), (90, 62), (70, 96), (8, 94)),),
        (((90, 0), (26, 4), (14, 46), (54, 40), (84, 60), (72, 92), (32, 100), (4, 86)),),
        (((82, 6), (40, 2), (22, 24), (50, 44), (80, 62), (68, 94), (10, 96)),),
        (((24, 6), (10, 48), (10, 48), (46, 44), (82, 58), (82, 84), (48, 98), (0, 96)), ((22, 6), (96, 0))),
    ),
    6: (
        (((74, 2), (36, 20), (10, 60), (20, 94), (62, 99), (88, 78), (66, 56), (28, 62), (12, 82)),),
        (((64, 0), (20, 48), (10, 82), (44, 100), (84, 86), (70, 62), (36, 62), (14, 86)),),
        (((84, 10), (58, 0), (22, 26), (6, 68), (34, 99), (76, 92), (80, 62), (44, 54), (12, 74)),),
        (((34, 0), (14, 40), (10, 80), (40, 100), (78, 88), (76, 62), (46, 54), (14, 70)),),
        (((56, 0), (12, 70), (34, 100), (72, 88), (60, 66), (20, 80)),),
    ),
    7: (
        (((6, 4), (88, 0), (88, 0), (44, 100)),),
        (((2, 0), (94, 4), (94, 4), (60, 40), (48, 100)),),
        (((10, 2), (84, 2), (84, 2), (56, 100)),),
        (((4, 6), (34, 2), (92, 0), (92, 0), (30, 100)),),
        (((6, 24), (10, 2), (10, 2), (90, 2), (90, 2), (44, 100)),),
        (((10, 16), (10, 0), (10, 0), (86, 2), (86, 2), (62, 44), (52, 100)),),
        (((4, 2), (90, 0), (90, 0), (42, 100)), ((30, 46), (82, 44))),
        (((6, 4), (92, 2), (92, 2), (58, 48), (46, 100)), ((20, 56), (86, 50))),
        (((10, 0), (84, 0), (84, 0), (50, 100)), ((40, 40), (92, 46))),
        (((6, 20), (8, 2), (8, 2), (92, 0), (92, 0), (40, 100)), ((22, 52), (84, 46))),
        (((2, 8), (26, 2), (60, 8), (96, 2), (96, 2), (50, 100)),),
        (((2, 10), (24, 2), (62, 8), (94, 0), (94, 0), (44, 100)), ((26, 54), (80, 52))),
    ),
    8: (
        (((76, 14), (50, 0), (20, 14), (34, 38), (72, 58), (84, 84), (48, 100), (14, 84), (30, 58), (68, 36),
          (78, 14)),),
        (((50, 46), (18, 26), (46, 0), (82, 22), (50, 46), (12, 74), (48, 100), (88, 74), (50, 46)),),
        (((84, 4), (36, 0), (18, 22), (52, 48), (82, 74), (50, 100), (16, 76), (48, 48), (88, 6)),),
        (((40, 50), (22, 24), (48, 0), (76, 20), (54, 46)), ((52, 46), (14, 72), (44, 100), (88, 78), (54, 46))),
        (((26, 22), (50, 0), (80, 16), (62, 42), (24, 66), (20, 92), (56, 100), (84, 82), (66, 56), (34, 38),
          (26, 20)),),
    ),
    9: (
        (((82, 22), (52, 0), (14, 18), (24, 48), (62, 48), (84, 20), (84, 20), (80, 100)),),
        (((78, 8), (40, 2), (12, 30), (42, 54), (78, 30), (80, 6), (80, 6), (72, 60), (52, 100)),),
        (((80, 24), (54, 0), (16, 14), (16, 42), (52, 52), (82, 22), (84, 58), (68, 94), (22, 98)),),
        (((86, 16), (44, 0), (8, 30), (46, 54), (84, 24), (78, 70), (52, 98), (14, 84)),),
        (((74, 28), (48, 4), (16, 26), (42, 50), (74, 26)), ((78, 2), (76, 100))),
        (((56, 0), (14, 20), (40, 48), (80, 30), (58, 2), (80, 8), (76, 100)),),
    ),
}  # fmt: skip
CROSSED: Final = 0.4  # of zeros: these have a stroke through the ring
SLASHES: Final = (55, 125, 90, 0)  # degrees: rising, falling, upright, level
# Shares of digits that are narrow, and how wide these are at the least, in heights: a 0 and an 8 may be taken for a 1.
NARROW: Final = {0: (0.3, 0.12), 8: (0.3, 0.12)}
NARROW_OTHERS: Final = (0.1, 0.22)


def written(digit: int, rng: np.random.Generator) -> list[Points]:
    """Return a digit as strokes of points (n, 2), in whole pixels, y down, as a random hand writes it."""
    style = STYLES[digit][rng.integers(len(STYLES[digit]))]
    if digit == 0 and rng.random() < CROSSED:
        style = crossed(style, rng)
    height = np.exp(rng.uniform(np.log(50), np.log(450)))  # pixels
    narrow, thin = NARROW.get(digit, NARROW_OTHERS)
    least, most = (thin, 0.4) if rng.random() < narrow else (0.4, 1.0)
    extent = height * np.array([np.exp(rng.uniform(np.log(least), np.log(most))), 1.0])
    slant, turn = np.clip(rng.normal(0.1, 0.18), -0.3, 0.6), rng.normal(0, 0.08)
    cosine, sine = np.cos(turn), np.sin(turn)
    manner = np.array([[1.0, 0.0], [-slant, 1.0]]) * extent @ np.array([[cosine, sine], [-sine, cosine]])
    unsure, round_corners, samples = rng.uniform(1, 5), rng.random() < 0.35, int(rng.integers(3, 13))
    phases, heights = rng.uniform(0, 2 * np.pi, (2, 2)), rng.normal(0, 0.02, (2, 2))
    strokes = []
    for stroke in style:
        points = np.array(stroke, float)
        again = np.flatnonzero((points[1:] == points[:-1]).all(axis=1)) + 1
        points += rng.normal(0, unsure, points.shape)
        points[again] = points[again - 1]
        parts = [np.delete(points, again, axis=0)] if round_corners else np.split(points, again)
        way = np.concatenate([_smooth(part, samples) for part in parts]) / 100 - 0.5
        for waves in range(2):  # a bend across all strokes alike
            way = way + np.sin((2 + waves) * np.pi * way[:, ::-1] + phases[waves]) * heights[waves]
        strokes.append(np.rint(way @ manner))
    return strokes


def crossed(ring: Style, rng: np.random.Generator) -> Style:
    """Return a zero's ring with a stroke through it, seldom two, in any direction.

    Each end lies inside the ring, on it or outside. One hand in four goes on to it without lifting the pen.
    """
    angles = [rng.choice(SLASHES, p=(0.5, 0.2, 0.15, 0.15))]
    if rng.random() < 0.12:  # a cross, or two strokes side by side
        angles.append(angles[0] + rng.choice((0, 70, 90)))
    slashes = []
    for number, angle in enumerate(angles):
        turned = np.radians(angle + rng.normal(0, 10))
        way = 45 * np.array([np.cos(turned), -np.sin(turned)])
        aside = np.array([way[1], -way[0]]) * (number and 0.4)
        middle = 50 + aside + rng.normal(0, 5, 2)
        ends = [middle + way * rng.uniform(0.45, 1.7), middle - way * rng.uniform(0.45, 1.7)]
        slashes.append(tuple((float(x), float(y)) for x, y in ends[:: rng.choice((1, -1))]))
    if rng.random() < 0.25:
        first, *others = slashes
        last = ring[-1][-1]
        return (*ring[:-1], (*ring[-1], last, first[0], first[0], first[1]), *others)
    return (*ring, *slashes)


def drawings(digits: np.ndarray, rng: np.random.Generator) -> Image:
    """Return what a network reads of digits (n,), each written by a hand of its own: (n, 28, 28) in 0 to 1."""
    images = [preprocess_strokes(written(int(digit), rng)) for digit in digits]
    return np.stack(images) if images else np.empty((0, 28, 28), np.float32)


def _smooth(points: Points, samples: int) -> Points:
    """Return a smooth way through points (n, 2), with so many points to a piece (uniform Catmull-Rom)."""
    padded = np.concatenate([2 * points[:1] - points[1:2], points, 2 * points[-1:] - points[-2:-1]])
    pieces = np.stack([padded[i : len(padded) - 3 + i] for i in range(4)])
    way = np.tensordot(_weights(samples), pieces, 1).swapaxes(0, 1).reshape(-1, 2)
    return np.concatenate([way, points[-1:]])


@lru_cache
def _weights(samples: int) -> np.ndarray:
    """Return how much each of four neighbours counts at places between the middle two, (samples, 4)."""
    t = np.arange(samples)[:, None] / samples
    matrix = 0.5 * np.array([[0, 2, 0, 0], [-1, 0, 1, 0], [2, -5, 4, -1], [-1, 3, -3, 1]])
    weights: np.ndarray = t ** np.arange(4) @ matrix
    return weights
