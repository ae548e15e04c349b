"""Sequential impulses: contacts are satisfied one after another, several times over (Catto, GDC 2006).

A contact is three rows of a constraint: a normal impulse at each of two points, and one friction impulse at their
midpoint, for in two dimensions both points slide alike. Friction stays within Coulomb's cone: at most the friction
coefficient times the sum of the normal impulses.

The two normal impulses of a contact are found together, exactly, as a linear complementarity problem (as in the block
solver of Box2D): solved in turn, the first point would get more than the second, and a tall stack would slowly sway.
docs/adr/0007-contacts-two-points-one-friction.md says why there is one friction.

Contacts of one colour share no body that can move. They are solved at once, in one set of array operations however many
worlds and bodies they span.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from engine.contacts import Contacts
from engine.state import BodyParams, BodyState
from engine.vector import Array, Bools, Ints, cross, dot, right_of

# Overlap that is left alone, so that resting contacts persist; metres.
SLOP = 0.005
# Share of the overlap beyond SLOP that one step corrects.
CORRECTION = 0.25
# Smallest excess that is corrected, so that a stack at rest needs no correction; metres.
TOLERANCE = 1e-4
# In place of TOLERANCE for worlds in which bodies fall asleep, at a point under load whose bodies have touched for OLD
# steps; metres. What overlap is left by then is jammed: to press it out, a few iterations at a time and without
# friction, would make a heap creep for ever.
LENIENCE = 1e-2
OLD = 15
# Two points nearly coincide if the determinant of K, their 2 × 2 matrix of speed per push, is less than this share of
# the product of its diagonal.
NARROWEST = 1e-3


class Solver:
    """Contact solver of one step: velocities first, overlaps after positions have moved."""

    def __init__(self, state: BodyState, params: BodyParams, contacts: Contacts) -> None:
        self._contacts = contacts
        self._inverse_mass = params.inverse_mass[contacts.body]  # (m, 2, 3)
        self._impulse = contacts.impulse.T.copy()  # (3, m): NumPy is quickest along the last axis
        self._rows = Rows.build(state, self._inverse_mass, contacts, self._impulse)
        self._approach = self._rows.speeds(state.velocity.reshape(-1))
        self._approach[:2] *= -1
        contacts.approach, contacts.impulse = self._approach.T, self._impulse.T  # views: the solver fills them
        ends = np.bincount(contacts.colour).cumsum().tolist()
        self._spans = [slice(start, end) for start, end in pairwise([0, *ends])]  # of each colour
        self._colours = [self._rows.part(span) for span in self._spans]

    def solve_velocities(self, state: BodyState, iterations: int, restitution_threshold: float, dt: float) -> None:
        """Apply normal impulses, with restitution, and friction to the velocities; add them to the contacts'.

        A point that closes faster than the threshold (m/s) is to part at e times that speed, with e the restitution;
        any other is to close no faster than its gap allows. `target` (2, m) is that least speed of parting, below 0
        where a gap is left.
        """
        contacts, closing = self._contacts, self._approach[:2]
        rebound = np.where(closing > restitution_threshold, contacts.restitution * closing, 0.0)
        # Where there still is a gap, this step may use it up.
        target = np.where(rebound > 0, rebound, np.minimum(contacts.depth.T, 0.0) / dt)
        velocity = state.velocity.reshape(-1)
        for rows, span in zip(self._colours, self._spans, strict=True):
            velocity[rows.index] += rows.effect(self._impulse[:, span])
        self._iterate(velocity, self._impulse, target, contacts.friction, iterations)

    def correct_positions(self, state: BodyState, iterations: int, dt: float, lenient: bool = False) -> None:
        """Move bodies out of overlaps, beyond SLOP, by shifts that are solved for as velocities are, and add no energy.

        A `lenient` solver leaves alone up to LENIENCE more at points under load that have not parted within OLD steps.
        """
        contacts = self._contacts
        # Depths were measured before bodies moved by their new speeds. What a rebound has undone since is not undone
        # once more, or a ball would be lifted at each bounce.
        depth = contacts.depth.T - dt * self._rows.speeds(state.velocity.reshape(-1))[:2]
        excess = np.where(contacts.valid.T, depth - SLOP, 0.0)
        jammed = (contacts.age >= OLD) & (self._impulse[:2] > 0) & lenient
        excess[excess < np.where(jammed, LENIENCE, TOLERANCE)] = 0.0
        if not excess.any():
            return
        shift, push = np.zeros(state.velocity.size), np.zeros_like(self._impulse)  # m and rad; kg·m
        self._iterate(shift, push, CORRECTION * excess, None, iterations)
        state.pose += shift.reshape(state.pose.shape)
        self._keep_angular_momentum(state, push)

    def _keep_angular_momentum(self, state: BodyState, push: Array) -> None:
        """Take back the angular momentum that free bodies gained as overlaps pushed them aside across their motion.

        Written for each pair, seen from its common centre of mass:

            r = B - A        v = velocity of B as seen from A (`along`)        μ = mA·mB / (mA + mB) (`reduced`)
            angular momentum       L = μ·(r × v) + IA·ωA + IB·ωB
            inertia as one body    I = μ·r² + IA + IB (`whole`)

        The `push` p along the contact normal n moved B by p/μ as seen from A, so L has grown by p·(n × v). L is brought
        back by turning the pair as one body, at L/I radians a second (`turn`), like a skater who spreads the arms. So
        the bodies come no nearer by it and do not slide on each other. The rest of their motion is their own (`own`),
        and has no angular momentum. Where the turn adds energy, ½L²/I, their own motion is slowed to make up for it.
        """
        rows = np.flatnonzero((self._inverse_mass[:, :, 0] > 0).all(axis=1) & push[:2].any(axis=0))
        if not len(rows):
            return
        contacts, (mass, _, inertia) = self._contacts, 1.0 / self._inverse_mass[rows].transpose(2, 1, 0)
        places = contacts.world[rows, None], contacts.body[rows]
        pose, velocity = state.pose[places], state.velocity[places]
        along, spins = velocity[:, 1, :2] - velocity[:, 0, :2], velocity[..., 2].T
        turned = -right_of(pose[:, 1, :2] - pose[:, 0, :2])  # v of a pair that turns as one by 1 rad/s
        share = mass[0] / (mass[0] + mass[1])  # of a change of v that B takes; A takes the rest, the other way
        reduced = share * mass[1]
        whole = reduced * dot(turned, turned) + inertia[0] + inertia[1]
        momentum = reduced * dot(turned, along) + inertia[0] * spins[0] + inertia[1] * spins[1]
        momentum_before = momentum - (push[0, rows] + push[1, rows]) * cross(contacts.normal[rows], along)
        turn = momentum / whole
        own, own_spins = along - turn[:, None] * turned, spins - turn
        twice_energy = reduced * dot(own, own) + inertia[0] * own_spins[0] ** 2 + inertia[1] * own_spins[1] ** 2
        excess = np.divide(
            momentum_before**2 - momentum**2, whole * twice_energy, out=np.zeros_like(whole), where=twice_energy > 0
        )
        own_change = np.sqrt(np.clip(1.0 - excess, 0.0, 1.0)) - 1.0  # relative, 0 or below
        turn_change = momentum_before / whole - turn
        change = np.empty_like(velocity)
        along_change = turn_change[:, None] * turned + own_change[:, None] * own
        change[:, 0, :2], change[:, 1, :2] = (share - 1.0)[:, None] * along_change, share[:, None] * along_change
        change[..., 2] = (turn_change + own_change * own_spins).T
        np.add.at(state.velocity, places, change)

    def _iterate(self, velocity: Array, total: Array, target: Array, friction: Array | None, iterations: int) -> None:
        """Projected Gauss-Seidel: drive each normal speed to `target` (2, m) or more, by pushing only.

        Changes `velocity`, of all bodies laid flat, and the accumulated impulses `total` (3, m). Positions are solved
        alike, with shifts in metres in place of speeds.
        It ends early only where a further iteration would change no bit, so a world is the same alone and among others.
        """
        parts = [
            (rows, (total[:, span], target[:, span], None if friction is None else friction[span]))
            for rows, span in zip(self._colours, self._spans, strict=True)
        ]
        for _ in range(iterations):
            changed = [rows.relax(velocity, *part) for rows, part in parts]
            if not any(changed):
                return


@dataclass
class Rows:
    """Constraint rows of m contacts: normal at each point, and friction; every array ends with the contacts.

    J is the Jacobian, M the masses and inertias of both bodies: rows respond to impulses p by speeds J·M⁻¹·Jᵀ·p. The
    entries of that 3 × 3 matrix are called stiffness here; K is its part for the two pushes.

    Scalar products are added up one after another by NumPy itself. The linear algebra library behind `@` adds in an
    order of its own on each kind of processor, and fuses additions on some: flights would differ.
    """

    index: Ints  # (6, m): where x, y and turn of A, then of B, stand among all velocities, laid flat
    jacobian: Array  # (3, 6, m): J; J · velocities is the speed along each row
    response: Array  # (3, 6, m): velocity change per unit of impulse: M⁻¹·Jᵀ, laid out as J is
    mass: Array  # (3, m): effective mass, impulse per unit of speed; 0 for a point that is not there
    coupling: Array  # (m,): K's entry beside the diagonal: speed at one point per unit of push at the other
    rub_coupling: Array  # (2, m): speed of sliding per unit of push at each point
    inverse: Array  # (2, m): diagonal of K⁻¹
    cross_inverse: Array  # (m,): K⁻¹'s entry beside the diagonal

    @classmethod
    def build(cls, state: BodyState, inverse_mass: Array, contacts: Contacts, impulse: Array) -> Rows:
        """Return the rows of these contacts; where two points nearly coincide, one's `impulse` (3, m) is set to 0."""
        slots = contacts.world[:, None] * state.pose.shape[1] + contacts.body
        index = (slots[:, :, None] * 3 + np.arange(3)).reshape(-1, 6).T.copy()
        jacobian = _jacobian(state.pose.reshape(-1, 3)[slots, :2], contacts)
        inverse_masses = inverse_mass.reshape(-1, 6).T.copy()
        response = jacobian * inverse_masses
        stiffness = _stiffness(jacobian, response)
        spare = np.flatnonzero(_coincide(stiffness))
        if len(spare):
            # Points that nearly coincide can't share a push sensibly; the deeper one will do.
            shallower = contacts.depth[spare].argmin(axis=1)
            jacobian[shallower, :, spare] = impulse[shallower, spare] = 0.0
            response = jacobian * inverse_masses
            stiffness = _stiffness(jacobian, response)
        first, second, _, coupling = stiffness[:4]  # K's diagonal, friction's own, K's entry beside the diagonal
        mass = np.divide(1.0, stiffness[:3], out=np.zeros_like(stiffness[:3]), where=stiffness[:3] > 0)
        alone = first * second == 0
        # K⁻¹ is 1 / determinant times K with its diagonal swapped and the rest negated; a point alone has 1 / K.
        determinant = np.where(alone, 1.0, first * second - coupling**2)
        inverse = np.where(alone, mass[:2], stiffness[1::-1] / determinant)
        cross_inverse = np.where(alone, 0.0, -coupling / determinant)
        return cls(index, jacobian, response, mass, coupling, stiffness[4:], inverse, cross_inverse)

    def part(self, span: slice) -> Rows:
        """Return the rows of some of the contacts."""
        return Rows(*(table[..., span] for table in vars(self).values()))

    def speeds(self, velocity: Array) -> Array:
        """Speed along each row, (3, m), given all velocities laid flat."""
        speed: Array = (self.jacobian * velocity[self.index]).sum(axis=1)
        return speed

    def effect(self, impulse: Array) -> Array:
        """Velocity change (6, m) of A and B by impulses (3, m)."""
        change = self.response * impulse[:, None]
        total: Array = change[0] + change[1] + change[2]
        return total

    def relax(self, velocity: Array, total: Array, wanted: Array, friction: Array | None) -> bool:
        """Solve these contacts once, friction last, so that it ends within its cone; return whether that changed any.

        Changes all velocities, laid flat, and the accumulated impulses `total` (3, m). Each point is to part at
        `wanted` (2, m) m/s or more. Friction goes by `sliding`, as the new pushes leave it: the impulse that would stop
        it is cut to the cone μ·(p₀ + p₁). Without `friction` coefficients μ (m,), there is none.
        """
        motion = velocity[self.index]
        speed = (self.jacobian * motion).sum(axis=1)
        pushes = self.push(wanted - speed[:2], total[:2])
        change = np.zeros_like(total)
        change[:2] = pushes - total[:2]
        if friction is not None:
            sliding = speed[2] + self.rub_coupling[0] * change[0] + self.rub_coupling[1] * change[1]
            cone = friction * (pushes[0] + pushes[1])
            rub = np.minimum(np.maximum(total[2] - self.mass[2] * sliding, -cone), cone)
            change[2] = rub - total[2]
        total += change
        velocity[self.index] = motion + self.effect(change)
        return bool(change.any())

    def push(self, lacking: Array, total: Array) -> Array:
        """Return impulses p (2, m) ≥ 0 in place of `total`, so that each point gains the speed it is `lacking`.

        With K the 2 × 2 matrix of speed per push, that is p = total + K⁻¹·lacking. Where a point would be pulled, it
        gets nothing, and may gain more than it lacked: the linear complementarity problem p ≥ 0, K·(p - total) ≥
        lacking, with equality in one of the two at each point.
        """
        both = total + self.inverse * lacking + self.cross_inverse * lacking[::-1]
        if both.min() >= 0:
            return both
        # The other point has to do alone, and without what the first has pushed at it until now.
        alone = total + self.mass[:2] * (lacking + self.coupling * total[::-1])
        return np.maximum(np.where(both[::-1] >= 0, both, alone), 0.0)


