"""Colours that mean something stay apart for every eye, and a shape always says the same."""

from itertools import combinations, product

import numpy as np
import pygame
import pytest

from game.drawing import shapes
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import (
    COLOUR_SAFE,
    EMBER,
    HUMAN,
    INK,
    MUTE,
    NET,
    NIGHT0,
    NIGHT1,
    PALETTE,
    PANEL,
    Colour,
    Palette,
)
from game.explain import readouts

# How eyes without one kind of cone see linear RGB: Machado, Oliveira and Fernandes, "A Physiologically-based Model for
# Simulation of Color Vision Deficiency", IEEE Transactions on Visualization and Computer Graphics 15(6), 2009,
# table 1, severity 1.0.
EYES = {
    "all cones": np.eye(3),
    "protanopia": np.array([
        [0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998],
    ]),
    "deuteranopia": np.array([
        [0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881],
    ]),
    "tritanopia": np.array([
        [1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900],
    ]),
}  # fmt: skip
# sRGB to CIE XYZ, D65 (IEC 61966-2-1).
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
APART = 25.0  # CIE76; some 2.3 are just noticed


def linear(colour: Colour) -> np.ndarray:
    value = np.array(colour) / 255
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def lab(light: np.ndarray) -> np.ndarray:
    ratio = TO_XYZ @ light / TO_XYZ.sum(axis=1)
    f = np.where(ratio > (6 / 29) ** 3, np.cbrt(ratio), ratio / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def apart(a: Colour, b: Colour, eye: str) -> float:
    seen = [lab(np.clip(EYES[eye] @ linear(colour), 0, 1)) for colour in (a, b)]
    return float(np.linalg.norm(seen[0] - seen[1]))


def contrast(a: Colour, b: Colour) -> float:
    """As the Web Content Accessibility Guidelines 2.1 define it, 1 to 21."""
    bright, dark = sorted((float(TO_XYZ[1] @ linear(colour)) for colour in (a, b)), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


def test_what_means_something_stays_apart_for_every_eye_and_the_safe_palette_is_the_better_one():
    for eye in EYES:
        assert apart(HUMAN, NET, eye) > APART
        for palette in (PALETTE, COLOUR_SAFE):
            assert apart(palette.good, palette.warn, eye) > APART, eye
    for eye in ("protanopia", "deuteranopia"):
        usual, safe = (apart(palette.good, palette.warn, eye) for palette in (PALETTE, COLOUR_SAFE))
        assert safe > 1.4 * usual, eye


def test_what_is_written_can_be_read():
    for ground in (NIGHT0, NIGHT1, PANEL):
        for palette in (PALETTE, COLOUR_SAFE):
            for colour in (INK, MUTE, HUMAN, NET, palette.good, palette.warn):
                assert contrast(colour, ground) >= 4.5, (colour, ground)


def test_the_model_of_the_eyes_does_what_it_says():
    """Red and green of equal lightness: far apart for most, near for those without one of their cones."""
    red, green = (200, 80, 60), (100, 130, 50)
    for eye in ("protanopia", "deuteranopia"):
        assert apart(red, green, eye) < 0.5 * apart(red, green, "all cones")
    assert apart(EMBER, EMBER, "tritanopia") == 0


def test_within_and_beyond_differ_in_shape():
    grey = Palette(good=(200, 200, 200), warn=(200, 200, 200))
    canvas = Canvas(pygame.Surface((1280, 720)), grey)
    masks = []
    for within in (True, False):
        canvas.surface.fill((0, 0, 0))
        readout = readouts.Readout("", "1.0", "m/s", within=within)
        readouts.write_readouts(Cursor(100, 100, 400, canvas=canvas), {"descent": readout})
        masks.append(pygame.surfarray.array3d(canvas.surface)[..., 0] > 100)
    assert all(mask.any() for mask in masks)
    for a, b in combinations(masks, 2):
        assert (a != b).sum() > 5


# Shapes that are copied from parts, tinted or scaled look as if they had been painted whole.

GOLD = (255, 196, 112)


def pixels(surface: pygame.Surface) -> np.ndarray:
    return pygame.surfarray.array3d(surface).astype(int)


def test_a_large_rectangle_has_the_corners_of_a_small_one_and_nothing_else():
    for size, width in product([(200, 120), (57, 41), (20, 90)], [0, 2]):
        cover = pygame.surfarray.array_alpha(shapes.rounded(size, 4.5, GOLD, width))
        small = pygame.surfarray.array_alpha(shapes.rounded((min(12, size[0]), 12), 4.5, GOLD, width))
        half = min(6, size[0] // 2)
        assert (cover[:half, :6] == small[:half, :6]).all()
        assert (cover[-half:, -6:] == small[-half:, -6:]).all()
        assert (cover[:, 6:-6] == cover[:, size[1] // 2, None]).all()
        assert cover[0, size[1] // 2] == 255
        assert cover[size[0] // 2, size[1] // 2] == (0 if width and size[0] > 2 * width + 8 else 255)


@pytest.mark.parametrize("fraction", [0.001, 0.31, 1.0])
def test_a_bar_is_a_pill_of_its_length(fraction: float):
    bar, pill = (Canvas(pygame.Surface((960, 540))) for _ in range(2))
    bar.bar((100, 50, 120, 4), fraction, GOLD)
    pill.pill((100, 50, 120, 4), (58, 68, 92), 0.6)
    bare = Canvas(pygame.Surface((960, 540)))
    bare.bar((100, 50, 120, 4), 0.0, GOLD)
    pill.surface.blit(bare.surface, (0, 0))
    pill.pill((100, 50, max(120 * fraction, 4), 4), GOLD)
    assert np.abs(pixels(bar.surface) - pixels(pill.surface)).max() <= 2


@pytest.mark.parametrize(("radius", "strength"), [(10, 0.2), (60, 0.8), (150, 1.0), (400, 2.6)])
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
