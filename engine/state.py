"""Arrays of body state, which each step changes, and of body parameters and shapes, which it does not.

Position and angle share an array, and so do velocity and spin, because everything that is integrated, solved
or reset treats the three components alike.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from engine.shapes import Circle, Polygon, Shape
from engine.vector import Array, Bools, Ints, rotate

Span = slice | Ints
_LARGEST: Final = float(np.finfo(float).max)
# Largest values of the tables that have any, and the tables in which NaN stands for a value left out.
_MOST: Final = dict.fromkeys(("inverse_mass", "linear_drag", "quadratic_drag", "friction"), _LARGEST) | {
    "restitution": 1.0
}
_LEFT_OUT: Final = ("restitution", "friction")
ALL: Final = slice(None)


def span(chosen: Bools) -> Span:
    """Indices of the chosen bodies; a slice, which indexes without a copy, if they are neighbours."""
    rows = np.flatnonzero(chosen)
    if len(rows) and rows[-1] - rows[0] == len(rows) - 1:
        return slice(int(rows[0]), int(rows[-1]) + 1)
    return rows


@dataclass
class BodyState:
    """State of the bodies, which each step changes. All arrays lead with (batch, bodies)."""

    pose: Array  # (..., 3): x, y in metres, angle in radians
    velocity: Array  # (..., 3): m/s, m/s, rad/s
    force: Array  # (..., 3): N, N, N·m, cleared by each step
    active: Bools  # (...): an inactive body neither moves nor touches
    cos: Array  # (...) of the angle, kept beside it because every phase needs them
    sin: Array

    @classmethod
    def empty(cls, batch: int) -> BodyState:
        """Return the state of `batch` worlds without bodies."""
        triple, single = (batch, 0, 3), (batch, 0)
        return cls(np.zeros(triple), np.zeros(triple), np.zeros(triple),
                   np.zeros(single, dtype=bool), np.zeros(single), np.zeros(single))  # fmt: skip

    def append(self, pose: Array) -> None:
        """Add a body at rest in every world, at `pose` (batch, 3)."""
        batch = len(self.pose)
        zeros = np.zeros((batch, 1, 3))
        self.pose = np.concatenate([self.pose, pose[:, None, :]], axis=1)
        self.velocity = np.concatenate([self.velocity, zeros], axis=1)
        self.force = np.concatenate([self.force, zeros], axis=1)
        self.active = np.concatenate([self.active, np.ones((batch, 1), dtype=bool)], axis=1)
        self.cos = np.concatenate([self.cos, zeros[..., 0]], axis=1)
        self.sin = np.concatenate([self.sin, zeros[..., 0]], axis=1)
        self.refresh_rotation()

    def refresh_rotation(self, bodies: Span = ALL) -> None:
        """Bring `cos` and `sin` of some bodies up to date after their poses have changed."""
        # A strided array may take another code path than a contiguous one, and differ in the last bit.
        angle = np.ascontiguousarray(self.pose[:, bodies, 2])
        self.cos[:, bodies], self.sin[:, bodies] = np.cos(angle), np.sin(angle)


@dataclass
class BodyParams:
    """Mass, drag and surface of the bodies. Rows are bodies, the same in every world of the batch.

    A table may be replaced at any time by another of its shape, and holds from the next step on, which begins without
    sleep and without the last one's impulses. Once all bodies are there, `quadratic_drag` may be made (batch, bodies,
    3), one air for each world, and written into; the others can't be written into. Raises ValueError for values without
    physical sense.
    """

    inverse_mass: Array = field(default_factory=lambda: np.zeros((0, 3)))  # 1/kg twice, 1/(kg·m²); 0: static
    linear_drag: Array = field(default_factory=lambda: np.zeros((0, 3)))  # kg/s, kg/s, kg·m²/s
    quadratic_drag: Array = field(default_factory=lambda: np.zeros((0, 3)))  # kg/m, kg/m, kg·m²
    restitution: Array = field(default_factory=lambda: np.zeros(0))  # NaN: takes the other body's
    friction: Array = field(default_factory=lambda: np.zeros(0))
    group: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.intp))
    version: int = 0  # one more each time a table is replaced

    def __setattr__(self, name: str, value: object) -> None:
        """Replace a table by a copy of this one."""
        before = self.__dict__.get(name)
        if name == "version" or before is None:
            object.__setattr__(self, name, value)
            return
        table = np.array(value, dtype=before.dtype)
        for_each_world = name == "quadratic_drag" and table.ndim == 3
        if (table.shape[1:] if for_each_world else table.shape) != before.shape[-table.ndim + for_each_world :]:
            raise ValueError(f"{name} must be of shape {before.shape}, not {table.shape}")
        if name in _MOST and not (np.isnan(table) * (name in _LEFT_OUT) | (table >= 0) & (table <= _MOST[name])).all():
            raise ValueError(f"{name} must be from 0 to {_MOST[name]}, not {table.tolist()}")
        self._put(name, table)

    def append(self, **row: object) -> None:
        """Add one body's row to every table."""
        for name, value in row.items():
            table = getattr(self, name)
            self._put(name, np.concatenate([table, np.asarray(value, dtype=table.dtype)[None]]))

    def _put(self, name: str, table: Array | Ints) -> None:
        table.flags.writeable = table.ndim == 3
        object.__setattr__(self, name, table)
        self.version += 1

    @property
    def dynamic(self) -> Bools:
        """Whether forces can move each body, (bodies,)."""
        return self.inverse_mass[:, 0] > 0


