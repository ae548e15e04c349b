"""Glyphs for gamepad and mouse buttons: private-use characters that any text can contain.

Each is one character of Unicode's private use area, so a sign can stand in a hint as well as in a sentence, and is
measured, drawn and kept like any other letter.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

import pygame

from game.drawing.marks import MARKS
from game.drawing.tokens import Colour
from game.input.signs import FAMILIES, FAMILY, FIRST, SIGNS

_LAST: Final = FIRST + len(FAMILIES) * FAMILY - 1
SIGN: Final = re.compile(f"([{chr(FIRST)}-{chr(_LAST)}])")

# Lengths, as multiples of the type size: half a sign's height, its middle above the baseline, the room beside it.
_RADIUS: Final = 0.66
_MIDDLE: Final = 0.36
_BESIDE: Final = 0.07
_STROKE: Final = 0.085
_WIDE: Final = 1.9


def sign_width(character: str, size: float) -> float:
    """Return a sign's width in pixels, with the room beside it, at a type size in pixels."""
    return size * ((_WIDE if _sign(character)[0] == "wide" else 2 * _RADIUS) + 2 * _BESIDE)


def draw_sign(
    surface: pygame.Surface,
    character: str,
    start: tuple[float, float],
    size: float,
    colour: Colour,
    write: Callable[[str, float], pygame.Surface],
) -> None:
    """Draw a sign with its left end at a point of the baseline; `write` renders letters of a size to a surface."""
    frame, mark = _sign(character)
    width = sign_width(character, size)
    middle = pygame.Vector2(start[0] + width / 2, start[1] - _MIDDLE * size)
    stroke = max(1, round(_STROKE * size))
    radius = _RADIUS * size
    if frame == "cross":
        _draw_cross(surface, middle, radius, colour, stroke, mark)
        return
    if frame == "mouse":
        _draw_mouse(surface, middle, radius, colour, stroke, mark)
        return
    if frame == "wide":
        box = pygame.Rect(0, 0, round(_WIDE * size), round(1.75 * radius))
        box.center = round(middle.x), round(middle.y)
        pygame.draw.rect(surface, colour, box, stroke, border_radius=round(0.6 * radius))
    else:
        pygame.draw.circle(surface, colour, middle, radius, stroke)
    if frame == "stick":
        pygame.draw.circle(surface, colour, middle, 0.74 * radius, max(1, stroke // 2))
    if mark in MARKS:
        half = (0.62 if frame == "stick" else 0.5) * radius
        MARKS[mark](surface, middle, half, colour, round(1.3 * stroke))
    else:
        letters = write(mark, (0.62 if frame == "stick" else 0.74) * size)
        ink = letters.get_bounding_rect()
        surface.blit(letters, (middle.x - ink.centerx, middle.y - ink.centery))


def _sign(character: str) -> tuple[str, str]:
    family, button = divmod(ord(character) - FIRST, FAMILY)
    return SIGNS[FAMILIES[family]].get(button, ("round", str(button)))


def _draw_mouse(
    surface: pygame.Surface, middle: pygame.Vector2, radius: float, colour: Colour, stroke: int, button: str
) -> None:
    """Draw a mouse with one button filled."""
    box = pygame.Rect(0, 0, round(1.4 * radius), round(2 * radius))
    box.center = round(middle.x), round(middle.y)
    round_ = round(0.6 * radius)
    half = pygame.Rect(box.left, box.top, box.width // 2, box.height // 2)
    corner = "border_top_left_radius"
    if button == "right":
        half.right, corner = box.right, "border_top_right_radius"
    elif button == "middle":  # the wheel
        half = half.inflate(-0.5 * half.width, -0.3 * half.height)
        half.centerx, corner = box.centerx, "border_top_left_radius"
    pygame.draw.rect(surface, colour, half, **{corner: round_})
    pygame.draw.rect(surface, colour, box, stroke, border_radius=round_)


_ARMS: Final = {"up": -90, "down": 90, "left": 180, "right": 0}


def _draw_cross(
    surface: pygame.Surface, middle: pygame.Vector2, radius: float, colour: Colour, stroke: int, arm: str
) -> None:
    """Draw a D-pad with one arm filled."""
    half, reach = 0.34 * radius, 0.98 * radius
    corner = [(half, half), (reach, half), (reach, -half), (half, -half)]
    outline = [pygame.Vector2(x, y).rotate(-90 * turn) for turn in range(4) for x, y in corner[:3]]
    pygame.draw.polygon(surface, colour, [middle + point for point in outline], stroke)
    if arm in _ARMS:
        filled = [pygame.Vector2(x, y).rotate(_ARMS[arm]) for x, y in corner]
        pygame.draw.polygon(surface, colour, [middle + point for point in filled])
    else:
        pygame.draw.circle(surface, colour, middle, 0.8 * half)
