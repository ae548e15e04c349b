"""Notes: short messages over any screen, at its foot; a click on one puts it away."""

from __future__ import annotations

from typing import Final

import pygame

from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import FAINT, INK, PANEL, SMALL

_STEPS_SHOWN: Final = 60 * 5
_STEPS_FADING: Final = 20
_LONGEST: Final = 220  # characters
_WIDEST: Final = 480.0  # points of a line; a longer message takes more lines
_MARGINS: Final = (16.0, 7.0)  # points beside and above what it says
_APART: Final = 8.0  # points from the strip to the window's edges


class Note:
    """Note that shows one message at a time, for five seconds, and moves nothing that could be clicked.

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

    def box(self, canvas: Canvas) -> pygame.FRect:
        """Return what the message takes of the foot, in points of what is read; an empty box while nothing is said."""
        return self._write(canvas, drawn=False).inflate(0, _APART) if self._left else pygame.FRect()

    def draw(self, canvas: Canvas) -> None:
        """Draw the message, if one is to be seen."""
        if self._left:
            self._write(canvas, drawn=True)

    def take(self, event: pygame.event.Event, canvas: Canvas) -> bool:
        """Put the message away by a click on it; return whether it was one."""
        on_it = event.type == pygame.MOUSEBUTTONDOWN and self._left > 0
        if not (on_it and self._write(canvas, drawn=False).collidepoint(event.pos)):
            return False
        self._left = 0
        return True

    def _write(self, canvas: Canvas, *, drawn: bool) -> pygame.FRect:
        view, (beside, above) = canvas.view, _MARGINS
        room = min(_WIDEST, view.width - 4 * beside)
        words = Cursor(view.centerx - room / 2, 0.0, room, canvas.scale, size=SMALL, colour=INK)
        high = words.text(self.text).height + 2 * above
        widest = min(words.measured(self.text), room) + 2 * beside
        box = pygame.FRect(view.centerx - widest / 2, view.bottom - high - _APART / 2, widest, high)
        if drawn:
            alpha = min(1.0, self._left / _STEPS_FADING)
            canvas.rounded(box, 8, PANEL, alpha)
            canvas.outline(box, 8, FAINT, alpha=alpha)
            words.canvas, words.y = canvas, box.top + above
            words.text(self.text, "centre", alpha)
        return box
