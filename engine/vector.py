"""Vector kernels on arrays whose last axis is (x, y).

Sums over the two components are written out: a reduction over an axis may add in another order in another
batch, and a flight must be the same, bit for bit, alone and among a thousand.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Ints = NDArray[np.intp]


def finite(name: str, value: object) -> Array:
    """Return `value` as an array of floats; raise ValueError, with its `name`, if any is not finite."""
    numbers = np.asarray(value, dtype=float)
    if not np.isfinite(numbers).all():
        raise ValueError(f"{name} must be finite, not {value}")
    return numbers


def dot(a: Array, b: Array) -> Array:
    """Scalar product, (..., 2) and (..., 2) to (...)."""
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]


def cross(a: Array, b: Array) -> Array:
    """z component of the vector product, (..., 2) and (..., 2) to (...)."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def length(a: Array) -> Array:
    """Euclidean length, (..., 2) to (...)."""
    return np.sqrt(dot(a, a))


def right_of(a: Array) -> Array:
    """`a` turned a quarter clockwise: along an edge of a counter-clockwise polygon, this points outwards."""
    turned = np.empty_like(a)
    turned[..., 0] = a[..., 1]
    turned[..., 1] = -a[..., 0]
    return turned


def rotate(a: Array, cos: Array, sin: Array) -> Array:
    """`a` turned counter-clockwise by the angle whose cosine and sine are given (broadcast against a's)."""
    x, y = a[..., 0], a[..., 1]
    turned_x = x * cos - y * sin
    turned = np.empty((*turned_x.shape, 2))
    turned[..., 0] = turned_x
    turned[..., 1] = x * sin + y * cos
    return turned
