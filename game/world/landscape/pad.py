"""Drawing of the landing pad: a deck on the regolith, its lamps, and the light they cast."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Final

import numpy as np
import pygame

from ai.lander.environment import PARAMS
from game.drawing.canvas import Canvas
from game.drawing.paint import light, mix
from game.drawing.tokens import INK, NIGHT0, NIGHT1, Colour
from game.world.camera import View
from game.world.landscape.sheet import WorldPicture

_FINEST: Final = 256  # pixels per metre in which a pad is painted before it is scaled down, at most
_BACK: Final = 0.20  # metres by which the deck's far edge appears above its near one
_LAMP: Final = 0.20  # height of a lamp above the deck
_MARGIN: Final = 0.6
_SOFT: Final = 0.25  # resolution at which light without edges is painted
_DASH_X, _DASH_Y = (-0.14, 0.14, 0.14, -0.14), (-0.185, -0.185, -0.245, -0.245)  # metres, of a dash below the edge
_BLUR: Final = 0.03  # relative error that its width may have


def draw_pad(
    canvas: Canvas, view: View, centre: tuple[float, float], width: float, floor: float = PARAMS.ground
) -> None:
    """Draw a pad whose top has its middle at `centre` and that stands on `floor`."""
    colour = canvas.palette.good
    x, top = centre
    deck, corner = _paint(view.painted_per_metre, width, round(top - floor, 2), colour)
    pool, reach = _pool(_SOFT * view.painted_per_metre, width, colour)
    pool.draw(canvas.surface, view, (x - reach[0], floor - 0.05 + reach[1]), pygame.BLEND_RGB_ADD)
    deck.draw(canvas.surface, view, (x + corner[0], top + corner[1]))
    for side in (-1, 1):
        lamp = view.point(centre[0] + side * (width / 2 - 0.08), centre[1] + _LAMP)
        metre = view.pixels_per_metre / view.scale
        canvas.glow(lamp, 0.95 * metre, colour, 0.7)
        canvas.glow(lamp, 0.34 * metre, colour, 1.0)
        canvas.dot(lamp, 0.085 * metre, mix(colour, (255, 255, 255), 0.45))


@lru_cache(maxsize=8)
def _paint(
    pixels_per_metre: float, width: float, height: float, colour: Colour
) -> tuple[WorldPicture, tuple[float, float]]:
    """Return the picture of a pad `height` metres high, and its corner relative to the middle of its top, in metres."""
    factor = max(2, min(4, int(_FINEST / pixels_per_metre)))
    scale = pixels_per_metre * factor
    half = math.ceil((width / 2 + _MARGIN) * pixels_per_metre)
    above, below = math.ceil(_MARGIN * pixels_per_metre), math.ceil((height + 0.25) * pixels_per_metre)
    sheet = pygame.Surface((2 * half * factor, (above + below) * factor), pygame.SRCALPHA)
    sheet.fill((*NIGHT1, 0))

    def place(x: float, y: float) -> tuple[float, float]:
        return half * factor + x * scale, above * factor - y * scale

    def quad(colour: Colour, *corners: tuple[float, float]) -> None:
        pygame.draw.polygon(sheet, colour, [place(x, y) for x, y in corners])

    edge, inset = width / 2, width / 2 - 0.42
    lip = 0.13
    quad(mix(NIGHT0, NIGHT1, 0.5), (-inset, -lip), (inset, -lip), (inset + 0.25, -height), (-inset - 0.25, -height))
    quad((30, 36, 58), (-inset, -lip), (inset, -lip), (inset + 0.06, -0.30), (-inset - 0.06, -0.30))
    for middle in (np.linspace(-0.9, 0.9, 10) * inset).tolist():
        quad(mix(NIGHT1, colour, 0.55), *((middle + x, y) for y, x in zip(_DASH_Y, _DASH_X, strict=True)))
    for foot in np.linspace(-inset + 0.1, inset - 0.1, 6).tolist():
        quad((40, 46, 68), (foot - 0.05, -0.30), (foot + 0.05, -0.30), (foot + 0.05, -height), (foot - 0.05, -height))
    quad((54, 58, 80), (-edge, 0.0), (edge, 0.0), (edge - 0.34, _BACK), (-edge + 0.34, _BACK))
    quad((72, 76, 98), (-0.9, 0.0), (0.9, 0.0), (0.78, _BACK), (-0.78, _BACK))
    quad((54, 58, 80), (-0.62, 0.02), (0.62, 0.02), (0.54, _BACK - 0.03), (-0.54, _BACK - 0.03))
    quad((84, 80, 96), (-edge, 0.0), (edge, 0.0), (edge - 0.06, -lip), (-edge + 0.06, -lip))
    quad((176, 160, 150), (0.2 * edge, 0.0), (edge, 0.0), (edge - 0.06, -lip), (0.6 * edge, -lip))
    quad(INK, (-edge, 0.03), (edge, 0.03), (edge, -0.035), (-edge, -0.035))
    for side in (-1, 1):
        x = side * (edge - 0.08)
        quad((150, 158, 178), (x - 0.035, 0.0), (x + 0.035, 0.0), (x + 0.035, _LAMP), (x - 0.035, _LAMP))
    picture = pygame.transform.smoothscale(sheet, (2 * half, above + below))
    return WorldPicture(picture, pixels_per_metre), (-half / pixels_per_metre, above / pixels_per_metre)


@lru_cache(maxsize=8)
def _pool(pixels_per_metre: float, width: float, colour: Colour) -> tuple[WorldPicture, tuple[float, float]]:
    """Return the lamps' light on the regolith around the pad, and half its width and height in metres."""
    half_width, half_height = (width / 2 + 2.6) * pixels_per_metre, 0.75 * pixels_per_metre
    x = np.arange(-half_width, half_width, dtype=np.float32)[None, :] / pixels_per_metre
    y = np.arange(-half_height, half_height, dtype=np.float32)[:, None] / half_height
    shine = sum(np.exp(-(((x - side * width / 2) / 1.25) ** 2) - (y / 0.42) ** 2) for side in (-1, 1))
    fade = np.clip(1 - np.abs(y), 0, 1) * np.clip(1 - np.abs(x) / (width / 2 + 2.6), 0, 1)
    picture = light((0.30 * shine * fade)[..., None] * np.array(colour, np.float32))
    reach = half_width / pixels_per_metre, half_height / pixels_per_metre
    return WorldPicture(picture, pixels_per_metre, _BLUR), reach
