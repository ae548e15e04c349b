"""Picture of a scene that stands still, for the screens that open over it."""

from __future__ import annotations

import pygame

from game.core import texts
from game.core.scene import Scene
from game.drawing.canvas import Canvas
from game.drawing.tokens import NIGHT0


class StillPicture:
    """Picture of a scene, `dimmed` by a share, and blurred unless `sharp`; painted once a window size and language."""

    def __init__(self, below: Scene, dimmed: float = 0.5, *, sharp: bool = False) -> None:
        self._below, self._dimmed, self._sharp = below, dimmed, sharp
        self._picture: pygame.Surface | None = None
        self._language = texts.LANGUAGE

    def draw(self, canvas: Canvas) -> None:
        whole = canvas.whole
        size, language = whole.surface.get_size(), texts.LANGUAGE
        if self._picture is None or (self._picture.get_size(), self._language) != (size, language):
            self._picture, self._language = self._paint(whole), language
        else:
            whole.surface.blit(self._picture, (0, 0))

    def _paint(self, canvas: Canvas) -> pygame.Surface:
        self._below.draw_on(canvas, 1.0)
        if not self._sharp:
            width, height = canvas.surface.get_size()
            # What a Gaussian takes grows with the fourth power of the resolution.
            small = pygame.transform.smoothscale(canvas.surface, (max(1, width // 8), max(1, height // 8)))
            soft = pygame.transform.gaussian_blur(small, max(1, canvas.px(1.5)))
            pygame.transform.smoothscale(soft, (width, height), canvas.surface)
        canvas.fill(canvas.surface.get_rect(), NIGHT0, self._dimmed)
        return canvas.surface.copy()
