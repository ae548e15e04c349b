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
    shape: Ints  # (m, 2) of A and of B
    body: Ints  # (m, 2) A and B
    friction: Array  # (m,)
    restitution: Array  # (m,)
    impulse: Array  # (m, 3) N·s: normal at each point, friction; begins with what the last step needed
    approach: Array  # (m, 3) m/s before the impulses: closing at each point, then sliding
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
    """Exact test of pairs of shapes that are near."""

    def __init__(self, params: BodyParams, shapes: ShapeTable) -> None:
        self._params, self._shapes = params, shapes
        self._places = np.array([len(shapes), 1])  # of two shapes in a number that names them
        self._coloured: tuple[Ints, Ints, Ints] | None = None  # keys of the last step's contacts, their order, colours

    def touching(self, state: BodyState, world: Ints, pair: Ints) -> Contacts | None:
        """Return those of the pairs of shapes (n, 2) that touch, in the solver's order; None if none does."""
        if not len(world):
            return None
        manifold = collide_pairs(self._shapes, state, world, pair, MARGIN)
        rows = np.flatnonzero(manifold.valid.any(axis=1))
        if not len(rows):
            return None
        order, colours = self._colour(world[rows], pair[rows], state.pose.shape[1])
        rows = rows[order]
        world, pair = world[rows], pair[rows]
        body = self._shapes.body[pair]
        return Contacts(
            **{name: table[rows] for name, table in vars(manifold).items()},
            world=world,
            shape=pair,
            body=body,
            friction=_mix(self._params.friction[body], lambda a, b: np.sqrt(a * b), _DEFAULT_FRICTION),
            restitution=_mix(self._params.restitution[body], np.maximum, 0.0),
            impulse=np.zeros((len(rows), 3)),
            approach=np.zeros((len(rows), 3)),
            colour=colours,
        )

    def _key(self, world: Ints, pair: Ints) -> Ints:
        """A number for each pair of shapes of each world, (n,)."""
        key: Ints = world * len(self._shapes) ** 2 + pair @ self._places
        return key

    def _colour(self, world: Ints, pair: Ints, bodies: int) -> tuple[Ints, Ints]:
        """Return order and colours of contacts; those of the last step if the same pairs touch."""
        key = self._key(world, pair)
        if self._coloured is None or not np.array_equal(key, self._coloured[0]):
            body = self._shapes.body[pair]
            colours = _colours(world[:, None] * bodies + body, self._params.dynamic[body])
            order = np.argsort(colours, kind="stable")
            self._coloured = (key, order, colours[order])
        return self._coloured[1:]

    def warm_start(self, contacts: Contacts, last: Contacts | None, pass_on: bool) -> None:
        """Begin with the last step's impulses at points that the same faces make as then.

        A resting stack so starts solved. With `pass_on`, other points may take over impulses, too.
        """
        if not last:
            return
        keys = self._key(contacts.world, contacts.shape), self._key(last.world, last.shape)
        _, now, then = np.intersect1d(*keys, assume_unique=True, return_indices=True)  # pairs that touched before, too
        same = contacts.valid[now] & last.valid[then] & (contacts.feature[now] == last.feature[then])
        # There is one friction for both points: it stays if all of the points have.
        unchanged = (same == contacts.valid[now]).all(axis=1)
        contacts.impulse[now] = last.impulse[then] * np.column_stack([same, unchanged])
        if pass_on and not unchanged.all():
            changed = np.flatnonzero(~unchanged)
            _pass_on(contacts, now[changed], last.take(then[changed]), same[changed])


def _pass_on(contacts: Contacts, rows: Ints, last: Contacts, same: Bools) -> None:
    """Let new points of contacts `rows` (n,) take over the impulses of points of the `last` (n,) that are gone.

    Two boxes that lie face to face make the same points by one's face or the other's, whichever happens to be a little
    less deep. If their impulses were lost with it, a heap would start afresh here and there in every step, and never
    come to rest. `same` (n, 2) are the points that kept theirs.

        gone   q0 ●            ● q1      a new point p takes over the impulse of q where each is the other's nearest,
        new      p1 ○        ○ p0        and near: here p0 that of q1, and p1 that of q0
    """
    alike = dot(last.normal, contacts.normal[rows]) > _ALIKE
    is_new, is_gone = contacts.valid[rows] & ~same, last.valid & ~same & alike[:, None]
    away = length(contacts.points[rows][:, :, None] - last.points[:, None])  # (n, p, q)
    away[~(is_new[:, :, None] & is_gone[:, None])] = np.inf
    nearest_new, nearest_gone = away.min(axis=1, keepdims=True), away.min(axis=2, keepdims=True)
    match = (away == nearest_new) & (away == nearest_gone) & (away < _NEAR)
    contacts.impulse[rows, :2] += (match * last.impulse[:, None, :2]).sum(axis=2)
    keeps_a_push = alike & (same | match.any(axis=2)).any(axis=1)
    contacts.impulse[rows, 2] = last.impulse[:, 2] * keeps_a_push  # friction goes with the pushes


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
