"""Contacts as constraints: how fast each point parts, and what an impulse at it changes.

A contact is three rows of a constraint: a normal impulse at each of two points, and one friction impulse at their
midpoint, for in two dimensions both points slide alike. Friction stays within Coulomb's cone: at most the friction
coefficient times the sum of the normal impulses.

The two normal impulses of a contact are found together, exactly, as a linear complementarity problem (as in the block
solver of Box2D): solved in turn, the first point would get more than the second, and a tall stack would slowly sway.
docs/adr/0007-contacts-two-points-one-friction.md says why there is one friction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.contacts import Contacts
from engine.state import BodyState
from engine.vector import Array, Bools, Ints, cross, right_of

# Two points nearly coincide if the determinant of K, their 2 × 2 matrix of speed per push, is less than this share of
# the product of its diagonal.
NARROWEST = 1e-3


@dataclass
class Constraints:
    """Constraint rows of m contacts: normal at each point, and friction; every array ends with the contacts.

    With J the Jacobian and M the masses and inertias of both bodies, impulses p change the velocities by M⁻¹·Jᵀ·p, and
    so the speeds along the rows by J·M⁻¹·Jᵀ·p. K is the part of that 3 × 3 matrix for the two pushes:

        K = | k₀  c |        K⁻¹ = |  k₁ -c | / (k₀·k₁ - c²)        a point without another: K = k, K⁻¹ = 1 / k
            | c  k₁ |              | -c  k₀ |

    Scalar products are added up one after another by NumPy itself. The linear algebra library behind `@` adds in an
    order of its own on each kind of processor, and fuses additions on some: flights would differ.
    """

    index: Ints  # (6, m): where x, y and turn of A, then of B, stand among all velocities, laid flat
    jacobian: Array  # (3, 6, m): J; J · velocities is the speed along each row
    response: Array  # (3, 6, m): velocity change per unit of impulse: M⁻¹·Jᵀ, laid out as J is
    mass: Array  # (3, m): effective mass, impulse per unit of speed: 1 / k; 0 for a point that does not count
    coupling: Array  # (m,): c, speed at one point per unit of push at the other
    friction_coupling: Array  # (2, m): speed of sliding per unit of push at each point
    inverse: Array  # (2, m): diagonal of K⁻¹
    cross_inverse: Array  # (m,): K⁻¹'s entry beside the diagonal

    @classmethod
    def build(cls, state: BodyState, inverse_mass: Array, contacts: Contacts) -> Constraints:
        """Return the rows of these contacts between bodies of `inverse_mass` (m, 2, 3)."""
        slots = contacts.world[:, None] * state.pose.shape[1] + contacts.body
        index = (slots[:, :, None] * 3 + np.arange(3)).reshape(-1, 6).T.copy()
        jacobian = _jacobian(state.pose.reshape(-1, 3)[slots, :2], contacts)
        response = jacobian * inverse_mass.reshape(-1, 6).T.copy()
        # J·M⁻¹·Jᵀ: k₀, k₁ and that of friction; c; what the pushes do to sliding.
        speeds = (jacobian[[0, 1, 2, 0, 0, 1]] * response[[0, 1, 2, 1, 2, 2]]).sum(axis=1)
        counts = _counting(contacts, *speeds[[0, 1, 3]])
        both = counts.all(axis=0)
        for table in (jacobian, response):
            table[:2] *= counts[:, None]
        k, c, sliding = speeds[:2], speeds[3] * both, speeds[4:] * counts
        mass = 1.0 / speeds[:3]
        mass[:2] *= counts
        determinant = np.where(both, k[0] * k[1] - c**2, 1.0)
        inverse = np.where(both, k[::-1] / determinant, mass[:2])
        return cls(index, jacobian, response, mass, c, sliding, inverse, -c / determinant)

    def part(self, span: slice) -> Constraints:
        """Return the rows of some of the contacts."""
        return Constraints(*(table[..., span] for table in vars(self).values()))

    def speeds(self, velocity: Array) -> Array:
        """Speed along each row, (3, m), given all velocities laid flat."""
        speed: Array = (self.jacobian * velocity[self.index]).sum(axis=1)
        return speed

    def effect(self, impulse: Array) -> Array:
        """Velocity change (6, m) of A and B by impulses (3, m)."""
        change = self.response * impulse[:, None]
        total: Array = change[0] + change[1] + change[2]
        return total

    def relax(self, velocity: Array, total: Array, wanted: Array, coefficient: Array | None) -> bool:
        """Solve these contacts once, friction last, so that it ends within its cone; return whether that changed any.

        Changes all velocities, laid flat, and the accumulated impulses `total` (3, m). Each point is to part at
        `wanted` (2, m) m/s or more. Friction goes by `sliding`, as the new pushes leave it: the impulse that would stop
        it is cut to the cone μ·(p₀ + p₁), with μ the `coefficient` (m,). Without one, there is no friction.
        """
        motion = velocity[self.index]
        speed = (self.jacobian * motion).sum(axis=1)
        pushes = self.push(wanted - speed[:2], total[:2])
        change = np.zeros_like(total)
        change[:2] = pushes - total[:2]
        if coefficient is not None:
            sliding = speed[2] + self.friction_coupling[0] * change[0] + self.friction_coupling[1] * change[1]
            cone = coefficient * (pushes[0] + pushes[1])
            friction = np.minimum(np.maximum(total[2] - self.mass[2] * sliding, -cone), cone)
            change[2] = friction - total[2]
        total += change
        velocity[self.index] = motion + self.effect(change)
        return bool(change.any())

    def push(self, lacking: Array, total: Array) -> Array:
        """Return the pushes p (2, m) that take the place of `total`, so that points gain at least the speed they lack.

        No point can pull. So p ≥ 0, K·(p - total) ≥ lacking, and at each point one of the two is an equality: a linear
        complementarity problem, with four cases for the two points of a contact.

            to gain just what they lack, both push      p is that
            one would have to pull                      it gets 0, and the other alone makes up for both
            both would                                  either alone is asked, and neither gets less than 0
        """
        both = total + self.inverse * lacking + self.cross_inverse * lacking[::-1]
        if both.min() >= 0:
            return both
        # What the other has pushed until now, it no longer does: that is lacking, too.
        alone = total + self.mass[:2] * (lacking + self.coupling * total[::-1])
        other_would_pull = both[::-1] < 0
        return np.maximum(np.where(other_would_pull, alone, both), 0.0)


def _counting(contacts: Contacts, first: Array, second: Array, coupling: Array) -> Bools:
    """Return which points count, (2, m): those that are there, but of two that nearly coincide the deeper one alone.

    No pair of pushes could tell such two apart: k₀·k₁ and c² are about the same.
    """
    product = first * second
    coincide = contacts.valid.all(axis=1) & (product - coupling**2 <= NARROWEST * product)
    shallower = contacts.depth.argmin(axis=1) == [[0], [1]]
    counts: Bools = contacts.valid.T & ~(coincide & shallower)
    return counts


def _jacobian(positions: Array, contacts: Contacts) -> Array:
    """Jacobian (3, 6, m) of contacts between bodies centred at `positions` (m, 2, 2).

    A row along the unit vector u at the point q is (-u, -(q - A) × u, u, (q - B) × u). Times the velocities, it is the
    speed along u of B's point as seen from A's, so parting is above 0. For friction, u lies a quarter right of the
    normal, and q half-way between the points.
    """
    first, second = contacts.points[:, 0], contacts.points[:, 1]
    both = contacts.valid.all(axis=1, keepdims=True)
    middle = np.where(both, (first + second) / 2, np.where(contacts.valid[:, :1], first, second))
    points = np.stack([first, second, middle])
    along = np.stack([contacts.normal, contacts.normal, right_of(contacts.normal)])
    rows = np.empty((3, 6, len(contacts)))
    rows[:, 3:5] = along.swapaxes(1, 2)
    rows[:, 0:2] = -rows[:, 3:5]
    rows[:, 2] = -cross(points - positions[:, 0], along)
    rows[:, 5] = cross(points - positions[:, 1], along)
    return rows
