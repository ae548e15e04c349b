"""Tooltip: a small panel beside the mouse with some lines, then rows of a word and a figure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import pygame

from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import INK, LABEL, LINE, MUTE, NIGHT0, SMALL, Colour

_ROW: Final = 15.0
_PADDING: Final = 10.0
_GAP: Final = 12.0  # points from the mouse to the panel
_BETWEEN: Final = 14.0  # points between words and figures
_SWATCH: Final = 20.0
_AFTER_SWATCH: Final = 7.0


@dataclass(frozen=True)
class TooltipRow:
    """Row of a tooltip: a word and its figure; with `dash`, also a piece of the line they belong to."""

    word: str
    figure: str
    colour: Colour = INK
    dash: tuple[float, ...] | None = None


def draw_tooltip(
    canvas: Canvas, point: Point, within: pygame.typing.RectLike, lines: Sequence[str], rows: Sequence[TooltipRow] = ()
) -> pygame.FRect:
    """Draw the panel to the right of a point, or to its left, inside a box; return its box."""
    bounds = pygame.FRect(within)
    indent = _SWATCH + _AFTER_SWATCH if any(row.dash is not None for row in rows) else 0.0
    words = max((canvas.text_width(row.word, size=LABEL) for row in rows), default=0.0)
    figures = max((canvas.text_width(row.figure, size=SMALL, tabular=True) for row in rows), default=0.0)
    widths = [canvas.text_width(line, size=LABEL, tabular=True) for line in lines]
    width = max(*widths, indent + words + _BETWEEN + figures if rows else 0.0, 0.0) + 2 * _PADDING
    height = _ROW * (len(lines) + len(rows)) + 9
    left = point[0] + _GAP
    if left + width > bounds.right:
        left = max(min(point[0] - _GAP, bounds.right) - width, bounds.left)
    top = max(min(point[1] - height / 2, bounds.bottom - height), bounds.top)
    canvas.rounded((left, top, width, height), 6, NIGHT0, 0.9)
    canvas.outline((left, top, width, height), 6, LINE)
    y, right = top + _ROW, left + width - _PADDING
    for line in lines:
        canvas.text(line, (left + _PADDING, y), size=LABEL, colour=MUTE, tabular=True)
        y += _ROW
    for row in rows:
        if row.dash is not None:
            draw_swatch(canvas, (left + _PADDING, y - 4), row.colour, row.dash)
        canvas.text(row.word, (left + _PADDING + indent, y), size=LABEL)
        canvas.text(row.figure, (right, y), size=SMALL, colour=row.colour, align="right", tabular=True)
        y += _ROW
    return pygame.FRect(left, top, width, height)


def draw_swatch(canvas: Canvas, start: Point, colour: Colour, dash: Sequence[float], length: float = _SWATCH) -> None:
    """Draw a short horizontal piece of a line; `dash` is on, off, ... in points, or empty for a solid one."""
    x, y = start
    pattern = list(dash) or [length, 0.0]
    at = 0.0
    while at < length:
        for on, off in zip(pattern[::2], pattern[1::2], strict=True):
            if at < length:
                canvas.pill((x + at, y - 1, min(on, length - at), 2), colour)
            at += on + off
