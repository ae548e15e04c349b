"""Icon of the window, drawn by code: a lander over the moon's edge."""

from __future__ import annotations

from typing import Final

import pygame

from game.drawing.tokens import DUSK, HUMAN, INK, MUTE, NIGHT1

_LARGE: Final = 256
_SIZE: Final = 64
_STAGE: Final = [(84, 128), (172, 128), (180, 152), (164, 168), (92, 168), (76, 152)]
_CABIN: Final = [(100, 84), (120, 68), (148, 68), (164, 88), (164, 122), (92, 122)]
_LEGS: Final = [((84, 150), (60, 198)), ((172, 150), (196, 198)), ((48, 198), (74, 198)), ((182, 198), (208, 198))]


def draw_icon(size: int = _SIZE) -> pygame.Surface:
    """Return the icon, `size` pixels wide."""
    sheet = pygame.Surface((_LARGE, _LARGE), pygame.SRCALPHA)
    whole = sheet.get_rect()
    mask = sheet.copy()
    pygame.draw.rect(mask, "white", whole, border_radius=56)
    sheet.fill(NIGHT1)
    pygame.draw.circle(sheet, MUTE, (128, 474), 276)
    pygame.draw.circle(sheet, DUSK, (128, 484), 276)
    for start, end in _LEGS:
        pygame.draw.line(sheet, INK, start, end, 9)
    pygame.draw.polygon(sheet, HUMAN, _STAGE)
    pygame.draw.polygon(sheet, INK, _CABIN)
    pygame.draw.polygon(sheet, NIGHT1, [(112, 92), (126, 84), (126, 104), (110, 104)])
    pygame.draw.line(sheet, INK, (140, 68), (140, 44), 5)
    pygame.draw.circle(sheet, HUMAN, (140, 40), 9)
    sheet.blit(mask, (0, 0), special_flags=pygame.BLEND_RGBA_MULT)
    return pygame.transform.smoothscale(sheet, (size, size))
