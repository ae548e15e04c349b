"""Picture of a map, whose pixels are pointed at."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

from ai.explain.unit_sums import Box
from game.core import texts
from game.digits.pictures import SIGNED, Numbers, Picture, Shades
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN
from game.ui.virtual_pointer import PictureRow

_LARGEST: Final = 230.0
_PACE: Final = 3.0  # points in a step of 1/60 s


class MapRow(PictureRow):
    """Map, of which the mouse or a virtual pointer chooses a pixel.

    Args:
        values: returns the map, (height, width) in -1 to 1.
        lit: returns top, left, bottom and right of the pixels that have an edge around them.
        choose: gets the row and the column of a pixel that is pointed at.

    """

    def __init__(
        self,
        values: Callable[[], Numbers],
        lit: Callable[[], Box],
        choose: Callable[[int, int], None],
        shades: Shades = SIGNED,
    ) -> None:
        super().__init__(
            texts.POINTER, lambda width: min(width, _LARGEST), self._point, self._draw_map, square=True, pace=_PACE
        )
        self._values, self._lit, self._choose, self._map = values, lit, choose, Picture(shades)

    def pixels(self, box: Box) -> pygame.FRect:
        """Return where some pixels are, in points."""
        (height, width), (left, top), side = self._values().shape, self.picture.topleft, self.picture.width
        down, across, bottom, right = box[0] / height, box[1] / width, box[2] / height, box[3] / width
        return pygame.FRect(left + across * side, top + down * side, (right - across) * side, (bottom - down) * side)

    def _point(self, event: pygame.event.Event) -> None:
        if self.picture.collidepoint(event.pos):
            (height, width), side = self._values().shape, self.picture.width
            row, column = (event.pos[1] - self.picture.top) / side, (event.pos[0] - self.picture.left) / side
            self._choose(int(row * height), int(column * width))

    def _draw_map(self, canvas: Canvas, box: pygame.FRect) -> None:
        self._map.draw(canvas, box, self._values())
        canvas.outline(self.pixels(self._lit()).inflate(2, 2), 1, HUMAN, 2)
