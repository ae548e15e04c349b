"""Dialogs: a question over the scene that asks it, which is paused and dimmed meanwhile."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

import pygame

from game.core import texts
from game.core.scene import Pop, Scene, Transition
from game.core.shelf import LONGEST_NAME, fitting
from game.drawing.tokens import FAINT
from game.ui.hints import HintRow, hint_lines
from game.ui.panel_scene import PanelScene, StillPicture

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.ui.panel import Panel

_MARGIN: Final = 32.0
_FOOT: Final = 30.0  # of the box, for the hints: nothing of the scene below shows behind them


class Dialog(PanelScene):
    """Base of all dialogs: a question, and what a subclass adds below. Escape closes without effect.

    Attributes:
        more: what is said below the question.

    """

    most = 480.0

    def __init__(self, below: Scene, question: str, more: str = "") -> None:
        super().__init__(below.context)
        self._behind, self._question, self.more = StillPicture(below, dimmed=0.8, sharp=True), question, more
        self.build()

    def describe(self, panel: Panel) -> None:
        panel.text(self._question)
        if self.more:
            panel.gap(4)
            panel.aside(self.more)
        panel.gap(10)
        self.add_answers(panel)

    @abstractmethod
    def add_answers(self, panel: Panel) -> None:
        """Add what there is to choose from."""

    def room(self, canvas: Canvas) -> pygame.FRect:
        view = canvas.view
        width = min(self.most, view.width - 16) - 2 * _MARGIN
        height = min(self.panel.height, view.height - 2 * _MARGIN - 2 * _FOOT)
        return pygame.FRect(view.centerx - width / 2, view.centery - height / 2 - 16, width, height)

    @property
    def box(self) -> pygame.FRect:
        box = self.panel.box.inflate(2 * _MARGIN, 1.5 * _MARGIN)
        box.height += _FOOT
        return box

    def hint_rows(self, canvas: Canvas) -> Sequence[HintRow]:
        box = self.box
        return hint_lines(self.hints, canvas, (box.left + _MARGIN, box.bottom - 20), box.width - 2 * _MARGIN)

    def draw_behind(self, canvas: Canvas, alpha: float) -> None:
        self._behind.draw(canvas)
        canvas.panel(self.box, 1.0)
        canvas.outline(self.box, 8, FAINT)


class QuestionDialog(Dialog):
    """Dialog with a few answers: any of them closes it and runs its action."""

    def __init__(
        self, below: Scene, question: str, more: str, answers: Sequence[tuple[str, Callable[[], None]]]
    ) -> None:
        self._answers = answers
        super().__init__(below, question, more)

    def add_answers(self, panel: Panel) -> None:
        panel.words([(label, partial(self._close, answer)) for label, answer in self._answers])

    def _close(self, answer: Callable[[], None]) -> Transition:
        answer()
        return Pop()


class NameDialog(Dialog):
    """Dialog that asks for a name, with a suggestion to accept or edit.

    `on_name` is called with the name and returns why it is invalid; if it returns "", the dialog closes.
    """

    def __init__(self, below: Scene, question: str, suggestion: str, on_name: Callable[[str], str]) -> None:
        self._on_name, self._suggestion = on_name, suggestion
        super().__init__(below, question)
        self._entry.begin()

    def add_answers(self, panel: Panel) -> None:
        self._entry = panel.entry(self._suggestion, self._done, Pop, LONGEST_NAME, fitting)
        panel.words([(texts.NAMING_KEEP, self._keep), (texts.NAMING_LEAVE, Pop)])

    def _keep(self) -> Transition | None:
        return self._done(self._entry.text.strip())

    def _done(self, name: str) -> Transition | None:
        problem = self._on_name(name)
        if not problem:
            return Pop()
        self.context.note(problem)
        self.form.focus(self._entry)
        self._entry.begin()
        return None
