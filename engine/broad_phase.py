"""Broad phase: find the pairs of shapes whose bounding boxes overlap, the only ones worth an exact test.

What moves is boxed by a circle, which needs no trigonometry; what is fixed by its corners, once. For up to some
hundreds of bodies, comparing all moving boxes with all boxes in one go is faster in NumPy than any tree. Bodies are
compared first, then the shapes of bodies that are near.

A box is four numbers: low x, low y, high x, high y. Arrays of boxes lead with these four, and end with the batch: NumPy
is quickest along the last axis, and that is the longest one.
"""

from __future__ import annotations

import numpy as np

from engine.shapes import ShapeTable
from engine.state import ALL, BodyParams, BodyState, Span, span
from engine.vector import Array, Bools, Ints, length


class BroadPhase:
    """Table of all `pairs` of shapes that may ever meet, (pairs, 2), and the search for those that are near now.

    Of a polygon and a circle, the polygon comes first.
    """

    def __init__(
        self, params: BodyParams, shapes: ShapeTable, batch: int, margin: float, before: BroadPhase | None = None
    ) -> None:
        """Make the table; what `before` has of the first bodies is kept, and pairs of new ones come after it."""
        self._shapes = shapes
        self._moving, self._fixed = span(params.dynamic), ~params.dynamic
        self._shape_reach = shapes.reach + margin
        self._reach = np.zeros(len(params.group))  # of bodies, from the centre of mass
        np.maximum.at(self._reach, shapes.body, length(shapes.centre) + self._shape_reach)
        self._boxes = np.zeros((4, len(params.group), batch))
        self._shape_boxes = np.zeros((4, len(shapes), batch))  # only those of fixed bodies are filled
        self._stale = self._fixed.copy()  # fixed bodies (bodies,) whose boxes are to be computed anew
        self._body_pairs = _meeting_bodies(params, len(before._reach) if before else 0)
        self.pairs, self._rows = _meeting_shapes(self._body_pairs, shapes)
        if before:
            rows = np.where(self._rows < 0, -1, self._rows + len(before.pairs))
            self._body_pairs = np.concatenate([before._body_pairs, self._body_pairs], axis=1)
            self.pairs = np.concatenate([before.pairs, self.pairs])
            wide = max(rows.shape[1], before._rows.shape[1])
            self._rows = np.concatenate([_padded(before._rows, wide), _padded(rows, wide)])

    def forget_boxes(self, bodies: Span = ALL) -> None:
        """Discard the kept boxes of fixed bodies, which were put elsewhere."""
        self._stale[bodies] = self._fixed[bodies]

    def near(self, state: BodyState, awake: Bools | None = None) -> tuple[Ints, Ints]:
        """Return world and row of `pairs`, each (n,), where boxes overlap; sorted by world, then by row.

        Given which bodies are `awake`, (batch, bodies), pairs without any are left out.
        """
        boxes = self._body_boxes(state)
        a, b = self._body_pairs
        overlap = _overlap(boxes, a, b)  # (pairs of bodies, batch)
        if not state.active.all():
            overlap &= (state.active[:, a] & state.active[:, b]).T
        if awake is not None:
            overlap &= (awake[:, a] | awake[:, b]).T
        met, world = overlap.nonzero()
        if not len(world):
            return world, world
        order = np.argsort(world, kind="stable")
        met, world = met[order], world[order]
        rows = self._rows[met]
        meet = rows >= 0
        world, pair = world[meet.nonzero()[0]], rows[meet]
        near = self._shapes_near(state, world, pair)
        return world[near], pair[near]

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
        return _overlap(boxes, slice(len(pair)), slice(len(pair), None))


def _overlap(boxes: Array, a: Span, b: Span) -> Bools:
    """Whether the boxes `a` overlap as many boxes `b`."""
    overlap: Bools = boxes[1, a] <= boxes[3, b]
    for low, one, high, other in ((1, b, 3, a), (0, a, 2, b), (0, b, 2, a)):
        if overlap.any():
            overlap &= boxes[low, one] <= boxes[high, other]
    return overlap


def _meeting_bodies(params: BodyParams, first: int) -> Ints:
    """Return the pairs of bodies that may meet, (2, pairs): one that can move, and one that their groups let it touch.

    Of two that can move, each pair is there once. At least one body of a pair is the `first` or a later one.
    """
    bodies, moving = np.arange(len(params.group)), np.flatnonzero(params.dynamic)
    pairs = []
    for movers, others in ((moving[moving < first], bodies[first:]), (moving[moving >= first], bodies)):
        meet = (others > movers[:, None]) | ~params.dynamic[others]
        meet &= (params.group[others] == 0) | (params.group[others] != params.group[movers, None])
        mover, other = meet.nonzero()
        pairs.append(np.stack([movers[mover], others[other]]))
    return np.concatenate(pairs, axis=1)


def _meeting_shapes(body_pairs: Ints, shapes: ShapeTable) -> tuple[Ints, Ints]:
    """Return all pairs of shapes that may meet, (pairs, 2), and which of them each pair of bodies has, (n, most).

    Where two bodies have fewer pairs of shapes than the most, -1 stands in place of rows.
    """
    parts = np.bincount(shapes.body)  # of each body; they stand side by side in the table
    begin, (one, other) = parts.cumsum() - parts, body_pairs
    count = parts[one] * parts[other]
    rows = np.arange(count.max(initial=0))
    padded = np.where(rows < count[:, None], (count.cumsum() - count)[:, None] + rows, -1)
    met, number = (rows < count[:, None]).nonzero()
    number, across = np.divmod(number, parts[other][met])
    pairs = np.stack([begin[one][met] + number, begin[other][met] + across], axis=1)
    turned = shapes.is_circle[pairs[:, 0]] & ~shapes.is_circle[pairs[:, 1]]
    pairs[turned] = pairs[turned, ::-1]
    return pairs, padded


def _padded(rows: Ints, wide: int) -> Ints:
    """Return a table of rows widened with -1."""
    return np.pad(rows, ((0, 0), (0, wide - rows.shape[1])), constant_values=-1)
