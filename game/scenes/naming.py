"""Naming: a line to write a name on, over the scene that asks for one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

from game import texts
from game.context import Context
from game.controls import Command
from game.scene import Pop, Scene, Transition
from game.ui.canvas import Canvas
from game.ui.entry import Entry, file_name
from game.ui.form import Form
from game.ui.hints import draw_hints
from game.ui.tokens import NIGHT0, TEXT
from game.ui.widgets import Word

_BOX: Final = pygame.Rect(420, 268, 440, 152)


class Naming:
    """Asks for a name, with a suggestion that can be taken as it is; then calls `on_name` with it and closes."""

    def __init__(self, below: Scene, question: str, suggestion: str, on_name: Callable[[str], None]) -> None:
        self._below, self._question, self._suggestion, self._on_name = below, question, suggestion, on_name

    def enter(self, context: Context) -> None:
        """Build the line and the two words."""
        self._context = context
        self._form = Form(context, on_back=Pop)
        manager = self._form.manager
        line = (_BOX.left + 32, _BOX.top + 52, _BOX.width - 64, 32)
        self._entry = self._form.add(
            Entry(manager, line, "", self._suggestion, self._done, on_cancel=Pop, fits=file_name)
        )
        y = _BOX.bottom - 48
        self._form.add(Word(manager, (_BOX.left + 32, y, 60, 28), texts.NAMING_KEEP, self._keep))
        self._form.add(Word(manager, (_BOX.left + 132, y, 70, 28), texts.NAMING_LEAVE, Pop))
        self._entry.begin()

    def exit(self) -> None:
        """Nothing is held."""

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Leave it to the form."""
        return self._form.handle_event(event)

    def update(self) -> Transition | None:
        """Let the form ease."""
        return self._form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the scene below, dimmed, and the question."""
        self._below.draw(canvas, 1.0)
        canvas.fill(canvas.surface.get_rect(), NIGHT0, 0.6)
        canvas.panel(_BOX, 0.96)
        canvas.text(self._question, (_BOX.left + 32, _BOX.top + 36), size=TEXT)
        self._form.draw(canvas)
        hints = [(self._context.controls.word(Command.CONFIRM), texts.NAMING_KEEP)]
        draw_hints(canvas, hints, (_BOX.left + 32, _BOX.bottom + 24))

    def _done(self, name: str) -> Transition:
        self._on_name(name)
        return Pop()

    def _keep(self) -> Transition:
        return self._done(self._entry.text)
