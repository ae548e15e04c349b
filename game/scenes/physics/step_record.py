"""Record of one step of the engine, piece by piece, taken while the engine's own code runs on a copy of an exhibit.

Nothing is computed a second time: arrays are copies of the local variables of the engine's functions, and the copy of
the exhibit ends in the state that the exhibit itself would reach.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from ai.explain.recorder import RETURN, Call, Recorder
from engine import Polygon
from engine.broad_phase import BroadPhase
from engine.collide import collide_circles, collide_polygon_circle, collide_polygons, deepest_face
from engine.constraints import Constraints
from engine.integrate import integrate_position, integrate_velocity
from engine.solver import Solver
from engine.vector import Array, Ints
from game.scenes.physics.exhibit import Exhibit
from game.world.grip import Grip

_RECORDED: Final = (
    BroadPhase.near,
    deepest_face,
    collide_polygons,
    collide_polygon_circle,
    collide_circles,
    integrate_velocity,
    Solver.solve_velocities,
    Constraints.relax,
    integrate_position,
)
NARROW: Final = (collide_polygons, collide_polygon_circle, collide_circles)  # by the number of circles of a pair


@dataclass(frozen=True, eq=False)
class Axis:
    """Axis on which two shapes were tried.

    Attributes:
        start: a place on the face that it is the normal of, in metres.
        direction: unit vector, out of that face.
        gap: metres between the shapes' shadows on it; below 0, they overlap by so much.
        first: whether the face belongs to the first shape of the pair.

    """

    start: Array
    direction: Array
    gap: float
    first: bool


@dataclass(frozen=True, eq=False)
class Pair:
    """Pair of shapes whose boxes overlap.

    Attributes:
        shapes: rows of the world's shapes.
        bodies: indices of their bodies.
        circles: how many of the two are circles.
        axes: the axes that were tried.
        chosen: number of the axis with the least overlap, or the widest gap.
        number: row among the pairs of its kind, in the arrays of `call`.
        call: the call in which the axis was chosen.
        line: number of the line in which it was chosen.
        contact: row of its contact in the solver; None if the two do not touch.

    """

    shapes: tuple[int, int]
    bodies: tuple[int, int]
    circles: int
    axes: list[Axis]
    chosen: int
    number: int
    call: Call
    line: int
    contact: int | None


@dataclass(frozen=True, eq=False)
class Impulse:
    """Impulse of one contact in one iteration: two normal parts, and one of friction.

    Attributes:
        iteration: from 1 on.
        contact: row of the contact in the solver.
        column: its place among those that were solved at once, in the arrays of `call`.
        call: the call of `Constraints.relax`.
        bodies: indices of both bodies, (2,).

    """

    iteration: int
    contact: int
    column: int
    call: Call
    bodies: Ints

    def value(self, name: str) -> Array:
        """Return this contact's part of a local variable whose last axis is contacts."""
        part: Array = self.call.values[name][..., self.column]
        return part

    @property
    def before(self) -> Array:
        """Accumulated impulses before, (3,), in N·s: normal, normal, friction."""
        before: Array = self.call.arguments["total"][:, self.column]
        return before

    @property
    def after(self) -> Array:
        """Accumulated impulses after, (3,), in N·s: the normal ones at least 0, friction within its cone."""
        return self.value("total")

    @property
    def motion(self) -> tuple[Array, Array]:
        """Velocities (2, 3) of both bodies before and after."""
        before = self.call.values["motion"][:, self.column].reshape(2, 3)
        return before, self.call.values["velocity"].reshape(-1, 3)[self.bodies]


