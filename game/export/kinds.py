"""The kinds of moving picture there are."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Final


@dataclass(frozen=True)
class Kind:
    """One kind of moving picture.

    Attributes:
        needs: the module without which it can't be made.
        size: width and height in pixels.
        every: physics steps from frame to frame.
        still: whether the camera rests, which a picture needs that stores only what changes.

    """

    needs: str
    size: tuple[int, int]
    every: int
    still: bool

    @property
    def missing(self) -> bool:
        """Whether what it needs is not installed."""
        return find_spec(self.needs) is None


KINDS: Final = {".gif": Kind("PIL", (640, 360), 3, True), ".mp4": Kind("av", (1280, 720), 1, False)}


def unfinished(path: Path) -> Path:
    """Return where a file is written until it is complete."""
    return path.with_name(f".{path.name}.part")
