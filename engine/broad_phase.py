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
from engine.vector import Array, Bools, Ints


class BroadPhase:
    """Table of all `pairs` of shapes that may ever meet, (pairs, 2), and the search for those that are near now.

    Of a polygon and a circle, the polygon comes first.
    """

    def __init__(self, params: BodyParams, shapes: ShapeTable, batch: int, margin: float) -> None:
        self._shapes = shapes
        self._moving = span(params.dynamic)
        self._fixed = ~params.dynamic
        self._shape_reach = shapes.reach + margin
        self._reach = np.zeros(len(params.group))  # of bodies, from the centre of mass
        far = np.sqrt(shapes.centre[:, 0] ** 2 + shapes.centre[:, 1] ** 2) + self._shape_reach
        np.maximum.at(self._reach, shapes.body, far)
        self._boxes = np.zeros((4, len(params.group), batch))
        self._shape_boxes = np.zeros((4, len(shapes), batch))  # only those of fixed bodies are filled
        self._stale = self._fixed.copy()  # fixed bodies (bodies,) whose boxes are to be computed anew
        # For each pair of bodies, its pairs of shapes are `_count` rows of `_movers_first`, from row `_first` on.
        self._movers_first, self._first, self._count = _meeting_pairs(params, shapes)
        self._meet = self._count[..., None] > 0  # (moving, bodies, 1)
        a, b = self._movers_first.T
        turned = shapes.is_circle[a] & ~shapes.is_circle[b]
        self.pairs = np.where(turned[:, None], self._movers_first[:, ::-1], self._movers_first)

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
        # Each pair of bodies becomes a run of `count` pairs of shapes: the numbers up to `end`, from its first row on.
        count = self._count[mover, other]
        end = count.cumsum()
        pair = np.arange(end[-1]) + (self._first[mover, other] - end + count).repeat(count)
        world = world.repeat(count)
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
        mine, other = self._movers_first[pair].T
        theirs = self._shape_boxes[:, other, world]
        loose = np.flatnonzero(~self._shapes.fixed[other])
        if len(loose):
            theirs[:, loose] = self._box_moving(state, world[loose], other[loose])
        return _overlap(self._box_moving(state, world, mine), theirs)

    def _box_moving(self, state: BodyState, world: Ints, shape: Ints) -> Array:
        """Boxes (4, n) around the circles around moving shapes."""
        centre, reach = self._shapes.centres(state, world, shape).T, self._shape_reach[shape]
        return np.concatenate([centre - reach, centre + reach])


def _overlap(a: Array, b: Array, meet: Bools | bool = True) -> Bools:
    """Whether boxes overlap that may `meet`; all are broadcast against each other."""
    overlap: Bools = (a[1] <= b[3]) & meet
    for low, high in ((b[1], a[3]), (a[0], b[2]), (b[0], a[2])):
        if overlap.any():
            overlap &= low <= high
    return overlap


def _meeting_pairs(params: BodyParams, shapes: ShapeTable) -> tuple[Ints, Ints, Ints]:
    """Return the table of shapes that may meet (pairs, 2), a moving body's first, and each body pair's rows in it.

    The rows are given as the first one and their number, (moving, bodies) each, for each moving body with each
    other body. Two bodies may meet if one of them can move and their groups let them touch.
    """
    bodies = np.arange(len(params.group))
    moving = bodies[span(params.dynamic)]
    meet = (bodies > moving[:, None]) | ~params.dynamic  # of two that can move, each pair once
    meet &= (params.group == 0) | (params.group != params.group[moving, None])
    shapes_of = [np.flatnonzero(shapes.body == body).tolist() for body in bodies]
    first, count = np.zeros((2, *meet.shape), dtype=np.intp)
    pairs: list[tuple[int, int]] = []
    for row, other in np.argwhere(meet).tolist():
        mine, theirs = shapes_of[moving[row]], shapes_of[other]
        first[row, other], count[row, other] = len(pairs), len(mine) * len(theirs)
        pairs += product(mine, theirs)
    return np.array(pairs, dtype=np.intp).reshape(-1, 2), first, count
