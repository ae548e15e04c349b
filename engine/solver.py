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
from functools import cached_property

import numpy as np

from engine.collide import Manifold
from engine.contact_set import Contacts
from engine.state import BodyParams, BodyState
from engine.vector import Array, Bools, Ints, cross, dot, right_of

# Overlap that is left alone, so that resting contacts persist; metres.
SLOP = 0.005
# Share of the overlap beyond SLOP that one step corrects.
CORRECTION = 0.25
# Smallest excess that is corrected, so that a stack at rest needs no correction; metres.
TOLERANCE = 1e-4
# The same between bodies that are to fall asleep, for a point under load where they have touched for OLD steps. What
# is left by then is jammed: to press it out, a few iterations at a time and without friction, would make a heap creep
# for as long as one looks.
LENIENCE = 1e-2
OLD = 15
# Share of what two points' pushes do to each other by which they must differ, or they nearly coincide.
NARROWEST = 1e-3
# Manifolds among which there nearly always is one that would be pulled; it is not asked then.
_MANY = 12


class Solver:
    """Contact solver of one step: velocities first, overlaps after positions have moved."""

    def __init__(self, state: BodyState, params: BodyParams, contacts: Contacts) -> None:
        self.contacts = contacts
        self._inverse_mass = params.inverse_mass[contacts.body]  # (m, 2, 3)
        self._rows = Rows.build(state, params, contacts)
        contacts.approach = self._rows.speeds(state.velocity.reshape(-1))
        contacts.approach[:2] *= -1
        starts = [0, *contacts.colour_ends[:-1]]
        self._spans = [slice(a, b) for a, b in zip(starts, contacts.colour_ends, strict=True)]
        self._colours = [self._rows.part(span) for span in self._spans]

    def solve_velocities(self, state: BodyState, iterations: int, restitution_threshold: float, dt: float) -> None:
        """Apply normal impulses, with restitution, and friction to the velocities in place; fill contacts.impulse."""
        contacts = self.contacts
        closing = contacts.approach[:2]
        rebound = np.where(closing > restitution_threshold, contacts.restitution * closing, 0.0)
        # Where there still is a gap, this step may use it up.
        target = np.where(rebound > 0, rebound, np.minimum(contacts.manifold.depth.T, 0.0) / dt)
        velocity = state.velocity.reshape(-1)
        for rows, span in zip(self._colours, self._spans, strict=True):
            velocity[rows.index] += rows.effect(contacts.impulse[:, span])
        self._sweep(velocity, contacts.impulse, target, contacts.friction, iterations)

    def solve_overlaps(self, state: BodyState, iterations: int, dt: float, lenient: bool = False) -> None:
        """Move bodies out of overlaps by a velocity that lasts for this step alone, and so adds no energy.

        A `lenient` solver leaves alone what is up to LENIENCE more, if that has not gone within OLD steps.
        """
        manifold = self.contacts.manifold
        # What a rebound is about to undo is left to it; taken back twice, it would lift a ball at each bounce.
        depth = manifold.depth.T - dt * self._rows.speeds(state.velocity.reshape(-1))[:2]
        excess = np.where(manifold.valid.T, depth - SLOP, 0.0)
        tolerance: Array | float = TOLERANCE
        if lenient:
            jammed = (self.contacts.age >= OLD) & (self.contacts.impulse[:2] > 0)
            tolerance = np.where(jammed, LENIENCE, TOLERANCE)
        excess[excess < tolerance] = 0.0
        if not excess.any():
            return
        shift = np.zeros(state.velocity.size)
        push = np.zeros((3, len(self.contacts)))
        self._sweep(shift, push, CORRECTION * excess, None, iterations)
        state.pose += shift.reshape(state.pose.shape)
        self._keep_angular_momentum(state, push)

    def _keep_angular_momentum(self, state: BodyState, push: Array) -> None:
        """Take back the angular momentum that free bodies gained as overlaps pushed them aside across their motion.

        Each pair turns a little about its common centre of mass as if it were one body, like a skater who spreads the
        arms, so the two move neither apart nor along each other. Where that would add energy, they do so less.
        """
        rows = np.flatnonzero((self._inverse_mass[:, :, 0] > 0).all(axis=1) & push[:2].any(axis=0))
        if not len(rows):
            return
        contacts, (mass, _, inertia) = self.contacts, 1.0 / self._inverse_mass[rows].transpose(2, 1, 0)
        places = contacts.world[rows, None], contacts.body[rows]
        pose, velocity = state.pose[places], state.velocity[places]
        along, spins = velocity[:, 1, :2] - velocity[:, 0, :2], velocity[..., 2].T
        turned = -right_of(pose[:, 1, :2] - pose[:, 0, :2])  # how B moves about A when both turn by a radian
        share = mass[0] / (mass[0] + mass[1])
        reduced = share * mass[1]
        whole = reduced * dot(turned, turned) + inertia[0] + inertia[1]
        now = reduced * dot(turned, along) + inertia[0] * spins[0] + inertia[1] * spins[1]
        before = now - (push[0, rows] + push[1, rows]) * cross(contacts.manifold.normal[rows], along)
        turn = now / whole
        own, own_spins = along - turn[:, None] * turned, spins - turn
        energy = reduced * dot(own, own) + inertia[0] * own_spins[0] ** 2 + inertia[1] * own_spins[1] ** 2  # twice
        excess = np.divide(before**2 - now**2, whole * energy, out=np.zeros_like(whole), where=energy > 0)
        less = np.sqrt(np.clip(1.0 - excess, 0.0, 1.0)) - 1.0
        turn = before / whole - turn
        change = np.empty_like(velocity)
        pull = turn[:, None] * turned + less[:, None] * own
        change[:, 0, :2], change[:, 1, :2] = (share - 1.0)[:, None] * pull, share[:, None] * pull
        change[..., 2] = (turn + less * own_spins).T
        np.add.at(state.velocity, places, change)

    def _sweep(self, velocity: Array, impulse: Array, target: Array, friction: Array | None, iterations: int) -> None:
        """Projected Gauss-Seidel: drive each normal speed to `target` (2, m) or more, by pushing only.

        It ends early only where a further iteration would change no bit, so a world is the same alone and among others.
        """
        parts = [
            (rows, impulse[:, span], target[:, span], None if friction is None else friction[span])
            for rows, span in zip(self._colours, self._spans, strict=True)
        ]
        if friction is None:
            for rows in self._colours:
                rows.space.change[2] = 0.0
        for _ in range(iterations):
            before = impulse.tobytes()
            for rows, total, wanted, coefficient in parts:
                rows.relax(velocity, total, wanted, coefficient)
            if impulse.tobytes() == before and not any(rows.space.change.any() for rows in self._colours):
                return


