"""Where Train's parts stand in a window of any shape: display and panel side by side, or one below the other."""

from __future__ import annotations

from typing import Final, NamedTuple

import pygame

CAPTION: Final = 32.0  # points below a chart, for what is said of it
_SIDE: Final = (320.0, 422.0)  # width of the panel at least and at most
_WIDE: Final = 680.0  # points of a window from which the panel stands beside the display
_BELOW: Final = 0.4  # share of a tall window for the panel
_MARGIN: Final = 28.0
_CHART: Final = (70.0, 172.0)  # height of a chart at least and at most
_CHARTS: Final = (0.31, 0.5)  # share of the display for one row of charts, and for more
_COLUMNS: Final = 2


class Layout(NamedTuple):
    """Boxes in points.

    Attributes:
        display: what is seen of the run.
        swarm: its upper part, above the charts.
        charts: a box for each chart, with room for a caption below.
        panel: beside or below the display.

    """

    display: pygame.FRect
    swarm: pygame.FRect
    charts: tuple[pygame.FRect, ...]
    panel: pygame.FRect


def layout(view: pygame.FRect, charts: int) -> Layout:
    """Lay a window out in points, with so many charts."""
    display, panel = pygame.FRect(0, 0, *view.size), pygame.FRect(0, 0, *view.size)
    if view.width >= _WIDE and view.width > view.height:
        panel.width = min(max(0.33 * view.width, _SIDE[0]), _SIDE[1])
        display.width = panel.left = view.width - panel.width
    else:
        display.height = panel.top = round((1 - _BELOW) * view.height)
        panel.height = view.height - display.height
    rows = -(-charts // _COLUMNS)
    share = _CHARTS[rows > 1] * display.height / rows
    height = min(max(share - CAPTION, _CHART[0]), _CHART[1])
    top = display.bottom - rows * (height + CAPTION) - 8
    width = (display.width - 2 * _MARGIN - (_COLUMNS - 1) * _MARGIN) / _COLUMNS
    boxes = tuple(
        pygame.FRect(_MARGIN + column * (width + _MARGIN), top + row * (height + CAPTION), width, height)
        for row, column in (divmod(number, _COLUMNS) for number in range(charts))
    )
    return Layout(display, pygame.FRect(0, 0, display.width, max(top - 14, 1.0)), boxes, panel)
