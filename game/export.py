"""A replay as a moving picture: frames are drawn off the screen, a few in every update, and saved at the end.

Needs Pillow, the extra `export`; `missing()` says whether it lacks.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Final

import pygame

from game.ui.canvas import Canvas

if TYPE_CHECKING:
    from PIL.Image import Image

SIZE: Final = (640, 360)
EVERY: Final = 3  # physics steps from frame to frame
_LINGER: Final = 1500  # milliseconds that the last frame stays
_COLOURS: Final = 255


def missing() -> bool:
    """Whether Pillow is not installed."""
    return find_spec("PIL") is None


class Film:
    """Frames drawn by `draw`, which is given a canvas and a step; `step` once an update, `save` once `done`."""

    def __init__(self, length: int, draw: Callable[[Canvas, int], None]) -> None:
        self._steps = [*range(0, length, EVERY), length]
        self._draw = draw
        self._canvas = Canvas(pygame.Surface(SIZE))
        self._frames: list[Image] = []

    @property
    def share(self) -> float:
        """How much of it is drawn, 0 to 1."""
        return len(self._frames) / len(self._steps)

    @property
    def done(self) -> bool:
        """Whether every frame is drawn."""
        return len(self._frames) == len(self._steps)

    def step(self) -> None:
        """Draw the next frame."""
        from PIL import Image

        self._draw(self._canvas, self._steps[len(self._frames)])
        picture = Image.frombytes("RGB", SIZE, pygame.image.tobytes(self._canvas.surface, "RGB"))
        self._frames.append(picture.quantize(_COLOURS, Image.Quantize.MAXCOVERAGE))

    def save(self, path: Path) -> None:
        """Write the GIF whole or not at all. Raises OSError."""
        path.parent.mkdir(parents=True, exist_ok=True)
        first, *others = self._frames
        pause = round(1000 * EVERY / 60)
        temporary = path.with_name(f".{path.name}.part")
        try:
            first.save(temporary, "GIF", save_all=True, append_images=others, loop=0,
                       duration=[*[pause] * len(others), _LINGER])  # fmt: skip
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)
