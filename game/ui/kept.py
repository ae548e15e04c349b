"""What changes seldom is painted once and then only copied."""

from __future__ import annotations

from collections.abc import Callable, Hashable

import pygame

from game.ui import typeface
from game.ui.canvas import Canvas


class Kept:
    """A picture, such as the words of a panel, that is painted anew only when what it shows has changed."""

    def __init__(self) -> None:
        self._shows: tuple[Hashable, ...] = ()
        self._painted: pygame.Surface | None = None

    def draw(
        self, canvas: Canvas, box: pygame.typing.RectLike, shows: Hashable, paint: Callable[[Canvas], None]
    ) -> None:
        """Draw what `paint` paints, with the corner of `box` as its origin; `shows` is all that it depends on."""
        x, y, width, height = pygame.FRect(box)
        now = (canvas.size, canvas.palette, typeface.growth(), shows)
        if self._painted is None or now != self._shows:
            sheet = canvas.sheet(width, height)
            paint(sheet)
            self._shows, self._painted = now, sheet.surface
        canvas.surface.blit(self._painted, canvas.rect(x, y, width, height).topleft)
