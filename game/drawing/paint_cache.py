"""What changes seldom is painted once and then only copied."""

from __future__ import annotations

from collections.abc import Callable, Hashable

import pygame

from game.drawing import typeface
from game.drawing.canvas import Canvas


class Kept:
    """Pictures, such as the words of a panel, that are painted anew only when what they show has changed.

    The last `most` are kept, to be found again by what they show.
    """

    def __init__(self, most: int = 1) -> None:
        self._most = most
        self._painted: dict[Hashable, Canvas] = {}

    def draw(
        self, canvas: Canvas, box: pygame.typing.RectLike, shows: Hashable, paint: Callable[[Canvas], None]
    ) -> None:
        """Draw what `paint` paints, with the corner of `box` as its origin; `shows` is all that it depends on."""
        x, y, width, height = pygame.FRect(box)
        key = (canvas.size, canvas.palette, typeface.growth(), width, height, shows)
        painted = self._painted.get(key)
        if painted is None:
            painted = self._painted[key] = canvas.sheet(width, height)
            paint(painted)
            if len(self._painted) > self._most:
                del self._painted[next(iter(self._painted))]
        canvas.lay(painted, x, y)
