"""Sequential impulses: contacts are satisfied one after another, several times over (Catto, GDC 2006).

Contacts of one colour share no body that can move. They are solved at once, in one set of array operations however many
worlds and bodies they span.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from engine.constraints import Constraints
from engine.contacts import Contacts
from engine.state import BodyParams, BodyState
from engine.vector import Array, cross, right_of

# Speed from which bodies rebound; m/s.
REBOUND = 0.25
# Overlap that is left alone, so that resting contacts persist; metres.
SLOP = 0.005
# Share of the overlap beyond SLOP that one step corrects.
CORRECTION = 0.25
# Smallest excess that is corrected, so that a stack at rest needs no correction; metres.
TOLERANCE = 1e-4


class Solver:
    """Contact solver of one step: velocities first, overlaps after positions have moved."""

    def __init__(self, state: BodyState, params: BodyParams, contacts: Contacts) -> None:
        self._contacts = contacts
        self._inverse_mass = params.inverse_mass[contacts.body]  # (m, 2, 3)
        self._impulse = contacts.impulse.T.copy()  # (3, m): NumPy is quickest along the last axis
        self._constraints = Constraints.build(state, self._inverse_mass, contacts)
        self._impulse[:2] *= self._constraints.mass[:2] > 0
        self._approach = self._constraints.speeds(state.velocity.reshape(-1))
        self._approach[:2] *= -1
        contacts.approach, contacts.impulse = self._approach.T, self._impulse.T  # views: the solver fills them
        ends = np.bincount(contacts.colour).cumsum().tolist()
        self._spans = [slice(start, end) for start, end in pairwise([0, *ends])]  # of each colour
        self._colours = [self._constraints.part(span) for span in self._spans]

    def solve_velocities(self, state: BodyState, iterations: int, dt: float) -> None:
        """Apply normal impulses, with restitution, and friction to the velocities; add them to the contacts'.

        A point that closes faster than REBOUND is to part at e times that speed, with e the restitution;
        any other is to close no faster than its gap allows. `target` (2, m) is that least speed of parting, below 0
        where a gap is left.
        """
        contacts, closing = self._contacts, self._approach[:2]
        rebound = np.where(closing > REBOUND, contacts.restitution * closing, 0.0)
        # Where there still is a gap, this step may use it up.
        target = np.where(rebound > 0, rebound, np.minimum(contacts.depth.T, 0.0) / dt)
        velocity = state.velocity.reshape(-1)
        for colour, span in zip(self._colours, self._spans, strict=True):
            velocity[colour.index] += colour.effect(self._impulse[:, span])
        self._iterate(velocity, self._impulse, target, contacts.friction, iterations)

    def correct_positions(self, state: BodyState, iterations: int, dt: float) -> None:
        """Move bodies out of overlaps beyond SLOP by shifts, solved for as velocities are, that add no energy."""
        contacts = self._contacts
        # Depths were measured before bodies moved by their new speeds. What a rebound has undone since is not undone
        # once more, or a ball would be lifted at each bounce.
        depth = contacts.depth.T - dt * self._constraints.speeds(state.velocity.reshape(-1))[:2]
        excess = np.where(contacts.valid.T, depth - SLOP, 0.0)
        excess[excess < TOLERANCE] = 0.0
        if not excess.any():
            return
        shift, push = np.zeros(state.velocity.size), np.zeros_like(self._impulse)  # m and rad; kg·m
        self._iterate(shift, push, CORRECTION * excess, None, iterations)
        state.pose += shift.reshape(state.pose.shape)
        _keep_angular_momentum(state, contacts, self._inverse_mass, push[:2].sum(axis=0))

    def _iterate(self, velocity: Array, total: Array, target: Array, friction: Array | None, iterations: int) -> None:
        """Projected Gauss-Seidel: drive each normal speed to `target` (2, m) or more, by pushing only.

        Changes `velocity`, of all bodies laid flat, and the accumulated impulses `total` (3, m). Positions are solved
        alike, with shifts in metres in place of speeds.
        It ends early only where a further iteration would change no bit, so a world is the same alone and among others.
        """
        parts = [
            (colour, (total[:, span], target[:, span], None if friction is None else friction[span]))
            for colour, span in zip(self._colours, self._spans, strict=True)
        ]
        for _ in range(iterations):
            changed = [colour.relax(velocity, *part) for colour, part in parts]
            if not any(changed):
                return


def _keep_angular_momentum(state: BodyState, contacts: Contacts, inverse_mass: Array, push: Array) -> None:
    """Take back the angular momentum that pairs of free bodies gained as they were pushed apart across their motion.

    A `push` p (m,), in kg·m along the normal n, has added p·(n × v), with v the velocity of B as seen from A. Each pair
    is taken as one rigid body, which turns about its centre of mass like a skater who spreads the arms: by changing
    that turn alone, its bodies come no nearer and do not slide on each other. Where that adds energy, all else that
    moves in the pair is slowed to make up for it.
    """
    rows = np.flatnonzero((inverse_mass[:, :, 0] > 0).all(axis=1) & (push > 0))
    if not len(rows):
        return
    places = contacts.world[rows, None], contacts.body[rows]
    # Of both bodies of each pair, in x, y and turn, (pairs, 2, 3):
    mass, pose, velocity = 1.0 / inverse_mass[rows], state.pose[places], state.velocity[places]
    share = mass / mass.sum(axis=1, keepdims=True)
    turning = np.ones_like(velocity)  # their velocities if the pair turned at 1 rad/s: (-ry, rx, 1), r from its centre
    turning[..., :2] = -right_of((pose - (share * pose).sum(axis=1, keepdims=True))[..., :2])
    # Of each pair: its inertia, and its angular momentum as it is and as it was before the push.
    inertia, momentum = _total(mass * turning**2), _total(mass * turning * velocity)
    before = momentum - (push[rows] * cross(contacts.normal[rows], velocity[:, 1] - velocity[:, 0]))[:, None, None]
    else_moving = velocity - momentum / inertia * turning
    else_moving[..., :2] -= (share * velocity).sum(axis=1, keepdims=True)[..., :2]
    gain, left = (before**2 - momentum**2) / inertia, _total(mass * else_moving**2)  # energies, both doubled
    lost = np.divide(gain, left, out=np.zeros_like(gain), where=left > 0)
    slower = np.sqrt(np.clip(1.0 - lost, 0.0, 1.0))
    np.add.at(state.velocity, places, (before - momentum) / inertia * turning + (slower - 1.0) * else_moving)


def _total(parts: Array) -> Array:
    """Sum of what both bodies of a pair have in x, y and turn: (pairs, 2, 3) to (pairs, 1, 1)."""
    total: Array = parts.sum(axis=(1, 2), keepdims=True)
    return total