@dataclass
class Rows:
    """Constraint rows. Axes: normal, normal, friction; A's x, y, turn, then B's; manifolds, which NumPy works along.

    Their scalar products are added up one after another by NumPy itself. The linear algebra library behind `dot` adds
    in an order of its own on each kind of processor, and fuses additions on some: flights would differ.
    """

    index: Ints  # (6, m): where A's and B's velocities stand among all of them, laid flat
    jacobian: Array  # (3, 6, m): row · velocities is the speed along it
    response: Array  # (3, 6, m): velocity change per unit of impulse
    mass: Array  # (3, m): effective mass, impulse per unit of speed; 0 for a point that is not there
    coupling: Array  # (m,): how a push at one point moves the other
    rub_coupling: Array  # (2, m): how friction moves both points
    inverse: Array  # (2, m): of the 2 × 2 matrix of both pushes, the diagonal
    cross_inverse: Array  # (m,): and what stands beside it

    @cached_property
    def space(self) -> Space:
        """Where `relax` works."""
        return Space(self.index.shape[1])

    @classmethod
    def build(cls, state: BodyState, params: BodyParams, contacts: Contacts) -> Rows:
        """Return the rows of these contacts, before any has been solved."""
        slots = contacts.world[:, None] * state.pose.shape[1] + contacts.body
        index = (slots[:, :, None] * 3 + np.arange(3)).reshape(-1, 6).T.copy()
        jacobian = _jacobian(state.pose.reshape(-1, 3)[slots, :2], contacts.manifold)
        inverse_mass = params.inverse_mass[contacts.body].reshape(-1, 6).T.copy()
        response = jacobian * inverse_mass
        stiffness = _stiffness(jacobian, response)
        spare = np.flatnonzero(_coincide(stiffness))
        if len(spare):
            # Points that nearly coincide can't share a push sensibly; the deeper one will do.
            shallower = contacts.manifold.depth[spare].argmin(axis=1)
            jacobian[shallower, :, spare] = contacts.impulse[shallower, spare] = 0.0
            response = jacobian * inverse_mass
            stiffness = _stiffness(jacobian, response)
        mass = np.divide(1.0, stiffness[:3], out=np.zeros_like(stiffness[:3]), where=stiffness[:3] > 0)
        first, second, coupling = stiffness[0], stiffness[1], stiffness[3]
        alone = first * second == 0
        determinant = np.where(alone, 1.0, first * second - coupling**2)
        inverse = np.where(alone, mass[:2], stiffness[1::-1] / determinant)
        cross_inverse = np.where(alone, 0.0, -coupling / determinant)
        return cls(index, jacobian, response, mass, coupling, stiffness[4:], inverse, cross_inverse)

    def part(self, span: slice) -> Rows:
        """Only the manifolds of `span`."""
        return Rows(
            self.index[:, span],
            self.jacobian[..., span],
            self.response[..., span],
            self.mass[:, span],
            self.coupling[span],
            self.rub_coupling[:, span],
            self.inverse[:, span],
            self.cross_inverse[span],
        )

    def speeds(self, velocity: Array) -> Array:
        """Speed along each row, (3, m), given all velocities laid flat."""
        speed: Array = (self.jacobian * velocity.take(self.index)).sum(axis=1)
        return speed

    def effect(self, impulse: Array) -> Array:
        """Velocity change (6, m) of A and B by impulses (3, m)."""
        change = self.response * impulse[:, None]
        total: Array = change[0] + change[1] + change[2]
        return total

    def relax(self, velocity: Array, total: Array, wanted: Array, friction: Array | None) -> None:
        """Bring these manifolds to rest, friction last, so that it ends within its cone; adds to `total` (3, m).

        Without `friction`, none is applied. A step calls this a hundred times on some dozens of numbers, so what counts
        is how many arrays are made: results go where those of the last call were.
        """
        space = self.space
        change, pushed = space.change, total[:2]
        motion = velocity.take(self.index, out=space.motion, mode="clip")
        np.multiply(self.jacobian, motion, out=space.products)
        speed = np.add.reduce(space.products, axis=1, out=space.speed)
        pushes = self.push(np.subtract(wanted, space.closing, out=space.lacking), pushed)
        np.subtract(pushes, pushed, out=space.pushed)
        if friction is not None:
            nudges = np.multiply(self.rub_coupling, space.pushed, out=space.nudges)
            sliding = np.add(speed[2], nudges[0], out=space.sliding)
            sliding += nudges[1]
            cone = np.add(pushes[0], pushes[1], out=space.cone)
            cone *= friction
            rub = np.multiply(self.mass[2], sliding, out=space.rub)
            np.subtract(total[2], rub, out=rub)
            np.maximum(rub, np.negative(cone, out=space.low), out=rub)
            np.minimum(rub, cone, out=rub)
            np.subtract(rub, total[2], out=change[2])
        total += change
        turn = np.multiply(self.response, space.column, out=space.turn)
        moved = np.add(turn[0], turn[1], out=space.moved)
        if friction is not None:
            moved += turn[2]
        moved += motion
        # A static body may stand in many rows at once; its response is zero, so any one of them may win.
        velocity[self.index] = moved

    def push(self, lacking: Array, total: Array) -> Array:
        """Impulses (2, m) >= 0 that give both points the speed they are `lacking`; 0 where none is."""
        space = self.space
        both = np.multiply(self.inverse, lacking, out=space.both)
        both += total
        both += np.multiply(self.cross_inverse, lacking[::-1], out=space.alone)
        if both.shape[1] < _MANY and both.min() >= 0:
            return both
        # Where that would pull at one point, there is no impulse at it, and the other point has to do alone.
        alone = np.multiply(self.coupling, total[::-1], out=space.alone)
        alone += lacking
        alone *= self.mass[:2]
        alone += total
        np.copyto(alone, both, where=both[::-1] >= 0)
        return np.maximum(alone, 0.0, out=alone)