class ShapeTable:
    """Every shape of a world, padded to one number of corners so that one kernel serves them all.

    Padding repeats the last edge, which is harmless: a repeated face can't separate what the first did not.
    """

    def __init__(self, shapes: list[Shape], bodies: list[int], dynamic: Bools) -> None:
        count = max([len(s.vertices) for s in shapes if isinstance(s, Polygon)], default=3)
        self.body = np.array(bodies, dtype=np.intp)
        self.fixed = ~dynamic[self.body]
        self.is_circle = np.array([isinstance(s, Circle) for s in shapes], dtype=bool)
        self.radius = np.array([s.radius if isinstance(s, Circle) else 0.0 for s in shapes])
        self.centre = np.array([s.centroid for s in shapes]).reshape(-1, 2)
        self.reach = np.array([s.bounding_radius for s in shapes])
        self.start = np.zeros((len(shapes), count, 2))  # where each edge begins
        self.end = np.zeros_like(self.start)
        self.normal = np.zeros_like(self.start)
        for row, shape in enumerate(shapes):
            if isinstance(shape, Polygon):
                last = len(shape.vertices) - 1
                for table, edges in (
                    (self.start[row], shape.vertices),
                    (self.end[row], shape.vertices[[*range(1, last + 1), 0]]),
                    (self.normal[row], shape.normals),
                ):
                    table[:last], table[last:] = edges[:last], edges[last]

    def __len__(self) -> int:
        return len(self.body)

    def centres(self, state: BodyState, world: Ints, shape: Ints) -> Array:
        """Centroids (n, 2) of some shapes in their worlds."""
        body = self.body[shape]
        centre = rotate(self.centre[shape], state.cos[world, body], state.sin[world, body])
        centre += state.pose[world, body, :2]
        return centre

    def bounds(self, state: BodyState, shape: Ints) -> tuple[Array, Array]:
        """Low and high corner (batch, n, 2) of the axis-aligned boxes around some shapes in every world."""
        body = self.body[shape]
        cos, sin, position = state.cos[:, body, None], state.sin[:, body, None], state.pose[:, body, None, :2]
        corners = rotate(self.start[shape], cos, sin) + position
        centre = rotate(self.centre[shape, None], cos, sin) + position
        round_, radius = self.is_circle[shape, None, None], self.radius[shape, None, None]
        low = np.where(round_, centre - radius, corners).min(axis=2)
        high = np.where(round_, centre + radius, corners).max(axis=2)
        return low, high
