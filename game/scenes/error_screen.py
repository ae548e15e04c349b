"""Error screen after a scene has failed: what happened, and the way back."""

from __future__ import annotations

from pathlib import Path

import pygame

from game.core import texts
from game.core.scene import Replace, Route, Scene, Transition
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import INK, MARGIN, MUTE, NIGHT0, TITLE
from game.input.controls import Command, translate
from game.ui.context import Context


class ErrorScene(Scene):
    """Error screen in place of all scenes; any confirmation leads to the menu."""

    def __init__(self, context: Context, error: Exception, log: Path) -> None:
        super().__init__(context)
        self._reason = f"{type(error).__name__}: {error}"
        self._log = log

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Go to the menu on any confirmation."""
        wants_back = translate(event) in (Command.CONFIRM, Command.BACK, Command.PAUSE)
        return Replace(Route("menu")) if wants_back or event.type == pygame.MOUSEBUTTONDOWN else None

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw what happened and what to do."""
        canvas.surface.fill(NIGHT0)
        view, margin = canvas.view, min(MARGIN, 0.05 * canvas.view.width)
        words = Cursor(margin, 0.37 * view.height, view.width - 2 * margin, canvas.scale, canvas, colour=MUTE)
        words.styled(texts.ERROR_TITLE, TITLE, INK, "light")
        for each in (texts.ERROR_KEPT, self._reason[:140], texts.ERROR_LOG.format(path=self._log)):
            words.gap()
            words.text(each)
        words.gap(24)
        words.styled(texts.ERROR_BACK.format(key=self.context.controls.word(Command.CONFIRM)), colour=INK)
