"""Broad phase: find the pairs of shapes whose bounding boxes overlap, the only ones worth an exact test.

What moves is boxed by a circle, which needs no trigonometry; what is fixed by its corners, once. For up to some
hundreds of bodies, comparing all moving boxes with all boxes in one go is faster in NumPy than any tree. Bodies are
compared first, then the shapes of bodies that are near.

A box is four numbers: low x, low y, high x, high y. Arrays of boxes lead with these four, and end with the batch: NumPy
is quickest along the last axis, and that is the longest one.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from engine.shapes import ShapeTable
from engine.state import ALL, BodyParams, BodyState, Span, span
from engine.vector import Array, Bools, Ints, length


class BroadPhase:
    """Table of all `pairs` of shapes that may ever meet, (pairs, 2), and the search for those that are near now.

    Of a polygon and a circle, the polygon comes first.
    """

    def __init__(self, params: BodyParams, shapes: ShapeTable, batch: int, margin: float) -> None:
        self._shapes = shapes
        self._moving, self._fixed = span(params.dynamic), ~params.dynamic
        self._shape_reach = shapes.reach + margin
        self._reach = np.zeros(len(params.group))  # of bodies, from the centre of mass
        np.maximum.at(self._reach, shapes.body, length(shapes.centre) + self._shape_reach)
        self._boxes = np.zeros((4, len(params.group), batch))
        self._shape_boxes = np.zeros((4, len(shapes), batch))  # only those of fixed bodies are filled
        self._stale = self._fixed.copy()  # fixed bodies (bodies,) whose boxes are to be computed anew
        self.pairs, self._rows = _meeting_pairs(params, shapes)
        self._meet = self._rows[..., :1] >= 0  # (moving, bodies, 1)

    def forget_boxes(self, bodies: Span = ALL) -> None:
        """Discard the kept boxes of fixed bodies, which were put elsewhere."""
        self._stale[bodies] = self._fixed[bodies]

    def near(self, state: BodyState, awake: Bools | None = None) -> tuple[Ints, Ints]:
        """Return world and row of `pairs`, each (n,), where boxes overlap; sorted by world, then by row.

        Given which bodies are `awake`, (batch, bodies), pairs without any are left out.
        """
        boxes = self._body_boxes(state)
        world, mover, other = self._bodies_near(boxes, state.active, awake)
        if not len(world):
            return world, world
        rows = self._rows[mover, other]
        meet = rows >= 0
        world, pair = world[meet.nonzero()[0]], rows[meet]
        near = self._shapes_near(state, world, pair)
        return world[near], pair[near]

    def _bodies_near(self, boxes: Array, active: Bools, awake: Bools | None) -> tuple[Ints, Ints, Ints]:
        """Return world, row of the moving body and the other body, each (n,), where bodies' boxes overlap."""
        overlap = _overlap(boxes[:, self._moving, None], boxes[:, None], self._meet)  # (moving, bodies, batch)
        if not active.all():
            overlap &= (active[:, self._moving, None] & active[:, None]).transpose(1, 2, 0)
        if awake is not None:
            overlap &= (awake[:, self._moving, None] | awake[:, None]).transpose(1, 2, 0)
        # Many times as fast as `nonzero` of three axes.
        mover, other, world = np.unravel_index(np.flatnonzero(overlap), overlap.shape)
        order = np.argsort(world, kind="stable")
        return world[order], mover[order], other[order]

    def _body_boxes(self, state: BodyState) -> Array:
        """Boxes (4, bodies, batch) of all bodies as they are now."""
        if self._stale.any():
            self._box_fixed(state, np.flatnonzero(self._stale))
            # A fixed body with a velocity, such as a lift, has other boxes in the next step.
            self._stale = self._fixed & state.velocity.any(axis=(0, 2))
        centre, reach = state.pose[:, self._moving, :2].transpose(2, 1, 0), self._reach[self._moving, None]
        self._boxes[:2, self._moving], self._boxes[2:, self._moving] = centre - reach, centre + reach
        return self._boxes

    def _box_fixed(self, state: BodyState, bodies: Ints) -> None:
        """Box some fixed bodies, in ascending order, and their shapes."""
        shapes = np.flatnonzero(np.isin(self._shapes.body, bodies))
        low, high = self._shapes.bounds(state, shapes)
        self._shape_boxes[:2, shapes], self._shape_boxes[2:, shapes] = low.T, high.T
        first = self._shapes.body[shapes].searchsorted(bodies)  # a body's shapes stand side by side
        self._boxes[:2, bodies] = np.minimum.reduceat(low.T, first, axis=1)
        self._boxes[2:, bodies] = np.maximum.reduceat(high.T, first, axis=1)

    def _shapes_near(self, state: BodyState, world: Ints, pair: Ints) -> Bools:
        """Whether the boxes of pairs of shapes overlap, (n,)."""
        shape, world = self.pairs[pair].T.ravel(), np.concatenate([world, world])  # the first of all, then the second
        boxes = self._shape_boxes[:, shape, world]
        loose = np.flatnonzero(~self._shapes.fixed[shape])
        centre = self._shapes.centres(state, world[loose], shape[loose]).T
        reach = self._shape_reach[shape[loose]]
        boxes[:2, loose], boxes[2:, loose] = centre - reach, centre + reach
        return _overlap(boxes[:, : len(pair)], boxes[:, len(pair) :])


def _overlap(a: Array, b: Array, meet: Bools | bool = True) -> Bools:
    """Whether boxes overlap that may `meet`; all are broadcast against each other."""
    overlap: Bools = (a[1] <= b[3]) & meet
    for low, high in ((b[1], a[3]), (a[0], b[2]), (b[0], a[2])):
        if overlap.any():
            overlap &= low <= high
    return overlap


def _meeting_pairs(params: BodyParams, shapes: ShapeTable) -> tuple[Ints, Ints]:
    """Return all pairs of shapes that may meet, (pairs, 2), and their rows by pair of bodies, (moving, bodies, most).

    Two bodies may meet if one of them can move and their groups let them touch. Where two have fewer pairs of shapes
    than the most, -1 stands in place of rows.
    """
    bodies = np.arange(len(params.group))
    moving = bodies[span(params.dynamic)]
    meet = (bodies > moving[:, None]) | ~params.dynamic  # of two that can move, each pair once
    meet &= (params.group == 0) | (params.group != params.group[moving, None])
    shapes_of = [np.flatnonzero(shapes.body == body).tolist() for body in bodies]
    parts = np.array([*map(len, shapes_of)], dtype=np.intp)
    most = (parts[moving, None] * parts * meet).max(initial=1)
    rows = np.full((*meet.shape, most), -1, dtype=np.intp)
    pairs: list[tuple[int, int]] = []
    for mover, other in np.argwhere(meet).tolist():
        both = list(product(shapes_of[moving[mover]], shapes_of[other]))
        rows[mover, other, : len(both)] = np.arange(len(pairs), len(pairs) + len(both))
        pairs += [(b, a) if shapes.is_circle[a] and not shapes.is_circle[b] else (a, b) for a, b in both]
    return np.array(pairs, dtype=np.intp).reshape(-1, 2), rows