class StepRecord:
    """One step of an exhibit, recorded on a copy of it; a grip pulls in it as it would in the exhibit.

    Nothing is computed for bodies that sleep, so a record wakes the exhibit first.

    Attributes:
        exhibit: the copy, after the step.
        before: poses and velocities (bodies, 3) before the step.
        after: poses and velocities (bodies, 3) after it.
        fallen: velocities (bodies, 3) after forces and drag.
        warm: velocities (bodies, 3) after the impulses of the last step were applied; None without contacts.
        boxes: box around each body, (bodies, 4): low x and y, high x and y, in metres.
        pairs: pairs of shapes whose boxes overlap, in the order in which they were found.
        contacts: what touched, as the solver left it; None if nothing did.
        impulses: the impulses, in order.
        call: returns the last call of a function.

    """

    def __init__(self, exhibit: Exhibit, grip: Grip | None = None) -> None:
        exhibit.world.wake()
        self.exhibit, grip = copy.deepcopy((exhibit, grip))
        state = self.exhibit.world.state
        self.before = (state.pose[0].copy(), state.velocity[0].copy())
        with Recorder(_RECORDED) as recorder:
            self.exhibit.step(grip)
        self.after = (state.pose[0].copy(), state.velocity[0].copy())
        self.contacts = self.exhibit.world.contacts
        self.call = recorder.call
        self.boxes: Array = self.call(BroadPhase.near).values["boxes"][..., 0].T
        self.fallen = self._of_movers(self.call(integrate_velocity).values["velocity"], self.before[1])
        self.steps = self._of_movers(self.call(integrate_position).values["step"], np.zeros_like(self.fallen))
        self.pairs = list(self._read_pairs())
        relaxed, solved = recorder.calls(Constraints.relax), recorder.calls(Solver.solve_velocities)
        self.warm: Array | None = relaxed[0].arguments["velocity"].reshape(-1, 3) if relaxed else None
        self.impulses = list(self._read_impulses([call for call in relaxed if call.caller in solved]))

    def _of_movers(self, values: Array, others: Array) -> Array:
        """Return values (1, movers, 3) of the bodies that move, in the rows of all bodies; `others` for the rest."""
        rows = others.copy()
        rows[self.exhibit.world.movers] = values[0]
        return rows

    def _read_pairs(self) -> Iterator[Pair]:
        world = self.exhibit.world
        found = self.call(BroadPhase.near).values[f"{RETURN}.1"].tolist()
        shapes, table = world.pairs, world.shape_table
        row_of = dict(zip(self.contacts.pair.tolist(), range(len(self.contacts)), strict=True)) if self.contacts else {}
        seen = [0, 0, 0]
        for pair in found:
            a, b = shapes[pair].tolist()
            circles = int(table.is_circle[[a, b]].sum())
            number, seen[circles] = seen[circles], seen[circles] + 1
            axes, chosen, call, line = self._axes(circles, number, (a, b))
            bodies = (int(table.body[a]), int(table.body[b]))
            yield Pair((a, b), bodies, circles, axes, chosen, number, call, line, row_of.get(pair))

    def _axes(self, circles: int, number: int, shapes: tuple[int, int]) -> tuple[list[Axis], int, Call, int]:
        """Return the axes of a pair, the chosen one, and the call and the line in which it was chosen."""
        if circles == 0:
            call, flip = self.call(deepest_face), self.call(collide_polygons).values["flip"]
            other = number + len(flip)  # the second shapes stand after the first ones
            axes = [*self._faces(call, number, shapes[0]), *self._faces(call, other, shapes[1], of_first=False)]
            face = call.values["face"]
            chosen = self._corners(shapes[0]) + face[other] if flip[number] else face[number]
            return axes, int(chosen), call, call.numbers["face"]
        call = self.call(NARROW[circles])
        values = call.values
        if circles == 2:
            gap = -float(values["depth"][number])
            return (
                [Axis(values["centre_a"][number], values["normal"][number], gap, True)],
                0,
                call,
                call.numbers["depth"],
            )
        axes = list(self._faces(call, number, shapes[0], radius=float(values["radius"][number])))
        if not values["from_corner"][number]:
            return axes, int(values["face"][number]), call, call.numbers["face"]
        gap = float(values["gap"][number] - values["radius"][number])
        corner = Axis(values["nearest"][number], values["normal"][number], gap, True)
        return [*axes, corner], len(axes), call, call.numbers["normal"]

    def _corners(self, shape: int) -> int:
        polygon = self.exhibit.world.shapes[shape]
        assert isinstance(polygon, Polygon)
        return len(polygon.normals)

    def _faces(
        self, call: Call, number: int, shape: int, *, of_first: bool = True, radius: float = 0.0
    ) -> Iterator[Axis]:
        """Yield the axes of a polygon's own faces; the table of shapes pads them to one number."""
        values = call.values
        for face in range(self._corners(shape)):
            start, normal = values["a.start"][number, face], values["a.normal"][number, face]
            gap = float(values["gaps"][number, face]) - radius
            yield Axis((start + values["a.end"][number, face]) / 2, normal, gap, of_first)

    def _read_impulses(self, calls: list[Call]) -> Iterator[Impulse]:
        contacts = self.contacts
        if contacts is None:
            return
        colours = int(contacts.colour[-1]) + 1
        for number, call in enumerate(calls):
            iteration, colour = divmod(number, colours)
            for column, row in enumerate(np.flatnonzero(contacts.colour == colour).tolist()):
                yield Impulse(iteration + 1, row, column, call, contacts.body[row])