class Space:
    """Arrays in which `Rows.relax` works on m manifolds, and views of them, made once for all its calls."""

    def __init__(self, count: int) -> None:
        self.motion, self.moved = np.empty((2, 6, count))
        self.products, self.turn = np.empty((2, 3, 6, count))
        self.speed = np.empty((3, count))
        self.closing = self.speed[:2]
        self.change = np.zeros((3, count))  # of impulses
        self.pushed, self.column = self.change[:2], self.change[:, None]
        self.lacking, self.both, self.alone, self.nudges = np.empty((4, 2, count))
        self.sliding, self.cone, self.low, self.rub = np.empty((4, count))


def colour(slots: Ints, free: Bools) -> tuple[Ints, list[int]]:
    """Colour m manifolds so that no two of a colour share a body that can move; return their order and the ends.

    slots (m, 2) name the bodies and `free` (m, 2) says which can move. Each manifold takes the first colour
    that neither of its bodies has yet, so a world is solved in the same order alone and among others.
    """
    nobody = int(slots.max(initial=-1)) + 1
    used = [0] * (nobody + 1)  # one bit for each colour of a body's manifolds
    bits = []
    for a, b in np.where(free, slots, nobody).tolist():
        used_a, used_b = used[a], used[b]
        busy = used_a | used_b
        bit = ~busy & (busy + 1)
        used[a], used[b] = used_a | bit, used_b | bit
        used[nobody] = 0
        bits.append(bit)
    chosen = np.array([bit.bit_length() for bit in bits])
    order = np.argsort(chosen, kind="stable")
    return order, np.bincount(chosen).cumsum()[1:].tolist()


