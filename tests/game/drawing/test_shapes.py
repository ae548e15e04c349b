"""Shapes that are copied from parts, tinted or scaled look as if they had been painted whole."""

import numpy as np
import pygame
import pytest

from game.drawing import shapes
from game.drawing.canvas import Canvas

GOLD = (255, 196, 112)


def pixels(surface: pygame.Surface) -> np.ndarray:
    return pygame.surfarray.array3d(surface).astype(int)


@pytest.mark.parametrize("size", [(200, 120), (57, 41), (20, 90)])
@pytest.mark.parametrize("width", [0, 2])
def test_a_large_rectangle_has_the_corners_of_a_small_one_and_nothing_else(size: tuple[int, int], width: int):
    cover = pygame.surfarray.array_alpha(shapes.rounded(size, 4.5, GOLD, width))
    small = pygame.surfarray.array_alpha(shapes.rounded((min(12, size[0]), 12), 4.5, GOLD, width))
    half = min(6, size[0] // 2)
    assert (cover[:half, :6] == small[:half, :6]).all()
    assert (cover[-half:, -6:] == small[-half:, -6:]).all()
    assert (cover[:, 6:-6] == cover[:, size[1] // 2, None]).all()
    assert cover[0, size[1] // 2] == 255
    assert cover[size[0] // 2, size[1] // 2] == (0 if width and size[0] > 2 * width + 8 else 255)


@pytest.mark.parametrize("fraction", [0.001, 0.02, 0.31, 0.5, 0.98, 1.0])
def test_a_bar_is_a_pill_of_its_length(fraction: float):
    bar, pill = (Canvas(pygame.Surface((1920, 1080))) for _ in range(2))
    bar.bar((100, 50, 120, 4), fraction, GOLD)
    pill.pill((100, 50, 120, 4), (58, 68, 92), 0.6)
    bare = Canvas(pygame.Surface((1920, 1080)))
    bare.bar((100, 50, 120, 4), 0.0, GOLD)
    pill.surface.blit(bare.surface, (0, 0))
    pill.pill((100, 50, max(120 * fraction, 4), 4), GOLD)
    assert np.abs(pixels(bar.surface) - pixels(pill.surface)).max() <= 2


@pytest.mark.parametrize("strength", [0.2, 0.8, 1.0, 2.6])
@pytest.mark.parametrize("radius", [10, 60, 150, 400])
def test_a_glow_fades_outwards_alike_in_every_size(radius: int, strength: float):
    canvas = Canvas(pygame.Surface((1280, 720)))
    canvas.surface.fill((0, 0, 0))
    canvas.glow((640, 360), radius, GOLD, strength)
    across = np.arange(1280) - 640
    size = 4 * round(radius / 4) if 24 <= radius < shapes.HUGE_GLOW else radius
    fall = (1 - np.minimum(np.abs(across) / size, 1)) ** 2.4 * round(32 * strength) / 32
    wanted = np.minimum(fall[:, None] * np.array(GOLD), 255)
    near = 8 if radius < shapes.HUGE_GLOW else 8 + 30 * strength  # huge ones come in steps of an eighth
    assert np.abs(pixels(canvas.surface)[:, 360] - wanted).max() <= near
    assert pixels(canvas.surface)[640, 360].tolist() == pytest.approx(wanted[640].tolist(), abs=12)
