"""Part of a lesson: a frame, and the walk through the code that belongs to it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ai.explain.recorder import Line
from game.lesson.code import CodeWalk
from game.lesson.frame import Frame


@dataclass(frozen=True)
class Part:
    """One frame of a lesson with its code."""

    frame: Frame
    code: CodeWalk

    @classmethod
    def of(cls, frame: Frame, lines: Iterable[Line]) -> Part:
        """Return a frame with those of the lines that ran in its functions."""
        return cls(frame, CodeWalk(lines, frame.functions, frame.begin))
