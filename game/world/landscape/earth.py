"""Picture of the distant Earth: day side, clouds and a thin bright atmosphere."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt
import pygame

from game.drawing.paint import PIECE, Picture, blocks, clouds, light
from game.drawing.paint_cache import Steps

_SUN: Final = np.array((0.80, 0.42, 0.43), np.float32)  # right, down, towards us
_WORK: Final = 4  # how much longer a pixel of it takes than one of the land


def paint_earth(radius: float, rng: np.random.Generator) -> Steps[tuple[pygame.Surface, pygame.Surface]]:
    """Paint the disc, with transparency, and the additive glow around it, to be drawn first."""
    half = int(radius * 1.06) + 2
    axis = (np.arange(4 * half, dtype=np.float32) + 0.5) / 2 - half  # twice as fine as it is drawn
    x, y = axis[None, :] / radius, axis[:, None] / radius
    beyond = np.hypot(x, y)
    z = np.sqrt(np.clip(1 - beyond**2, 0, 1))
    sun = _SUN / np.linalg.norm(_SUN)
    day = sun[0] * x + sun[1] * y + sun[2] * z
    # Noise is drawn flat and squeezed towards the limb, as a globe would.
    flat = yield from clouds(day.shape, rng, (4.2, 3.4), octaves=5)
    veil = yield from clouds(day.shape, rng, (9, 4.5), octaves=5, gain=0.62)
    side, picture = 2 * half, np.empty((*day.shape, 3), np.float32)
    for part in blocks(day.shape, PIECE // _WORK):
        on_globe = _globe(y[part], z[part], len(day)), _globe(x, z[part], len(day))
        picture[part] = _surface(y[part], z[part], day[part], flat[on_globe], veil[on_globe])
        yield _WORK * day[part].size
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
    soil = np.array((74, 104, 66), np.float32) + np.clip(land - 0.25, 0, 1)[..., None] * np.array(
        (150, 96, 30), np.float32
    )
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
