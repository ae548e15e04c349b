"""Background of screens without a world: a night sky with a glow at the bottom, and stars."""

from __future__ import annotations

from functools import lru_cache, partial
from typing import Final

import numpy as np
import pygame

from game.drawing.canvas import Canvas, Stamp
from game.drawing.paint import PIECE, Sheet, blocks
from game.drawing.paint_cache import InPieces, Steps
from game.drawing.tokens import DUSK, EMBER, NIGHT0, NIGHT1

_STARS: Final = 70
_FINE: Final = 270  # lines in which the night is computed; each of their pixels fills a square of the window's
_GLOW: Final = (150, 170, 220)  # of a bright star


class NightSky:
    """Still night sky. Its picture without stars is shared by all screens."""

    def __init__(self, rng: np.random.Generator) -> None:
        self._places, self._brightness = rng.random((_STARS, 2)), rng.random(_STARS) ** 4
        self._size = (0, 0)  # of the window for which the stars were painted, in pixels
        self._dots: list[Stamp] = []
        self._glows: list[Stamp] = []

    def draw(self, canvas: Canvas, clear: pygame.FRect) -> None:
        """Draw the sky over the whole view, without stars in a box that is clear for words."""
        words, canvas = canvas.rect(*clear), canvas.whole
        surface, size = canvas.surface, canvas.surface.get_size()
        if size != self._size:
            self._size, self._dots, self._glows = size, [], []
            for place, brightness in zip(self._places.tolist(), self._brightness.tolist(), strict=True):
                self._paint(canvas, place, brightness)
        night = _night(size).picture
        surface.blit(night, (0, 0))
        surface.fblits(self._dots)
        surface.fblits(self._glows, pygame.BLEND_RGB_ADD)
        surface.blit(night, words, words)

    def _paint(self, canvas: Canvas, place: tuple[float, float], brightness: float) -> None:
        """Paint a star at a place in shares of the view; it fades towards the horizon, and a bright one glows."""
        view, level = canvas.view, (0.25 + 0.75 * brightness) * (1 - place[1])
        centre = view.left + place[0] * view.width, view.top + place[1] * view.height
        shade = 120 + round(120 * brightness)
        picture, corner = canvas.stamp("circle", centre, 0.5 + 0.7 * brightness, (shade, shade, min(255, shade + 12)))
        dot = picture.copy()
        dot.set_alpha(255)  # others may have drawn it faintly
        dot.fill((255, 255, 255, round(255 * level)), special_flags=pygame.BLEND_RGBA_MULT)
        self._dots.append((dot, corner))
        if brightness > 0.75 and (glow := canvas.light(centre, 9, _GLOW, 0.35 * level)):
            self._glows.append(glow)


@lru_cache(maxsize=4)
def _night(size: tuple[int, int]) -> InPieces[pygame.Surface]:
    """Return a sky without stars, kept for all screens."""
    return InPieces(partial(_paint_night, size))


def _paint_night(size: tuple[int, int], share: float) -> Steps[pygame.Surface]:
    """Paint a sky without stars, of so many pixels, at a share of its resolution."""
    times = max(2, size[1] // round(_FINE * share))  # too smooth to need every pixel
    width, height = -(-size[0] // times), -(-size[1] // times)
    across = np.linspace(0, 1, width, dtype=np.float32)[None, :]
    down = np.linspace(0, 1, height, dtype=np.float32)[:, None]
    low = 0.3 * np.clip((down - 0.55) / 0.45, 0, 1) ** 2
    away = np.hypot((across - 0.78) * 1.5, (down - 1.06) * 1.9)
    near = 0.275 * np.clip(1 - away, 0, 1) ** 2.2
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
