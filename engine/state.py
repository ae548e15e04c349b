"""What each step changes, `BodyState`, and what it does not, `BodyParams`.

Position and angle share an array, and so do velocity and spin: all three numbers are integrated, solved and set alike.
"""

from __future__ import annotations

from collections.abc import Mapping
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


class BodyParams:
    """Mass, drag and surface of the bodies. Rows are bodies, the same in every world of the batch.

    A table may be replaced at any time by another of its shape. The next step goes by it, and bodies whose rows differ
    begin it awake and without the last one's impulses. Tables can't be written into, except a `quadratic_drag` of shape
    (batch, bodies, 3), which gives each world an air of its own. Raises ValueError for values without physical sense.
    """

    inverse_mass: Array  # (bodies, 3): 1/kg, 1/kg, 1/(kg·m²); 0 for a body that no force moves
    linear_drag: Array  # (bodies, 3): kg/s, kg/s, kg·m²/s
    quadratic_drag: Array  # (bodies, 3): kg/m, kg/m, kg·m²
    restitution: Array  # (bodies,): 0 to 1; NaN leaves it to the other body
    friction: Array  # (bodies,): Coulomb's coefficient; NaN leaves it to the other body
    group: Ints  # (bodies,): bodies of the same group do not meet, but for group 0

    def __init__(self, **tables: object) -> None:
        for name, table in tables.items():
            setattr(self, name, table)

    def __setattr__(self, name: str, value: object) -> None:
        """Replace a table by a copy of `value`, unless it is equal."""
        table = np.array(value, dtype=np.intp if name == "group" else float)
        before = vars(self).get(name, table)
        most_axes = 3 if name == "quadratic_drag" else before.ndim
        if table.shape[-2:] != before.shape[-2:] or table.ndim > most_axes:
            raise ValueError(f"{name} must be of shape {before.shape[-2:]}, not {table.shape}")
        given = table[~np.isnan(table)] if name in ("restitution", "friction") else table
        most = 1.0 if name == "restitution" else _LARGEST
        if name != "group" and not ((given >= 0) & (given <= most)).all():
            raise ValueError(f"{name} must be from 0 to {most}, not {table.tolist()}")
        if name in vars(self) and np.array_equal(table, before, equal_nan=name != "group"):
            return
        table.flags.writeable = table.ndim == 3
        vars(self)[name] = table

    @classmethod
    def empty(cls) -> BodyParams:
        """Return tables without bodies."""
        rows, row = np.zeros((0, 3)), np.zeros(0)
        return cls(inverse_mass=rows, linear_drag=rows, quadratic_drag=rows, restitution=row, friction=row, group=row)

    @property
    def dynamic(self) -> Bools:
        """Whether forces can move each body, (bodies,)."""
        return self.inverse_mass[:, 0] > 0

    def append(self, row: BodyParams) -> None:
        """Add the rows of `row` to every table."""
        grown = BodyParams(**{name: np.concatenate([table, getattr(row, name)]) for name, table in vars(self).items()})
        vars(self).update(vars(grown))

    def changed(self, before: Mapping[str, Array | Ints]) -> Bools:
        """Return which of the bodies of the tables `before`, by name, have other rows now, (bodies,)."""
        changed = np.zeros(len(before["group"]), dtype=bool)
        for name, then in before.items():
            now = getattr(self, name)
            if now is not then:
                now = now[: len(changed)] if now.ndim == 1 else now[..., : len(changed), :]
                differs = (now != then) & ~(np.isnan(now) & np.isnan(then))
                rows = differs if now.ndim == 1 else differs.any(axis=-1)
                changed |= rows.any(axis=0) if now.ndim == 3 else rows
        return changed
