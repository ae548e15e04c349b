"""Painting with arrays: conversion to surfaces, and fractal noise for landscapes.

Pictures are arrays of float32, rows first: colour (height, width, 3) in 0 to 255, cover (height, width) in
0 to 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import pygame

from game.drawing.tokens import Colour

Picture = npt.NDArray[np.floating[Any]]

_GRAIN_SIDE: Final = 256


def mix(a: Colour, b: Colour, share: float) -> Colour:
    """Return the linear mix of two colours; `share` 0 is a, 1 is b."""
    red, green, blue = (round(u + (v - u) * share) for u, v in zip(a, b, strict=True))
    return red, green, blue


def ramp(rows: int, stops: list[tuple[float, Colour]]) -> Picture:
    """Return a column of colours (rows, 3), interpolated between stops at positions 0 to 1."""
    at = np.linspace(0, 1, rows, dtype=np.float32)
    places = [place for place, _ in stops]
    return np.stack([np.interp(at, places, [c[k] for _, c in stops]) for k in range(3)], 1).astype(np.float32)


def shine(picture: Picture, light: Picture, colour: Sequence[float] | Picture) -> None:
    """Add light (rows, columns) of one colour to a picture, in place.

    A channel at a time: broadcasting over a last axis of three takes six times as long.
    """
    for channel, share in enumerate(colour):
        picture[..., channel] += light * np.float32(share)


def bell(length: int, centre: float, width: float) -> Picture:
    """Return a Gaussian bell (length,), with centre and width in pixels."""
    hump: Picture = np.exp(-(((np.arange(length, dtype=np.float32) - centre) / width) ** 2))
    return hump


def opaque(colour: Picture, rng: np.random.Generator) -> pygame.Surface:
    """Return a surface without transparency, dithered with noise against banding in dark gradients."""
    height, width = colour.shape[:2]
    surface = pygame.Surface((width, height), depth=32)
    pixels = pygame.surfarray.pixels3d(surface)
    pixels[:] = _quantise(colour, rng).swapaxes(0, 1)
    del pixels
    return surface


def layer(colour: Picture, cover: Picture, rng: np.random.Generator) -> pygame.Surface:
    """Return a surface with transparency, run-length encoded so that clear and solid runs cost almost nothing."""
    height, width = colour.shape[:2]
    surface = pygame.Surface((width, height), pygame.SRCALPHA)
    pixels = pygame.surfarray.pixels3d(surface)
    pixels[:] = _quantise(colour, rng).swapaxes(0, 1)
    del pixels
    alpha = pygame.surfarray.pixels_alpha(surface)
    alpha[:] = np.round(255 * cover).astype(np.uint8).T
    del alpha
    surface.set_alpha(255, pygame.RLEACCEL)
    return surface


def light(colour: Picture) -> pygame.Surface:
    """Return a surface for additive blending; black adds nothing."""
    return pygame.surfarray.make_surface(np.clip(colour, 0, 255).astype(np.uint8).swapaxes(0, 1))


def profile(length: int, rng: np.random.Generator, cells: float, octaves: int = 5, gain: float = 0.5) -> Picture:
    """Return smooth fractal noise (length,) in about -1 to 1; `cells` is the number of humps in the coarsest octave."""
    at = np.linspace(0, 1, length, dtype=np.float32)
    total = np.zeros(length, np.float32)
    weight = 1.0
    for _ in range(octaves):
        total += weight * (_weights(at * cells) @ rng.uniform(-1, 1, int(cells) + 3).astype(np.float32))
        cells, weight = cells * 2.03, weight * gain
    return total


def clouds(
    shape: tuple[int, int],
    rng: np.random.Generator,
    cells: tuple[float, float],
    octaves: int = 4,
    gain: float = 0.5,
) -> Picture:
    """Return smooth fractal noise (rows, columns) in about -1 to 1; `cells` counts humps down and across."""
    total = np.zeros(shape, np.float32)
    weight = 1.0
    down, across = cells
    for _ in range(octaves):
        grid = rng.uniform(-1, 1, (int(down) + 3, int(across) + 3)).astype(np.float32)
        rows = _weights(np.linspace(0, down, shape[0], dtype=np.float32))
        columns = _weights(np.linspace(0, across, shape[1], dtype=np.float32))
        total += weight * (rows @ grid @ columns.T)
        down, across, weight = down * 2.03, across * 2.03, weight * gain
    return total


def _weights(at: Picture) -> Picture:
    """Return the weight (points, knots) of each knot of a quadratic B-spline at each point."""
    left = np.floor(at).astype(np.intp)
    t = at - left
    weights = np.zeros((len(at), int(at.max()) + 3), np.float32)
    rows = np.arange(len(at))
    weights[rows, left] = 0.5 * (1 - t) ** 2
    weights[rows, left + 1] = 0.5 + t - t * t
    weights[rows, left + 2] = 0.5 * t * t
    return weights


def _quantise(colour: Picture, rng: np.random.Generator) -> npt.NDArray[np.uint8]:
    height, width = colour.shape[:2]
    grain = rng.random((_GRAIN_SIDE, _GRAIN_SIDE, 1), dtype=np.float32).repeat(3, axis=2)
    grain = np.tile(grain, (1, -(-width // _GRAIN_SIDE), 1))[:, :width]
    levels = np.empty(colour.shape, np.uint8)
    for top in range(0, height, _GRAIN_SIDE):
        reward_bar = colour[top : top + _GRAIN_SIDE]
        levels[top : top + _GRAIN_SIDE] = np.clip(reward_bar + grain[: len(reward_bar)], 0, 255)
    return levels
