"""Blurred picture of a scene, for the screens that open over one which stands still."""

from __future__ import annotations

import pygame

from game.core.scene import Scene
from game.drawing.canvas import Canvas
from game.drawing.tokens import NIGHT0


class BlurredPicture:
    """Blurred picture of a scene, `dimmed` by a share; painted once per window size, then copied."""

    def __init__(self, below: Scene, dimmed: float = 0.5) -> None:
        self._below, self._dimmed = below, dimmed
        self._picture: pygame.Surface | None = None

    def draw(self, canvas: Canvas) -> None:
        """Draw the picture over the whole window."""
        whole = canvas.whole
        if self._picture is None or self._picture.get_size() != whole.surface.get_size():
            self._picture = self._paint(whole)
        whole.surface.blit(self._picture, (0, 0))

    def _paint(self, canvas: Canvas) -> pygame.Surface:
        self._below.draw_on(canvas, 1.0)
        width, height = canvas.surface.get_size()
        small = pygame.transform.smoothscale(canvas.surface, (max(1, width // 4), max(1, height // 4)))
        soft = pygame.transform.gaussian_blur(small, max(1, canvas.px(3)))
        canvas.surface.blit(pygame.transform.smoothscale(soft, (width, height)), (0, 0))
        canvas.fill(canvas.surface.get_rect(), NIGHT0, self._dimmed)
        return canvas.surface.copy()
