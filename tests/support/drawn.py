"""Reads the panel of six values as it is drawn: from the calls that reach the canvas, not from what asked for them."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pygame
import pytest

from ai.lander.environment import ACTION_NAMES
from game.core import texts
from game.drawing.canvas import Canvas


class Drawn:
    """Everything that was written, and every bar and mark, with its place; nothing reaches the surface."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.texts: list[tuple[str, float, float]] = []
        self.bars: list[tuple[float, float, float]] = []  # left, middle, fraction
        self.markers: list[tuple[str, float, float]] = []
        self.lines: list[tuple[Any, Any]] = []
        record: dict[str, Callable[..., Any]] = {
            "text": self._text,
            "bar": self._bar,
            "marker": self._marker,
            "line": self._line,
            "panel": lambda *_, **__: None,
            "pill": lambda *_, **__: None,
            "dot": lambda *_, **__: None,
        }
        for name, take in record.items():
            monkeypatch.setattr(Canvas, name, take)

    def _text(self, string: str, position: tuple[float, float], **_: Any) -> pygame.FRect:
        self.texts.append((string, *position))
        return pygame.FRect(position, (1, 1))

    def _bar(self, rect: Any, fraction: float, *_: Any, **__: Any) -> None:
        box = pygame.FRect(rect)
        self.bars.append((box.x, box.centery, fraction))

    def _marker(self, shape: str, centre: tuple[float, float], *_: Any, **__: Any) -> None:
        self.markers.append((shape, *centre))

    def _line(self, start: Any, end: Any, *_: Any, **__: Any) -> None:
        self.lines.append((start, end))

    def clear(self) -> None:
        for kept in (self.texts, self.bars, self.markers, self.lines):
            kept.clear()

    @property
    def words(self) -> list[str]:
        return [string for string, _, _ in self.texts]


@dataclass
class Row:
    """One action as it is drawn."""

    figure: str
    fraction: float
    marked: bool
    beyond: bool


@dataclass
class Panel:
    """What a viewer reads off."""

    expected: str
    rows: list[Row]
    inputs: list[str]


def read_panel(drawn: Drawn) -> Panel:
    """Return what the panel shows; every row is found by its name alone."""
    return Panel(
        _beside(drawn, texts.Q_EXPECTED),
        read_rows(drawn),
        [_beside(drawn, name) for name in texts.INPUTS if name in drawn.words],
    )


def read_rows(drawn: Drawn) -> list[Row]:
    """Return the rows of the six actions alone, of values or of chances."""
    return [_row(drawn, name) for name in ACTION_NAMES]


def _place(drawn: Drawn, word: str) -> tuple[float, float]:
    """Where a word stands; names of actions and of inputs may stand elsewhere as well, further left."""
    return max((x, y) for string, x, y in drawn.texts if string == word)


def _beside(drawn: Drawn, word: str) -> str:
    x, y = _place(drawn, word)
    right = [(left, string) for string, left, line in drawn.texts if line == y and left > x]
    return min(right)[1]


def _row(drawn: Drawn, name: str) -> Row:
    x, y = _place(drawn, name)
    middle = y - 4
    (fraction,) = {part for left, line, part in drawn.bars if math.isclose(line, middle, abs_tol=1.0) and left > x}
    marked = any(shape == "triangle" and line == middle and left > x for shape, left, line in drawn.markers)
    beyond = any(end[1] == middle and start[1] == middle - 4 for start, end in drawn.lines)
    return Row(_beside(drawn, name), fraction, marked, beyond)


def number(figure: str) -> float:
    """Read a figure as a viewer does; the best one is so much behind itself."""
    return 0.0 if figure == texts.Q_BEST else float(figure.replace("−", "-"))
