"""Rows of figures, each of which explains itself: tables and formulas."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Final

from game.drawing.cursor import BASELINE, LEADING, Cursor
from game.drawing.paint import mix
from game.drawing.tokens import FAINT, INK, LABEL, LINE, MUTE, NET, SMALL, STEP, TITLE

_BAR: Final = 2.5  # height of a bar
_APART: Final = 18.0  # points between two columns of a table
_PAD: Final = 4.0  # above and below a line of it


@dataclass(frozen=True)
class Line:
    """Line of a table: a name and its figures, and for who asks, what they are and how they come about.

    Attributes:
        bars: for each figure, where a bar below it begins and ends, 0 to 1; empty for none.

    """

    cells: Sequence[str]
    what: str = ""
    now: str = ""
    lit: bool = False
    bars: Sequence[tuple[float, float]] = ()


def table(head: Sequence[str], lines: Callable[[], Sequence[Line]]) -> Callable[[Cursor], None]:
    """Return what writes a table: names on the left, figures in columns at the right; `head` may be empty."""

    def write(cursor: Cursor) -> None:
        small, label, shown = cursor.in_style(SMALL), cursor.in_style(LABEL, MUTE), lines()
        widths = [
            max(
                label.measured(head[place]) if head else 0.0,
                *(small.measured(line.cells[place], tabular=True) for line in shown),
            )
            + _APART
            for place in range(1, len(shown[0].cells))
        ]
        if head:
            _write_cells(label, head, widths)
            cursor.y = label.y + _PAD
        for line in shown:
            _write_line(cursor, line, widths)

    return write


def _write_line(cursor: Cursor, line: Line, widths: Sequence[float]) -> None:
    top = cursor.y
    row = replace(cursor, y=top + _PAD, size=SMALL, colour=INK if line.lit else mix(MUTE, INK, 0.35))
    _write_cells(row, line.cells, widths)
    right, wide = cursor.right, min(widths) - _APART  # bars side by side have one scale
    for width, (begin, end) in zip(widths[::-1], line.bars[::-1], strict=False):
        if cursor.canvas:
            left, colour = right - wide, NET if line.lit else mix(FAINT, NET, 0.4)
            cursor.canvas.bar((left, row.y + 1, wide, _BAR), 0.0, colour)
            if end > begin:
                length = max((end - begin) * wide, _BAR)
                cursor.canvas.bar((left + begin * wide, row.y + 1, length, _BAR), 1.0, colour)
        right -= width
    cursor.y = row.y + (STEP if line.bars else _PAD)
    if cursor.canvas:
        cursor.canvas.line((cursor.left, cursor.y), (cursor.right, cursor.y), LINE)
        if line.what:
            cursor.canvas.explain((cursor.left, top, cursor.width, cursor.y - top), line.what, partial(str, line.now))


def from_zero(value: float, low: float, high: float) -> tuple[float, float]:
    """Return where the bar of a value begins and ends on a scale with 0 on it; both are the same at 0."""
    low, high = min(low, 0.0), max(high, 0.0)
    zero, end = ((min(max(each, low), high) - low) / max(high - low, 1e-9) for each in (0.0, value))
    return min(zero, end), max(zero, end)


def _write_cells(row: Cursor, cells: Sequence[str], widths: Sequence[float]) -> None:
    """Write a name, on as many lines as it needs, and its figures, each at the right end of its column."""
    baseline, right = row.baseline, row.right
    for cell, width in zip(cells[:0:-1], widths[::-1], strict=True):
        if row.canvas:
            row.canvas.text(cell, (right, baseline), size=row.size, colour=row.colour, align="right", tabular=True)
        right -= width
    name, top = replace(row, width=max(right - row.left, 40.0)), row.y
    name.text(cells[0])
    row.y = max(name.y, top + LEADING * row.size)


def figure_rows(*pairs: tuple[str, str]) -> str:
    """Return pairs of a word and a figure as the rows of an explanation."""
    return "\n".join("\t".join(pair) for pair in pairs)


@dataclass(frozen=True)
class Part:
    """Part of a formula: a figure over the word for it, or a sign without one."""

    figure: str
    word: str = ""
    what: str = ""


def formula(parts: Callable[[], Sequence[Part]]) -> Callable[[Cursor], None]:
    """Return what writes a formula, on as many lines as it needs."""

    def write(cursor: Cursor) -> None:
        figures, words = cursor.in_style(TITLE - 2), cursor.in_style(LABEL, MUTE)
        x, high = cursor.left, LEADING * (figures.size + words.size) + STEP
        for part in parts():
            wide = max(figures.measured(part.figure, tabular=True), words.measured(part.word) if part.word else 0.0)
            if x > cursor.left and x + wide > cursor.right:
                x = cursor.left
                cursor.y += high
            if canvas := cursor.canvas:
                baseline = cursor.y + BASELINE * figures.size
                canvas.text(part.figure, (x, baseline), size=figures.size, colour=INK if part.word else MUTE,
                            tabular=True)  # fmt: skip
                canvas.text(part.word, (x, baseline + LEADING * words.size), size=words.size, colour=MUTE)
                if part.what:
                    canvas.explain((x, cursor.y, wide, high - STEP), part.what)
            x += wide + (_APART if part.word else _APART / 1.5)
        cursor.y += high

    return write
