"""The menu."""

from __future__ import annotations

import pygame

from game import texts
from game.context import Context
from game.scene import Transition
from game.ui.canvas import Canvas
from game.ui.tokens import NIGHT0


class Menu:
    """The first screen."""

    def enter(self, context: Context) -> None:
        """Become the top scene."""

    def exit(self) -> None:
        """Stop being the top scene."""

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Take one event."""
        return None

    def update(self) -> Transition | None:
        """Advance by a step."""
        return None

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the title."""
        canvas.surface.fill(NIGHT0)
        canvas.text(texts.GAME, (64, 200), size=72, weight="extralight")
