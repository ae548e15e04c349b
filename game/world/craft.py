"""Drawing of landers: one in full with its flame, or a crowd in one call."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import pygame

from ai.environment import Doubles
from ai.lander.environment import PARAMS
from ai.lander.rules import FOOT_CENTRE, FOOT_SIZE
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import HUMAN, NET
from game.world import lander as art
from game.world.camera import View
from game.world.flame import HUMAN_PLUME, JET, NET_PLUME, Plume, plume, plumes

STAND: Final = PARAMS.stand
_FIRELIGHT: Final = 0.35  # light that a craft's own flame adds by night


def draw_craft(
    canvas: Canvas,
    view: View,
    image: str,
    pose: Doubles,
    thrust: Doubles,
    blue: float,
    flicker: int,
    size: float = 1.0,
    floor: float = math.inf,
    light: float = 1.0,
) -> None:
    """Draw a lander by its image key, and its fire, which ends at the pixel row `floor`.

    `light`, 0 to 1, is the ambient light on it; `size` 1 is true to scale. A smaller lander still stands on its feet.
    """
    surface = canvas.surface
    x, y, angle = pose.tolist()
    metre = view.pixels_per_metre * size
    middle_x, middle_y = view.pixel(*stand(x, y, angle, size))
    cos, sin = math.cos(angle), math.sin(angle)

    def place(right: float, up: float) -> tuple[float, float]:
        return middle_x + metre * (right * cos - up * sin), middle_y - metre * (right * sin + up * cos)

    main, *jets = thrust.tolist()
    fire = mix(HUMAN, NET, round(blue * 4) / 4)
    if main > 0.06:
        nozzle = place(*art.NOZZLE)
        heart = place(art.NOZZLE[0], art.NOZZLE[1] - 0.35)
        scale = canvas.scale
        canvas.glow(canvas.points(heart), 2.3 * metre / scale, fire, 0.42 * main)
        fire_kind = NET_PLUME if blue > 0.5 else HUMAN_PLUME
        _burn(surface, fire_kind, metre, angle, main, flicker // 2, nozzle, floor)
    craft, corner = art.turned(image, view.painted_per_metre * size, angle, (middle_x, middle_y), scaling(view))
    surface.blit(shaded(craft, light + _FIRELIGHT * max(main, *jets)), corner)
    for side, force in enumerate(jets):
        if force > 0.06:
            outward = angle + (math.pi / 2 if side else -math.pi / 2)
            _burn(surface, JET, metre, outward, force, flicker // 2 + side, place(*art.JETS[side]), floor)
    tip = canvas.points(place(*art.ANTENNA_TIP))
    owner = mix(HUMAN, NET, round(blue * 8) / 8)
    canvas.glow(tip, 0.45 * metre / canvas.scale, owner, 1.0)
    canvas.dot(tip, max(1.0, 0.07 * metre / canvas.scale), mix(owner, (255, 255, 255), 0.35))


def draw_fires(canvas: Canvas, view: View, poses: Doubles, flicker: int, size: float) -> None:
    """Draw the main engines' flames of landers at poses (n, 3), small and in one call."""
    if not len(poses):
        return
    angle = poses[:, 2]
    nozzles = _middles(poses, size)
    nozzles += size * art.NOZZLE[1] * np.stack([-np.sin(angle), np.cos(angle)], axis=1)
    fires = plumes(NET_PLUME, view.pixels_per_metre * size, angle, view.pixels(nozzles), flicker // 2)
    canvas.surface.fblits(fires, pygame.BLEND_RGB_ADD)


def draw_crowd(canvas: Canvas, view: View, poses: Doubles, size: float) -> None:
    """Draw landers at poses (n, 3), small and in one call, each standing on its feet."""
    if not len(poses):  # beside a single lander, whose camera zooms: a new picture in every frame, for none
        return
    middles = view.pixels(_middles(poses, size))
    canvas.surface.fblits(art.sprites(view.pixels_per_metre * size, poses[:, 2], middles))


def stand(x: float, y: float, angle: float, size: float) -> tuple[float, float]:
    """Return the middle at which to draw a lander of that size so that its feet stay in place."""
    lower = STAND * (1 - size)
    return x + lower * math.sin(angle), y - lower * math.cos(angle)


def foot_place(x: float, y: float, angle: float, side: int) -> tuple[float, float]:
    """Return the position of the sole of a foot; `side` is -1 for the left foot, 1 for the right."""
    aside, down = side * FOOT_CENTRE[0], FOOT_CENTRE[1] - FOOT_SIZE[1] / 2
    cos, sin = math.cos(angle), math.sin(angle)
    return x + aside * cos - down * sin, y + aside * sin + down * cos


def _middles(poses: Doubles, size: float) -> Doubles:
    """Apply `stand` to poses (n, 3); return positions (n, 2)."""
    lower = STAND * (1 - size)
    angle = poses[:, 2]
    middles: Doubles = poses[:, :2] + lower * np.stack([np.sin(angle), -np.cos(angle)], axis=1)
    return middles


def _burn(
    surface: pygame.Surface,
    kind: Plume,
    metre: float,
    angle: float,
    thrust: float,
    flicker: int,
    nozzle: tuple[float, float],
    floor: float,
) -> None:
    fire = plume(kind, metre, angle, thrust, flicker)
    if fire:
        sheet, (x, y) = fire
        left, top = round(nozzle[0] - x), round(nozzle[1] - y)
        height = min(sheet.get_height(), max(0.0, floor - top))
        surface.blit(sheet, (left, top), (0, 0, sheet.get_width(), height), pygame.BLEND_RGB_ADD)


def shaded(picture: pygame.Surface, light: float) -> pygame.Surface:
    """Return a picture darkened to `light`, 0 to 1."""
    if light >= 1:
        return picture
    dark = picture.copy()
    dark.fill([round(255 * light)] * 3, special_flags=pygame.BLEND_RGB_MULT)
    return dark


def scaling(view: View) -> float:
    """Return the factor that scales a picture painted for the closest view to this one."""
    return view.pixels_per_metre / view.painted_per_metre
