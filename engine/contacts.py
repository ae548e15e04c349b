"""Contact detection: the narrow phase for pairs that are near, and the last step's impulses for a warm start."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from engine.broad_phase import BroadPhase
from engine.collide import Manifold, PlacedPolygons, collide_circles, collide_polygon_circle, collide_polygons
from engine.contact_set import Contacts
from engine.rest import Rest
from engine.solver import colour
from engine.state import BodyParams, BodyState, ShapeTable
from engine.vector import Array, Bools, Ints, dot, length, rotate

_DEFAULT_FRICTION = 0.5
# Distance in metres below which shapes count as touching: a contact that came and went with rounding errors would
# start from no impulse each time, and a heap would never come to rest.
MARGIN = 0.002
# Metres within which a point takes over the impulse of one that is gone, and how alike the normals must be (a cosine).
_NEAR = 0.2
_ALIKE = 0.9


@dataclass(frozen=True)
class WarmStart:
    """Impulses of the last step's k manifolds, sorted by world and pair, for a warm start."""

    key: Ints  # (k,) world · pairs + pair, rising
    feature: Ints  # (k, 2), 0 for a point that was not there
    impulse: Array  # (3, k)
    points: Array  # (k, 2, 2)
    normal: Array  # (k, 2)
    age: Ints  # (k,)

    @classmethod
    def of(cls, contacts: Contacts, pairs: int) -> WarmStart:
        """Return the features and impulses of a solved step."""
        key = contacts.world * pairs + contacts.pair
        rising = np.argsort(key)
        manifold = contacts.manifold
        feature = manifold.feature * manifold.valid
        return cls(
            key[rising],
            feature[rising],
            contacts.impulse[:, rising],
            manifold.points[rising],
            manifold.normal[rising],
            contacts.age[rising],
        )

    def where(self, kept: Bools | Ints) -> WarmStart:
        """Return the memory of these manifolds alone, which are marked, or named by their rows."""
        return WarmStart(
            self.key[kept],
            self.feature[kept],
            self.impulse[:, kept],
            self.points[kept],
            self.normal[kept],
            self.age[kept],
        )

    def with_others(self, others: WarmStart) -> WarmStart:
        """Return this memory and another together."""
        order = np.argsort(np.concatenate([self.key, others.key]), kind="stable")
        return WarmStart(
            np.concatenate([self.key, others.key])[order],
            np.concatenate([self.feature, others.feature])[order],
            np.concatenate([self.impulse, others.impulse], axis=1)[:, order],
            np.concatenate([self.points, others.points])[order],
            np.concatenate([self.normal, others.normal])[order],
            np.concatenate([self.age, others.age])[order],
        )


_NOTHING = WarmStart(
    np.zeros(0, dtype=np.intp),
    np.zeros((0, 2), dtype=np.intp),
    np.zeros((3, 0)),
    np.zeros((0, 2, 2)),
    np.zeros((0, 2)),
    np.zeros(0, dtype=np.intp),
)


@dataclass(frozen=True)
class Memory:
    """All that the next step takes over from the last ones: impulses, and what sleeps."""

    impulses: WarmStart
    rest: Rest | None
    forgotten: list[tuple[int, Bools | None]]
    gravity: Array | None
    pairs: int  # of shapes, in every world

    def of_worlds(self, worlds: Ints) -> Memory:
        """Return the memory of some worlds (m,), each as often as it is named; raises ValueError where bodies sleep."""
        if self.rest:
            raise ValueError("worlds in which bodies sleep are remembered as a whole")
        last = self.impulses
        first, behind = last.key.searchsorted([worlds * self.pairs, (worlds + 1) * self.pairs])
        count = behind - first
        ends = count.cumsum()
        row = np.arange(count.sum()) + (first - ends + count).repeat(count)
        key = last.key[row] + ((np.arange(len(worlds)) - worlds) * self.pairs).repeat(count)
        gravity = self.gravity if self.gravity is None or self.gravity.ndim == 1 else self.gravity[worlds]
        return replace(self, impulses=replace(last.where(row), key=key), gravity=gravity)


