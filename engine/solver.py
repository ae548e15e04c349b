"""Sequential impulses: contacts are satisfied one after another, several times over (Catto, GDC 2006).

A manifold is three rows of a constraint: a normal impulse at each of two points, and one friction impulse at
their midpoint, for in two dimensions both points of a manifold slide alike. Friction stays within Coulomb's
cone, bounded by the friction coefficient times the sum of the normal impulses.

The two normal impulses of a manifold are found together, exactly, as a linear complementarity problem: solved
in turn, the first point would get more than the second, and a tall stack would slowly sway.

Manifolds that share no body can be solved at once, so they are sorted into colours, and a colour is one set
of array operations however many worlds and bodies it spans.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.collide import Manifold
from engine.state import BodyParams, BodyState
from engine.vector import Array, Bools, Ints, cross, right_of

# Overlap that is left alone, so that resting contacts persist; metres.
SLOP = 0.005
# Share of the overlap beyond it that one step takes back.
CORRECTION = 0.25


@dataclass
class Contacts:
    """The touching pairs of one step, m of them, in the order of their colours."""

    world: Ints  # (m,)
    pair: Ints  # (m,) row of the world's table of shape pairs
    body: Ints  # (m, 2) A and B
    manifold: Manifold
    friction: Array  # (m,)
    restitution: Array  # (m,)
    impulse: Array  # (3, m) N·s: normal, normal, friction; begins with what the last step needed
    approach: Array  # (3, m) m/s before the impulses: closing at each point, then sliding
    colour_ends: list[int]  # manifolds up to each of these indices share no dynamic body

    def __len__(self) -> int:
        return len(self.world)


class Solver:
    """Satisfies one step's contacts: velocities first, overlaps after positions have moved."""

    def __init__(self, state: BodyState, params: BodyParams, contacts: Contacts) -> None:
        self.contacts = contacts
        rows = _Rows.build(state, params, contacts)
        contacts.approach = rows.speeds(state.velocity.reshape(-1, 3))
        contacts.approach[:2] *= -1
        starts = [0, *contacts.colour_ends[:-1]]
        self._slices = [slice(a, b) for a, b in zip(starts, contacts.colour_ends, strict=True)]
        self._colours = [rows.part(span) for span in self._slices]

    def solve_velocities(self, state: BodyState, iterations: int, restitution_threshold: float) -> None:
        """Change velocities in place until contacts stop closing, bounce and rub; fills contacts.impulse."""
        contacts = self.contacts
        closing = contacts.approach[:2]
        rebound = np.where(closing > restitution_threshold, contacts.restitution * closing, 0.0)
        velocity = state.velocity.reshape(-1, 3)
        for rows, span in zip(self._colours, self._slices, strict=True):
            rows.apply(velocity, contacts.impulse[:, span])
        self._sweep(velocity, contacts.impulse, rebound, contacts.friction, iterations)

    def solve_overlaps(self, state: BodyState, iterations: int) -> None:
        """Move bodies out of overlaps by a velocity that lasts for this step alone, and so adds no energy."""
        manifold = self.contacts.manifold
        excess = np.where(manifold.valid, manifold.depth - SLOP, 0.0).T
        if not (excess > 0).any():
            return
        shift = np.zeros((state.velocity.size // 3, 3))
        wanted = CORRECTION * np.maximum(excess, 0.0)
        self._sweep(shift, np.zeros((3, len(self.contacts))), wanted, None, iterations)
        state.pose += shift.reshape(state.pose.shape)
        state.refresh_rotation()

    def _sweep(
        self, velocity: Array, impulse: Array, target: Array, friction: Array | None, iterations: int
    ) -> None:
        """Projected Gauss-Seidel: drive each normal speed to `target` (2, m) or more, by pushing only."""
        parts = [
            (rows, impulse[:, span], target[:, span], None if friction is None else friction[span])
            for rows, span in zip(self._colours, self._slices, strict=True)
        ]
        for _ in range(iterations):
            for rows, total, wanted, coefficient in parts:
                speed = rows.speeds(velocity)
                change = np.zeros_like(total)
                if coefficient is not None:
                    cone = coefficient * (total[0] + total[1])
                    rub = np.minimum(np.maximum(total[2] - rows.mass[2] * speed[2], -cone), cone)
                    change[2] = rub - total[2]
                    speed[:2] += rows.rub_coupling * change[2]
                # The speeds there would be without any normal impulse at all.
                speed[:2] -= wanted + rows.mass_inverse * total[:2] + rows.push_coupling * total[1::-1]
                change[:2] = rows.push(speed[:2]) - total[:2]
                np.add(total, change, out=total)
                rows.apply(velocity, change)


@dataclass
class _Rows:
    """Constraint rows. First axis: normal, normal, friction; last axis: A's x, y, turn, then B's."""

    slots: Ints  # (m, 2) A and B in the flattened (batch, bodies) axis
    jacobian: Array  # (3, m, 6): row · velocities is the speed along it
    response: Array  # (3, m, 6): velocity change per unit of impulse
    mass: Array  # (3, m): impulse per unit of speed; 0 for a point that is not there
    mass_inverse: Array  # (2, m) of the normal rows
    push_coupling: Array  # (m,): how a push at one point moves the other
    rub_coupling: Array  # (2, m): how friction moves both points
    pair_inverse: Array  # (3, m): other and own entries of the 2 × 2 inverse of a pair; NaN if singular

    @classmethod
    def build(cls, state: BodyState, params: BodyParams, contacts: Contacts) -> _Rows:
        slots = contacts.world[:, None] * state.pose.shape[1] + contacts.body
        jacobian = _jacobian(state.pose.reshape(-1, 3)[slots, :2], contacts.manifold)
        response = jacobian * params.inverse_mass[contacts.body].reshape(-1, 6)
        stiffness = np.vecdot(jacobian[[0, 1, 2, 0, 0, 1]], response[[0, 1, 2, 1, 2, 2]])
        mass = np.divide(1.0, stiffness[:3], out=np.zeros_like(stiffness[:3]), where=stiffness[:3] > 0)
        first, second, coupling = stiffness[0], stiffness[1], stiffness[3]
        determinant = first * second - coupling**2
        # Points that nearly coincide can't share a push sensibly; NaN makes `push` take one of them.
        determinant[determinant <= 1e-3 * first * second] = np.nan
        pair_inverse = np.stack([coupling, second, first]) / determinant
        return cls(slots, jacobian, response, mass, stiffness[:2], coupling, stiffness[4:], pair_inverse)

    def part(self, span: slice) -> _Rows:
        """Only the manifolds of `span`."""
        return _Rows(
            self.slots[span], self.jacobian[:, span], self.response[:, span], self.mass[:, span],
            self.mass_inverse[:, span], self.push_coupling[span], self.rub_coupling[:, span],
            self.pair_inverse[:, span],
        )  # fmt: skip

    def speeds(self, velocity: Array) -> Array:
        """Speed along each row, (3, m), given flattened velocities (batch · bodies, 3)."""
        speed: Array = np.vecdot(self.jacobian, velocity[self.slots].reshape(-1, 6))
        return speed

    def apply(self, velocity: Array, impulse: Array) -> None:
        """Add the effect of `impulse` (3, m) to the flattened velocities, in place."""
        change = self.response * impulse[:, :, None]
        total = change[0] + change[1] + change[2]
        # A static body may stand in many rows at once; its response is zero, so any one of them may win.
        velocity[self.slots] += total.reshape(-1, 2, 3)

    def push(self, speed: Array) -> Array:
        """Solve for both points at once: impulses (2, m) and resulting speeds >= 0, one of the two 0."""
        both = self.pair_inverse[0] * speed[::-1] - self.pair_inverse[1:] * speed
        alone = np.maximum(-self.mass[:2] * speed, 0.0)
        first_will_do = speed[1] + self.push_coupling * alone[0] >= 0
        alone[0] *= first_will_do
        alone[1] *= ~first_will_do
        return np.where((both >= 0).all(axis=0), both, alone)


def colour(slots: Ints, free: Bools, pair: Ints) -> tuple[Ints, list[int]]:
    """Order m manifolds so that within each colour no two share a body that can move; and the colours' ends.

    slots (m, 2) name the bodies and `free` (m, 2) says which can move. Each round takes the manifolds that
    have the lowest number among the neighbours left (Luby 1986); the numbers are a scrambled `pair`, the
    same in every batch, so that a world is solved in the same order alone and among others.
    """
    rank = (pair * 0x9E3779B1) & 0xFFFFFFFF
    left = np.arange(len(slots))
    order: list[Ints] = []
    ends: list[int] = []
    lowest = np.empty(int(slots.max(initial=-1)) + 1, dtype=np.intp)
    while len(left):
        lowest[slots[left]] = np.iinfo(np.intp).max
        for side in (0, 1):
            moving = left[free[left, side]]
            np.minimum.at(lowest, slots[moving, side], rank[moving])
        taken: Bools = ((lowest[slots[left]] == rank[left, None]) | ~free[left]).all(axis=1)
        order.append(left[taken])
        ends.append(len(order[-1]) + (ends[-1] if ends else 0))
        left = left[~taken]
    return (np.concatenate(order) if order else left), ends


def _jacobian(positions: Array, manifold: Manifold) -> Array:
    """Rows (3, m, 6) of a manifold between bodies centred at `positions` (m, 2, 2)."""
    valid = manifold.valid
    both = valid.all(axis=1)[:, None]
    first, second = manifold.points[:, 0], manifold.points[:, 1]
    middle = np.where(both, (first + second) / 2, np.where(valid[:, :1], first, second))
    points = np.stack([first, second, middle])
    along = np.stack([manifold.normal, manifold.normal, right_of(manifold.normal)])
    rows = np.empty((3, len(valid), 6))
    rows[..., 0:2] = -along
    rows[..., 2] = -cross(points - positions[:, 0], along)
    rows[..., 3:5] = along
    rows[..., 5] = cross(points - positions[:, 1], along)
    rows[:2][~valid.T] = 0.0
    return rows
