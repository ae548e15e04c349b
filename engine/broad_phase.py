"""Broad phase: find the pairs of shapes whose bounding boxes overlap, the only ones worth an exact test."""

from __future__ import annotations

import numpy as np

from engine.state import BodyParams, BodyState, ShapeTable, span
from engine.vector import Array, Bools, Ints, every

_NONE: Ints = np.zeros(0, dtype=np.intp)
_SLACK = 1e-6  # metres, far more than rounding makes of a box
_PAUSE = 8


class BroadPhase:
    """Table of all pairs of shapes that may ever meet, and search for those whose boxes overlap now.

    Bodies that move are boxed by the circle around their centre of mass, which needs no trigonometry; fixed
    ones by their corners, once. For up to some hundreds of bodies, comparing all moving boxes with all boxes
    in one go is faster in NumPy than any tree. Shapes of near bodies are then compared in the same way.
    """

    def __init__(self, params: BodyParams, shapes: ShapeTable, margin: float) -> None:
        self._shapes = shapes
        self._moving = span(params.dynamic)
        self._is_fixed = ~params.dynamic
        self._several = len(shapes) > len(params.group)
        self._shape_reach = shapes.reach + margin
        far = np.sqrt(shapes.centre[:, 0] ** 2 + shapes.centre[:, 1] ** 2) + self._shape_reach
        self._reach = np.zeros(len(params.group))
        np.maximum.at(self._reach, shapes.body, far)
        self.version = 0  # of where fixed bodies are: one more each time any is put elsewhere
        self._boxes: Array | None = None  # (4, batch, bodies): low x and y, high x and y
        self._stale = self._is_fixed.copy()  # fixed bodies (bodies,) whose boxes are to be computed anew
        self._clear: tuple[Array, Array] | None = None  # where nothing was near, and how far all may go from there
        self._pause = 0  # searches to wait before that is measured again, if it was of no use
        self._shape_boxes = np.zeros((4, 0, 0))  # the same of shapes; only those of fixed bodies are filled
        self._movers_first, self._first, self._count = _meeting_pairs(params, shapes)
        a, b = self._movers_first.T
        turned = shapes.is_circle[a] & ~shapes.is_circle[b]
        self.pairs = np.where(turned[:, None], self._movers_first[:, ::-1], self._movers_first)

    def forget_boxes(self, bodies: int | slice = slice(None)) -> None:
        """Discard the cached boxes of `bodies`: those that forces do not move were put elsewhere, or will be."""
        self._stale[bodies] = self._is_fixed[bodies]
        self._clear = None
        self.version += 1

    def near(self, state: BodyState, awake: Bools | None = None) -> tuple[Ints, Ints]:
        """Return world and row of `pairs`, each (n,), where boxes overlap; sorted by world, then by row.

        Given which bodies are `awake`, (batch, bodies), pairs without any are left out.
        """
        if self._all_clear(state):
            return _NONE, _NONE
        fixed = not self._stale.any()
        boxes = self._boxes_now(state)
        worlds, active = None, state.active
        if awake is not None:
            worlds = np.flatnonzero(awake.any(axis=1))
            boxes, active, awake = boxes[:, worlds], active[worlds], awake[worlds]
        low_x, low_y, high_x, high_y = boxes[:, :, None, :]
        my_low_x, my_low_y, my_high_x, my_high_y = boxes[:, :, self._moving, None]
        near: Bools = (my_low_y <= high_y) & (self._count > 0)
        near &= low_y <= my_high_y
        near &= my_low_x <= high_x
        near &= low_x <= my_high_x
        if not every(active):
            near &= active[:, self._moving, None] & active[:, None, :]
        if awake is not None:
            near &= awake[:, self._moving, None] | awake[:, None, :]
        world, mover, other = near.nonzero()
        pair = self._first[mover, other]
        if worlds is not None:
            world = worlds[world]
        if fixed and worlds is None and not len(world):
            self._pause -= 1
            if self._pause < 0:
                self._measure_clearance(state, boxes)
        if not self._several or not len(world):
            return world, pair
        count = self._count[mover, other]
        world, first = world.repeat(count), (pair - count.cumsum() + count).repeat(count)
        pair = first + np.arange(len(first))
        kept = self._shapes_near(state, world, pair)
        return world[kept], pair[kept]

    def _all_clear(self, state: BodyState) -> bool:
        """Whether no body has gone so far since nothing was near that it could have met another (Verlet, 1967)."""
        if self._clear is None:
            return False
        place, room = self._clear
        clear = every(np.abs(state.pose[:, self._moving, :2] - place) < room)
        if clear:
            self._pause = 0
        else:
            self._clear = None
        return clear

    def _measure_clearance(self, state: BodyState, boxes: Array) -> None:
        """Note how far all bodies may go, (batch, 1, 1), before boxes can overlap: the least gap, or half of it."""
        mine = boxes[:, :, self._moving, None]
        others = boxes[:, :, None, :]
        gaps = np.maximum(mine[:2] - others[2:], others[:2] - mine[2:]).max(axis=0)
        gaps[:, self._count == 0] = np.inf
        each = 1.0 if len(self._first) == 1 else 0.5
        room = gaps.reshape(len(gaps), -1).min(axis=1, initial=np.inf) * each - _SLACK
        self._clear = state.pose[:, self._moving, :2].copy(), room[:, None, None]
        self._pause = _PAUSE

    def _boxes_now(self, state: BodyState) -> Array:
        if self._boxes is None:
            self._boxes = np.empty((4, *state.active.shape))
            self._shape_boxes = np.zeros((4, len(state.pose), len(self._shapes)))
        boxes = self._boxes
        if self._stale.any():
            self._box(state, boxes, np.flatnonzero(self._stale))
            # A lift has other boxes in the next step.
            self._stale = self._is_fixed & state.velocity.any(axis=(0, 2))
        centre, reach = state.pose[:, self._moving, :2], self._reach[self._moving]
        for axis in (0, 1):
            boxes[axis][:, self._moving] = centre[..., axis] - reach
            boxes[2 + axis][:, self._moving] = centre[..., axis] + reach
        return boxes

    def _box(self, state: BodyState, boxes: Array, bodies: Ints) -> None:
        """Box some fixed bodies, in ascending order, and their shapes."""
        shapes = np.flatnonzero(np.isin(self._shapes.body, bodies))
        low, high = self._shapes.bounds(state, shapes)
        self._shape_boxes[:2, :, shapes] = np.moveaxis(low, 2, 0)
        self._shape_boxes[2:, :, shapes] = np.moveaxis(high, 2, 0)
        first = self._shapes.body[shapes].searchsorted(bodies)  # a body's shapes stand side by side
        boxes[:2, :, bodies] = np.minimum.reduceat(self._shape_boxes[:2, :, shapes], first, axis=2)
        boxes[2:, :, bodies] = np.maximum.reduceat(self._shape_boxes[2:, :, shapes], first, axis=2)

    def _shapes_near(self, state: BodyState, world: Ints, pair: Ints) -> Bools:
        """Whether the boxes of some pairs of shapes overlap, (n,)."""
        mine, other = self._movers_first[pair].T
        boxes = self._shape_boxes[:, world, other]
        loose = np.flatnonzero(~self._shapes.fixed[other])
        if len(loose):
            centre = self._shapes.centres(state, world[loose], other[loose]).T
            reach = self._shape_reach[other[loose]]
            boxes[:2, loose], boxes[2:, loose] = centre - reach, centre + reach
        x, y = self._shapes.centres(state, world, mine).T
        reach = self._shape_reach[mine]
        near: Bools = y - reach <= boxes[3]
        near &= boxes[1] <= y + reach
        near &= x - reach <= boxes[2]
        near &= boxes[0] <= x + reach
        return near


