"""One step of the engine, recorded while its own code runs on a copy of an exhibit, and shown piece by piece.

Nothing is computed a second time: arrays are copies of the local variables of the engine's functions, and the copy of
the exhibit ends in the state that the exhibit itself would reach.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ai.explain.recorder import RETURN, Call, Recorder
from engine import Polygon, World
from engine.broad_phase import BroadPhase
from engine.collide import collide_circles, collide_polygon_circle, collide_polygons, deepest_face
from engine.constraints import Constraints
from engine.integrate import integrate_position, integrate_velocity
from engine.solver import Solver
from engine.vector import Array, Ints
from game.core import texts
from game.scenes.physics.exhibit import Exhibit, Grip

NARROW: Final = (collide_polygons, collide_polygon_circle, collide_circles)  # by the number of circles of a pair
# Functions that are recorded; of some, variables that are shown beside the lines that set them, and on which axis a
# pair has its row.
_RECORDED: Final[dict[Callable[..., Any], tuple[int, tuple[str, ...]]]] = {
    BroadPhase.near: (0, ()),
    deepest_face: (0, ("gaps", "face")),
    NARROW[0]: (0, ("gap_a", "gap_b", "flip", "normal", "depth")),
    NARROW[1]: (0, ("face", "along", "distance", "normal", "gap")),
    NARROW[2]: (0, ("away", "distance", "normal", "depth")),
    integrate_velocity: (1, ("velocity",)),
    Solver.solve_velocities: (0, ()),
    Constraints.relax: (-1, ("speed", "pushes", "sliding", "cone", "friction", "total")),
    integrate_position: (1, ("step",)),
}
_MOST: Final = 4  # numbers beside a line


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
        bodies: indices of their bodies.
        circles: how many of the two are circles.
        axes: the axes that were tried.
        chosen: number of the axis with the least overlap, or the widest gap.
        number: row among the pairs of its kind, in the arrays of `call`.
        call: the call in which the axis was chosen.
        line: number of the line in which it was chosen.
        contact: row of its contact in the solver; None if the two do not touch.

    """

    bodies: tuple[int, int]
    circles: int
    axes: list[Axis]
    chosen: int
    number: int
    call: Call
    line: int
    contact: int | None

    @property
    def to_b(self) -> Array:
        """Unit vector along the chosen axis, from the first shape to the second."""
        axis = self.axes[self.chosen]
        return axis.direction if axis.first else -axis.direction


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


@dataclass(frozen=True, eq=False)
class Piece:
    """Piece of a step.

    Attributes:
        kind: its name in `texts.STEP_PIECES`.
        function: the function that computes it.
        line: number of the line in its file that does; None for the whole function.
        notes: numbers of this case beside lines, by their numbers.
        impulse: the impulse that it is; None for others.

    """

    kind: str
    function: Callable[..., Any]
    line: int | None = None
    notes: dict[int, str] | None = None
    impulse: Impulse | None = None