def _stiffness(jacobian: Array, response: Array) -> Array:
    """J·M⁻¹·Jᵀ, speed per unit of impulse, (6, m): of each row (3), both pushes on each other, friction on each."""
    products: Array = (jacobian[[0, 1, 2, 0, 0, 1]] * response[[0, 1, 2, 1, 2, 2]]).sum(axis=1)
    return products


def _coincide(stiffness: Array) -> Bools:
    """Whether a contact's two points are so near each other that no pair of pushes can tell them apart, (m,)."""
    product = stiffness[0] * stiffness[1]
    near: Bools = (product > 0) & (product - stiffness[3] ** 2 <= NARROWEST * product)
    return near


def _jacobian(positions: Array, contacts: Contacts) -> Array:
    """Jacobian (3, 6, m) of contacts between bodies centred at `positions` (m, 2, 2).

    A row along the unit vector u at the point q is (-u, -(q - A) × u, u, (q - B) × u). Times the velocities, it is the
    speed along u of B's point as seen from A's, so parting is above 0. For friction, u lies a quarter right of the
    normal, and q half-way between the points. Rows of points that are not there are 0.
    """
    valid = contacts.valid
    both = (valid[:, 0] & valid[:, 1])[:, None]
    first, second = contacts.points[:, 0], contacts.points[:, 1]
    middle = np.where(both, (first + second) / 2, np.where(valid[:, :1], first, second))
    points = np.stack([first, second, middle])
    along = np.stack([contacts.normal, contacts.normal, right_of(contacts.normal)])
    rows = np.empty((3, 6, len(valid)))
    rows[:, 3:5] = along.swapaxes(1, 2)
    rows[:, 0:2] = -rows[:, 3:5]
    rows[:, 2] = -cross(points - positions[:, 0], along)
    rows[:, 5] = cross(points - positions[:, 1], along)
    rows[:2] *= valid.T[:, None]
    return rows
