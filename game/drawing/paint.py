"""Painting with arrays: conversion to surfaces, and fractal noise for landscapes.

Pictures are arrays of float32, rows first: one (height, width) in 0 to 255 for each channel, and cover (height, width)
in 0 to 1. Broadcasting over a last axis of three channels would take six times as long.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import pygame

from game.drawing.paint_cache import Steps
from game.drawing.tokens import Colour

Picture = npt.NDArray[np.floating[Any]]

PIECE: Final = 65_536  # pixels that are painted between two yields of what paints in steps, at most
_GRAIN: Final = (64, 256)  # rows and columns of the noise that is repeated over a picture
_DENSE: Final = 96  # knots up to which a product of matrices is faster than picking three of them


def mix(a: Colour, b: Colour, share: float) -> Colour:
    """Return the linear mix of two colours; `share` 0 is a, 1 is b."""
    red, green, blue = (round(u + (v - u) * share) for u, v in zip(a, b, strict=True))
    return red, green, blue


def ramp(rows: int, stops: list[tuple[float, Colour]]) -> Picture:
    """Return a column of colours (rows, 3), interpolated between stops at positions 0 to 1."""
    at = np.linspace(0, 1, rows, dtype=np.float32)
    places = [place for place, _ in stops]
    return np.stack([np.interp(at, places, [c[k] for _, c in stops]) for k in range(3)], 1).astype(np.float32)


def bell(length: int, centre: float, width: float) -> Picture:
    """Return a Gaussian bell (length,), with centre and width in pixels."""
    hump: Picture = np.exp(-(((np.arange(length, dtype=np.float32) - centre) / width) ** 2))
    return hump


class Sheet:
    """A surface while it is painted, a part at a time; dithered with noise against banding in dark gradients.

    Attributes:
        surface: what has been painted of it; a `clear` one is transparent elsewhere.

    """

    def __init__(self, shape: tuple[int, int], rng: np.random.Generator, *, clear: bool = True) -> None:
        rows, columns = shape
        self.surface = pygame.Surface((columns, rows), pygame.SRCALPHA if clear else 0, 32)
        self._pixels = pygame.surfarray.pixels2d(self.surface).T.view(np.int32)
        self._grain = np.tile(rng.random(_GRAIN, dtype=np.float32), -(-columns // _GRAIN[1]))

    def put(self, top: int, left: int, colour: Sequence[Picture], cover: Picture | None = None) -> None:
        """Paint colour, a picture for each channel, from a row and a column on; all of it, or as far as covered."""
        rows, columns = np.broadcast_shapes(*(channel.shape for channel in colour))
        grain = self._grain[np.arange(top, top + rows) % _GRAIN[0], left : left + columns]
        packed = np.zeros((rows, columns), np.int32)
        for channel, shift in zip(colour, self.surface.get_shifts(), strict=False):
            packed |= np.minimum(np.maximum(channel + grain, 0), 255).astype(np.int32) << shift
        if cover is not None:
            packed |= (255 * cover + np.float32(0.5)).astype(np.int32) << self.surface.get_shifts()[3]
        self._pixels[top : top + rows, left : left + columns] = packed

    def put_larger(self, top: int, colour: Sequence[Picture], times: int) -> None:
        """Paint rows of colour, each pixel `times` as wide and as high, from row `times` × `top` on."""
        rows = self._pixels[top * times : (top + len(colour[0])) * times]
        width = self._pixels.shape[1]
        grain = (255 * self._grain[:, :width]).astype(np.uint16)
        grain = grain[np.arange(top * times, top * times + len(rows)) % len(grain)]
        packed = np.zeros(rows.shape, np.int32)
        for channel, shift in zip(colour, self.surface.get_shifts(), strict=False):
            levels = np.clip(256 * channel, 0, 65_280).astype(np.uint16)  # in whole numbers, as there are many
            wide = levels.repeat(times, axis=1)[:, :width].repeat(times, axis=0)[: len(rows)]
            packed |= ((wide + grain) >> 8).astype(np.int32) << shift
        rows[:] = packed

    def done(self) -> pygame.Surface:
        """Return the surface, once it is painted."""
        del self._pixels  # a surface cannot be drawn while its pixels are written
        return self.surface


def blocks(shape: tuple[int, int], piece: int = PIECE) -> Iterator[slice]:
    """Return the rows of a picture in blocks, of at most so many pixels each, to be painted one after the other."""
    rows, columns = shape
    stride = max(1, piece // columns)
    for top in range(0, rows, stride):
        yield slice(top, min(top + stride, rows))


def light(colour: Picture) -> pygame.Surface:
    """Return a surface for additive blending; black adds nothing."""
    return pygame.surfarray.make_surface(np.clip(colour, 0, 255).astype(np.uint8).swapaxes(0, 1))


def profile(length: int, rng: np.random.Generator, cells: float, octaves: int = 5, gain: float = 0.5) -> Picture:
    """Return smooth fractal noise (length,) in about -1 to 1; `cells` is the number of humps in the coarsest octave."""
    at = np.linspace(0, 1, length, dtype=np.float32)
    total = np.zeros(length, np.float32)
    weight = 1.0
    for _ in range(octaves):
        knots = rng.uniform(-1, 1, int(cells) + 3).astype(np.float32)
        total += weight * _Spline(at * cells, len(knots)).value.of(knots[None])[0]
        cells, weight = cells * 2.03, weight * gain
    return total


def clouds(
    shape: tuple[int, int], rng: np.random.Generator, cells: tuple[float, float], octaves: int = 4, gain: float = 0.5
) -> Steps[Picture]:
    """Paint smooth fractal noise (rows, columns) in about -1 to 1; `cells` counts humps down and across."""
    total = np.zeros(shape, np.float32)
    for weight, grid, (down, across) in _octaves(rng, cells, octaves, gain):
        rows = _Spline(np.linspace(0, down, shape[0], dtype=np.float32), len(grid)).value
        columns = _Spline(np.linspace(0, across, shape[1], dtype=np.float32), grid.shape[1]).value
        for part in blocks(shape):
            total[part] += weight * columns.of(rows.matrix[part] @ grid)
            yield total[part].size // 4  # quick, beside other painting
    return total


class Slope:
    """How steeply `clouds` rise at every pixel, downwards or across.

    The slope of a sum of splines is the sum of their slopes. It is soft, so that it is known at every `stride`-th
    pixel, and taken on straight lines between them.
    """

    def __init__(self, shape: tuple[int, int], stride: int) -> None:
        self._stride = stride
        self.known = np.zeros([-(-length // stride) + 1 for length in shape], np.float32)

    def part(self, rows: slice, columns: slice) -> Picture:
        """Return a part of it, (rows, columns)."""
        stride = self._stride
        if stride == 1:
            return self.known[rows, columns]
        above, share = np.divmod(np.arange(rows.start, rows.stop), stride)
        first, last = columns.start // stride, -(-columns.stop // stride) + 1
        parts = (share / stride).astype(np.float32)[:, None]
        some = self.known[above, first:last]
        some = some + parts * (self.known[above + 1, first:last] - some)
        step = np.diff(some, axis=1)
        fine = np.empty((*step.shape, stride), np.float32)
        for number in range(stride):
            fine[..., number] = some[:, :-1] + np.float32(number / stride) * step
        left = first * stride
        return fine.reshape(len(fine), -1)[:, columns.start - left : columns.stop - left]


def slopes(
    shape: tuple[int, int], rng: np.random.Generator, cells: tuple[float, float], octaves: int, gain: float, stride: int
) -> Steps[tuple[Slope, Slope]]:
    """Paint the slopes of `clouds` of the same arguments, downwards and across, in steps."""
    slope = Slope(shape, stride), Slope(shape, stride)
    for weight, grid, counts in _octaves(rng, cells, octaves, gain):
        rates = [count / max(length - 1, 1) for count, length in zip(counts, shape, strict=True)]
        at = [
            np.minimum(np.arange(length, dtype=np.float32) * (stride * rate), count)
            for length, rate, count in zip(slope[0].known.shape, rates, counts, strict=True)
        ]
        down, across = (_Spline(at[axis], grid.shape[axis]) for axis in (0, 1))
        for rows in blocks(slope[0].known.shape):
            slope[0].known[rows] += weight * rates[0] * across.value.of(down.rise.matrix[rows] @ grid)
            slope[1].known[rows] += weight * rates[1] * across.rise.of(down.value.matrix[rows] @ grid)
            yield slope[0].known[rows].size // 2
    return slope


def _octaves(
    rng: np.random.Generator, cells: tuple[float, float], octaves: int, gain: float
) -> Iterator[tuple[float, Picture, tuple[float, float]]]:
    """Return for each octave of noise its weight, its knots, and how many cells it has down and across."""
    weight = 1.0
    down, across = cells
    for _ in range(octaves):
        yield weight, rng.uniform(-1, 1, (int(down) + 3, int(across) + 3)).astype(np.float32), (down, across)
        down, across, weight = down * 2.03, across * 2.03, weight * gain


class _Spline:
    """What each knot of a quadratic B-spline counts at points: for its value, and for its rise from cell to cell."""

    def __init__(self, at: Picture, knots: int) -> None:
        left = np.minimum(np.floor(at).astype(np.intp), knots - 3)
        t = at - left
        self.value = _Bands(left, knots, (0.5 * (1 - t) ** 2, 0.5 + t - t * t, 0.5 * t * t))
        self.rise = _Bands(left, knots, (t - 1, 1 - 2 * t, t))


class _Bands:
    """Matrix (points, knots) with three numbers in each row, from the column `left` on."""

    def __init__(self, left: npt.NDArray[np.intp], knots: int, bands: Sequence[Picture]) -> None:
        self._left, self._knots, self._bands = left, knots, bands

    @cached_property
    def matrix(self) -> Picture:
        """The whole matrix."""
        matrix = np.zeros((len(self._left), self._knots), np.float32)
        for number, band in enumerate(self._bands):
            matrix[np.arange(len(matrix)), self._left + number] = band
        return matrix

    def of(self, values: Picture) -> Picture:
        """Return the sums (rows, points) of values (rows, knots). Of many knots, only the three are looked at."""
        if self._knots <= _DENSE:
            return values @ self.matrix.T
        knots = np.ascontiguousarray(values.T)
        total = self._bands[0][:, None] * knots[self._left]
        for number in (1, 2):
            total += self._bands[number][:, None] * knots[self._left + number]
        return total.T