def _stiffness(jacobian: Array, response: Array) -> Array:
    """Speed per unit of impulse: of each row (3, m), of both pushes on each other, of friction on both."""
    products: Array = (jacobian[[0, 1, 2, 0, 0, 1]] * response[[0, 1, 2, 1, 2, 2]]).sum(axis=1)
    return products


def _coincide(stiffness: Array) -> Bools:
    """Whether a manifold's two points are so near each other that no pair of pushes can tell them apart, (m,)."""
    product = stiffness[0] * stiffness[1]
    near: Bools = (product > 0) & (product - stiffness[3] ** 2 <= NARROWEST * product)
    return near


def _jacobian(positions: Array, manifold: Manifold) -> Array:
    """Rows (3, 6, m) of a manifold between bodies centred at `positions` (m, 2, 2)."""
    valid = manifold.valid
    both = (valid[:, 0] & valid[:, 1])[:, None]
    first, second = manifold.points[:, 0], manifold.points[:, 1]
    middle = np.where(both, (first + second) / 2, np.where(valid[:, :1], first, second))
    points = np.stack([first, second, middle])
    along = np.stack([manifold.normal, manifold.normal, right_of(manifold.normal)])
    rows = np.empty((3, 6, len(valid)))
    rows[:, 3:5] = along.swapaxes(1, 2)
    rows[:, 0:2] = -rows[:, 3:5]
    rows[:, 2] = -cross(points - positions[:, 0], along)
    rows[:, 5] = cross(points - positions[:, 1], along)
    rows[:2] *= valid.T[:, None]
    return rows
