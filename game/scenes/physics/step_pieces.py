"""What a step of the engine is told as: its pieces in order, with their code, a sentence, and figures in rows."""

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
from engine.contacts import MARGIN
from engine.integrate import integrate_position, integrate_velocity
from engine.solver import Solver
from engine.vector import Array
from game.core import texts
from game.scenes.physics.step_record import NARROW, Impulse, Pair, StepRecord

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
        impulse: the impulse that it is; None for others.

    """

    kind: str
    function: Callable[..., Any]
    line: int | None = None
    notes: dict[int, str] | None = None
    impulse: Impulse | None = None


def pieces_of(record: StepRecord, pair: Pair | None) -> list[Piece]:
    """Return the pieces of a step, as one pair of shapes goes through it; without one if none is near another."""
    pieces = [Piece("boxes", BroadPhase.near, record.call(BroadPhase.near).numbers["world"])]
    narrow = NARROW[pair.circles] if pair else None
    if pair and narrow:
        finder = narrow if pair.circles else deepest_face
        pieces.append(Piece("axes", finder, pair.line, _notes(finder, pair.call, pair.number)))
        if pair.contact is not None:
            call = record.call(narrow)
            line = call.numbers["depth" if "depth" in call.numbers else "gap"]
            pieces.append(Piece("contact", narrow, line, _notes(narrow, call, pair.number)))
    pieces.append(Piece("forces", integrate_velocity, record.call(integrate_velocity).numbers["velocity"]))
    if pair and pair.contact is not None:
        solve = record.call(Solver.solve_velocities)
        pieces.append(Piece("memory", Solver.solve_velocities, max(line.number for line in solve.lines[:-1])))
        for impulse in record.impulses:
            if impulse.contact == pair.contact:
                notes = _notes(Constraints.relax, impulse.call, impulse.column)
                pieces.append(Piece("impulses", Constraints.relax, impulse.call.numbers["velocity"], notes, impulse))
    pieces.append(Piece("motion", integrate_position, record.call(integrate_position).numbers["step"]))
    return [*pieces, Piece("end", World.step)]


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


_MM: Final = 1e3
_CLOSE: Final = 0.1  # metres below which a length is told in millimetres
Rows = list[tuple[str, bool]]  # a row's words, and whether it is lit


def sentence(record: StepRecord, piece: Piece, pair: Pair | None) -> str:
    """Return what happens in a piece."""
    if piece.kind == "boxes" and pair is None:
        return texts.STEP_NOTHING
    if piece.kind == "axes" and pair and pair.contact is None:
        return texts.STEP_APART
    return texts.STEP_PIECES[piece.kind][1].format(
        pairs=len(record.pairs),
        all=len(record.exhibit.world.pairs),
        iteration=piece.impulse.iteration if piece.impulse else 0,
        total=record.impulses[-1].iteration if record.impulses else 0,
    )


def rows(record: StepRecord, piece: Piece, pair: Pair | None) -> Rows:
    """Return the figures of a piece."""
    if pair is None:
        return []
    match piece.kind:
        case "axes":
            return list(_axes(pair))
        case "contact":
            return list(_points(record, pair))
        case "impulses" if piece.impulse:
            return list(_impulse(piece.impulse))
        case "forces":
            return list(_velocities(record, pair, record.before[1], record.fallen))
        case "memory":
            warm = record.fallen if record.warm is None else record.warm
            return [_warm(record), *_velocities(record, pair, record.fallen, warm)]
        case "motion":
            return list(_moved(record, pair))
        case "end":
            return list(_velocities(record, pair, record.before[1], record.after[1]))
    return []


def _axes(pair: Pair) -> Iterator[tuple[str, bool]]:
    for number, axis in enumerate(pair.axes):
        words = texts.STEP_ROWS["axis_A" if axis.first else "axis_B"]
        kind = "overlap" if axis.gap <= 0 else "touch" if axis.gap <= MARGIN else "gap"
        gap = texts.STEP_ROWS[kind].format(size=_length(abs(axis.gap)))
        yield words.format(count=number + 1, gap=gap), number == pair.chosen


def _length(metres: float) -> str:
    if metres < _CLOSE:
        return texts.STEP_ROWS["millimetres"].format(size=_MM * metres)
    return texts.STEP_ROWS["metres"].format(size=metres)


def _points(record: StepRecord, pair: Pair) -> Iterator[tuple[str, bool]]:
    assert record.contacts is not None
    assert pair.contact is not None
    contacts = record.contacts
    for number in np.flatnonzero(contacts.valid[pair.contact]).tolist():
        depth = float(contacts.depth[pair.contact, number])
        yield texts.STEP_ROWS["point"].format(count=number + 1, size=_MM * depth + 0.0), True


def _warm(record: StepRecord) -> tuple[str, bool]:
    begun = [impulse.before for impulse in record.impulses if impulse.iteration == 1]
    size, count = sum(float(before[:2].sum()) for before in begun), sum(bool(before.any()) for before in begun)
    return texts.STEP_ROWS["warm"].format(count=count, size=size), True


def _impulse(impulse: Impulse) -> Iterator[tuple[str, bool]]:
    told, before, after = texts.STEP_ROWS, impulse.before.tolist(), impulse.after.tolist()
    for number in (0, 1) if before[1] or after[1] else (0,):
        words = told["normal"].format(count=number + 1, before=_told(before[number]), after=_told(after[number]))
        yield words, True
    cone = _told(float(impulse.value("cone")))
    yield told["friction"].format(before=_told(before[2]), after=_told(after[2]), cone=cone), True
    for letter, *motion in zip("AB", *impulse.motion, strict=True):
        yield from _of_body(letter, *motion)


def _velocities(record: StepRecord, pair: Pair, before: Array, after: Array) -> Iterator[tuple[str, bool]]:
    for letter, body in zip("AB", pair.bodies, strict=True):
        if record.exhibit.world.params.dynamic[body]:
            yield from _of_body(letter, before[body], after[body])
        else:
            yield texts.STEP_ROWS[f"fixed_{letter}"], False


def _of_body(letter: str, before: Array, after: Array) -> Iterator[tuple[str, bool]]:
    yield _row(f"velocity_{letter}", after), True
    yield _row(f"before_{letter}", before), False


def _moved(record: StepRecord, pair: Pair) -> Iterator[tuple[str, bool]]:
    for letter, body in zip("AB", pair.bodies, strict=True):
        if record.exhibit.world.params.dynamic[body]:
            yield _row(f"moved_{letter}", record.steps[body] * _MM), True
        else:
            yield texts.STEP_ROWS[f"fixed_{letter}"], False


def _row(name: str, values: Array) -> str:
    x, y, turn = (_told(value) for value in values.tolist())
    return texts.STEP_ROWS[name].format(x=x, y=y, turn=turn)


def _told(value: float) -> str:
    """Write a number to four decimals: what is less is not worth a look."""
    return written(round(value, 4))
