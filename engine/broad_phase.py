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
    """Search for pairs of shapes that are near now, among all that may ever meet."""

    def __init__(self, params: BodyParams, shapes: ShapeTable, batch: int, margin: float) -> None:
        self._shapes = shapes
        self._moving, self._fixed = span(params.dynamic), ~params.dynamic
        self._movers = np.flatnonzero(params.dynamic)
        self._may_meet = _may_meet(params)
        self._shape_reach = shapes.reach + margin
        self._reach = np.zeros(len(params.group))  # of bodies, from the centre of mass
        np.maximum.at(self._reach, shapes.body, length(shapes.centre) + self._shape_reach)
        self._boxes = np.zeros((4, len(params.group), batch))
        self._shape_boxes = np.zeros((4, len(shapes), batch))  # only those of fixed bodies are filled
        self._overlap: Bools = np.zeros((0, 0, 0), dtype=bool)  # of bodies in the last step
        self._met: tuple[Ints, Ints]  # and the worlds and pairs of their shapes
        self._stale = self._fixed.copy()  # fixed bodies (bodies,) whose boxes are to be computed anew

    def all_pairs(self) -> Ints:
        """Return all pairs of shapes that may ever meet, (pairs, 2); of a polygon and a circle, it first."""
        mover, other = self._may_meet.nonzero()
        return self._shapes.pairs_of(self._movers[mover], other)[0]

    def forget_boxes(self, bodies: Span = ALL) -> None:
        """Discard the boxes of fixed bodies, which were put elsewhere."""
        self._stale[bodies] = self._fixed[bodies]

    def near(self, state: BodyState, awake: Bools | None = None) -> tuple[Ints, Ints]:
        """Return the worlds (n,) and pairs of shapes (n, 2) whose boxes overlap; sorted by world, then by shapes.

        Given which bodies are `awake`, (batch, bodies), pairs without any are left out.
        """
        boxes = self._body_boxes(state)
        overlap = _overlap(boxes[:, self._moving, None], boxes[:, None], self._may_meet[..., None])
        if not state.active.all():
            overlap &= (state.active[:, self._moving, None] & state.active[:, None]).transpose(1, 2, 0)
        if awake is not None:
            overlap &= (awake[:, self._moving, None] | awake[:, None]).transpose(1, 2, 0)
        if not np.array_equal(overlap, self._overlap):  # most often the same bodies are near as a step before
            self._overlap, self._met = overlap, self._shapes_of(overlap)
        world, pair = self._met
        near = self._shapes_near(state, world, pair)
        return world[near], pair[near]

    def _shapes_of(self, overlap: Bools) -> tuple[Ints, Ints]:
        """Return the worlds (n,) and pairs of shapes (n, 2) of bodies that overlap, (movers, bodies, batch)."""
        world, mover, other = overlap.transpose(2, 0, 1).nonzero()
        pair, row = self._shapes.pairs_of(self._movers[mover], other)
        return world[row], pair

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
        if not len(pair):
            return np.zeros(0, dtype=bool)
        shape, world = pair.T.ravel(), np.concatenate([world, world])  # the first of all, then the second
        boxes = self._shape_boxes[:, shape, world]
        loose = np.flatnonzero(~self._shapes.fixed[shape])
        centre = self._shapes.centres(state, world[loose], shape[loose]).T
        reach = self._shape_reach[shape[loose]]
        boxes[:2, loose], boxes[2:, loose] = centre - reach, centre + reach
        return _overlap(boxes[:, : len(pair)], boxes[:, len(pair) :])


def _overlap(a: Array, b: Array, among: Bools | np.bool_ = np.True_) -> Bools:
    """Whether the boxes `a` (4, ...) overlap the boxes `b`, `among` those that may."""
    overlap: Bools = (a[1] <= b[3]) & among
    for low, high in ((b[1], a[3]), (a[0], b[2]), (b[0], a[2])):
        if overlap.any():  # most often none is left after a comparison or two
            overlap &= low <= high
    return overlap


def _may_meet(params: BodyParams) -> Bools:
    """Whether bodies that can move may touch others, (movers, bodies): of two that can move, the first may the second.

    Bodies of one group, but for group 0, pass through each other.
    """
    bodies, moving = np.arange(len(params.group)), np.flatnonzero(params.dynamic)
    apart = (params.group == 0) | (params.group != params.group[moving, None])
    meet: Bools = apart & ((bodies > moving[:, None]) | ~params.dynamic)
    return meet
