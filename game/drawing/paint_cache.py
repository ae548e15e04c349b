"""Cache of painted pictures that change seldom."""

from __future__ import annotations

from collections.abc import Callable, Hashable

import pygame

from game.drawing import typeface
from game.drawing.canvas import Canvas


class PaintCache:
    """Paint cache: pictures, such as the text of a panel, repainted only when their contents change.

    The last `most` pictures are kept, by their contents.
    """

    def __init__(self, most: int = 1) -> None:
        self._most = most
        self._painted: dict[Hashable, Canvas] = {}

    def draw(
        self, canvas: Canvas, box: pygame.typing.RectLike, shows: Hashable, paint: Callable[[Canvas], None]
    ) -> None:
        """Draw a picture with its origin at the corner of `box`; call `paint` only for a new `shows`, its contents."""
        x, y, width, height = pygame.FRect(box)
        key = (canvas.size, canvas.palette, typeface.growth(), width, height, shows)
        painted = self._painted.get(key)
        if painted is None:
            painted = self._painted[key] = canvas.sheet(width, height)
            paint(painted)
            if len(self._painted) > self._most:
                del self._painted[next(iter(self._painted))]
        canvas.lay(painted, x, y)
