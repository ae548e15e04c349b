"""Notes: short messages over any screen, under its head in the middle, or near its lower edge."""

from __future__ import annotations

from typing import Final

import pygame

from game.drawing.canvas import Canvas
from game.drawing.cursor import LEADING, Cursor
from game.drawing.prose import lines
from game.drawing.tokens import FAINT, INK, SMALL

_STEPS_SHOWN: Final = 60 * 5
_STEPS_FADING: Final = 20
_LONGEST: Final = 220  # characters
_WIDEST: Final = 480.0  # points of a line; a longer message takes more lines
_MARGINS: Final = (16.0, 7.0)  # points beside and above what it says
_COVER: Final = 0.96  # opacity of the panel, over any background
_HIGH, _LOW = 0.10, 0.70  # where its top may be, in shares of the height that is left


class Note:
    """Note that shows one message at a time, for five seconds; it is laid out on the canvas for text that flows.

    Attributes:
        text: the message that is shown, or was shown last.

    """

    def __init__(self) -> None:
        self.text = ""
        self._left = 0

    def show(self, text: str) -> None:
        """Show a message in place of the last one."""
        text = " ".join(text.split())
        if len(text) > _LONGEST:  # the end of a path or a reason matters most
            text = text[: _LONGEST // 3] + " … " + text[-_LONGEST * 2 // 3 :]
        self.text, self._left = text, _STEPS_SHOWN

    def update(self) -> None:
        """Advance by 1/60 s."""
        self._left = max(0, self._left - 1)

    def draw(self, canvas: Canvas, *, low: bool = False) -> None:
        """Draw the message, if one is to be seen."""
        if not self._left:
            return
        alpha, reading, (beside, above) = min(1.0, self._left / _STEPS_FADING), canvas.reading, _MARGINS
        view = reading.view
        wrapped = lines(self.text, SMALL, "regular", min(_WIDEST, view.width - 4 * beside), reading.scale)
        width = max(reading.text_width(line, size=SMALL) for line in wrapped) + 2 * beside
        height = len(wrapped) * LEADING * SMALL + 2 * above
        top = (_LOW if low else _HIGH) * (view.height - height)
        box = pygame.FRect((view.width - width) / 2, top, width, height)
        reading.panel(box, _COVER, alpha)
        reading.outline(box, 8, FAINT, alpha=alpha)
        room = box.width - 2 * beside + 1
        words = Cursor(box.left + beside, box.top + above, room, reading.scale, reading, size=SMALL, colour=INK)
        words.text(self.text, "centre", alpha)
