"""Where Train's parts stand in a window of any shape, side by side or one below the other, and the title over them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import pygame

from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import MUTE, SMALL, TITLE
from game.explain.readouts import rate_colour
from game.ui.hints import Hint, HintRow

_SAID: Final = 32.0  # points below a chart, for what is said of it
_SIDE: Final = (320.0, 422.0)  # width of the panel at least and at most
PANEL_MARGIN: Final = 32.0  # of the panel at either side
_WIDE: Final = 680.0  # points of a window from which the panel stands beside the display
_BELOW: Final = 0.4  # share of a tall window for the panel
_MARGIN: Final = 28.0
_CHART: Final = (70.0, 172.0)  # height of a chart at least and at most
_CHARTS: Final = 0.31  # share of the display for the charts
_TITLE: Final = (24.0, 16.0)  # corner of the title over the display
_WIDEST: Final = 372.0
FLIGHTS: Final = 160.0  # height that two swarms keep, before charts and title
NAMES: Final = 60.0  # of the words below each of them
_LOW: Final = 200.0  # points of the display above the charts, in which the title is its figure alone
_FIGURE: Final = (30.0, 60.0, 0.14)  # size at least, at most, and as a share of the picture's height


class Layout(NamedTuple):
    """Boxes in points.

    Attributes:
        display: what is seen of the run.
        swarm: its upper part, above the charts.
        charts: a box for both charts, with room for a caption below; none where they would leave two swarms too little.
        panel: beside or below the display.

    """

    display: pygame.FRect
    swarm: pygame.FRect
    charts: tuple[pygame.FRect, ...]
    panel: pygame.FRect


def layout(view: pygame.FRect, *, pair: bool = False) -> Layout:
    """Lay a window out in points, for one swarm or a pair."""
    display, panel = pygame.FRect(0, 0, *view.size), pygame.FRect(0, 0, *view.size)
    if view.width >= _WIDE and view.width > view.height:
        panel.width = min(max(0.33 * view.width, _SIDE[0]), _SIDE[1])
        display.width = panel.left = view.width - panel.width
    else:
        display.height = panel.top = round((1 - _BELOW) * view.height)
        panel.height = view.height - display.height
    height = min(max(_CHARTS * display.height - _SAID, _CHART[0]), _CHART[1])
    top, width = display.bottom - height - _SAID - 8, (display.width - 3 * _MARGIN) / 2
    boxes = tuple(pygame.FRect(left, top, width, height) for left in (_MARGIN, 2 * _MARGIN + width))
    if pair and top - 14 < FLIGHTS + NAMES:
        return Layout(display, display.copy(), (), panel)
    return Layout(display, pygame.FRect(0, 0, display.width, max(top - 14, 1.0)), boxes, panel)


def _title_width(place: Layout) -> float:
    return min(_WIDEST, place.display.width - 2 * _TITLE[0])


def hint_row(place: Layout, hints: Sequence[Hint], *, titled: bool) -> HintRow:
    """Return the hints that stand beside the title, or without one, in the corner of the panel."""
    if not titled:
        return HintRow(hints, (place.panel.right - PANEL_MARGIN, place.panel.bottom - 22), from_right=True)
    return HintRow(hints, (_TITLE[0] + _title_width(place) - 16, _TITLE[1] + 30), from_right=True)


def is_low(place: Layout) -> bool:
    """Whether there is so little room above the charts that the title is its figure alone."""
    return place.swarm.height < _LOW


class Status(NamedTuple):
    """Title of the screen, a line of text, and a figure in percent with what it counts, empty before it is known."""

    title: str
    line: str
    figure: str
    words: str

    def draw(self, canvas: Canvas, place: Layout) -> None:
        """Draw the title over the display, and the share that succeeds, large; over a low one that share alone."""
        (left, top), width, low = _TITLE, _title_width(place), is_low(place)
        if low and not self.figure:
            return
        if low:  # no wider than its words: below it are landers
            words = canvas.text_width(self.words, size=SMALL) + 2.0 * _FIGURE[0]
            width = min(width, words + 60)
        size = min(max(_FIGURE[2] * place.swarm.height, _FIGURE[0]), _FIGURE[1])
        cursor = Cursor(left + 16, top + (2 if low else 10), width - 32, canvas.scale)
        begun = cursor.y
        self._write(cursor, size, low)
        canvas.panel((left, top, width, cursor.y - top + 8), 1.0)
        self._write(Cursor(left + 16, begun, width - 32, canvas.scale, canvas), size, low)

    def _write(self, cursor: Cursor, size: float, low: bool) -> None:
        if not low:
            cursor.styled(self.title, TITLE)
        if self.figure:
            wide = cursor.in_style(size, weight="light").measured(self.figure, tabular=True)
            if canvas := cursor.canvas:
                left, y = cursor.left - 2, cursor.y + 0.92 * size
                colour = rate_colour(canvas, float(self.figure))
                canvas.text(self.figure, (left, y), size=size, weight="light", tabular=True, colour=colour)
                left, room = left + wide + 12, cursor.width - wide - 10
                canvas.text(self.words, (left, y), size=SMALL, colour=MUTE, room=room)
            cursor.gap(1.08 * size)
        if not low:
            cursor.aside(self.line)
