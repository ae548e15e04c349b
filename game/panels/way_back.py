"""Hint that a network reads far worse than it did, with a button that takes it back to its best."""

from __future__ import annotations

import pygame

from game.core import texts
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import SMALL
from game.panels.advice import draw_hint
from game.training.digit_run import DigitRun
from game.ui.form import Form
from game.ui.widgets import TextButton


class WayBack:
    """Hint in a box, and its button; there only while the accuracy of a run is far below its best."""

    def __init__(self, form: Form, box: pygame.Rect, digit_run: DigitRun) -> None:
        self._form, self._box, self._digit_run = form, box, digit_run
        self._words: list[TextButton] = []

    def follow(self) -> None:
        """Add or remove the button, as the run goes."""
        run = self._digit_run
        wanted = run.alive and not run.stopping and run.curves.fallen is not None
        if wanted == bool(self._words):
            return
        width = typeface.width(texts.DIGIT_RUN_GO_BACK, SMALL, "regular")
        box = (self._box.right - 14 - width, self._box.top + 2, width, 22)
        words = (
            [TextButton(self._form.manager, box, texts.DIGIT_RUN_GO_BACK, run.go_back, size=SMALL)] if wanted else []
        )
        self._form.replace(self._words, words)
        self._words = words

    def draw(self, canvas: Canvas) -> None:
        """Draw the box and the sentence; the form draws the button."""
        if self._words and (fallen := self._digit_run.curves.fallen):
            best, now = (f"{100 * part:.1f}%" for part in fallen)
            draw_hint(canvas, self._box, texts.HINT_TITLE, texts.DIGIT_RUN_FALLEN.format(best=best, now=now))
