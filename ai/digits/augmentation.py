"""Data augmentation: MNIST's images slanted, turned, bent and written with other pens.

After Simard, Steinkraus and Platt 2003. Every change is followed by what preprocessing would do to such a
drawing: it is fitted to the box and centred again.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from ai.digits.preprocessing import BOX, CENTRE, SIDE

Images = npt.NDArray[np.float32]
MIDDLE = CENTRE - 0.5  # of pixel 14, counted in pixels from the middle of pixel 0


@dataclass(frozen=True)
class Strength:
    """Strength of each change: standard deviations, except for `shift`, which is the maximum."""

    rotation: float = 0.12  # rad
    slant: float = 0.15  # pixels aside for each pixel up
    aspect: float = 0.1  # of the logarithm
    scale: float = 0.05  # of the logarithm, after fitting to the box
    shift: float = 1.0  # pixels, after centring
    bend: float = 1.0  # pixels
    pen: float = 0.5  # of how far greys are bent: strokes grow and shrink with it

    def times(self, factor: float) -> Strength:
        """Return all changes `factor` times as strong."""
        return Strength(**{name: value * factor for name, value in vars(self).items()})


def augment(images: Images, rng: np.random.Generator, strength: Strength | None = None) -> Images:
    """Return changed copies of `images`, (n, 28, 28) float32 in 0 to 1, each by a change of its own."""
    s = strength or Strength()
    n = len(images)
    if not n:
        return images.copy()
    turn, slant, aspect, scale, pen = rng.standard_normal((5, n), np.float32)
    shift = rng.uniform(-s.shift, s.shift, (2, n, 1, 1)).astype(np.float32)
    bend = _bend(rng, n, s.bend)

    # Where in the original each pixel of the result comes from: (n, 2, 2) times a place, plus a bend.
    cosine, sine = np.cos(s.rotation * turn), np.sin(s.rotation * turn)
    stretch = np.exp(0.5 * s.aspect * aspect)
    matrix = np.empty((n, 2, 2), np.float32)  # by (down, across)
    matrix[:, 0, 0], matrix[:, 0, 1] = cosine * stretch, -sine / stretch
    matrix[:, 1, 0] = (sine + cosine * s.slant * slant) * stretch
    matrix[:, 1, 1] = (cosine - sine * s.slant * slant) / stretch

    # A first, rough look shows where the ink goes, the second puts it where it belongs.
    place = np.arange(SIDE, dtype=np.float32) - MIDDLE
    down, across = _sources(matrix, place[:, None], place[None, :], bend)
    middle, size = _measure(_nearest(images, down, across))
    pitch = (np.clip(size, 10, 30) / BOX * np.exp(s.scale * scale)).astype(np.float32)[:, None, None]
    rows = (place[:, None] - shift[0]) * pitch + middle[0]
    columns = (place[None, :] - shift[1]) * pitch + middle[1]
    result = _bilinear(images, *_sources(matrix, rows, columns, bend))

    # An edge is grey where a pixel is partly covered: bending the greys moves it, and leaves black and white.
    result /= result + np.exp(s.pen * np.clip(pen, -2, 2))[:, None, None] * (1 - result) + np.float32(1e-6)
    result -= 0.5
    result *= 1.3
    result += 0.5
    return np.clip(result, 0.0, 1.0, out=result)


def _sources(matrix: Images, rows: Images, columns: Images, bend: Images) -> tuple[Images, Images]:
    """Return the places, (n, 28, 28) down and across, that the matrix and the bend send a grid of places to."""
    m = matrix[:, :, :, None, None]
    down, across = (m[:, axis, 0] * rows + m[:, axis, 1] * columns + bend[axis] + MIDDLE for axis in (0, 1))
    return down, across


def _bend(rng: np.random.Generator, n: int, strength: float) -> Images:
    """Return smooth random displacements, (2, n, 28, 28): independent ones at 6 x 6 places, and splines between."""
    knots = rng.standard_normal((2, n, 6, 6), np.float32) * np.float32(strength)
    spline = _spline(6)
    return spline @ knots @ spline.T


@lru_cache
def _spline(knots: int) -> Images:
    """Return how much each knot counts for each of 28 pixels, (28, knots): cubic B-splines."""
    x = np.abs(np.linspace(0.5, knots - 1.5, SIDE)[:, None] - np.arange(knots))
    near, far = 2 / 3 - x * x + x**3 / 2, (2 - x) ** 3 / 6
    return np.where(x < 1, near, np.where(x < 2, far, 0.0)).astype(np.float32)


def _measure(images: Images) -> tuple[tuple[Images, Images], npt.NDArray[np.float64]]:
    """Return each image's centre of mass, from the middle pixel, and the longer side of its box, in pixels."""
    place = np.arange(SIDE, dtype=np.float32) - np.float32(MIDDLE)
    by_row, by_column = images.sum(axis=2), images.sum(axis=1)
    mass = np.maximum(by_row.sum(axis=1), 1e-6)
    middle = tuple((by @ place / mass)[:, None, None] for by in (by_row, by_column))
    ink = images > 0.3
    sides = []
    for lines in (ink, ink.transpose(0, 2, 1)):
        line = np.logical_or.reduce(lines, axis=2)
        sides.append(SIDE - line.argmax(axis=1) - line[:, ::-1].argmax(axis=1))
    return (middle[0], middle[1]), np.maximum(*sides).astype(np.float64)


PADDED = SIDE + 2


def _flat(images: Images) -> tuple[Images, npt.NDArray[np.intp]]:
    """Return the images in a border of zeros as one vector, and where each of them begins."""
    padded = np.zeros((len(images), PADDED, PADDED), np.float32)
    padded[:, 1:-1, 1:-1] = images
    return padded.reshape(-1), (np.arange(len(images)) * PADDED**2)[:, None, None]


def _nearest(images: Images, down: Images, across: Images) -> Images:
    flat, first = _flat(images)
    row = np.clip(np.rint(down), -1, SIDE).astype(np.intp) + 1
    column = np.clip(np.rint(across), -1, SIDE).astype(np.intp) + 1
    return flat.take(first + row * PADDED + column)


def _bilinear(images: Images, down: Images, across: Images) -> Images:
    flat, first = _flat(images)
    down, across = np.clip(down + 1, 0.0, PADDED - 1.001), np.clip(across + 1, 0.0, PADDED - 1.001)
    row, column = down.astype(np.intp), across.astype(np.intp)
    down = (down - row).astype(np.float32)
    across = (across - column).astype(np.float32)
    place = first + row * PADDED + column
    above = flat.take(place)
    above += across * (flat.take(place + 1) - above)
    place += PADDED
    below = flat.take(place)
    below += across * (flat.take(place + 1) - below)
    below -= above
    below *= down
    above += below
    return above
