"""Pause menu over a blurred scene that stands still."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from game.core import texts
from game.core.scene import Pop, Scene, Transition, push
from game.drawing.canvas import Canvas
from game.drawing.tokens import MARGIN
from game.input.controls import Command
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form import Form
from game.ui.form_scene import FormScene
from game.ui.still_picture import StillPicture
from game.ui.widget import OnPress
from game.ui.widgets import TextButton

_FIRST_WORD: Final = 304
_LINE: Final = 44


class PauseScene(FormScene):
    """Pause menu over a scene, until the player resumes or leaves it.

    Args:
        below: the paused scene.
        retry: function that restarts the scene below; None for no such entry.
        retry_word: label of that entry.
        more: function that returns further entries and their actions; called each time the column is built.

    """

    def __init__(
        self,
        context: Context,
        below: Scene,
        retry: Callable[[], None] | None = None,
        retry_word: str = texts.PAUSE_RETRY,
        more: Callable[[], list[tuple[str, OnPress]]] = list,
    ) -> None:
        super().__init__(context)
        self._behind = StillPicture(below)
        self._retry, self._retry_word, self._more = retry, retry_word, more
        self._build()

    def enter(self) -> None:
        """Name the entries anew, for a scene above may have changed them."""
        self._build()

    def _build(self) -> None:
        """Build the column of entries."""
        self.form = Form(self.context, on_back=Pop)
        rows: list[tuple[str, OnPress]] = [(texts.PAUSE_RESUME, Pop)]
        if self._retry:
            rows.append((self._retry_word, self._begin_anew))
        rows += [*self._more(), (texts.PAUSE_SETTINGS, _open_settings), (texts.PAUSE_LEAVE, lambda: Pop(2))]
        for number, (label, press) in enumerate(rows):
            box = (MARGIN, _FIRST_WORD + number * _LINE, 420, _LINE)
            self.form.add(TextButton(self.form.manager, box, label, press, size=22, weight="light"))

    def actions(self) -> Table:
        """Choose, or resume."""
        return [self.form.confirms(texts.HINT_CHOOSE), Action(Command.PAUSE, Pop, texts.HINT_RESUME)]

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the blurred scene below, and the column."""
        self._behind.draw(canvas)
        canvas.text(texts.PAUSE_TITLE, (MARGIN, 256), size=44, weight="extralight")
        self.form.draw(canvas)
        self.draw_hints(canvas)

    def _begin_anew(self) -> Transition:
        assert self._retry is not None
        self._retry()
        return Pop()


def _open_settings() -> Transition:
    return push("settings")
