"""The sky before dawn: night, the glow of a sun still below the horizon, stars near and far, the Earth."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt
import pygame

from ai.environment import Doubles, Ints
from game.drawing.paint import PIECE, Picture, Sheet, bell, blocks, clouds, light, mix, ramp
from game.drawing.paint_cache import Steps
from game.drawing.tokens import DUSK, EMBER, NIGHT0, NIGHT1
from game.world.landscape.themes import HORIZON, Theme

# Where things stand, as shares of the page at the lower edge of the view, and across as shares of the view.
SUN: Final = (0.77, 0.835)
_BAND: Final = (0.30, -0.42, 0.085)  # the Milky Way: height at the left edge, slope, half width
_FINE: Final = 540  # lines in which gradients are computed; each of their pixels fills a square of the window's
_GLOW: Final = (232, 142, 90)
_CORE: Final = (255, 204, 138)
_SUNLIT: Final = np.array((0.80, 0.42, 0.43), np.float32)  # right, down, towards us
_EARTH_WORK: Final = 4  # how much longer a pixel of it takes than one of the land


def page_of(size: tuple[int, int]) -> tuple[int, int]:
    """Return the size of the page of 16:9 in a view of `size` pixels; beside it is more land, above it more sky."""
    width, height = size
    page = round(height * 16 / 9), round(width * 9 / 16)
    return tuple(part if part < whole - 2 else whole for part, whole in zip(page, size, strict=True))  # type: ignore[return-value]


def _top(size: tuple[int, int]) -> float:
    """Return the upper edge of a view of `size` pixels, as a share of the page's height: 0, or less for a high one."""
    return 1 - size[1] / page_of(size)[1]


