"""Contacts of one step: what touches in all worlds, in the solver's order, with the last step's impulses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine.collide import Manifold, collide_pairs
from engine.shapes import ShapeTable
from engine.state import BodyParams, BodyState
from engine.vector import Array, Bools, Ints, dot, length

# Distance in metres below which shapes count as touching: a contact that came and went with rounding errors would
# start from no impulse each time, and a heap would never come to rest.
MARGIN = 0.002
_DEFAULT_FRICTION = 0.5
# Metres within which a point takes over the impulse of one that is gone, and how alike the normals must be (a cosine).
_NEAR = 0.2
_ALIKE = 0.9


@dataclass
class Contacts(Manifold):
    """The touching pairs of one step, m of them, with all that is known of each; every array leads with them."""

    world: Ints  # (m,)
    pair: Ints  # (m,) row of the world's table of shape pairs
    body: Ints  # (m, 2) A and B
    friction: Array  # (m,)
    restitution: Array  # (m,)
    impulse: Array  # (m, 3) N·s: normal at each point, friction; begins with what the last step needed
    approach: Array  # (m, 3) m/s before the impulses: closing at each point, then sliding
    age: Ints  # (m,) steps for which the pair has touched without a break
    colour: Ints  # (m,) rising: contacts of one colour share no body that can move, so they are solved at once

    def __len__(self) -> int:
        return len(self.world)

    def take(self, rows: Ints) -> Contacts:
        """Return these contacts alone."""
        return Contacts(*(table[rows] for table in vars(self).values()))

    def with_others(self, others: Contacts | None) -> Contacts:
        """Return these contacts, and others after them."""
        if others is None:
            return self
        return Contacts(*map(np.concatenate, zip(vars(self).values(), vars(others).values(), strict=True)))


class NarrowPhase:
    """Exact test of pairs of shapes that are near, rows of `pairs`, and what is known of each pair beforehand."""

    def __init__(self, params: BodyParams, shapes: ShapeTable, pairs: Ints) -> None:
        self._shapes = shapes
        self.pairs = pairs  # (pairs, 2) of shapes
        self._body = shapes.body[pairs]
        self._free = params.dynamic[self._body]  # (pairs, 2): which of the two bodies can move
        self._friction = _mix(params.friction[self._body], _geometric_mean, _DEFAULT_FRICTION)
        self._restitution = _mix(params.restitution[self._body], np.maximum, 0.0)
        self._coloured: tuple[Ints, Ints, Ints] | None = None  # keys of the last step's contacts, their order, colours

    def touching(self, state: BodyState, world: Ints, pair: Ints) -> Contacts | None:
        """Return those of the pairs (n,) that touch, in the solver's order; None if none does."""
        if not len(world):
            return None
        manifold = collide_pairs(self._shapes, state, world, self.pairs[pair], MARGIN)
        rows = np.flatnonzero(manifold.valid.any(axis=1))
        if not len(rows):
            return None
        order, colours = self._colour(world[rows], pair[rows], state.pose.shape[1])
        rows = rows[order]
        world, pair = world[rows], pair[rows]
        return Contacts(
            **{name: table[rows] for name, table in vars(manifold).items()},
            world=world,
            pair=pair,
            body=self._body[pair],
            friction=self._friction[pair],
            restitution=self._restitution[pair],
            impulse=np.zeros((len(rows), 3)),
            approach=np.zeros((len(rows), 3)),
            age=np.zeros(len(rows), dtype=np.intp),
            colour=colours,
        )

    def _key(self, world: Ints, pair: Ints) -> Ints:
        """A number for each pair of each world, (n,)."""
        return world * len(self.pairs) + pair

    def _colour(self, world: Ints, pair: Ints, bodies: int) -> tuple[Ints, Ints]:
        """Return order and colours of contacts; those of the last step if the same pairs touch."""
        key = self._key(world, pair)
        if self._coloured is None or not np.array_equal(key, self._coloured[0]):
            colours = _colours(world[:, None] * bodies + self._body[pair], self._free[pair])
            order = np.argsort(colours, kind="stable")
            self._coloured = (key, order, colours[order])
        return self._coloured[1:]

    def warm_start(self, contacts: Contacts, last: Contacts | None, share: Array | None, pass_on: bool) -> None:
        """Begin with the last step's impulses, or a `share` (batch,), at points that the same faces make as then.

        A resting stack so starts solved. With `pass_on`, other points may take over impulses, too.
        """
        if not last:
            return
        key, last_key = self._key(contacts.world, contacts.pair), self._key(last.world, last.pair)
        # Look up each contact's key among those of the last step: `row` is where it stands there, if it does.
        rising = np.argsort(last_key)
        row = rising[np.minimum(last_key.searchsorted(key, sorter=rising), len(rising) - 1)]
        known = last_key[row] == key  # pairs that touched in the last step, in its `row`
        same = known[:, None] & last.valid[row] & contacts.valid & (last.feature[row] == contacts.feature)
        # There is one friction for both points: it stays if all of the points have.
        all_same = same.all(axis=1) | (same.any(axis=1) & (contacts.valid.sum(axis=1) == 1))
        impulse = last.impulse[row] if share is None else last.impulse[row] * share[contacts.world, None]
        contacts.impulse = impulse * np.column_stack([same, all_same])
        contacts.age = (last.age[row] + 1) * known
        changed = np.flatnonzero(known & ~all_same)
        if pass_on and len(changed):
            _pass_on(contacts, changed, last.take(row[changed]), impulse[changed], same[changed])