class StepRecord:
    """One step of an exhibit, recorded on a copy of it; a grip pulls in it as it would in the exhibit.

    Nothing is computed for bodies that sleep, so a record wakes the exhibit first.

    Attributes:
        exhibit: the copy, after the step.
        before: poses and velocities (bodies, 3) before the step.
        after: poses and velocities (bodies, 3) after it.
        fallen: velocities (bodies, 3) after forces and drag.
        warm: velocities (bodies, 3) after the impulses of the last step were applied; as fallen without contacts.
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
        self.fallen = self.before[1].copy()
        self.fallen[self.exhibit.world.movers] = self.call(integrate_velocity).values["velocity"][0]
        self.pairs = list(self._read_pairs())
        relaxed, solved = recorder.calls(Constraints.relax), recorder.calls(Solver.solve_velocities)
        self.warm: Array = relaxed[0].arguments["velocity"].reshape(-1, 3) if relaxed else self.fallen
        self.impulses = list(self._read_impulses([call for call in relaxed if call.caller in solved]))

    def can_move(self, body: int) -> bool:
        """Whether a body is moved by impulses."""
        return bool(self.exhibit.world.params.dynamic[body])

    # Pairs and impulses

    def _read_pairs(self) -> Iterator[Pair]:
        world = self.exhibit.world
        table = world.shape_table
        touching = self.contacts.shape.tolist() if self.contacts else []
        row_of = {(a, b): row for row, (a, b) in enumerate(touching)}
        seen = [0, 0, 0]
        for a, b in self.call(BroadPhase.near).values[f"{RETURN}.1"].tolist():
            circles = int(table.is_circle[[a, b]].sum())
            number, seen[circles] = seen[circles], seen[circles] + 1
            axes, chosen, call, line = self._axes(circles, number, (a, b))
            bodies = (int(table.body[a]), int(table.body[b]))
            yield Pair(bodies, circles, axes, chosen, number, call, line, row_of.get((a, b)))

    def _axes(self, circles: int, number: int, shapes: tuple[int, int]) -> tuple[list[Axis], int, Call, int]:
        """Return the axes of a pair, the chosen one, and the call and the line in which it was chosen."""
        if circles == 0:
            call, flip = self.call(deepest_face), self.call(collide_polygons).values["flip"]
            other = number + len(flip)  # the second shapes stand after the first ones
            axes = list(self._faces(call, number, shapes[0]))
            face, corners = call.values["face"], len(axes)
            axes += self._faces(call, other, shapes[1], of_first=False)
            chosen = corners + face[other] if flip[number] else face[number]
            return axes, int(chosen), call, call.numbers["face"]
        call = self.call(NARROW[circles])
        values = call.values
        if circles == 2:
            gap = -float(values["depth"][number])
            only = Axis(values["centre_a"][number], values["normal"][number], gap, True)
            return [only], 0, call, call.numbers["depth"]
        radius = float(values["radius"][number])
        axes = list(self._faces(call, number, shapes[0], radius=radius))
        if not values["from_corner"][number]:
            return axes, int(values["face"][number]), call, call.numbers["face"]
        corner = Axis(values["nearest"][number], values["normal"][number], float(values["gap"][number] - radius), True)
        return [*axes, corner], len(axes), call, call.numbers["normal"]

    def _faces(
        self, call: Call, number: int, shape: int, *, of_first: bool = True, radius: float = 0.0
    ) -> Iterator[Axis]:
        """Yield the axes of a polygon's own faces; the table of shapes pads them to one number."""
        polygon, values = self.exhibit.world.shapes[shape], call.values
        assert isinstance(polygon, Polygon)
        for face in range(len(polygon.normals)):
            middle = (values["a.start"][number, face] + values["a.end"][number, face]) / 2
            yield Axis(middle, values["a.normal"][number, face], float(values["gaps"][number, face]) - radius, of_first)

    def _read_impulses(self, calls: list[Call]) -> Iterator[Impulse]:
        contacts = self.contacts
        if contacts is None:
            return
        colours = int(contacts.colour[-1]) + 1
        for number, call in enumerate(calls):
            iteration, colour = divmod(number, colours)
            for column, row in enumerate(np.flatnonzero(contacts.colour == colour).tolist()):
                yield Impulse(iteration + 1, row, column, call, contacts.body[row])

    # Pieces, and what is said of them

    def pieces(self, pair: Pair | None) -> list[Piece]:
        """Return the pieces of the step, as one pair of shapes goes through it; without one if none is near another."""
        pieces = [Piece("boxes", BroadPhase.near, self.call(BroadPhase.near).numbers["world"])]
        if pair:
            narrow = NARROW[pair.circles]
            finder = narrow if pair.circles else deepest_face
            pieces.append(Piece("axes", finder, pair.line, _notes(finder, pair.call, pair.number)))
            if pair.contact is not None:
                call = self.call(narrow)
                line = call.numbers["depth" if "depth" in call.numbers else "gap"]
                pieces.append(Piece("contact", narrow, line, _notes(narrow, call, pair.number)))
        pieces.append(self._moved("forces", integrate_velocity, pair))
        if pair and pair.contact is not None:
            solve = self.call(Solver.solve_velocities)
            pieces.append(Piece("memory", Solver.solve_velocities, max(line.number for line in solve.lines[:-1])))
            for impulse in self.impulses:
                if impulse.contact == pair.contact:
                    notes = _notes(Constraints.relax, impulse.call, impulse.column)
                    line = impulse.call.numbers["velocity"]
                    pieces.append(Piece("impulses", Constraints.relax, line, notes, impulse))
        return [*pieces, self._moved("motion", integrate_position, pair), Piece("end", World.step)]

    def _moved(self, kind: str, function: Callable[..., Any], pair: Pair | None) -> Piece:
        """Return the piece of a function that moves all bodies, with its numbers for the pair's first that can move."""
        call, movers = self.call(function), np.arange(len(self.boxes))[self.exhibit.world.movers].tolist()
        body = next((each for each in pair.bodies if self.can_move(each)), None) if pair else None
        notes = None if body is None else _notes(function, call, movers.index(body))
        return Piece(kind, function, call.numbers[_RECORDED[function][1][0]], notes)

    def sentence(self, piece: Piece, pair: Pair | None) -> str:
        """Return what happens in a piece."""
        if piece.kind == "boxes" and pair is None:
            return texts.STEP_NOTHING
        if piece.kind == "axes" and pair and pair.contact is None:
            return texts.STEP_APART
        return texts.STEP_PIECES[piece.kind][1].format(
            pairs=len(self.pairs),
            all=len(self.exhibit.world.pairs),
            iteration=piece.impulse.iteration if piece.impulse else 0,
            total=self.impulses[-1].iteration if self.impulses else 0,
        )

    def motion(self, piece: Piece, pair: Pair) -> tuple[Array, Array] | None:
        """Return the velocities (2, 3) of the pair's bodies before and after a piece that changes them."""
        if piece.impulse:
            return piece.impulse.motion
        change = {
            "forces": (self.before[1], self.fallen),
            "memory": (self.fallen, self.warm),
            "end": (self.before[1], self.after[1]),
        }.get(piece.kind)
        return (change[0][list(pair.bodies)], change[1][list(pair.bodies)]) if change else None


def _notes(function: Callable[..., Any], call: Call, row: int) -> dict[int, str]:
    axis, names = _RECORDED[function]
    notes = {}
    for name in names:
        if name in call.numbers and (name not in call.arguments or call.numbers[name] > call.lines[0].number):
            values = np.atleast_1d(np.take(call.values[name], row, axis=axis)).ravel()
            notes[call.numbers[name]] = "  ".join(written(float(value)) for value in values[:_MOST])
    return notes


def written(value: float) -> str:
    """Write a number in a few characters: 0.125, -3.2, 1e-05, 0."""
    return f"{value:.3g}".replace("-", "−") if abs(value) >= 1e-9 else "0"
