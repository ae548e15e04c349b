"""Pieces of a recorded step in the order in which the engine computes them, each with the code that did it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ai.explain.recorder import Call
from engine import World
from engine.broad_phase import BroadPhase
from engine.collide import deepest_face
from engine.constraints import Constraints
from engine.integrate import integrate_position, integrate_velocity
from engine.solver import Solver
from game.exhibits.step_record import NARROW, Impulse, Pair, StepRecord

# Local variables that are told beside the lines that set them, by function, and on which axis a pair has its row.
_TOLD: Final[dict[Callable[..., Any], tuple[int, tuple[str, ...]]]] = {
    deepest_face: (0, ("gaps", "face")),
    NARROW[0]: (0, ("gap_a", "gap_b", "flip", "normal", "depth")),
    NARROW[1]: (0, ("face", "along", "distance", "normal", "gap")),
    NARROW[2]: (0, ("away", "distance", "normal", "depth")),
    Constraints.relax: (-1, ("speed", "pushes", "sliding", "cone", "friction", "total")),
}
_MOST: Final = 4  # numbers beside a line


@dataclass(frozen=True, eq=False)
class Piece:
    """Piece of a step.

    Attributes:
        kind: its name in `texts.STEP_PIECES`.
        function: the function that computes it.
        line: number of the line in its file that does; None for the whole function.
        notes: numbers of this case beside lines, by their numbers.
        pair: the pair of shapes it is about; None if it is about all.
        impulse: the impulse or push that it is; None for others.

    """

    kind: str
    function: Callable[..., Any]
    line: int | None = None
    notes: dict[int, str] | None = None
    pair: Pair | None = None
    impulse: Impulse | None = None


def pieces_of(record: StepRecord, followed: Pair | None) -> list[Piece]:
    """Return the pieces of a step: those of one pair, or of every pair if None is followed."""
    near = record.call(BroadPhase.near)
    pieces = [Piece("boxes", BroadPhase.near, near.numbers["world"], pair=followed)]
    pairs = record.pairs if followed is None else [followed]
    for pair in pairs:
        pieces += _meeting(record, pair)
    fall = record.call(integrate_velocity)
    pieces.append(Piece("forces", integrate_velocity, fall.numbers["velocity"], pair=followed))
    touching = {pair.contact: pair for pair in pairs if pair.contact is not None}
    if touching:
        solve = record.call(Solver.solve_velocities)
        pieces.append(
            Piece("memory", Solver.solve_velocities, max(line.number for line in solve.lines[:-1]), pair=followed)
        )
        pieces += _pushes("impulses", record.impulses, touching)
    move = record.call(integrate_position)
    pieces.append(Piece("motion", integrate_position, move.numbers["step"], pair=followed))
    pieces += _pushes("overlap", record.overlaps, touching)
    pieces.append(Piece("end", World.step, pair=followed))
    return pieces


def _meeting(record: StepRecord, pair: Pair) -> Iterator[Piece]:
    finder = deepest_face if pair.circles == 0 else NARROW[pair.circles]
    notes = _notes(finder, pair.call, pair.number)
    yield Piece("axes", finder, pair.line, notes, pair)
    if pair.contact is not None:
        call = record.call(NARROW[pair.circles])
        notes = _notes(NARROW[pair.circles], call, pair.number)
        yield Piece(
            "contact", NARROW[pair.circles], call.numbers["depth" if "depth" in call.numbers else "gap"], notes, pair
        )


def _pushes(kind: str, impulses: list[Impulse], touching: dict[int, Pair]) -> Iterator[Piece]:
    for impulse in impulses:
        if pair := touching.get(impulse.contact):
            notes = _notes(Constraints.relax, impulse.call, impulse.column)
            yield Piece(kind, Constraints.relax, impulse.call.numbers["velocity"], notes, pair, impulse)


def _notes(function: Callable[..., Any], call: Call, row: int) -> dict[int, str]:
    axis, names = _TOLD[function]
    notes = {}
    for name in names:
        if name in call.numbers and (name not in call.arguments or call.numbers[name] > call.lines[0].number):
            values = np.atleast_1d(np.take(call.values[name], row, axis=axis)).ravel()
            notes[call.numbers[name]] = "  ".join(written(float(value)) for value in values[:_MOST])
    return notes


def written(value: float) -> str:
    """Write a number in a few characters: 0.125, -3.2, 1e-05, 0."""
    return f"{value:.3g}".replace("-", "−") if abs(value) >= 1e-9 else "0"
