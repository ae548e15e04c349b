"""Picking: one of some rows, over the scene that asks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import pygame

from game import texts
from game.context import Context
from game.controls import Command
from game.scene import Pop, Scene, Transition
from game.ui.canvas import Canvas
from game.ui.form import Form
from game.ui.hints import draw_hints
from game.ui.listing import Listing, Row
from game.ui.tokens import NIGHT0, TEXT

_BOX: Final = pygame.Rect(400, 176, 480, 336)


class Picking:
    """Calls `on_pick` with the number of the row that was pressed, and closes."""

    def __init__(self, below: Scene, question: str, rows: Sequence[Row], on_pick: Callable[[int], None]) -> None:
        self._below, self._question, self._rows, self._on_pick = below, question, rows, on_pick

    def enter(self, context: Context) -> None:
        """Build the list."""
        self._context = context
        self._form = Form(context, on_back=Pop)
        box = (_BOX.left + 32, _BOX.top + 56, _BOX.width - 64, _BOX.height - 84)
        self._form.add(Listing(self._form.manager, box, self._rows, on_press=self._pick, empty=texts.PICKING_EMPTY))

    def exit(self) -> None:
        """Nothing is held."""

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Leave it to the form."""
        return self._form.handle_event(event)

    def update(self) -> Transition | None:
        """Let the form ease."""
        return self._form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the scene below, dimmed, and the rows."""
        self._below.draw(canvas, 1.0)
        canvas.fill(canvas.surface.get_rect(), NIGHT0, 0.6)
        canvas.panel(_BOX, 0.96)
        canvas.text(self._question, (_BOX.left + 32, _BOX.top + 36), size=TEXT)
        self._form.draw(canvas)
        word = self._context.controls.word
        hints = [(word(Command.CONFIRM), texts.HINT_CHOOSE), (word(Command.BACK), texts.HINT_LEAVE)]
        draw_hints(canvas, hints, (_BOX.left + 32, _BOX.bottom + 24))

    def _pick(self, number: int) -> Transition:
        self._on_pick(number)
        return Pop()
