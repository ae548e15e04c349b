"""Error screen after a scene has failed: what happened, and the way back."""

from __future__ import annotations

from pathlib import Path

import pygame

from game.core import texts
from game.core.scene import Pop, Transition
from game.drawing.canvas import Canvas
from game.drawing.tokens import MARGIN, MUTE, NIGHT0, TITLE
from game.input.controls import Command, translate
from game.ui.context import Context


class ErrorScene:
    """Error screen over the menu; any confirmation returns to the menu."""

    def __init__(self, error: Exception, log: Path) -> None:
        self._reason = f"{type(error).__name__}: {error}"
        self._log = log

    def enter(self, context: Context) -> None:
        """Store the controls, which name the keys."""
        self._controls = context.controls

    def exit(self) -> None:
        """Do nothing: no resources to release."""

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Go back to the menu on any confirmation."""
        wants_back = translate(event) in (Command.CONFIRM, Command.BACK, Command.PAUSE)
        return Pop() if wants_back or event.type == pygame.MOUSEBUTTONDOWN else None

    def update(self) -> Transition | None:
        """Do nothing: the screen is static."""
        return None

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw what happened and what to do."""
        canvas.surface.fill(NIGHT0)
        canvas.text(texts.FAULT_TITLE, (MARGIN, 296), size=TITLE, weight="light")
        canvas.text(texts.FAULT_KEPT, (MARGIN, 336), colour=MUTE)
        canvas.text(self._reason[:140], (MARGIN, 368), colour=MUTE)
        canvas.text(texts.FAULT_LOG.format(path=self._log), (MARGIN, 392), colour=MUTE)
        canvas.text(texts.FAULT_BACK.format(key=self._controls.word(Command.CONFIRM)), (MARGIN, 440))
