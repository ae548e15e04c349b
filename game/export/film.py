"""Film of a flight: its replay without text, drawn off screen and written frame by frame, as a GIF.

It runs in a process of its own, so that the window neither waits nor slows down.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import platformdirs
import pygame

from game.core import texts
from game.core.clock import STEP
from game.core.settings import Settings
from game.core.worker import Worker, WorkerState
from game.drawing.canvas import Canvas
from game.drawing.tokens import COLOUR_SAFE, PALETTE
from game.export.gif import Frame, GifWriter
from game.flight.flight_file import Record
from game.ui.context import Context

SIZE: Final = (640, 360)  # pixels
EVERY: Final = 3  # steps per frame
_AFTER: Final = 120  # updates shown after the end, while fire and dust die away
_LINGER: Final = 60  # steps that the last frame then stays on screen
_SAMPLE: Final = 40  # steps between the frames sampled for the palette
Scenes = Callable[[Context, Record], Any]  # makes a replay: its `update` flies a step, its `draw_world` draws no words


def films_dir() -> Path:
    """Return the folder for films, within the player's documents."""
    return Path(platformdirs.user_documents_dir()) / texts.GAME


@dataclass(frozen=True)
class FrameDrawn:
    """Progress message: the share of the frames drawn, 0 to 1."""

    newest_only = True

    share: float


def film(
    make: Scenes, record: Record, path: Path, colour_safe: bool = False
) -> Generator[list[FrameDrawn], None, None]:
    """Write a flight, drawn by the scene from `make`, to a GIF, whole or not at all; yield after each frame.

    Raises:
        OSError: the file can't be written, or the disk is full.

    """
    last = len(record.recording.pushes) + _AFTER
    steps = [*range(0, last, EVERY), last]
    temporary = unfinished(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        sample = frames(make, record, range(0, last, _SAMPLE), colour_safe)
        with GifWriter(temporary, SIZE, sample, EVERY * STEP) as writer:
            yield [FrameDrawn(0.0)]
            for number, frame in enumerate(frames(make, record, steps, colour_safe), 1):
                writer.add(frame)
                yield [FrameDrawn(number / (len(steps) + 1))]
            for _ in range(0, _LINGER, EVERY):
                writer.add(frame)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def frames(make: Scenes, record: Record, steps: Iterable[int], colour_safe: bool = False) -> Iterator[Frame]:
    """Yield the frames at these rising update numbers of a replay; one update is one step, up to the flight's end.

    The camera stands still, as only pixels that change take room in a GIF.
    """
    os.environ["SDL_VIDEODRIVER"] = "dummy"
    pygame.display.init()
    pygame.font.init()
    scene = make(Context(Path(), Settings(reduced_motion=True, colour_safe=colour_safe)), record)
    canvas = Canvas(pygame.Surface(SIZE), COLOUR_SAFE if colour_safe else PALETTE)
    flown = 0
    for step in steps:
        while flown < step:
            scene.update()
            flown += 1
        scene.draw_world(canvas, 1.0)
        yield np.frombuffer(pygame.image.tobytes(canvas.surface, "RGB"), np.uint8).reshape(*SIZE[::-1], 3)


def unfinished(path: Path) -> Path:
    """Return the path of a file while it is incomplete."""
    return path.with_name(f".{path.name}.part")


class Export:
    """Running export of a flight, which may outlive the replay that began it; call `follow` once a frame.

    Args:
        scene: makes the replay; a class or function at module level, so that another process can import it.
        record: the flight.
        path: the file to write.
        colour_safe: whether to use the palette for colour-blind viewers.

    Attributes:
        path: the file, complete once the export has ended without a problem.
        share: progress, 0 to 1.

    """

    def __init__(self, scene: Scenes, record: Record, path: Path, *, colour_safe: bool = False) -> None:
        self.path, self.share = path, 0.0
        self._worker = Worker(film, scene, record, path, colour_safe)

    def follow(self) -> str:
        """Update the progress; return what came of it once it has ended, and nothing before."""
        for drawn in self._worker.poll():
            self.share = drawn.share
        if self._worker.state not in (WorkerState.ENDED, WorkerState.FAILED):
            return ""
        self.close()
        problem = self._worker.problem
        return texts.EXPORT_FAILED.format(reason=problem) if problem else texts.EXPORT_DONE.format(path=self.path)

    def close(self) -> None:
        """Cancel the export and delete the unfinished file."""
        self._worker.close(0.0)  # the window may go on: it waits for no goodbye
        with suppress(OSError, ValueError):  # usually the process has deleted it already
            unfinished(self.path).unlink()
