"""Video export of a flight: its replay without text, drawn off screen and written frame by frame.

It runs in a process of its own, which `game.export.export` controls.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Protocol

import numpy as np
import pygame
from numpy.typing import NDArray

from game.core.clock import STEP
from game.core.settings import Settings
from game.drawing.canvas import Canvas
from game.drawing.tokens import COLOUR_SAFE, PALETTE
from game.export.kinds import KINDS, VideoKind, unfinished
from game.flight.flight_file import Record
from game.ui.context import Context

Frame = NDArray[np.uint8]  # (height, width, 3)

_AFTER: Final = 120  # updates shown after the end, while fire and dust settle
_LINGER: Final = 60  # steps that the last frame then stays on screen
_SAMPLE: Final = 40  # steps between the frames sampled for the palette


@dataclass(frozen=True)
class FrameDrawn:
    """Progress message: the share of the frames drawn, 0 to 1."""

    newest_only = True

    share: float


class Filmed(Protocol):
    """Scene that shows a flight, and can draw its world without text."""

    def update(self) -> object:
        """Advance the replay by one step."""

    def draw_world(self, canvas: Canvas, alpha: float) -> None:
        """Draw the world without text."""


class _Writer(Protocol):
    def add(self, frame: Frame) -> None:
        """Append a frame (height, width, 3)."""


def film(
    make: Callable[[Context, Record], Filmed], record: Record, path: Path, colour_safe: bool = False
) -> Generator[list[FrameDrawn], None, None]:
    """Write a flight, drawn by the scene from `make`, to a video file, whole or not at all; yield after each frame.

    The suffix of the path selects the kind of file.

    Raises:
        OSError: the file can't be written, or the disk is full.

    """
    kind = KINDS[path.suffix]
    last = len(record.recording.actions) + _AFTER
    steps = [*range(0, last, kind.every), last]
    temporary = unfinished(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        with _writer(temporary, kind, frames(make, record, kind, range(0, last, _SAMPLE), colour_safe)) as writer:
            yield [FrameDrawn(0.0)]
            shown = frames(make, record, kind, steps, colour_safe)
            for number, frame in enumerate(shown, 1):
                writer.add(frame)
                yield [FrameDrawn(number / (len(steps) + 1))]
            for _ in range(0, _LINGER, kind.every):
                writer.add(frame)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def frames(
    make: Callable[[Context, Record], Filmed],
    record: Record,
    kind: VideoKind,
    steps: Iterable[int],
    colour_safe: bool = False,
) -> Iterator[Frame]:
    """Yield the frames at these rising update numbers of a replay; one update is one step, up to the flight's end."""
    _need_no_screen()
    settings = Settings(reduced_motion=kind.still, colour_safe=colour_safe)
    scene = make(Context(Path(), settings), record)
    canvas = Canvas(pygame.Surface(kind.size), COLOUR_SAFE if colour_safe else PALETTE)
    flown = 0
    for step in steps:
        while flown < step:
            scene.update()
            flown += 1
        scene.draw_world(canvas, 1.0)
        yield np.frombuffer(pygame.image.tobytes(canvas.surface, "RGB"), np.uint8).reshape(*kind.size[::-1], 3)


def _writer(path: Path, kind: VideoKind, sample: Iterable[Frame]) -> AbstractContextManager[_Writer]:
    seconds = kind.every * STEP
    if kind is KINDS[".mp4"]:
        from game.export.mp4 import Mp4Writer

        return Mp4Writer(path, kind.size, round(1 / seconds))
    from game.export.gif import GifWriter

    return GifWriter(path, kind.size, sample, seconds)


def _need_no_screen() -> None:
    os.environ["SDL_VIDEODRIVER"] = "dummy"
    pygame.display.init()
    pygame.font.init()
