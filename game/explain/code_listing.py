"""Listing of our own code: the lines of a function, the one that runs now lit, with a case's numbers beside them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Final

import pygame

from game.core.source import Source
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import FAINT, INK, LABEL, LINE, MUTE, NET, Colour

if TYPE_CHECKING:
    from game.ui.panel import Column

Shown = tuple[Source, int | None, Mapping[int, str]]  # a function, its lit line, and what stands beside lines
_LEADING: Final = 16.0
_NUMBER: Final = 34.0  # room for the line's number
_INDENT: Final = 6  # characters by which the rest of a long line is moved to the right
_BETWEEN: Final = 12.0  # points between code and notes
_CODE: Final[Colour] = (190, 198, 214)
# Characters of an operator are drawn one by one: the font would make one sign of some pairs.
_PARTS: Final = re.compile(r"[-!<>=*/&|:+~]|[^-!<>=*/&|:+~]*[^-!<>=*/&|:+~\s]")


def draw_listing(
    canvas: Canvas, box: pygame.typing.RectLike, source: Source, current: int | None, notes: Mapping[int, str]
) -> None:
    """Draw the source in a box, in points; `current` is the number of the lit line, which is kept in sight.

    `notes` are short words in a column on the right, by the numbers of their lines: numbers of the case at hand.
    """
    area = pygame.FRect(box)
    letter = typeface.digit_width(LABEL, "code")
    beside = area.width / 3 if notes else -_BETWEEN
    room = int((area.width - _NUMBER - beside - _BETWEEN) // letter)
    canvas.text(source.path, (area.left, area.top + _LEADING * 0.8), size=LABEL, colour=MUTE)
    top = area.top + _LEADING * 1.4
    rows = [row for number, line in source.lines for row in _broken(number, line, max(room, 20))]
    shown = _around(rows, current, int((area.bottom - top) // _LEADING))
    for place, (number, text, begins) in enumerate(shown):
        y = top + (place + 0.8) * _LEADING
        lit = number == current
        if lit:
            canvas.fill(canvas.rect(area.left, y - 0.76 * _LEADING, area.width, _LEADING), LINE)
            canvas.fill(canvas.rect(area.left, y - 0.76 * _LEADING, 2, _LEADING), NET)
        if begins:
            canvas.text(str(number), (area.left + _NUMBER - 8, y), size=LABEL, weight="code",
                        colour=NET if lit else FAINT, align="right")  # fmt: skip
        if begins and number in notes:
            canvas.text(notes[number], (area.right - beside, y), size=LABEL, colour=NET if lit else MUTE, tabular=True,
                        room=beside)  # fmt: skip
        for part, colour, column in _coloured(text, lit):
            place_of = (area.left + _NUMBER + column * letter, y)
            canvas.text(part, place_of, size=LABEL, weight="code", colour=colour)


def listing_height(source: Source, width: float) -> float:
    """Return how high all of a source is, drawn so wide without notes, in points."""
    room = int((width - _NUMBER) // typeface.digit_width(LABEL, "code"))
    rows = sum(len(list(_broken(number, line, max(room, 20)))) for number, line in source.lines)
    return (rows + 2) * _LEADING


def _broken(number: int, line: str, room: int) -> Iterator[tuple[int, str, bool]]:
    """Yield the rows of a line of code: its number, a text no longer than `room`, and whether it is the first."""
    indent = len(line) - len(line.lstrip())
    begins = True
    while len(line) > room:
        cut = line.rfind(" ", indent + _INDENT + 1, room)
        cut = cut if cut > 0 else room
        yield number, line[:cut], begins
        line, begins = " " * (indent + _INDENT) + line[cut:].lstrip(), False
    yield number, line, begins


def _around(rows: list[tuple[int, str, bool]], current: int | None, most: int) -> list[tuple[int, str, bool]]:
    """Return as many rows as there is room for, the current line in the middle where possible."""
    at = next((place for place, row in enumerate(rows) if row[0] == current), 0)
    first = max(0, min(at - most // 2, len(rows) - most))
    return rows[first : first + most]


def _coloured(text: str, lit: bool) -> Iterator[tuple[str, Colour, int]]:
    """Yield the parts of a row: its text, colour and column; comments are muted."""
    code, mark, comment = text.partition("# ")
    for part in _PARTS.finditer(code):
        yield part[0], INK if lit else _CODE, part.start()
    if mark:
        yield mark + comment, MUTE, len(code)


def add_listing(column: Column, height: float | Callable[[float], float], shown: Callable[[], Shown]) -> None:
    """Add a listing to a column, painted when what is `shown` has changed; its height may follow from the width."""
    cache = PaintCache()

    def draw(canvas: Canvas, box: pygame.FRect) -> None:
        source, current, notes = shown()
        shows = source, current, tuple(notes.items())
        cache.draw(canvas, box, shows, lambda sheet: draw_listing(sheet, (0, 0, *box.size), source, current, notes))

    column.picture(height, draw)
