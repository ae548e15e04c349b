"""Where Train's parts stand in a window of any shape: display and panel side by side, or one below the other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import pygame

CAPTION: Final = 32.0  # points below a chart, for what is said of it
_SIDE: Final = (320.0, 422.0)  # width of the panel at least and at most
_WIDE: Final = 680.0  # points of a window from which the panel stands beside the display
_BELOW: Final = 0.4  # share of a tall window for the panel
_MARGIN: Final = 28.0
_CHART: Final = (70.0, 172.0)  # height of a chart at least and at most
_CHARTS: Final = (0.31, 0.5)  # share of the display for one row of charts, and for more
_COLUMNS: Final = 2


@dataclass(frozen=True)
class Layout:
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

    @property
    def beside(self) -> bool:
        """Whether the panel stands beside the display."""
        return self.panel.left > self.display.left


def layout(view: pygame.FRect, charts: int) -> Layout:
    """Lay a window out in points, with so many charts."""
    if view.width >= _WIDE and view.width > view.height:
        side = min(max(0.33 * view.width, _SIDE[0]), _SIDE[1])
        display = pygame.FRect(0, 0, view.width - side, view.height)
        panel = pygame.FRect(display.right, 0, side, view.height)
    else:
        display = pygame.FRect(0, 0, view.width, round((1 - _BELOW) * view.height))
        panel = pygame.FRect(0, display.bottom, view.width, view.height - display.bottom)
    rows = -(-charts // _COLUMNS)
    share = _CHARTS[rows > 1] * display.height / rows
    height = min(max(share - CAPTION, _CHART[0]), _CHART[1])
    top = display.bottom - rows * (height + CAPTION) - 8
    width = (display.width - 2 * _MARGIN - (_COLUMNS - 1) * _MARGIN) / _COLUMNS
    boxes = tuple(
        pygame.FRect(display.left + _MARGIN + column * (width + _MARGIN), top + row * (height + CAPTION), width, height)
        for row in range(rows)
        for column in range(_COLUMNS)
    )[:charts]
    swarm = pygame.FRect(display.left, display.top, display.width, max(top - 14 - display.top, 1.0))
    return Layout(display, swarm, boxes, panel)
