"""Convex shapes, discs and polygons: area, centroid, second moment of area; and a table of all shapes of a world."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from engine.state import BodyState
from engine.vector import Array, Bools, Ints, cross, dot, length, right_of, rotate

Point = Sequence[float] | Array


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
    """A convex polygon in its body's frame; immutable.

    Raises ValueError for fewer than three vertices, no area, or a corner that points inwards.

    Attributes:
        vertices: (k, 2) in metres, counter-clockwise.
        normals: (k, 2) of the edges, outwards, of length 1.
        area: square metres.
        centroid: centre of area, (2,).
        second_moment: polar one about the centroid, m⁴; times density it is the inertia.
        bounding_radius: distance of the farthest vertex from the centroid, metres.

          v3 ---- edge 2 ---- v2
          |                   |         edge i leads from vertex i to vertex i + 1;
        edge 3              edge 1      its normal points outwards, to its right
          |                   |
          v0 ---- edge 0 ---- v1
    """

    def __init__(self, vertices: Sequence[Point] | Array) -> None:
        corners = np.array(vertices, dtype=float)
        if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3 or not np.isfinite(corners).all():
            raise ValueError(f"a polygon needs at least three finite (x, y) corners, not {vertices!r}")
        own = corners - corners[0]  # far from the origin, products of large numbers would cancel
        if cross(own, _following(own)).sum() < 0:
            corners = corners[::-1].copy()
        edges = _following(corners) - corners
        after = _following(edges)
        if (length(edges) < 1e-9).any() or (cross(edges, after) <= 0).any():
            raise ValueError(f"a polygon must be convex, its corners distinct and not in line: {vertices!r}")
        # A star turns left at each corner, too, but more than once around.
        if np.arctan2(cross(edges, after), dot(edges, after)).sum() > 2 * np.pi + 1e-6:
            raise ValueError(f"a polygon must not cross itself: {vertices!r}")
        self.vertices = corners
        self.normals = right_of(edges) / length(edges)[:, None]
        self._measure()

    def _measure(self) -> None:
        """Work out area, centroid and second moment: sums over the edges, from a to b, as seen from the first vertex.

            A = Σ a × b / 2      c = Σ (a + b)·(a × b) / 6A      second moment = Σ (a × b)·(a·a + a·b + b·b) / 12

        That moment is about the first vertex; about the centroid c it is less by A·c·c (parallel axis theorem).
        """
        a = self.vertices - self.vertices[0]
        b = _following(a)
        twice = cross(a, b)
        self.area = float(twice.sum() / 2)
        own: Array = ((a + b) * twice[:, None]).sum(axis=0) / (6 * self.area)
        self.centroid: Array = self.vertices[0] + own
        about_first = (twice * (dot(a, a) + dot(a, b) + dot(b, b))).sum() / 12
        self.second_moment = float(about_first - self.area * dot(own, own))
        self.bounding_radius = float(length(self.vertices - self.centroid).max())

    @classmethod
    def box(cls, width: float, height: float, centre: Point = (0.0, 0.0), angle: float = 0.0) -> Polygon:
        """A rectangle `width` by `height` around `centre`, turned by `angle`."""
        corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * (width / 2, height / 2)
        return cls(rotate(corners, np.cos(angle), np.sin(angle)) + np.asarray(centre))

    def moved(self, offset: Array) -> Polygon:
        """Return the same polygon shifted by `offset` (2,)."""
        return Polygon(self.vertices + offset)

    def __repr__(self) -> str:
        return f"Polygon({self.vertices.tolist()})"


Shape = Circle | Polygon


def _following(rows: Array) -> Array:
    """Return for each row (k, 2) the next one, and for the last the first; `np.roll` takes ten times as long."""
    return np.concatenate((rows[1:], rows[:1]))


def mass_properties(shapes: Sequence[Shape]) -> tuple[Array, float]:
    """Common centroid (2,) of `shapes` of one density, and their inertia about it per unit of mass, m²."""
    areas = np.array([shape.area for shape in shapes])
    centroids = np.array([shape.centroid for shape in shapes])
    centre = (areas[:, None] * centroids).sum(axis=0) / areas.sum()
    moments = np.array([shape.second_moment for shape in shapes])
    away = centroids - centre
    return centre, float((moments + areas * dot(away, away)).sum() / areas.sum())  # parallel axis theorem


class PlacedPolygons(NamedTuple):
    """n polygons in the world: where each edge starts and ends, and its outward normal, (n, edges, 2)."""

    start: Array
    end: Array
    normal: Array


class ShapeTable:
    """Every shape of a world as rows of arrays, so that one set of array operations serves them all.

    Polygons are padded to one number of edges by repeating the last. That is harmless: a repeated face can't separate
    what the first did not.
    """

    def __init__(self, shapes: Sequence[Shape], bodies: Sequence[int], dynamic: Bools) -> None:
        self.body = np.array(bodies, dtype=np.intp)  # of each shape, rising: a body's shapes stand side by side
        self.count = np.bincount(self.body, minlength=len(dynamic))  # of each body's shapes
        self.first = self.count.cumsum() - self.count  # of each body's shapes
        self.fixed = ~dynamic[self.body]
        self.is_circle = np.array([isinstance(shape, Circle) for shape in shapes], dtype=bool)
        self.radius = np.array([shape.radius if isinstance(shape, Circle) else 0.0 for shape in shapes])
        self.centre = np.array([shape.centroid for shape in shapes]).reshape(-1, 2)
        self.reach = np.array([shape.bounding_radius for shape in shapes])
        polygons = [shape for shape in shapes if isinstance(shape, Polygon)]
        edges = np.array([len(shape.vertices) for shape in polygons], dtype=np.intp)[:, None]
        vertices, normals = (
            np.concatenate([np.zeros((0, 2)), *tables])
            for tables in ([shape.vertices for shape in polygons], [shape.normals for shape in polygons])
        )
        edge = np.minimum(np.arange(edges.max(initial=3)), edges - 1)  # (polygons, edges)
        begin = edges.cumsum()[:, None] - edges
        self.start, self.end, self.normal = np.zeros((3, len(shapes), edge.shape[1], 2))
        self.start[~self.is_circle] = vertices[begin + edge]
        self.end[~self.is_circle] = vertices[begin + (edge + 1) % edges]
        self.normal[~self.is_circle] = normals[begin + edge]

    def __len__(self) -> int:
        return len(self.body)

    def centres(self, state: BodyState, world: Ints, shape: Ints) -> Array:
        """Centroids (n, 2) of shapes (n,) in their worlds (n,)."""
        body = self.body[shape]
        return rotate(self.centre[shape], state.cos[world, body], state.sin[world, body]) + state.pose[world, body, :2]

    def placed(self, state: BodyState, world: Ints, shape: Ints) -> PlacedPolygons:
        """Polygons (n,) in their worlds (n,)."""
        body = self.body[shape]
        cos, sin = state.cos[world, body, None], state.sin[world, body, None]
        position = state.pose[world, body, None, :2]
        return PlacedPolygons(
            rotate(self.start[shape], cos, sin) + position,
            rotate(self.end[shape], cos, sin) + position,
            rotate(self.normal[shape], cos, sin),
        )

    def pairs_of(self, one: Ints, other: Ints) -> tuple[Ints, Ints]:
        """Return all pairs of a shape of body `one` (n,) and one of `other`, (m, 2), and which of the n, (m,).

        Of a polygon and a circle, the polygon comes first.
        """
        of_other = self.count[other]
        count = self.count[one] * of_other
        row = np.repeat(np.arange(len(count)), count)
        number = np.arange(len(row)) - (count.cumsum() - count)[row]  # from 0 on, of each of the n
        nth, nth_of_other = np.divmod(number, of_other[row])
        pair = np.stack([self.first[one][row] + nth, self.first[other][row] + nth_of_other], axis=1)
        turned = self.is_circle[pair[:, 0]] & ~self.is_circle[pair[:, 1]]
        pair[turned] = pair[turned, ::-1]
        return pair, row

    def bounds(self, state: BodyState, shape: Ints) -> tuple[Array, Array]:
        """Low and high corner (batch, n, 2) of the axis-aligned boxes around some shapes in every world."""
        body = self.body[shape]
        cos, sin, position = state.cos[:, body, None], state.sin[:, body, None], state.pose[:, body, None, :2]
        corners = rotate(self.start[shape], cos, sin) + position
        centre = rotate(self.centre[shape, None], cos, sin) + position
        is_circle, radius = self.is_circle[shape, None, None], self.radius[shape, None, None]
        low = np.where(is_circle, centre - radius, corners).min(axis=2)
        high = np.where(is_circle, centre + radius, corners).max(axis=2)
        return low, high
