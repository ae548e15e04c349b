"""What is said about a piece of a step: a sentence, and its figures in rows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from engine.contacts import MARGIN
from engine.vector import Array
from game.core import texts
from game.exhibits.step_pieces import Piece, written
from game.exhibits.step_record import Pair, StepRecord

_MM: Final = 1e3
_CLOSE: Final = 0.1  # metres below which a length is told in millimetres
Rows = list[tuple[str, bool]]  # a row's words, and whether it is lit


def sentence(record: StepRecord, piece: Piece) -> str:
    """Return what happens in a piece."""
    if piece.kind == "boxes" and not record.pairs:
        return texts.STEP_NOTHING
    if piece.kind == "axes" and piece.pair and piece.pair.contact is None:
        return texts.STEP_APART
    impulse = piece.impulse
    runs = record.overlaps if piece.kind == "overlap" else record.impulses
    figures = {
        "pairs": len(record.pairs),
        "all": len(record.exhibit.world.pairs),
        "iteration": impulse.iteration if impulse else 0,
        "total": runs[-1].iteration if runs else 0,
    }
    return texts.STEP_PIECES[piece.kind][1].format(**figures)


def rows(record: StepRecord, piece: Piece) -> Rows:
    """Return the figures of a piece."""
    pair = piece.pair
    if pair is None:
        return _warm(record) if piece.kind == "memory" else []
    if piece.kind == "axes":
        return list(_axes(pair))
    if piece.kind == "contact":
        return list(_points(record, pair))
    if piece.kind in ("impulses", "overlap"):
        return list(_impulse(piece))
    if piece.kind == "forces":
        return list(_velocities(record, pair, (record.before[1], record.fallen)))
    if piece.kind == "memory":
        warm = record.fallen if record.warm is None else record.warm
        return [*_warm(record), *_velocities(record, pair, (record.fallen, warm))]
    if piece.kind == "motion":
        return list(_moved(record, pair, record.steps))
    if piece.kind == "end":
        return list(_velocities(record, pair, (record.before[1], record.after[1])))
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


def _warm(record: StepRecord) -> Rows:
    begun = [impulse for impulse in record.impulses if impulse.iteration == 1]
    size = sum(float(impulse.before[:2].sum()) for impulse in begun)
    count = sum(bool(impulse.before.any()) for impulse in begun)
    return [(texts.STEP_ROWS["warm"].format(count=count, size=size), True)]


def _impulse(piece: Piece) -> Iterator[tuple[str, bool]]:
    impulse, pair = piece.impulse, piece.pair
    assert impulse is not None
    assert pair is not None
    unit = texts.STEP_ROWS["impulse_unit" if piece.kind == "impulses" else "push_unit"]
    before, after = impulse.before.tolist(), impulse.after.tolist()
    for number in (0, 1) if before[1] or after[1] else (0,):
        words = texts.STEP_ROWS["normal"]
        yield words.format(count=number + 1, before=_told(before[number]), after=_told(after[number]), unit=unit), True
    if piece.kind == "impulses":
        words, cone = texts.STEP_ROWS["friction"], _told(float(impulse.value("cone")))
        yield words.format(before=_told(before[2]), after=_told(after[2]), unit=unit, cone=cone), True
        motions = impulse.motion
        for which, letter in enumerate("AB"):
            yield from _of_body(letter, *(motion[which] for motion in motions))
    else:
        for which, letter in enumerate("AB"):
            yield _row(f"moved_{letter}", impulse.motion[1][which] * _MM), True


def _velocities(record: StepRecord, pair: Pair, velocities: tuple[Array, Array]) -> Iterator[tuple[str, bool]]:
    for letter, body in zip("AB", pair.bodies, strict=True):
        if record.exhibit.world.params.dynamic[body]:
            yield from _of_body(letter, *(each[body] for each in velocities))
        else:
            yield texts.STEP_ROWS[f"fixed_{letter}"], False


def _of_body(letter: str, before: Array, after: Array) -> Iterator[tuple[str, bool]]:
    yield _row(f"velocity_{letter}", after), True
    yield _row(f"before_{letter}", before), False


def _moved(record: StepRecord, pair: Pair, steps: Array) -> Iterator[tuple[str, bool]]:
    for letter, body in zip("AB", pair.bodies, strict=True):
        if record.exhibit.world.params.dynamic[body]:
            yield _row(f"moved_{letter}", steps[body] * _MM), True
        else:
            yield texts.STEP_ROWS[f"fixed_{letter}"], False


def _row(name: str, values: Array) -> str:
    x, y, turn = (_told(value) for value in values.tolist())
    return texts.STEP_ROWS[name].format(x=x, y=y, turn=turn)


def _told(value: float) -> str:
    """Write a number to four decimals: what is less is not worth a look."""
    return written(round(value, 4))
