"""Notes: short messages over any screen, placed where they hide nothing to read, to press or to look at."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import Final

import numpy as np
import numpy.typing as npt
import pygame

from game.drawing.canvas import Canvas
from game.drawing.cursor import LEADING, Cursor
from game.drawing.prose import lines
from game.drawing.tokens import FAINT, INK, SMALL

_STEPS_SHOWN: Final = 60 * 5
_STEPS_FADING: Final = 20
_LONGEST: Final = 220  # characters
# Points of a line, the best first; a longer message takes more lines.
_WIDTHS: Final = (380.0, 560.0, 240.0)
_MARGINS: Final = (16.0, 7.0)  # points beside and above what it says
_COVER: Final = 0.96  # opacity of the panel, over any background
# Where its middle may be across the window, as shares of what is left beside it, and its top down from there: the best
# first. The rows near the upper and the lower edge, and then those between them.
_ACROSS: Final = (0.5, 0.25, 0.75, 0.0, 1.0)
_DOWN: Final = (0.10, 0.92, 0.15, 0.03, 0.0, 0.875, 0.86, 0.20, 0.80, 0.26, 0.74, 0.32, 0.68, 0.38, 0.62, 0.44, 0.56)
_WORDS: Final = 8  # times as bad as a picture are words that are hidden
Place = tuple[float, float, float]  # of those three
_PLACES: Final[tuple[Place, ...]] = tuple(product(_WIDTHS, _ACROSS, _DOWN))


class Note:
    """Note that shows one message at a time, for five seconds; it is laid out on the canvas for text that flows.

    Attributes:
        text: the message that is shown, or was shown last.

    """

    def __init__(self) -> None:
        self.text = ""
        self._left = 0
        self._place = _PLACES[0]

    def show(self, text: str) -> None:
        """Show a message in place of the last one."""
        text = " ".join(text.split())
        if len(text) > _LONGEST:  # the end of a path or a reason matters most
            text = text[: _LONGEST // 3] + " … " + text[-_LONGEST * 2 // 3 :]
        self.text, self._left, self._place = text, _STEPS_SHOWN, _PLACES[0]

    def update(self, canvas: Canvas) -> None:
        """Advance by 1/60 s; move to where the note hides least of what the last frame's reader sees."""
        self._left = max(0, self._left - 1)
        if self._left and self._hidden(canvas, [self._place])[0]:
            hidden = self._hidden(canvas, _PLACES)
            if hidden[_PLACES.index(self._place)] > hidden.min():
                self._place = _PLACES[hidden.argmin()]

    def _hidden(self, canvas: Canvas, places: Sequence[Place]) -> npt.NDArray[np.int64]:
        """Return how much a note would hide at each place, in pixels; of words, each counts more."""
        reading = canvas.reading
        sizes = {widest: self._size(reading, widest) for widest in _WIDTHS}
        boxes = np.array([_edges(reading.rect(*_box(reading, place, sizes[place[0]]))) for place in places])[:, None]
        areas = np.array([_edges(area) for area in (*canvas.words, *canvas.looked_at)], np.int64).reshape(-1, 4)
        weights = [_WORDS] * len(canvas.words) + [1] * len(canvas.looked_at)
        common = np.minimum(boxes[..., 2:], areas[:, 2:]) - np.maximum(boxes[..., :2], areas[:, :2])
        hidden: npt.NDArray[np.int64] = common.clip(0).prod(axis=2) @ np.array(weights, np.int64)
        return hidden

    def box(self, canvas: Canvas) -> pygame.Rect:
        """Return the note's panel, in the window's pixels."""
        reading = canvas.reading
        return reading.rect(*self._box_at(reading, self._place))

    def _box_at(self, reading: Canvas, place: Place) -> pygame.FRect:
        return _box(reading, place, self._size(reading, place[0]))

    def _size(self, reading: Canvas, widest: float) -> tuple[float, float]:
        """Return the width and the height of a note whose lines are no wider than that."""
        beside, above = _MARGINS
        room = min(widest, reading.view.width - 4 * beside)
        wrapped = lines(self.text, SMALL, "regular", room, reading.scale)
        width = max(reading.text_width(line, size=SMALL) for line in wrapped)
        return width + 2 * beside, len(wrapped) * LEADING * SMALL + 2 * above

    def draw(self, canvas: Canvas) -> None:
        if not self._left:
            return
        alpha = min(1.0, self._left / _STEPS_FADING)
        reading = canvas.reading
        box = self._box_at(reading, self._place)
        with reading.unnoted():  # the note avoids the page, not itself
            reading.panel(box, _COVER, alpha)
            reading.outline(box, 8, FAINT, alpha=alpha)
            beside, above = _MARGINS
            room = box.width - 2 * beside + 1
            words = Cursor(box.left + beside, box.top + above, room, reading.scale, reading, size=SMALL, colour=INK)
            words.text(self.text, "centre", alpha)


def _box(reading: Canvas, place: Place, size: tuple[float, float]) -> pygame.FRect:
    (_, across, down), (width, height), view = place, size, reading.view
    return pygame.FRect(across * (view.width - width), down * (view.height - height), width, height)


def _edges(box: pygame.Rect) -> tuple[int, int, int, int]:
    return box.left, box.top, box.right, box.bottom
