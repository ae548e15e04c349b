"""Advice box of the training screen: one diagnosis, its remedy at a press, and an undo."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import pygame

from ai.training.config import Config
from ai.training.hints import Adviser, Hint
from ai.training.history import History
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, LABEL, SMALL
from game.training.knob_descriptions import told
from game.ui.form import Form
from game.ui.widgets import TextButton

_WORD: Final = 62.0  # from one word to the next
_LINES: Final = 2  # of room for a hint, also at the largest text size


class Advice:
    """Box in a form with the adviser's current hint; `turn` sets a knob by its name.

    `go_back` is called with the moment, in decisions, that a run should return to.

    Attributes:
        done: description of the last remedy's effect.

    """

    def __init__(
        self, form: Form, box: pygame.Rect, turn: Callable[[str, Any], None], go_back: Callable[[int], None]
    ) -> None:
        self._form, self._box, self._turn, self._go_back = form, box, turn, go_back
        self.adviser = Adviser(Config())
        self._moment = 0  # of the run as it was last seen, in decisions
        self._came_from: int | None = None  # the moment at which a remedy went back
        self._hint: Hint | None = None
        self.done = ""  # what the last remedy did
        self._quiet = False
        self._words: list[TextButton] = []

    @property
    def shown(self) -> bool:
        """Whether the box has anything to show."""
        return bool(self._words)

    @property
    def hint(self) -> str:
        """Name of the hint that is shown; empty without one."""
        return self._hint.name if self._hint and self.shown else ""

    def follow(
        self, history: History, config: Config, dead_share: float | None = None, clipped_share: float | None = None
    ) -> None:
        """Diagnose the run again; call it when there is news."""
        if len(history):
            self._moment = int(history["decisions"][-1])
        self._lay(self.adviser.advise(history, config, dead_share, clipped_share))

    def hush(self, quiet: bool) -> None:
        """Hide the hint while other changes wait to be applied or undone: one question at a time."""
        if quiet != self._quiet:
            self._quiet = quiet
            self.adviser.undo()  # that question decides on what was applied
            self._lay(self._hint)

    def clear(self) -> None:
        """Reset for another run."""
        self.adviser.reset()
        self._lay(None)

    def draw(self, canvas: Canvas) -> None:
        """Draw the box and the sentence; the form draws the words."""
        if not self.shown:
            return
        title, said = (
            (texts.HINT_TITLE, texts.HINTS[self._hint.name].format(what=told(self._hint.remedy)))
            if self._hint
            else (texts.HINT_APPLIED, self.done)
        )
        draw_hint(canvas, self._box, title, said)

    def _lay(self, hint: Hint | None) -> None:
        """Add the buttons that fit the hint that is shown."""
        self._hint = hint
        wanted: list[tuple[str, Callable[[], None]]] = []
        if self._quiet:
            pass
        elif hint is not None:
            if hint.remedy or hint.back_to is not None:
                wanted.append((texts.HINT_APPLY, self._apply))
            wanted.append((texts.HINT_DISMISS, self._dismiss))
        elif self.adviser.can_undo:
            wanted = [(texts.HINT_UNDO, self._undo), (texts.HINT_DISMISS, self._keep)]
        if [label for label, _ in wanted] == [word.label for word in self._words]:
            return
        box = self._box
        words = [
            TextButton(
                self._form.manager,
                (box.right - _WORD * (len(wanted) - number), box.top + 2, _WORD - 14, 22),
                label,
                press,
                size=SMALL,
            )
            for number, (label, press) in enumerate(wanted)
        ]
        self._form.replace(self._words, words)
        self._words = words

    def _apply(self) -> None:
        back_to = self._hint.back_to if self._hint else None
        remedy = self.adviser.apply(went_back=back_to is not None)
        went = [] if back_to is None else [texts.HINT_WENT_BACK.format(count=back_to)]
        self.done = ", ".join([*([told(remedy)] if remedy else []), *went])
        for name, value in remedy.items():
            self._turn(name, value)
        self._came_from = None if back_to is None else self._moment
        if back_to is not None:
            self._go_back(back_to)
        self._lay(None)

    def _undo(self) -> None:
        for name, value in self.adviser.undo().items():
            self._turn(name, value)
        if self._came_from is not None:
            self._go_back(self._came_from)
        self._lay(None)

    def _dismiss(self) -> None:
        self.adviser.dismiss()
        self._lay(None)

    def _keep(self) -> None:
        """Keep the remedy, and close the hint."""
        self.adviser.undo()
        self._lay(None)


def draw_hint(canvas: Canvas, box: pygame.Rect, title: str, said: str) -> None:
    """Draw the box of a hint, with its title and what it says, at most two lines."""
    canvas.outline(box, 8, HUMAN, 1, 0.35)
    canvas.text(title, (box.left + 14, box.top + 17), size=LABEL, colour=HUMAN)
    draw_wrapped(canvas, said, (box.left + 14, box.top + 34), box.width - 28, most=_LINES)
