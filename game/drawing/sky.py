"""Background of screens without a world: a night sky with a glow at the bottom, and stars away from the words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from itertools import product
from typing import Final

import numpy as np
import pygame

from ai.common.environment import Bools, Doubles
from game.drawing.canvas import Canvas
from game.drawing.paint import PIECE, Sheet, blocks
from game.drawing.tokens import DUSK, EMBER, NIGHT0, NIGHT1, VIEW_SIZE

_FINE: Final = 270  # lines in which the night is computed; each of their pixels fills a square of the window's


class NightSky:
    """Still night sky, repainted only when the window's size changes, or when words appear or vanish over a star."""

    def __init__(self, rng: np.random.Generator, ember: float = 1.0, stars: int = 260) -> None:
        self._page = rng.random((stars, 2)) * VIEW_SIZE
        self._places = self._page  # and again beside or above and below the page, where the view reaches beyond it
        self._brightness = rng.random(stars) ** 4
        self._ember = ember
        self._painted: pygame.Surface | None = None
        self._shown: list[int] = []
        self._words: list[pygame.Rect] = []  # that the painted stars avoid

    def draw(self, canvas: Canvas, time: float = 0.0) -> None:  # noqa: ARG002
        """Draw the sky over the whole view. It does not change with time."""
        canvas = canvas.whole
        size, shown = canvas.surface.get_size(), self._shown
        fits = self._painted is not None and self._painted.get_size() == size
        if not fits:
            self._places = _spread(self._page, canvas.view)
        if not fits or canvas.words != self._words:
            self._words = canvas.words
            pixels = self._places * canvas.scale + canvas.origin
            shown = np.flatnonzero(beside(pixels, canvas.words)).tolist()
        if self._painted is None or not fits or shown != self._shown:
            self._painted, self._shown = _paint_night(size, self._ember).copy(), shown
            canvas.surface.blit(self._painted, (0, 0))
            self._add_stars(canvas)
            self._painted.blit(canvas.surface, (0, 0))
        canvas.surface.blit(self._painted, (0, 0))

    def _add_stars(self, canvas: Canvas) -> None:
        bright = self._brightness[np.array(self._shown, np.intp) % len(self._brightness)]
        for (x, y), brightness in zip(self._places[self._shown], bright, strict=True):
            fade = min(max(float(1 - (y - canvas.view.top) / canvas.view.height), 0.0), 1.0)
            level = (0.25 + 0.75 * float(brightness)) * fade
            shade = 120 + round(120 * float(brightness))
            canvas.dot((x, y), 0.5 + 0.7 * float(brightness), (shade, shade, min(255, shade + 12)), level)
            if brightness > 0.75:
                canvas.glow((x, y), 9, (150, 170, 220), 0.35 * level)


def _spread(places: Doubles, view: pygame.FRect) -> Doubles:
    """Return the places of stars on a page, (n, 2), and copies of it side by side as far as the view reaches.

    Those of the page come first, and every copy has as many, in the same order.
    """
    across, down = (math.ceil(-start / length) for start, length in zip(view.topleft, VIEW_SIZE, strict=True))
    pages = sorted(product(range(-across, across + 1), range(-down, down + 1)), key=lambda page: page != (0, 0))
    return np.concatenate([places + np.multiply(page, VIEW_SIZE) for page in pages])


@lru_cache(maxsize=4)
def _paint_night(size: tuple[int, int], ember: float) -> pygame.Surface:
    """Return a sky without stars, cached for all screens with the same one."""
    times = max(2, size[1] // _FINE)  # too smooth to need every pixel
    width, height = -(-size[0] // times), -(-size[1] // times)
    across = np.linspace(0, 1, width, dtype=np.float32)[None, :]
    down = np.linspace(0, 1, height, dtype=np.float32)[:, None]
    low = ember * 0.6 * np.clip((down - 0.55) / 0.45, 0, 1) ** 2
    away = np.hypot((across - 0.78) * 1.5, (down - 1.06) * 1.9)
    near = ember * 0.55 * np.clip(1 - away, 0, 1) ** 2.2
    channels = []
    for night0, night1, dusk, glow in zip(NIGHT0, NIGHT1, DUSK, EMBER, strict=True):
        sky = night0 + (night1 - night0) * down
        sky = sky + (dusk - sky) * low
        channels.append(sky + (glow - sky) * near - np.float32(0.5))
    sheet = Sheet(size[::-1], np.random.default_rng(0), clear=False)
    for rows in blocks((height, width), PIECE // times):
        sheet.put_larger(rows.start, [channel[rows] for channel in channels], times)
    return sheet.done()


def beside(places: Doubles, boxes: Sequence[pygame.Rect]) -> Bools:
    """Return a mask (n,) of the places (n, 2) that lie in none of the boxes."""
    edges = np.array([(box.left, box.top, box.right, box.bottom) for box in boxes]).reshape(-1, 4)
    past, beyond = places[:, None] >= edges[:, :2], places[:, None] >= edges[:, 2:]
    outside: Bools = ~np.logical_and.reduce(past & ~beyond, axis=2)
    free: Bools = np.logical_and.reduce(outside, axis=1)
    return free