class Detector:
    """Contact detector of every world. It remembers impulses (warm starting), so that a resting stack starts solved.

    With `rest`, bodies sleep, and no contact of theirs is looked for.
    """

    def __init__(self, params: BodyParams, shapes: ShapeTable, rest: Rest | None = None) -> None:
        self.shapes = shapes
        self.rest = rest
        self.broad = BroadPhase(params, shapes, MARGIN)
        self.pairs = self.broad.pairs  # (pairs, 2) of shapes, a polygon before a circle
        self.body_pairs = shapes.body[self.pairs]
        self.free = params.dynamic[self.body_pairs]  # (pairs, 2): which of the two can move
        self.friction = _mix(params.friction[self.body_pairs], _geometric_mean, _DEFAULT_FRICTION)
        self.restitution = _mix(params.restitution[self.body_pairs], np.maximum, 0.0)
        self._kinds = shapes.is_circle[self.pairs].sum(axis=1)  # how many of the two are circles
        self.impulses = _NOTHING
        self.gravity: Array | None = None  # under which these were needed
        self._forgotten: list[tuple[int, Bools | None]] = []  # bodies, and in which worlds: see `forget`
        self._colours = (np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp), [0])  # of what, order, ends

    def find(self, state: BodyState) -> Contacts | None:
        """Return every touching pair of active bodies, one of them awake, in the solver's order; None if there is none.

        What an awake body touches wakes.
        """
        while True:
            world, pair = self.broad.near(state, self.rest.awake if self.rest else None)
            if not len(world):
                return None
            manifold = self._touch(state, world, pair)
            touching = np.flatnonzero(manifold.valid.any(axis=1))
            if not len(touching):
                return None
            if not (self.rest and self.rest.wake_touched(world[touching], self.body_pairs[pair[touching]])):
                break
        order, ends = self._colour(world[touching], pair[touching], state.pose.shape[1])
        kept = touching[order]
        world, pair, manifold = world[kept], pair[kept], manifold.rows(kept)
        impulse, age = self._recall(world, pair, manifold)
        return Contacts(
            world=world,
            pair=pair,
            body=self.body_pairs[pair],
            manifold=manifold,
            friction=self.friction[pair],
            restitution=self.restitution[pair],
            impulse=impulse,
            approach=np.zeros((3, len(kept))),
            age=age,
            colour_ends=ends,
        )

    def remember(self, contacts: Contacts | None) -> None:
        """Keep the impulses of a step to warm-start the next one, and only that."""
        self.impulses = WarmStart.of(contacts, len(self.pairs)) if contacts else _NOTHING
        if self.rest:
            self.rest.woken = None
            self._forgotten = []

    def memory(self) -> Memory:
        """Return the impulses that `remember` has kept, and what sleeps, to be put back by `recall_memory`."""
        return Memory(self.impulses, self.rest.copy() if self.rest else None, self._forgotten.copy(), self.gravity,
                      len(self.pairs))  # fmt: skip

    def recall_memory(self, memory: Memory) -> None:
        """Put back what a call of `memory` returned."""
        self.impulses, self._forgotten, self.gravity = memory.impulses, memory.forgotten.copy(), memory.gravity
        self.rest = memory.rest.copy() if memory.rest else None
        self.broad.forget_boxes()

    def feel(self, gravity: Array, batch: int) -> None:
        """Expect of contacts no more than another `gravity` (2,) or (batch, 2) asks of them.

        Impulses that bore a stack under a stronger one would throw it up, and a few iterations do not take that back.
        """
        before, self.gravity = self.gravity, gravity
        if before is None or not before.any():
            return
        strength = dot(before, before)
        share = np.where(strength > 0, dot(before, gravity) / np.where(strength > 0, strength, 1.0), 1.0)
        shares = np.broadcast_to(np.clip(share, 0.0, 1.0), (batch,))
        if (shares == 1).all():
            return
        last = self.impulses
        if len(last.key):
            self.impulses = replace(last, impulse=last.impulse * shares[last.key // len(self.pairs)])
        if self.rest and (slept := self.rest.contacts):
            self.rest.contacts = replace(slept, impulse=slept.impulse * shares[slept.world])

    def forget(self, body: int, worlds: Bools | None) -> None:
        """Forget the contacts of a body that was put elsewhere, in these worlds or in all: they no longer apply."""
        self.impulses = self._without(self.impulses, body, worlds)
        if self.rest:  # it may sleep, and wake with the next step
            self._forgotten.append((body, worlds))

    def _without(self, memory: WarmStart, body: int, worlds: Bools | None) -> WarmStart:
        if not len(memory.key):
            return memory
        world, pair = np.divmod(memory.key, len(self.pairs))
        gone = (self.body_pairs[pair] == body).any(axis=1)
        if worlds is not None:
            gone &= worlds[world]
        return memory.where(~gone)

    def _last(self) -> WarmStart:
        """Return the impulses of the last step, and those that what has woken fell asleep with."""
        if not (self.rest and self.rest.woken):
            return self.impulses
        woken = WarmStart.of(self.rest.woken, len(self.pairs))
        for body, worlds in self._forgotten:
            woken = self._without(woken, body, worlds)
        return self.impulses.with_others(woken)

    def _colour(self, world: Ints, pair: Ints, bodies: int) -> tuple[Ints, list[int]]:
        """Return the order and ends of the colours; those of the last step if the same pairs touch."""
        key = world * len(self.pairs) + pair
        if not np.array_equal(key, self._colours[0]):
            slots = world[:, None] * bodies + self.body_pairs[pair]
            self._colours = (key, *colour(slots, self.free[pair]))
        return self._colours[1:]

    def _touch(self, state: BodyState, world: Ints, pair: Ints) -> Manifold:
        """Narrow phase: the manifolds of n pairs, whatever kinds of shape they are."""
        kinds = self._kinds[pair]
        if not kinds.any():
            return self._touch_kind(0, state, world, pair)
        manifold = Manifold.empty(len(pair))
        for kind in (0, 1, 2):
            rows = np.flatnonzero(kinds == kind)
            if len(rows):
                manifold.put(rows, self._touch_kind(kind, state, world[rows], pair[rows]))
        return manifold

    def _touch_kind(self, circles: int, state: BodyState, world: Ints, pair: Ints) -> Manifold:
        a, b = self.pairs[pair].T
        if circles == 0:
            return collide_polygons(self._place(state, world, a), self._place(state, world, b), MARGIN)
        radius = self.shapes.radius
        if circles == 1:
            disc = self.shapes.centres(state, world, b)
            return collide_polygon_circle(self._place(state, world, a), disc, radius[b], MARGIN)
        disc_a, disc_b = self.shapes.centres(state, world, a), self.shapes.centres(state, world, b)
        return collide_circles(disc_a, radius[a], disc_b, radius[b], MARGIN)

    def _place(self, state: BodyState, world: Ints, shape: Ints) -> PlacedPolygons:
        """Return polygons in their worlds, from their bodies' poses."""
        body = self.shapes.body[shape]
        cos, sin = state.cos[world, body, None], state.sin[world, body, None]
        position = state.pose[world, body, None, :2]
        start = rotate(self.shapes.start[shape], cos, sin)
        start += position
        end = rotate(self.shapes.end[shape], cos, sin)
        end += position
        return PlacedPolygons(start, end, rotate(self.shapes.normal[shape], cos, sin))

    def _recall(self, world: Ints, pair: Ints, manifold: Manifold) -> tuple[Array, Ints]:
        """Return the last step's impulses (3, m) for points made by the same faces as then, 0 for others; and ages."""
        impulse, age = np.zeros((3, len(world))), np.zeros(len(world), dtype=np.intp)
        last = self._last()
        if not len(last.key):
            return impulse, age
        key = world * len(self.pairs) + pair
        row = np.minimum(last.key.searchsorted(key), len(last.key) - 1)
        known = last.key[row] == key
        same = known[:, None] & (last.feature[row] == manifold.feature) & manifold.valid
        np.multiply(last.impulse[:2, row], same.T, out=impulse[:2])
        rubs = same.all(axis=1) | (same.any(axis=1) & (manifold.valid.sum(axis=1) == 1))
        np.multiply(last.impulse[2, row], rubs, out=impulse[2])
        if self.rest:
            np.multiply(last.age[row] + 1, known, out=age)
            lost = known & ~(rubs & (same == manifold.valid).all(axis=1))
            if lost.any():
                rows = np.flatnonzero(lost)
                _pass_on(last, row[rows], same[rows], manifold.rows(rows), impulse, rows)
        return impulse, age


def _pass_on(last: WarmStart, row: Ints, same: Bools, manifold: Manifold, impulse: Array, rows: Ints) -> None:
    """Give points that other faces make now the impulses of the nearest that are gone; fill `impulse` at `rows`.

    Two boxes that lie face to face make the same points by one's face or the other's, whichever happens to be a
    little less deep. If their impulses were lost with it, a heap would start afresh here and there in every step, and
    never come to rest. Friction stays if any push does.
    """
    alike = dot(last.normal[row], manifold.normal) > _ALIKE
    gone = (last.feature[row] > 0) & ~same & alike[:, None]
    new = manifold.valid & ~same
    away = length(manifold.points[:, :, None] - last.points[row][:, None])  # (n, new, gone)
    away = np.where(new[:, :, None] & gone[:, None], np.minimum(away, _NEAR), _NEAR)
    crossed = away[:, 0, 1] + away[:, 1, 0] < away[:, 0, 0] + away[:, 1, 1]
    passed = np.zeros_like(same)
    for point in (0, 1):
        heir = np.where(crossed, 1 - point, point)
        passed[:, point] = away[np.arange(len(row)), point, heir] < _NEAR
        impulse[point, rows] += np.where(passed[:, point], last.impulse[heir, row], 0.0)
    rubs = alike & (passed | same).any(axis=1)
    impulse[2, rows] = np.where(rubs, last.impulse[2, row], impulse[2, rows])


def _mix(values: Array, combine: Callable[[Array, Array], Array], default: float) -> Array:
    """Mix surface values (pairs, 2) to one per pair: combined if both bodies set one, else the one set or `default`."""
    a, b = values.T
    either = np.where(np.isnan(a), b, a)
    both = ~np.isnan(a) & ~np.isnan(b)
    return np.where(both, combine(a, b), np.where(np.isnan(either), default, either))


def _geometric_mean(a: Array, b: Array) -> Array:
    return np.sqrt(a * b)
