"""Dialogs: a question over the scene that asks it, which is paused and dimmed meanwhile."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import pygame

from game.core import texts
from game.core.names import LONGEST_NAME, fitting
from game.core.scene import Pop, Scene, Transition
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import FAINT, MUTE, TEXT
from game.ui.actions import Table, hints_of
from game.ui.entry import Entry
from game.ui.form_scene import FormScene
from game.ui.hints import HintRow
from game.ui.listing import Listing, Row
from game.ui.still_picture import StillPicture
from game.ui.widget import OnPress
from game.ui.widgets import TextButton

_LEFT, _WIDTH = 400, 480
_MARGIN: Final = 32
_ROOM: Final = _WIDTH - 2 * _MARGIN
_GAP: Final = 28.0  # between words


class Dialog(FormScene):
    """Base of all dialogs; a subclass adds its widgets to the form. Escape closes without effect.

    Attributes:
        more: what is said below the question.

    """

    height = 164

    def __init__(self, below: Scene, question: str, more: str = "", height: int | None = None) -> None:
        super().__init__(below.context)
        height = height or self.height
        self._behind, self._question, self.more = StillPicture(below, dimmed=0.8, sharp=True), question, more
        self.box = pygame.Rect(_LEFT, (720 - height) // 2 - 16, _WIDTH, height)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the scene below, dimmed, and the question."""
        self._behind.draw(canvas)
        canvas.panel(self.box, 1.0)
        canvas.outline(self.box, 8, FAINT)
        left, top = self.box.left + _MARGIN, self.box.top
        canvas.text(self._question, (left, top + 40), size=TEXT)
        if self.more:
            draw_wrapped(canvas, self.more, (left, top + 66), _ROOM, colour=MUTE, leading=18)
        self.form.draw(canvas)
        self.draw_hints(canvas)

    def actions(self) -> Table:
        """Choose, or close without effect."""
        return [self.form.confirms(texts.HINT_CHOOSE), self.form.goes_back(texts.HINT_BACK)]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints below the box."""
        return [
            HintRow(hints_of(self.actions(), self.context.controls), (self.box.left + _MARGIN, self.box.bottom + 24))
        ]

    def add_words(self, words: Sequence[tuple[str, OnPress]]) -> None:
        """Add buttons side by side along the lower edge."""
        x = float(self.box.left + _MARGIN)
        for label, press in words:
            width = typeface.width(label, TEXT, "regular")
            self.form.add(TextButton(self.form.manager, (x, self.box.bottom - 52, width, 28), label, press))
            x += width + _GAP


class QuestionDialog(Dialog):
    """Dialog with a few answers: any of them closes it and runs its action."""

    def __init__(
        self,
        below: Scene,
        question: str,
        more: str,
        answers: Sequence[tuple[str, Callable[[], None]]],
        height: int | None = None,
    ) -> None:
        super().__init__(below, question, more, height)
        self.add_words([(label, _closing(deed)) for label, deed in answers])


class NameDialog(Dialog):
    """Dialog that asks for a name, with a suggestion to accept or edit.

    `on_name` is called with the name and returns why it is invalid; if it returns "", the dialog closes.
    """

    def __init__(self, below: Scene, question: str, suggestion: str, on_name: Callable[[str], str]) -> None:
        super().__init__(below, question)
        self._on_name = on_name
        line = (self.box.left + _MARGIN, self.box.top + 60, _ROOM, 32)
        self._entry = self.form.add(Entry(
            self.form.manager, line, "", suggestion, self._done, on_cancel=Pop, limit=LONGEST_NAME, fits=fitting,
        ))  # fmt: skip
        self.add_words([(texts.NAMING_KEEP, self._keep), (texts.NAMING_LEAVE, Pop)])
        self._entry.begin()

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


class ListDialog(Dialog):
    """Dialog with a list: a press on a row closes it and calls `on_pick` with the row's index."""

    height = 336

    def __init__(self, below: Scene, question: str, rows: Sequence[Row], on_pick: Callable[[int], None]) -> None:
        super().__init__(below, question)
        self._on_pick = on_pick
        box = (self.box.left + _MARGIN, self.box.top + 56, _ROOM, self.box.height - 84)
        self.form.add(Listing(self.form.manager, box, rows, on_press=self._pick, empty=texts.PICKING_EMPTY))

    def _pick(self, number: int) -> Transition:
        self._on_pick(number)
        return Pop()


def _closing(deed: Callable[[], None]) -> Callable[[], Transition]:
    def press() -> Transition:
        deed()
        return Pop()

    return press
