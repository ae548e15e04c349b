"""One step of the engine, recorded while its own code runs on a copy of an exhibit.

Nothing is computed a second time: arrays are copies of the local variables of the engine's functions, and the copy of
the exhibit ends in the state that the exhibit itself would reach.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from ai.explain.recorder import RETURN, Call, Recorder
from engine import Polygon
from engine.broad_phase import BroadPhase
from engine.collide import collide_circles, collide_polygon_circle, collide_polygons, deepest_face
from engine.integrate import integrate_velocity
from engine.vector import Array
from game.core import texts
from game.scenes.physics.exhibit import Exhibit, Grip

_RECORDED: Final = (
    BroadPhase.near, deepest_face, collide_polygons, collide_polygon_circle, collide_circles, integrate_velocity,
)  # fmt: skip
# An axis on which two shapes were tried: a place on the face that it is the normal of, and its unit vector.
Axis = tuple[Array, Array]


@dataclass(frozen=True, eq=False)
class Pair:
    """Pair of shapes whose boxes overlap.

    Attributes:
        bodies: indices of their bodies.
        axes: the axes that were tried.
        chosen: number of the axis with the least overlap, or the widest gap.
        to_b: unit vector along that axis, from the first shape to the second.
        contact: row of its contact in the solver; None if the two do not touch.

    """

    bodies: tuple[int, int]
    axes: list[Axis]
    chosen: int
    to_b: Array
    contact: int | None


class StepRecord:
    """One step of an exhibit, recorded on a copy of it; a grip pulls in it as it would in the exhibit.

    Nothing is computed for bodies that sleep, so a record wakes the exhibit first.

    Attributes:
        exhibit: the copy, after the step.
        before: poses and velocities (bodies, 3) before the step.
        after: poses and velocities (bodies, 3) after it.
        fallen: velocities (bodies, 3) after forces and drag.
        boxes: box around each body, (bodies, 4): low x and y, high x and y, in metres.
        pairs: pairs of shapes whose boxes overlap, in the order in which they were found.
        contacts: what touched, as the solver left it; None if nothing did.

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
        self._call = recorder.call
        self.boxes: Array = self._call(BroadPhase.near).values["boxes"][..., 0].T
        self.fallen = self.before[1].copy()
        self.fallen[self.exhibit.world.movers] = self._call(integrate_velocity).values["velocity"][0]
        self.pairs = list(self._read_pairs())

    def can_move(self, body: int) -> bool:
        """Whether a body is moved by impulses."""
        return bool(self.exhibit.world.params.dynamic[body])

    def _read_pairs(self) -> Iterator[Pair]:
        table = self.exhibit.world.shape_table
        touching = self.contacts.shape.tolist() if self.contacts else []
        row_of = {(a, b): row for row, (a, b) in enumerate(touching)}
        seen = [0, 0, 0]
        for a, b in self._call(BroadPhase.near).values[f"{RETURN}.1"].tolist():
            circles = int(table.is_circle[[a, b]].sum())
            axes, chosen, flipped = self._axes(circles, seen[circles], (a, b))
            seen[circles] += 1
            to_b = -axes[chosen][1] if flipped else axes[chosen][1]
            yield Pair((int(table.body[a]), int(table.body[b])), axes, chosen, to_b, row_of.get((a, b)))

    def _axes(self, circles: int, number: int, shapes: tuple[int, int]) -> tuple[list[Axis], int, bool]:
        """Return the axes of a pair with so many circles, which was chosen, and whether it is a face of the second."""
        if circles == 0:
            call, flip = self._call(deepest_face), self._call(collide_polygons).values["flip"]
            other, face = number + len(flip), call.values["face"]  # the second shapes stand after the first ones
            axes = list(self._faces(call, number, shapes[0]))
            chosen = len(axes) + face[other] if flip[number] else face[number]
            return [*axes, *self._faces(call, other, shapes[1])], int(chosen), bool(flip[number])
        call = self._call(collide_polygon_circle if circles == 1 else collide_circles)
        values = call.values
        if circles == 2:
            return [(values["centre_a"][number], values["normal"][number])], 0, False
        axes = list(self._faces(call, number, shapes[0]))
        if not values["from_corner"][number]:
            return axes, int(values["face"][number]), False
        return [*axes, (values["nearest"][number], values["normal"][number])], len(axes), False

    def _faces(self, call: Call, number: int, shape: int) -> Iterator[Axis]:
        """Yield the axes of a polygon's own faces; the table of shapes pads them to one number."""
        polygon, values = self.exhibit.world.shapes[shape], call.values
        assert isinstance(polygon, Polygon)
        for face in range(len(polygon.normals)):
            middle = (values["a.start"][number, face] + values["a.end"][number, face]) / 2
            yield middle, values["a.normal"][number, face]

    # Pieces, named as in `texts.STEP_PIECES`, and what is said of them

    def pieces(self, pair: Pair | None) -> list[str]:
        """Return the pieces of the step, as one pair of shapes goes through it; without one if none is near another."""
        if pair is None:
            return ["boxes", "forces", "motion"]
        if pair.contact is None:
            return ["boxes", "axes", "forces", "motion"]
        return ["boxes", "axes", "contact", "forces", "impulses", "motion"]

    def sentence(self, piece: str, pair: Pair | None) -> str:
        """Return what happens in a piece."""
        if piece == "boxes" and pair is None:
            return texts.STEP_NOTHING
        if piece == "axes" and pair and pair.contact is None:
            return texts.STEP_APART
        pairs, every = len(self.pairs), len(self.exhibit.world.pairs)
        return texts.STEP_PIECES[piece][1].format(pairs=pairs, all=every)

    def motion(self, piece: str) -> tuple[Array, Array] | None:
        """Return all velocities (bodies, 3) before and after a piece that changes them."""
        return {
            "forces": (self.before[1], self.fallen),
            "impulses": (self.fallen, self.after[1]),
            "motion": (self.before[1], self.after[1]),
        }.get(piece)