def _meeting_pairs(params: BodyParams, shapes: ShapeTable) -> tuple[Ints, Ints, Ints]:
    """Return the table of shapes that may meet (pairs, 2), a moving body's first, and each body pair's rows in it.

    The rows are given as the first one and their number, (moving, bodies) each, for each moving body with each
    other body. Two bodies may meet if one of them can move and their groups let them touch.
    """
    bodies = np.arange(len(params.group))
    moving = bodies[span(params.dynamic)]
    met = params.dynamic[moving, None] & ((bodies > moving[:, None]) | ~params.dynamic)
    met &= (params.group == 0) | (params.group != params.group[moving, None])
    sizes = np.bincount(shapes.body, minlength=len(bodies))
    count = np.where(met, sizes[moving, None] * sizes, 0)
    first = (count.cumsum() - count.ravel()).reshape(count.shape)
    starts = sizes.cumsum() - sizes
    row, other = count.nonzero()
    mover = moving[row]
    repeats = count[row, other]
    within = np.arange(repeats.sum()) - first[row, other].repeat(repeats)
    a = starts[mover].repeat(repeats) + within // sizes[other].repeat(repeats)
    b = starts[other].repeat(repeats) + within % sizes[other].repeat(repeats)
    return np.stack([a, b], axis=1), first, count
