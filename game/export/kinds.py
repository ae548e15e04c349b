"""Kinds of video files."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Final


@dataclass(frozen=True)
class VideoKind:
    """Kind of video file.

    Attributes:
        needs: the module it requires.
        size: width and height in pixels.
        every: physics steps per frame.
        still: whether the camera stands still, for formats that store only changed pixels.

    """

    needs: str
    size: tuple[int, int]
    every: int
    still: bool

    @property
    def missing(self) -> bool:
        """Whether the required module is not installed."""
        return find_spec(self.needs) is None


KINDS: Final = {".gif": VideoKind("PIL", (640, 360), 3, True), ".mp4": VideoKind("av", (1280, 720), 1, False)}


def unfinished(path: Path) -> Path:
    """Return the path of a file while it is incomplete."""
    return path.with_name(f".{path.name}.part")
