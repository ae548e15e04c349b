"""Contacts of one body that is alone in its world with fixed ones, in plain floats.

A craft on its feet has one to four contacts, each a colour of its own, and a step of them makes a thousand calls of
NumPy on arrays of length one. Here the same is computed in Python's floats, in the same operations and the same order
as in `collide`, `contacts` and `solver`, which say what each formula is for; so the results are the same, bit for bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from engine.collide import Manifold
from engine.contact_set import Contacts
from engine.contacts import MARGIN, WarmStart
from engine.lone_touch import Face, Touch, edges_of, placed, touch_of
from engine.solver import CORRECTION, NARROWEST, SLOP, TOLERANCE
from engine.vector import Ints

if TYPE_CHECKING:
    from engine.free_flight import FreeFlight
    from engine.world import World

_STIFF: Final = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))  # the rows of the six numbers of a stiffness

Triple = list[float]  # x, y and turn of the body; what it touches does not move


class LoneContacts:
    """Steps of the body of a free `flight` in which something is near: `World.step` of a world without sleep."""

    def __init__(self, world: World, flight: FreeFlight) -> None:
        self._world, self.flight = world, flight
        detector, body = world.detector, flight.body
        shapes = detector.shapes
        self._friction, self._restitution = detector.friction.tolist(), detector.restitution.tolist()
        self._parts = {  # its own shapes: corners, normals, middle, and how far from it contacts are looked for
            part: (edges_of(shapes.start[part], shapes.normal[part]), shapes.centre[part].tolist(), reach + MARGIN)
            for part, reach in enumerate(shapes.reach.tolist())
            if shapes.body[part] == body
        }
        self._pairs: dict[int, list[tuple[int, int]]] = {}  # by fixed shape: row of the world's pairs, and own shape
        for row, (part, fixed) in enumerate(detector.pairs.tolist()):
            self._pairs.setdefault(fixed, []).append((row, part))
        self._inverse: Triple = world.params.inverse_mass[body].tolist()
        self._faces: dict[int, list[Face]] = {}  # of fixed shapes, as far as any was near
        self._version = -1  # of where fixed bodies were when these were read

    def step(self, force: tuple[float, float, float], dt: float) -> Contacts | None:
        """Advance the body by `dt` seconds under this force and torque; return what touched."""
        world, flight = self._world, self.flight
        touches = self._find()
        solver = _Solver(world, flight, touches, self._inverse, self._friction, self._restitution) if touches else None
        flight.fall(*force, dt)
        if solver:
            solver.solve_velocities(dt)
        flight.move(dt)
        if solver:
            solver.solve_overlaps(dt)
        flight.give()
        return solver.contacts() if solver else None

    def _find(self) -> list[Touch]:
        """Return what touches, in the order of the world's pairs."""
        flight, detector = self.flight, self._world.detector
        if self._version != detector.broad.version:
            self._faces, self._version = {}, detector.broad.version
        x, y, cos, sin = flight.x, flight.y, flight.cos, flight.sin
        own: dict[int, list[Face]] = {}
        found = []
        for shape, (low_x, low_y, high_x, high_y), _ in flight.around():
            for row, part in self._pairs.get(shape, ()):
                edges, (right, up), reach = self._parts[part]
                at_x, at_y = right * cos - up * sin + x, right * sin + up * cos + y
                if at_y - reach > high_y or at_y + reach < low_y or at_x - reach > high_x or at_x + reach < low_x:
                    continue
                if part not in own:
                    own[part] = placed(edges, x, y, cos, sin)
                if touch := touch_of(row, own[part], self._fixed(shape)):
                    found.append(touch)
        found.sort()
        return found

    def _fixed(self, shape: int) -> list[Face]:
        """Return the faces of a fixed shape where it is."""
        if shape not in self._faces:
            shapes, state = self._world.detector.shapes, self._world.state
            body = shapes.body[shape]
            edges = edges_of(shapes.start[shape], shapes.normal[shape])
            x, y, _ = state.pose[0, body].tolist()
            self._faces[shape] = placed(edges, x, y, state.cos.item(0, body), state.sin.item(0, body))
        return self._faces[shape]


