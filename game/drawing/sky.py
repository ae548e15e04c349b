"""Background of screens without a world: a night sky with a glow at the bottom, and stars."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache, partial
from itertools import product
from typing import Final, NamedTuple

import numpy as np
import pygame

from ai.environment import Doubles
from game.drawing.canvas import Canvas, Stamp
from game.drawing.paint import PIECE, Sheet, blocks
from game.drawing.paint_cache import InPieces, Steps
from game.drawing.tokens import DUSK, EMBER, NIGHT0, NIGHT1, VIEW_SIZE

_FINE: Final = 270  # lines in which the night is computed; each of their pixels fills a square of the window's
_GLOW: Final = (150, 170, 220)  # of a bright star


class NightSky:
    """Still night sky. Its picture without stars is shared by all screens with the same glow."""

    def __init__(self, rng: np.random.Generator, ember: float = 1.0, stars: int = 260) -> None:
        self._page = rng.random((stars, 2)) * VIEW_SIZE
        self._brightness = rng.random(stars) ** 4
        self._ember = ember
        self._size = (0, 0)  # of the window for which the stars were painted, in pixels
        self._stars: list[_Star]

    def draw(self, canvas: Canvas) -> None:
        """Draw the sky over the whole view."""
        canvas = canvas.whole
        surface, size = canvas.surface, canvas.surface.get_size()
        if size != self._size:
            self._size = size
            places = _spread(self._page, canvas.view).tolist()
            self._stars = [self._star(canvas, number, place) for number, place in enumerate(places)]
        surface.blit(_night(size, self._ember).picture, (0, 0))
        surface.fblits([star.dot for star in self._stars])
        surface.fblits([star.glow for star in self._stars if star.glow], pygame.BLEND_RGB_ADD)

    def _star(self, canvas: Canvas, number: int, place: Sequence[float]) -> _Star:
        """Paint the star of a number at a place in points; it fades towards the horizon."""
        x, y = place
        brightness = float(self._brightness[number % len(self._brightness)])
        fade = min(max(1 - (y - canvas.view.top) / canvas.view.height, 0.0), 1.0)
        level = (0.25 + 0.75 * brightness) * fade
        shade = 120 + round(120 * brightness)
        picture, corner = canvas.stamp("circle", (x, y), 0.5 + 0.7 * brightness, (shade, shade, min(255, shade + 12)))
        dot = picture.copy()
        dot.set_alpha(255)  # others may have drawn it faintly
        dot.fill((255, 255, 255, round(255 * level)), special_flags=pygame.BLEND_RGBA_MULT)
        return _Star((dot, corner), canvas.light((x, y), 9, _GLOW, 0.35 * level) if brightness > 0.75 else None)


class _Star(NamedTuple):
    """A star's dot, and if it is bright its glow, each with the corner where it is drawn, in pixels."""

    dot: Stamp
    glow: Stamp | None


def _spread(places: Doubles, view: pygame.FRect) -> Doubles:
    """Return the places of stars on a page, (n, 2), and copies of it side by side as far as the view reaches.

    Those of the page come first, and every copy has as many, in the same order.
    """
    across, down = (math.ceil(-start / length) for start, length in zip(view.topleft, VIEW_SIZE, strict=True))
    pages = sorted(product(range(-across, across + 1), range(-down, down + 1)), key=lambda page: page != (0, 0))
    return np.concatenate([places + np.multiply(page, VIEW_SIZE) for page in pages])


@lru_cache(maxsize=4)
def _night(size: tuple[int, int], ember: float) -> InPieces[pygame.Surface]:
    """Return a sky without stars, kept for all screens with the same one."""
    return InPieces(partial(_paint_night, size, ember))


def _paint_night(size: tuple[int, int], ember: float, share: float) -> Steps[pygame.Surface]:
    """Paint a sky without stars, of so many pixels, at a share of its resolution."""
    times = max(2, size[1] // round(_FINE * share))  # too smooth to need every pixel
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
        channels.append(sky + (glow - sky) * near)
    yield width * height
    if share < 1:  # without the noise that hides the borders of its shades
        rough = pygame.surfarray.make_surface(np.stack(channels, axis=-1).swapaxes(0, 1).astype(np.uint8))
        return pygame.transform.scale(rough.convert(32), size)
    sheet = Sheet(size[::-1], np.random.default_rng(0), clear=False)
    for rows in blocks((height, width), PIECE // times):
        sheet.put_larger(rows.start, [channel[rows] - np.float32(0.5) for channel in channels], times)
        yield channels[0][rows].size * times
    return sheet.done()
