"""GIF writer, frame by frame: one global palette, and ordered dithering that does not flicker.

Needs Pillow, for the palette and the compression.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from PIL.GifImagePlugin import getdata

Frame = NDArray[np.uint8]  # (height, width, 3)

_COLOURS: Final = 255
_SAME: Final = 255  # palette index of transparent pixels
_SPREAD: Final = 5.0  # of 255: amplitude of the dithering, which mixes the colours between two of the palette
_SHADES: Final = 64  # levels of each of red, green and blue when the palette is chosen


class GifWriter:
    """Writer of a GIF that repeats for ever; a context manager, at whose exit the file is complete.

    Each frame stores only the pixels that have changed, and the ordered dithering is fixed to the picture
    (Bayer, 1973), so still parts neither flicker nor take space.

    Args:
        path: the file to write.
        size: width and height in pixels.
        sample: frames to choose the palette from.
        seconds: time per frame, stored in hundredths.

    Raises:
        OSError: the file can't be written, then or later.

    """

    def __init__(self, path: Path, size: tuple[int, int], sample: Iterable[Frame], seconds: float) -> None:
        self._palette = palette_of(sample)
        self._seconds = seconds
        self._shown: NDArray[np.uint8] | None = None
        width, height = size
        self._push = np.tile(_bayer(3), (height // 8 + 1, width // 8 + 1))[:height, :width, None]
        self._file = path.open("wb")
        self._file.write(b"GIF89a" + struct.pack("<HHBBB", width, height, 0b11110111, 0, 0))
        self._file.write(bytes((self._palette.getpalette() or [])[: 3 * _COLOURS]).ljust(768, b"\0"))
        self._file.write(b"!\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00")

    def __enter__(self) -> GifWriter:
        return self

    def __exit__(self, *error: object) -> None:
        with self._file:
            self._file.write(b";")

    def add(self, frame: Frame) -> None:
        """Append a frame (height, width, 3)."""
        indices = self._indices(frame)
        box, patch, more = (0, 0), indices, {}
        if self._shown is not None:
            same = indices == self._shown
            rows, columns = (np.flatnonzero(~same.all(axis=axis)) for axis in (1, 0))
            top, bottom, left, right = (0, 1, 0, 1) if same.all() else (*rows[[0, -1]], *columns[[0, -1]])
            part = np.s_[top : bottom + 1, left : right + 1]
            box, patch, more = (int(left), int(top)), np.where(same, _SAME, indices)[part], {"transparency": _SAME}
        self._shown = indices
        picture = Image.fromarray(np.ascontiguousarray(patch, np.uint8))
        for data in getdata(picture, box, duration=round(1000 * self._seconds), disposal=1, **more):
            self._file.write(data)

    def _indices(self, frame: Frame) -> NDArray[np.uint8]:
        pushed = np.clip(frame + self._push, 0, 255).astype(np.uint8)
        found = Image.fromarray(pushed).quantize(palette=self._palette, dither=Image.Dither.NONE)
        return np.asarray(found)


def palette_of(sample: Iterable[Frame]) -> Image.Image:
    """Return an image with the palette for frames like these.

    A colour is weighted by the square root of its count, so that a small flame gets colours beside a large sky.
    """
    counts = np.zeros(_SHADES**3)
    for frame in sample:
        red, green, blue = np.moveaxis(frame.astype(np.intp) * _SHADES // 256, -1, 0)
        counts += np.bincount(((red * _SHADES + green) * _SHADES + blue).ravel(), minlength=len(counts))
    cells = np.flatnonzero(counts)
    shades = np.stack(np.unravel_index(cells, (_SHADES,) * 3), axis=1) * (256 // _SHADES) + 128 // _SHADES
    weights = np.ceil(np.sqrt(counts[cells])).astype(np.intp)
    pixels = np.repeat(shades.astype(np.uint8), weights, axis=0)
    return Image.fromarray(pixels[None]).quantize(_COLOURS, Image.Quantize.MEDIANCUT, kmeans=2)


def _bayer(order: int) -> NDArray[np.float64]:
    """Return the Bayer threshold matrix of side 2 ** order, centred around 0."""
    matrix = np.zeros((1, 1))
    for _ in range(order):
        matrix = np.block([[4 * matrix, 4 * matrix + 2], [4 * matrix + 3, 4 * matrix + 1]])
    return _SPREAD * ((matrix + 0.5) / matrix.size - 0.5)
