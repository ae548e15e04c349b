"""Convex shapes, discs and polygons, with their area, centroid and second moment of area."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from engine.vector import Array, cross, dot, length, right_of, rotate

Point = Sequence[float] | Array


def following(rows: Array) -> Array:
    """Return for each row (k, 2) the next one, and for the last the first; `np.roll` takes ten times as long."""
    return np.concatenate((rows[1:], rows[:1]))


@dataclass(frozen=True)
class Circle:
    """A disc of `radius` metres around `centre` in its body's frame."""

    radius: float
    centre: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        if not (np.isfinite(self.radius) and self.radius > 0 and np.isfinite(self.centre).all()):
            raise ValueError(f"a circle needs a finite centre and a radius above 0, not {self}")

    @property
    def area(self) -> float:
        """Square metres."""
        return float(np.pi * self.radius**2)

    @property
    def centroid(self) -> Array:
        """Centre of area, (2,)."""
        return np.asarray(self.centre, dtype=float)

    @property
    def second_moment(self) -> float:
        """Polar second moment of area about the centroid, m⁴; times density it is the inertia."""
        return float(np.pi * self.radius**4 / 2)

    @property
    def bounding_radius(self) -> float:
        """Largest distance of any point from the centroid, metres."""
        return self.radius

    def moved(self, offset: Array) -> Circle:
        """Return the same disc shifted by `offset` (2,)."""
        x, y = self.centroid + offset
        return Circle(self.radius, (float(x), float(y)))


class Polygon:
    """A convex polygon in its body's frame, corners (k, 2) in metres, kept counter-clockwise; immutable.

    Raises ValueError for fewer than three corners, no area, or a corner that points inwards.
    """

    def __init__(self, vertices: Sequence[Point] | Array) -> None:
        corners = np.array(vertices, dtype=float)
        if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3 or not np.isfinite(corners).all():
            raise ValueError(f"a polygon needs at least three finite (x, y) corners, not {vertices!r}")
        if cross(corners, following(corners)).sum() < 0:
            corners = corners[::-1].copy()
        edges = following(corners) - corners
        after = following(edges)
        if (length(edges) < 1e-9).any() or (cross(edges, after) <= 0).any():
            raise ValueError(f"a polygon must be convex, its corners distinct and not in line: {vertices!r}")
        turns = np.arctan2(cross(edges, after), dot(edges, after))
        if turns.sum() > 2 * np.pi + 1e-6:
            raise ValueError(f"a polygon must not cross itself: {vertices!r}")
        self.vertices = corners
        self.normals = right_of(edges) / length(edges)[:, None]

    @classmethod
    def box(cls, width: float, height: float, centre: Point = (0.0, 0.0), angle: float = 0.0) -> Polygon:
        """A rectangle `width` by `height` around `centre`, turned by `angle`."""
        corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * (width / 2, height / 2)
        return cls(rotate(corners, np.cos(angle), np.sin(angle)) + np.asarray(centre))

    @cached_property
    def _fans(self) -> Array:
        """Twice the signed area of the triangle between the origin and each edge, (k,)."""
        return cross(self.vertices, following(self.vertices))

    @cached_property
    def area(self) -> float:
        """Square metres."""
        return float(self._fans.sum() / 2)

    @cached_property
    def centroid(self) -> Array:
        """Centre of area, (2,)."""
        sums = self.vertices + following(self.vertices)
        centre: Array = (sums * self._fans[:, None]).sum(axis=0) / (6 * self.area)
        return centre

    @cached_property
    def second_moment(self) -> float:
        """Polar second moment of area about the centroid, m⁴; times density it is the inertia."""
        a, b = self.vertices, following(self.vertices)
        about_origin = (self._fans * (dot(a, a) + dot(a, b) + dot(b, b))).sum() / 12
        return float(about_origin - self.area * dot(self.centroid, self.centroid))

    @cached_property
    def bounding_radius(self) -> float:
        """Distance of the farthest corner from the centroid, metres."""
        return float(length(self.vertices - self.centroid).max())

    def moved(self, offset: Array) -> Polygon:
        """Return the same polygon shifted by `offset` (2,)."""
        return Polygon(self.vertices + offset)

    def __deepcopy__(self, memo: object) -> Polygon:
        """Return itself, for it does not change."""
        return self

    def __repr__(self) -> str:
        return f"Polygon({self.vertices.tolist()})"


Shape = Circle | Polygon


def mass_properties(shapes: Sequence[Shape]) -> tuple[Array, float]:
    """Common centroid (2,) of `shapes` of one density, and their inertia about it per unit of mass, m²."""
    areas = np.array([shape.area for shape in shapes])
    centroids = np.array([shape.centroid for shape in shapes])
    centre = (areas[:, None] * centroids).sum(axis=0) / areas.sum()
    moments = np.array([shape.second_moment for shape in shapes])
    spread = centroids - centre
    return centre, float((moments + areas * dot(spread, spread)).sum() / areas.sum())