class _Solver:
    """`solver.Solver` for touches that are a colour each."""

    def __init__(
        self,
        world: World,
        flight: FreeFlight,
        touches: list[Touch],
        inverse: Triple,
        friction: list[float],
        restitution: list[float],
    ) -> None:
        self._world, self._flight, self._touches = world, flight, touches
        self._impulses = _recalled(world.detector.impulses, touches)
        self._rows = []
        for touch, impulse in zip(touches, self._impulses, strict=True):
            jacobian = _jacobian(touch, flight.x, flight.y)
            response, stiffness = _response(jacobian, inverse)
            product = stiffness[0] * stiffness[1]
            if product > 0 and product - stiffness[3] * stiffness[3] <= NARROWEST * product:
                shallower = int(touch.depth[1] < touch.depth[0])
                jacobian[shallower], impulse[shallower] = [0.0, 0.0, 0.0], 0.0
                response, stiffness = _response(jacobian, inverse)
            self._rows.append((jacobian, _mixed(stiffness), response, friction[touch.pair]))
        self.approach = self._speeds()
        for closing in self.approach:
            closing[:2] = -closing[0], -closing[1]
        self._restitution = [restitution[touch.pair] for touch in touches]

    def solve_velocities(self, dt: float) -> None:
        flight, threshold = self._flight, self._world.restitution_threshold
        targets = []
        for touch, approach, bounce in zip(self._touches, self.approach, self._restitution, strict=True):
            rebounds = [bounce * closing if closing > threshold else 0.0 for closing in approach[:2]]
            targets.append(
                [back if back > 0 else min(depth, 0.0) / dt for back, depth in zip(rebounds, touch.depth, strict=True)]
            )
        velocity = [flight.vx, flight.vy, flight.spin]
        for (_, _, response, _), (first, second, rub) in zip(self._rows, self._impulses, strict=True):
            for k in range(3):
                velocity[k] += response[0][k] * first + response[1][k] * second + response[2][k] * rub
        self._sweep(velocity, self._impulses, targets, self._world.iterations, rubs=True)
        flight.vx, flight.vy, flight.spin = velocity

    def solve_overlaps(self, dt: float) -> None:
        flight = self._flight
        targets, any_excess = [], False
        for touch, speeds in zip(self._touches, self._speeds(), strict=True):
            excess = [
                depth - dt * speed - SLOP if there else 0.0
                for depth, speed, there in zip(touch.depth, speeds[:2], touch.valid, strict=True)
            ]
            targets.append([CORRECTION * (over if over >= TOLERANCE else 0.0) for over in excess])
            any_excess = any_excess or max(excess) >= TOLERANCE
        if not any_excess:
            return
        shift = [0.0, 0.0, 0.0]
        pushes = [[0.0, 0.0, 0.0] for _ in self._touches]
        self._sweep(shift, pushes, targets, max(2, self._world.iterations // 3), rubs=False)
        flight.x, flight.y, flight.angle = flight.x + shift[0], flight.y + shift[1], flight.angle + shift[2]
        flight.turn()

    def _speeds(self) -> list[Triple]:
        """Speed along each row of each touch: normal, normal, friction."""
        motion = self._flight.vx, self._flight.vy, self._flight.spin
        return [[_product(row, motion) for row in jacobian] for jacobian, _, _, _ in self._rows]

    def _sweep(
        self,
        velocity: list[float],
        impulses: list[list[float]],
        targets: list[list[float]],
        iterations: int,
        rubs: bool,
    ) -> None:
        """`Solver._sweep` with `Rows.relax`, one touch after another; changes `velocity` and `impulses`."""
        vx, vy, spin = velocity
        for _ in range(iterations):
            changed = False
            for (jacobian, mixed, response, friction), total, (wanted, second_wanted) in zip(
                self._rows, impulses, targets, strict=True
            ):
                mass, second_mass, rub_mass, coupling, rub, second_rub, inverse, second_inverse, cross = mixed
                (closing_x, closing_y, closing_turn), (second_x, second_y, second_turn), (x, y, turn) = jacobian
                closing = closing_x * vx + closing_y * vy + closing_turn * spin
                second_closing = second_x * vx + second_y * vy + second_turn * spin
                sliding = x * vx + y * vy + turn * spin
                lacking, second_lacking = wanted - closing, second_wanted - second_closing
                first, second, third = total
                push = inverse * lacking + first + cross * second_lacking
                second_push = second_inverse * second_lacking + second + cross * lacking
                if push < 0 or second_push < 0:
                    alone = (coupling * second + lacking) * mass + first
                    second_alone = (coupling * first + second_lacking) * second_mass + second
                    push, second_push = (
                        max(push if second_push >= 0 else alone, 0.0),
                        max(second_push if push >= 0 else second_alone, 0.0),
                    )
                change, second_change, third_change = push - first, second_push - second, 0.0
                if rubs:
                    sliding = sliding + rub * change + second_rub * second_change
                    cone = (push + second_push) * friction
                    third_change = min(max(third - rub_mass * sliding, -cone), cone) - third
                total[0], total[1], total[2] = first + change, second + second_change, third + third_change
                along, second_along, across = response
                if rubs:
                    vx += along[0] * change + second_along[0] * second_change + across[0] * third_change
                    vy += along[1] * change + second_along[1] * second_change + across[1] * third_change
                    spin += along[2] * change + second_along[2] * second_change + across[2] * third_change
                else:
                    vx += along[0] * change + second_along[0] * second_change
                    vy += along[1] * change + second_along[1] * second_change
                    spin += along[2] * change + second_along[2] * second_change
                changed = changed or bool(change or second_change or third_change)
            if not changed:
                break
        velocity[:] = vx, vy, spin

    def contacts(self) -> Contacts:
        """Return the solved contacts, in arrays."""
        detector, count = self._world.detector, len(self._touches)
        pair, normal, points, depth, valid, feature = zip(*self._touches, strict=True)
        pairs: Ints = np.array(pair)
        manifold = Manifold(
            np.array(normal), np.array(points), np.array(depth), np.array(valid), np.array(feature, dtype=np.intp)
        )
        return Contacts(
            world=np.zeros(count, dtype=np.intp),
            pair=pairs,
            body=detector.body_pairs[pairs],
            manifold=manifold,
            friction=detector.friction[pairs],
            restitution=detector.restitution[pairs],
            impulse=np.array(self._impulses).T,
            approach=np.array(self.approach).T,
            age=np.zeros(count, dtype=np.intp),
            colour_ends=list(range(1, count + 1)),
        )


def _recalled(last: WarmStart, touches: list[Touch]) -> list[list[float]]:
    """`Detector._recall`: the last step's impulses for points made by the same faces as then."""
    known = dict(zip(last.key.tolist(), zip(last.feature.tolist(), last.impulse.T.tolist(), strict=True), strict=True))
    impulses = []
    for touch in touches:
        feature, impulse = known.get(touch.pair, ((0, 0), (0.0, 0.0, 0.0)))
        first, second = (
            was == now and there for was, now, there in zip(feature, touch.feature, touch.valid, strict=True)
        )
        rubs = (first and second) or ((first or second) and sum(touch.valid) == 1)
        impulses.append([impulse[0] * first, impulse[1] * second, impulse[2] * rubs])
    return impulses


def _product(a: Sequence[float], b: Sequence[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _response(jacobian: list[Triple], inverse: Triple) -> tuple[list[Triple], Triple]:
    """Return the velocity change per unit of impulse, by row, and the six numbers of the stiffness."""
    response = [[along * ease for along, ease in zip(row, inverse, strict=True)] for row in jacobian]
    return response, [_product(jacobian[one], response[other]) for one, other in _STIFF]


def _jacobian(touch: Touch, x: float, y: float) -> list[Triple]:
    """`solver._jacobian` of one touch: A is the body, at `x` and `y`; B does not move, wherever its middle is."""
    (normal_x, normal_y), valid = touch.normal, touch.valid
    (first_x, first_y), (second_x, second_y) = touch.points
    middle = touch.points[0] if valid[0] else touch.points[1]
    if valid[0] and valid[1]:
        middle = ((first_x + second_x) / 2, (first_y + second_y) / 2)
    rows = []
    for (at_x, at_y), along_x, along_y, there in (
        (touch.points[0], normal_x, normal_y, valid[0]),
        (touch.points[1], normal_x, normal_y, valid[1]),
        (middle, normal_y, -normal_x, True),
    ):
        turn = (at_x - x) * along_y - (at_y - y) * along_x
        rows.append([-along_x * there, -along_y * there, -turn * there])
    return rows


def _mixed(stiffness: list[float]) -> tuple[float, ...]:
    """Return what `solver.Rows` makes of a stiffness: masses, couplings and the inverse of the 2 × 2 matrix."""
    first, second, rub, coupling, rub_coupling, second_rub_coupling = stiffness
    mass, second_mass, rub_mass = (1.0 / each if each > 0 else 0.0 for each in (first, second, rub))
    inverse, second_inverse, cross = mass, second_mass, 0.0
    if first * second != 0:
        determinant = first * second - coupling * coupling
        inverse, second_inverse, cross = second / determinant, first / determinant, -coupling / determinant
    return (
        mass, second_mass, rub_mass, coupling, rub_coupling, second_rub_coupling, inverse, second_inverse, cross
    )  # fmt: skip
