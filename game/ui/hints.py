"""Key hints: a row that tells which key does what, each of which can be clicked."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import pygame

from game.core import texts
from game.core.scene import Transition
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import INK, MUTE, SMALL
from game.input.controls import Controls, Held

_GAPS: Final = 8.0, 24.0  # points from a key to its meaning, and from there to the next key
_LINE: Final = 18.0  # points above its baseline in which a hint can be clicked
_BESIDE: Final = 6.0  # and on either side of it


class Hint(NamedTuple):
    """Name of a key, what it does in a word or two, and the function that does so on a click; None if none can."""

    key: str
    meaning: str
    run: Callable[[], Transition | None] | None = None


@dataclass(frozen=True)
class HintRow:
    """Hints on one baseline. Where they stand follows from their texts alone, whether or not they are drawn.

    Attributes:
        hints: the hints, from left to right.
        position: left end of the baseline, or its right end if `from_right`, in points.

    """

    hints: Sequence[Hint]
    position: Point
    from_right: bool = False
    size: float = SMALL

    @property
    def top(self) -> float:
        """The y of its upper edge, in points."""
        return self.position[1] - _LINE

    def width(self, canvas: Canvas) -> float:
        return _length(self._widths(canvas))

    def boxes(self, canvas: Canvas) -> list[pygame.FRect]:
        """Return the box, in points, in which each hint can be clicked."""
        return self._boxes(self._widths(canvas))

    def draw(self, canvas: Canvas) -> None:
        """Write the hints that no message covers; the one below the mouse stands out if it can be clicked."""
        size, widths = self.size, self._widths(canvas)  # once: measuring words costs as much as writing them
        for hint, width, box in zip(self.hints, widths, self._boxes(widths), strict=True):
            if canvas.message.colliderect(box):
                continue
            pointed = hint.run and canvas.pointer is not None and box.collidepoint(canvas.pointer)
            x, y = box.x + _BESIDE, self.position[1]
            canvas.text(hint.key, (x, y), size=size, colour=INK, weight="medium")
            canvas.text(hint.meaning, (x + width, y), size=size, colour=INK if pointed else MUTE, align="right")

    def _boxes(self, widths: Sequence[float]) -> list[pygame.FRect]:
        x, y = self.position
        x -= _length(widths) if self.from_right else 0.0
        boxes = []
        for width in widths:
            boxes.append(pygame.FRect(x - _BESIDE, y - _LINE, width + 2 * _BESIDE, 1.6 * _LINE))
            x += width + _GAPS[1]
        return boxes

    def _widths(self, canvas: Canvas) -> list[float]:
        """Return the width of each hint."""
        return [
            canvas.text_width(key, size=self.size, weight="medium")
            + _GAPS[0]
            + canvas.text_width(meaning, size=self.size)
            for key, meaning, _ in self.hints
        ]


def split(hints: Sequence[Hint], canvas: Canvas, room: float) -> list[list[Hint]]:
    """Return hints in lines no wider than `room`, in points."""
    lines: list[list[Hint]] = []
    for hint in hints:
        if lines and HintRow([*lines[-1], hint], (0, 0)).width(canvas) <= room:
            lines[-1].append(hint)
        else:
            lines.append([hint])
    return lines


def hint_lines(hints: Sequence[Hint], canvas: Canvas, corner: Point, room: float) -> list[HintRow]:
    """Return rows of hints no wider than `room`, the last of which begins at the corner at the lower left."""
    (x, y), lines = corner, split(hints, canvas, room)
    return [HintRow(line, (x, y - 1.6 * _LINE * (len(lines) - number))) for number, line in enumerate(lines, 1)]


def _length(widths: Sequence[float]) -> float:
    return sum(widths) + (len(widths) - 1) * _GAPS[1]


def flight_hints(controls: Controls) -> list[Hint]:
    """Return the hints of the flight controls for the device in use; one for both turns if one control does both."""
    left, right = controls.word(Held.LEFT), controls.word(Held.RIGHT)
    turn = texts.TURN_TO_MOUSE if controls.mouse_in_use else texts.TURN
    turns = [Hint(left, turn)] if left == right else [Hint(left, texts.TURN_LEFT), Hint(right, texts.TURN_RIGHT)]
    return [Hint(controls.word(Held.MAIN), texts.MAIN_ENGINE), *turns]
