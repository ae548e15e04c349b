"""Film strip: a small card for each frame of a lesson, with a figure and a little picture, the current one lit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import pygame

from game.drawing.canvas import Canvas, Point
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import INK, LABEL, LINE, MUTE, NET, SMALL
from game.lesson.frame import SMALL_PICTURE, Frame

STRIP: Final = pygame.Rect(40, 62, 1200, 72)
_GAP: Final = 10.0


class FilmStrip:
    """Film strip of some frames, from left to right."""

    def __init__(self, frames: Sequence[Frame]) -> None:
        self._frames = tuple(frames)
        self._pictures = [PaintCache() for _ in frames]

    def box(self, number: int) -> pygame.FRect:
        """Return the box of a card, in points."""
        width = (STRIP.width + _GAP) / len(self._frames)
        return pygame.FRect(STRIP.left + number * width, STRIP.top, width - _GAP, STRIP.height)

    def at(self, point: Point) -> int | None:
        """Return the number of the card at a point of the view."""
        return next((number for number in range(len(self._frames)) if self.box(number).collidepoint(point)), None)

    def draw(self, canvas: Canvas, current: int) -> None:
        """Draw the cards."""
        for number, frame in enumerate(self._frames):
            box, lit = self.box(number), number == current
            pointed = canvas.pointer is not None and box.collidepoint(canvas.pointer)
            if lit:
                canvas.panel(box, 0.9)
            canvas.outline(box, 8, NET if lit else MUTE if pointed else LINE, 1)
            x, room = box.left + 12, box.width - 24
            canvas.text(str(number + 1), (x, box.top + 22), size=LABEL, colour=NET if lit else MUTE)
            canvas.text(frame.name, (x + 16, box.top + 22), size=SMALL, colour=INK if lit else MUTE, room=room - 16)
            wide, high = SMALL_PICTURE
            corner = (box.right - 10 - wide, box.bottom - 12 - high)
            self._pictures[number].draw(canvas, (*corner, wide, high), None, frame.paint_small)
            colour = INK if lit else MUTE
            canvas.text(frame.figure, (x, box.top + 54), size=SMALL, colour=colour, tabular=True, room=room - wide)
