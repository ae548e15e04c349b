"""Hint that a network reads far worse than it did, with a button that takes it back to its best."""

from __future__ import annotations

from typing import Final

import pygame

from ai.training.history import REVERTED, History
from game.core import texts
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import SMALL
from game.panels.advice import draw_hint
from game.training.run import TrainingRun
from game.ui.form import Form
from game.ui.widgets import TextButton

FALLEN: Final = 0.15  # drop of the accuracy below its best at which a return to the best is offered


def fallen(history: History) -> tuple[float, float] | None:
    """Return the best and the present accuracy, if the present one is far lower; None otherwise, or after a return."""
    back = max((turn.seconds for turn in history.setting_changes if turn.name == REVERTED), default=-1.0)
    read = [score.success for score in history.validations if score.seconds > back]
    best = max((score.success for score in history.validations), default=0.0)
    return (best, read[-1]) if read and best - read[-1] > FALLEN else None


class WayBack:
    """Hint in a box, and its button; there only while the accuracy of a run is far below its best."""

    def __init__(self, form: Form, box: pygame.Rect, digit_run: TrainingRun) -> None:
        self._form, self._box, self._digit_run = form, box, digit_run
        self._words: list[TextButton] = []

    def follow(self) -> None:
        """Add or remove the button, as the run goes."""
        run = self._digit_run
        wanted = run.alive and not run.stopping and fallen(run.history) is not None
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
        if self._words and (parts := fallen(self._digit_run.history)):
            best, now = (f"{100 * part:.1f}%" for part in parts)
            draw_hint(canvas, self._box, texts.HINT_TITLE, texts.DIGIT_RUN_FALLEN.format(best=best, now=now))
