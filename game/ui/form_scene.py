"""Base of the scenes that are made of widgets: a form, a table of actions, and a row of hints."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pygame

from game.core import texts
from game.core.scene import Pop, Scene, Transition
from game.drawing.tokens import MARGIN, VIEW_SIZE
from game.ui.actions import Table, hints_of
from game.ui.form import Form, tab
from game.ui.hints import Hint, HintRow

if TYPE_CHECKING:
    from collections.abc import Sequence

    from game.drawing.canvas import Canvas
    from game.ui.context import Context
    from game.ui.widget import OnPress

FOOT: Final = (MARGIN, VIEW_SIZE[1] - 40.0)  # where most scenes have their hints


class FormScene(Scene):
    """Scene with a form, whose keys, hints and clicks on hints all follow one table, `actions`.

    Attributes:
        form: the widgets.
        takes_tab: whether Tab is a key for the actions, instead of moving the focus.

    """

    takes_tab = False

    def __init__(self, context: Context, on_back: OnPress = Pop) -> None:
        super().__init__(context)
        self.form = Form(context, on_back)

    @property
    def typing(self) -> bool:  # type: ignore[override]
        """Whether the focused widget takes every key, as a text line does."""
        return self.form.typing

    def actions(self) -> Table:
        return [self.form.confirms(texts.HINT_CHOOSE), self.form.goes_back(texts.HINT_BACK)]

    @property
    def hints(self) -> list[Hint]:
        return self.form.hints or hints_of(self.actions(), self.context.controls)

    def hint_rows(self, canvas: Canvas) -> Sequence[HintRow]:  # noqa: ARG002
        return [HintRow(self.hints, FOOT)]

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        moves = tab(event) != 0 and not self.takes_tab
        return self.form.handle_event(event, () if moves else self.actions())

    def update(self) -> Transition | None:
        return self.form.update()

    def draw_hints(self, canvas: Canvas) -> None:
        for row in self.hint_rows(canvas):
            row.draw(canvas)