def _pass_on(contacts: Contacts, rows: Ints, last: Contacts, impulse: Array, same: Bools) -> None:
    """Let new points of contacts `rows` (n,) take over the impulse (n, 3) of the nearest of the `last` that is gone.

    Two boxes that lie face to face make the same points by one's face or the other's, whichever happens to be a little
    less deep. If their impulses were lost with it, a heap would start afresh here and there in every step, and never
    come to rest. `same` (n, 2) are points that kept theirs.
    """
    alike = dot(last.normal, contacts.normal[rows]) > _ALIKE
    new, gone = contacts.valid[rows] & ~same, last.valid & ~same & alike[:, None]
    source, passed = _nearest(contacts.points[rows], new, last.points, gone)
    contacts.impulse[rows, :2] += np.where(passed, np.take_along_axis(impulse[:, :2], source, axis=1), 0.0)
    pushed = alike & (passed | same).any(axis=1)  # friction stays if any push does
    contacts.impulse[rows, 2] = np.where(pushed, impulse[:, 2], contacts.impulse[rows, 2])


def _nearest(points: Array, new: Bools, last: Array, gone: Bools) -> tuple[Ints, Bools]:
    """Match the new ones of `points` (n, 2, 2) with those of the `last` that are gone, straight or crosswise.

    Of the two ways the shorter holds. Returns for each point which of the last it is matched with, (n, 2), and whether
    both are there and lie near each other.
    """
    away = length(points[:, :, None] - last[:, None])  # (n, point, last)
    away = np.where(new[:, :, None] & gone[:, None], np.minimum(away, _NEAR), _NEAR)
    crossed = away[:, 0, 1] + away[:, 1, 0] < away[:, 0, 0] + away[:, 1, 1]
    source = np.where(crossed[:, None], (1, 0), (0, 1))
    return source, np.take_along_axis(away, source[:, :, None], axis=2)[..., 0] < _NEAR


def _colours(slots: Ints, free: Bools) -> Ints:
    """Colour m contacts so that no two of a colour share a body that can move: numbers from 0 on, (m,).

    `slots` (m, 2) name the bodies and `free` (m, 2) says which can move. Each contact takes the first colour that
    neither of its bodies has yet (greedy graph colouring), so a world is solved in the same order alone and among
    others.
    """
    taken = [0] * (int(slots.max(initial=-1)) + 1)  # for each body, one bit for each colour of its contacts
    colours = []
    for (a, b), (a_free, b_free) in zip(slots.tolist(), free.tolist(), strict=True):
        busy = taken[a] | taken[b]
        bit = ~busy & (busy + 1)  # the lowest that is not set
        taken[a] |= bit * a_free
        taken[b] |= bit * b_free
        colours.append(bit.bit_length() - 1)
    return np.array(colours, dtype=np.intp)


def _mix(values: Array, combine: Callable[[Array, Array], Array], default: float) -> Array:
    """Mix surface values (pairs, 2) to one per pair: combined if both bodies set one, else the one set or `default`."""
    a, b = values.T
    either = np.where(np.isnan(a), b, a)
    both = ~np.isnan(a) & ~np.isnan(b)
    return np.where(both, combine(a, b), np.where(np.isnan(either), default, either))


def _geometric_mean(a: Array, b: Array) -> Array:
    return np.sqrt(a * b)
