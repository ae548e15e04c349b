"""What each step changes, `BodyState`, and what it does not, `BodyParams`.

Position and angle share an array, and so do velocity and spin: all three numbers are integrated, solved and set alike.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from engine.vector import Array, Bools, Ints

Span = slice | Ints
ALL: Final = slice(None)
_LARGEST: Final = float(np.finfo(float).max)


def span(chosen: Bools) -> Span:
    """Indices of the chosen bodies; a slice, which indexes without a copy, if they are neighbours."""
    rows = np.flatnonzero(chosen)
    if len(rows) and rows[-1] - rows[0] == len(rows) - 1:
        return slice(int(rows[0]), int(rows[-1]) + 1)
    return rows


@dataclass
class BodyState:
    """State of the bodies. All arrays lead with (batch, bodies)."""

    pose: Array  # (..., 3): x, y in metres, angle in radians
    velocity: Array  # (..., 3): m/s, m/s, rad/s
    force: Array  # (..., 3): N, N, N·m; each step clears it
    active: Bools  # (...): an inactive body neither moves nor touches
    cos: Array  # (...) of the angle, kept beside it because every phase needs them
    sin: Array

    @classmethod
    def at_rest(cls, pose: Array) -> BodyState:
        """Return the state of bodies at rest at `pose` (batch, bodies, 3)."""
        zeros, shape = np.zeros_like(pose), pose.shape[:2]
        state = cls(pose, zeros, zeros.copy(), np.ones(shape, dtype=bool), np.empty(shape), np.empty(shape))
        state.refresh_rotation()
        return state

    def append(self, pose: Array) -> None:
        """Add a body at rest in every world, at `pose` (batch, 3)."""
        for name, row in vars(BodyState.at_rest(pose[:, None])).items():
            setattr(self, name, np.concatenate([getattr(self, name), row], axis=1))

    def refresh_rotation(self, bodies: Span = ALL) -> None:
        """Bring `cos` and `sin` of some bodies up to date after their poses have changed."""
        # A strided array may take another code path than a contiguous one, and differ in the last bit.
        angle = np.ascontiguousarray(self.pose[:, bodies, 2])
        self.cos[:, bodies], self.sin[:, bodies] = np.cos(angle), np.sin(angle)


@dataclass(frozen=True)
class BodyParams:
    """Mass, drag and surface of the bodies. Rows are bodies, the same in every world of the batch.

    To change a table, assign another `BodyParams` to `World.params`, made by `dataclasses.replace`. Tables can't be
    written into, except a `quadratic_drag` of shape (batch, bodies, 3), which gives each world an air of its own.
    Raises ValueError for values without physical sense.
    """

    inverse_mass: Array  # (bodies, 3): 1/kg, 1/kg, 1/(kg·m²); 0 for a body that no force moves
    linear_drag: Array  # (bodies, 3): kg/s, kg/s, kg·m²/s
    quadratic_drag: Array  # (bodies, 3): kg/m, kg/m, kg·m²
    restitution: Array  # (bodies,): 0 to 1; NaN leaves it to the other body
    friction: Array  # (bodies,): Coulomb's coefficient; NaN leaves it to the other body
    group: Ints  # (bodies,): bodies of the same group do not meet, but for group 0

    def __post_init__(self) -> None:
        count = len(self.group)
        for name, value in vars(self).items():
            table = np.array(value, dtype=np.intp if name == "group" else float)
            shape = (count, 3) if name in ("inverse_mass", "linear_drag", "quadratic_drag") else (count,)
            if table.shape != shape and (name != "quadratic_drag" or table.shape[1:] != shape):
                raise ValueError(f"{name} must be of shape {shape}, not {table.shape}")
            given = table[~np.isnan(table)] if name in ("restitution", "friction") else table
            most = 1.0 if name == "restitution" else _LARGEST
            if name != "group" and not ((given >= 0) & (given <= most)).all():
                raise ValueError(f"{name} must be from 0 to {most}, not {table.tolist()}")
            table.flags.writeable = table.ndim == 3
            object.__setattr__(self, name, table)  # a copy of its own

    @classmethod
    def empty(cls) -> BodyParams:
        """Return tables without bodies."""
        rows, row = np.zeros((0, 3)), np.zeros(0)
        return cls(rows, rows, rows, row, row, np.zeros(0, dtype=np.intp))

    @property
    def dynamic(self) -> Bools:
        """Whether forces can move each body, (bodies,)."""
        return self.inverse_mass[:, 0] > 0

    def with_body(self, row: BodyParams) -> BodyParams:
        """Return these tables with the row of another body."""
        return BodyParams(**{name: np.concatenate([table, vars(row)[name]]) for name, table in vars(self).items()})