def paint_sky(
    size: tuple[int, int], rng: np.random.Generator, look: Theme, *, stars: bool = True
) -> Steps[pygame.Surface]:
    """Paint the part of the sky that never moves: night, glow and, unless it is rough, faint `stars`."""
    times = max(2 if stars else 1, round(size[1] / _FINE))  # too smooth to need every pixel
    width, height = -(-size[0] // times), -(-size[1] // times)
    warm = mix(DUSK, EMBER, 0.14)
    top = _top(size)
    night = [(top, NIGHT0), (0.30, NIGHT0), (0.58, NIGHT1), (0.73, mix(NIGHT1, DUSK, 0.8))]
    column = ramp(height, [((share - top) / (1 - top), c) for share, c in (*night, (HORIZON, warm), (1.0, warm))])
    x, y = SUN[0] * width, (SUN[1] - top) / (1 - top) * height
    glows = [
        (strength * bell(height, y, up / (1 - top) * height)[:, None], bell(width, x, across * width), colour)
        for colour, strength, across, up in (
            (mix(DUSK, EMBER, 0.45), 0.34, 0.50, 0.28),
            (_GLOW, 0.50, 0.25, 0.155),
            (_CORE, 0.32, 0.12, 0.075),
        )
    ]
    dust = yield from clouds((height, width), rng, (5 * (1 - top), 9), octaves=4)
    places, light = _far_stars(size, rng)
    yield PIECE // 2
    sheet = Sheet(size[::-1], rng, clear=False)
    yield PIECE // 2
    for rows in blocks((height, width), PIECE // times):
        picture = [np.repeat(column[rows, k, None], width, axis=1) for k in range(3)]
        milky = _milky_way(dust[rows], np.linspace(top, 1, height, dtype=np.float32)[rows, None])
        lights = [(milky, (150, 165, 215)), *((up[rows] * across, colour) for up, across, colour in glows)]
        for glow, colour in lights:
            for number, hue in enumerate(colour):
                picture[number] += np.float32(hue) * glow
        sheet.put_larger(rows.start, look.on_sky(picture, np.linspace(0, 1 / HORIZON, height)[rows, None]), times)
        yield picture[0].size * times
    sky = sheet.done()
    if stars:
        pixels = pygame.surfarray.pixels3d(sky)
        pixels[places] = np.clip(pixels[places] + light * look.sky, 0, 255)
    return sky


def _milky_way(dust: Picture, rows: Picture) -> Picture:
    """Return a faint slanting band of unresolved light, 0 to about 0.1, in rows (k, 1) of the page."""
    columns = np.linspace(0, 1, dust.shape[1], dtype=np.float32)[None, :]
    start, slope, half = _BAND
    across = (rows - np.float32(start) - np.float32(slope) * (columns - np.float32(0.5))) / np.float32(half)
    band = np.exp(-((across + 0.7 * dust) ** 2)) * np.clip(0.55 + 0.8 * dust, 0, 1.2)
    lane = 1 - 0.6 * np.exp(-(((across + 0.1 + 1.1 * dust) / 0.28) ** 2))
    glow: Picture = 0.062 * band * lane * np.clip((HORIZON - rows) / 0.35, 0, 1)
    return glow


def _far_stars(size: tuple[int, int], rng: np.random.Generator) -> tuple[tuple[Ints, Ints], Doubles]:
    """Return the faint stars: single pixels (columns, rows), denser along the band, and their light (n, 3).

    The glow hides those near the horizon. None is bright enough to be read as a dot, so they stay behind text.
    """
    width, height = size
    top = _top(size)
    count = round(width * height / 640)
    across = rng.uniform(0, 1, count)
    spread = rng.uniform(-1, 1, count) * HORIZON
    start, slope, half = _BAND
    in_band = rng.random(count) < 0.4
    banded = start + slope * (across - 0.5) + half * 0.8 * rng.standard_normal(count)
    down = np.where(in_band, banded, top + np.abs(spread) * ((HORIZON - top) / HORIZON))
    seen = (down > top) & (down < HORIZON)
    rows = ((down[seen] - top) / (1 - top) * (height - 1)).astype(int)
    columns = (across[seen] * (width - 1)).astype(int)
    brightness = 52 * rng.random(seen.sum()) ** 2.7 * np.clip((HORIZON - 0.06 - down[seen]) / 0.3, 0, 1) + 3
    tint = 1 + 0.16 * rng.uniform(-1, 1, (seen.sum(), 1)) * np.array((1.0, 0.1, -1.0))
    return (columns, rows), brightness[:, None] * tint


class NearStars:
    """The brighter stars, which drift a little with the view; without air, they do not twinkle."""

    def __init__(self, size: tuple[int, int], rng: np.random.Generator) -> None:
        width, height = size[0], page_of(size)[1]
        count = round(130 * width * size[1] / math.prod(page_of(size)))
        place = rng.uniform((-0.03, _top(size) - 0.03), (1.03, HORIZON - 0.06), (count, 2)) * (width, height)
        size_of = rng.random(count) ** 2.6
        size_of *= np.clip((HORIZON - 0.05 - place[:, 1] / height) / 0.25, 0.15, 1)
        self._depth = 0.01 + 0.025 * size_of
        stars = [light(_star(kind, height / 720)) for kind in range(6)]
        self._stars = [stars[kind] for kind in np.round(size_of * 5).astype(int).tolist()]
        half = np.array([star.get_width() // 2 for star in self._stars])
        self._corner = place + np.array((0, size[1] - height)) - half[:, None]

    def draw(self, surface: pygame.Surface, shift: tuple[float, float]) -> None:
        """Add the stars to the sky; `shift` is how far the foreground and the horizon have moved, in pixels."""
        corners = np.rint(
            self._corner + np.stack([self._depth * shift[0], np.full(len(self._depth), shift[1])], axis=1)
        )
        surface.fblits(list(zip(self._stars, corners.tolist(), strict=True)), pygame.BLEND_RGB_ADD)


def _star(kind: int, unit: float) -> Picture:
    """Return a star of one of six sizes: a hot point, and round the larger ones a soft glow."""
    half = max(2, round((2 + 2.4 * kind) * unit))
    axis = np.arange(-half, half + 1, dtype=np.float32)
    distance = np.hypot(axis[:, None], axis[None, :])
    core = np.exp(-((distance / ((0.6 + 0.1 * kind) * max(unit, 1.0))) ** 2)) * (62 + 33 * kind)
    halo = np.clip(1 - distance / half, 0, 1) ** 2.4 * 8 * kind
    white: Picture = core[..., None] * np.array((1.0, 0.98, 0.95), np.float32)
    return white + halo[..., None] * np.array((0.66, 0.8, 1.1), np.float32)


def paint_earth(radius: float, rng: np.random.Generator) -> Steps[tuple[pygame.Surface, pygame.Surface]]:
    """Paint the disc, with transparency, and the additive glow around it, to be drawn first."""
    half = int(radius * 1.06) + 2
    axis = (np.arange(4 * half, dtype=np.float32) + 0.5) / 2 - half  # twice as fine as it is drawn
    x, y = axis[None, :] / radius, axis[:, None] / radius
    beyond = np.hypot(x, y)
    z = np.sqrt(np.clip(1 - beyond**2, 0, 1))
    sun = _SUNLIT / np.linalg.norm(_SUNLIT)
    day = sun[0] * x + sun[1] * y + sun[2] * z
    # Noise is drawn flat and squeezed towards the limb, as a globe would.
    flat = yield from clouds(day.shape, rng, (4.2, 3.4), octaves=5)
    veil = yield from clouds(day.shape, rng, (9, 4.5), octaves=5, gain=0.62)
    side, picture = 2 * half, np.empty((*day.shape, 3), np.float32)
    for part in blocks(day.shape, PIECE // _EARTH_WORK):
        on_globe = _globe(y[part], z[part], len(day)), _globe(x, z[part], len(day))
        picture[part] = _surface(y[part], z[part], day[part], flat[on_globe], veil[on_globe])
        yield _EARTH_WORK * day[part].size
    picture, cover = _halved(picture), _halved(np.clip((1 - beyond) * radius + 0.5, 0, 1))
    disc = pygame.Surface((side, side), pygame.SRCALPHA)
    pygame.surfarray.pixels3d(disc)[:] = np.clip(picture, 0, 255).astype(np.uint8).swapaxes(0, 1)
    pygame.surfarray.pixels_alpha(disc)[:] = np.round(255 * cover).astype(np.uint8).T
    yield PIECE
    return disc, _air(radius)


def _halved(picture: Picture) -> Picture:
    """Return a picture at half its resolution."""
    half: Picture = 0.25 * (picture[::2, ::2] + picture[1::2, ::2] + picture[::2, 1::2] + picture[1::2, 1::2])
    return half


def _surface(y: Picture, z: Picture, day: Picture, land: Picture, veil: Picture) -> Picture:
    shape = day.shape
    sea = np.array((20, 66, 138), np.float32)
    picture = np.broadcast_to(sea, (*shape, 3)).copy()
    shore = _step(land, 0.10, 0.16)[..., None]
    green, dry = np.array((74, 104, 66), np.float32), np.array((150, 96, 30), np.float32)
    soil = green + np.clip(land - 0.25, 0, 1)[..., None] * dry
    picture += shore * (soil - picture)
    shallow = (_step(land, -0.06, 0.12) * (1 - shore[..., 0]))[..., None]
    picture += 0.35 * shallow * (np.array((58, 132, 178), np.float32) - picture)
    white = _step(veil, 0.05, 0.62) + _step(np.abs(y), 0.84, 0.97) * 0.9
    picture += np.clip(white, 0, 0.94)[..., None] * (np.array((244, 248, 255), np.float32) - picture)
    lit = np.clip(day * 1.25 + 0.10, 0, 1) ** 0.85
    dusk = np.exp(-(((day - 0.02) / 0.09) ** 2))[..., None] * np.array((38, 14, 0), np.float32)
    limb = np.clip(1 - z, 0, 1) ** 2.6
    picture = picture * lit[..., None] + dusk * 0.7
    picture += (limb * np.clip(day + 0.25, 0, 1))[..., None] * np.array((88, 150, 230), np.float32)
    lifted: Picture = picture + np.array((5, 8, 17), np.float32)
    return lifted


def _globe(across: Picture, z: Picture, length: int) -> npt.NDArray[np.intp]:
    turned = np.arctan2(np.broadcast_to(across, z.shape), z + 1e-3) / np.pi + 0.5
    place: npt.NDArray[np.intp] = np.clip(turned * length, 0, length - 1).astype(np.intp)
    return place


def _step(value: Picture, low: float, high: float) -> Picture:
    t = np.clip((value - low) / (high - low), 0, 1)
    eased: Picture = t * t * (3 - 2 * t)
    return eased


def _air(radius: float) -> pygame.Surface:
    half = int(radius * 2.6)
    axis = np.arange(-half, half + 1, dtype=np.float32) / radius
    x, y = axis[None, :], axis[:, None]
    distance = np.hypot(x, y)
    side = 0.5 + 0.5 * (x * 0.80 + y * 0.42) / np.maximum(distance, 0.3)
    fall = np.clip(1 - (distance - 1) / 1.6, 0, 1)
    fall = 0.62 * fall**3.4 + 0.5 * np.exp(-np.clip(distance - 1, 0, 9) / 0.055)
    glow = np.clip(np.where(distance < 1, 0.55, fall) * (0.22 + 0.78 * side), 0, 1)
    return light(glow[..., None] * np.array((52, 96, 168), np.float32))
