"""Knob of the random seed: a row of the panel of settings in which a number is typed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

from game.core import texts
from game.core.scene import Transition
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, MUTE, SMALL
from game.panels.knob import draw_row
from game.ui.entry import Entry, draw_line
from game.ui.text_line import digits
from game.ui.widget import PointsManager

_LONGEST_SEED: Final = 9  # digits


class SeedKnob(Entry):
    """The random seed: typed, or stepped with the arrows. It takes a new run, as a run begins with it."""

    live = False
    changed = False

    def __init__(
        self, manager: PointsManager, box: pygame.typing.RectLike, label: str, turn: Callable[[int], None]
    ) -> None:
        super().__init__(manager, box, label, "0", self._accept, limit=_LONGEST_SEED, fits=digits, size=SMALL)
        self.help = texts.KNOB_SEED
        self._turn, self.value, self.waits = turn, 0, False

    def display(self, value: int, *, waits: bool) -> None:
        """Show what the panel says."""
        self.value, self.waits = value, waits
        if not self.typing:
            self.line.set(str(value))

    def shift(self, direction: int) -> bool:
        """Raise or lower the seed by one."""
        self._turn(min(max(self.value + direction, 0), 10**_LONGEST_SEED - 1))
        return True

    def _accept(self, text: str) -> Transition | None:
        self._turn(int(text))
        return None

    def ease(self, at_once: bool) -> None:
        """Take what was typed once the focus is elsewhere."""
        super().ease(at_once)
        self.commit()

    def commit(self) -> None:
        """Take what was typed, unless it is still being typed."""
        if not self.typing and self.line.text != str(self.value):
            self._turn(int(self.line.text or self.value))

    @property
    def start(self) -> tuple[float, float]:
        """Left end of the number, which is aligned to the right end of the row."""
        return self.box.right - typeface.width(self.line.shown, SMALL, "regular"), self.box.centery + 4.5

    def paint(self, canvas: Canvas) -> None:
        """Draw the label and the number."""
        draw_row(canvas, self, changed=False)
        x, baseline = self.start
        if self.typing:
            draw_line(canvas, self.line, (x, baseline), self.box.width, SMALL, typing=True)
            canvas.line((min(x, self.box.right - 20), baseline + 5.5), (self.box.right, baseline + 5.5), HUMAN, 1)
        else:
            canvas.text(self.line.text, (x, baseline), size=SMALL, colour=HUMAN if self.waits else MUTE)
