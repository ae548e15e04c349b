"""Short messages near the top of the window, where no screen has figures or choices of its own."""

from __future__ import annotations

from typing import Final

from game.ui.canvas import Canvas
from game.ui.tokens import FAINT, INK, SMALL, VIEW_SIZE

_STEPS_SHOWN: Final = 60 * 5
_STEPS_FADING: Final = 20
_LONGEST: Final = 150
_TOP: Final = 68
_COVER: Final = 0.96  # it comes over whatever is there


class Notes:
    """One message at a time, gone after five seconds."""

    def __init__(self) -> None:
        self._text = ""
        self._left = 0

    def show(self, text: str) -> None:
        """Show a message in place of the last one."""
        if len(text) > _LONGEST:  # the end of a path or a reason says the most
            text = text[: _LONGEST // 3] + " … " + text[-_LONGEST * 2 // 3 :]
        self._text, self._left = text, _STEPS_SHOWN

    def update(self) -> None:
        """Let 1/60 s pass."""
        self._left = max(0, self._left - 1)

    def draw(self, canvas: Canvas) -> None:
        """Draw the message, if there is one."""
        if not self._left:
            return
        alpha = min(1.0, self._left / _STEPS_FADING)
        width = canvas.text_width(self._text, size=SMALL)
        middle = VIEW_SIZE[0] / 2
        box = (middle - width / 2 - 16, _TOP, width + 32, 32)
        canvas.panel(box, _COVER * alpha)
        canvas.outline(box, 8, FAINT, alpha=alpha)
        canvas.text(self._text, (middle, _TOP + 20), size=SMALL, colour=INK, align="centre", alpha=alpha)
