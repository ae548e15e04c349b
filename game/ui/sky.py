"""The ground of screens that show no world: night above, a last ember below, stars."""

from __future__ import annotations

import numpy as np
import pygame

from game.ui.canvas import Canvas
from game.ui.tokens import DUSK, EMBER, NIGHT0, NIGHT1, VIEW_SIZE


class NightSky:
    """A still sky, painted once per window size."""

    def __init__(self, rng: np.random.Generator, ember: float = 1.0, stars: int = 260) -> None:
        self._places = rng.random((stars, 2)) * VIEW_SIZE
        self._brightness = rng.random(stars) ** 4
        self._ember = ember
        self._painted: pygame.Surface | None = None

    def draw(self, canvas: Canvas, time: float = 0.0) -> None:  # noqa: ARG002
        """Draw the sky over the whole view. It does not change with time."""
        if self._painted is None or self._painted.get_size() != canvas.surface.get_size():
            self._painted = self._paint(canvas.surface.get_size())
            canvas.surface.blit(self._painted, (0, 0))
            self._add_stars(canvas)
            self._painted.blit(canvas.surface, (0, 0))
        canvas.surface.blit(self._painted, (0, 0))

    def _paint(self, size: tuple[int, int]) -> pygame.Surface:
        across, down = np.linspace(0, 1, size[0])[:, None, None], np.linspace(0, 1, size[1])[None, :, None]
        night0, night1, dusk, ember = (np.array(colour, float) for colour in (NIGHT0, NIGHT1, DUSK, EMBER))
        sky = night0 + (night1 - night0) * down
        sky = sky + (dusk - sky) * self._ember * 0.6 * np.clip((down - 0.55) / 0.45, 0, 1) ** 2
        away = np.hypot((across - 0.78) * 1.5, (down - 1.06) * 1.9)
        sky = sky + (ember - sky) * self._ember * 0.55 * np.clip(1 - away, 0, 1) ** 2.2
        # A little noise keeps the long gradient from showing bands.
        noise = np.random.default_rng(0).random((size[0], size[1], 1)) - 0.5
        return pygame.surfarray.make_surface(np.clip(sky + noise, 0, 255).astype(np.uint8)).convert()

    def _add_stars(self, canvas: Canvas) -> None:
        for (x, y), brightness in zip(self._places, self._brightness, strict=True):
            fade = float(1 - y / VIEW_SIZE[1])
            level = (0.25 + 0.75 * float(brightness)) * fade
            shade = 120 + round(120 * float(brightness))
            canvas.dot((x, y), 0.5 + 0.7 * float(brightness), (shade, shade, min(255, shade + 12)), level)
            if brightness > 0.75:
                canvas.glow((x, y), 9, (150, 170, 220), 0.35 * level)
