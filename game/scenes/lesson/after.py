"""Frame after the step: the value again, and who pulled on it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
import pygame

from ai.explain.recorder import Function
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import EMBER, FAINT, HUMAN, LINE, MUTE, NET, SMALL
from game.panels.figures import number, points
from game.panels.tables import told
from game.scenes.lesson.frame import Frame, in_points
from game.scenes.lesson.step import LearningStep, Pulls
from game.ui.panel import Column

_LINE, _ROW = 60.0, 30.0  # heights
_NAMES, _FIGURES = 0.52, 0.66  # of the width: where names and figures of pulls end


class AfterFrame(Frame):
    """Frame after the step.

    `values` are an output before, the same after, and its target, in the network's scale; `telling` says that it is
    nearer now, or farther. `derivative` is that of the cost by the output, which is in points then; without it,
    nothing is said of pulls.
    """

    def __init__(
        self,
        words: Sequence[str],
        functions: Sequence[Function],
        step: LearningStep,
        values: tuple[float, float, float],
        derivative: float | None,
        telling: Sequence[str],
    ) -> None:
        self._values = before, after, target = [value / step.scale for value in values]
        figure, write = (number(after), number) if derivative is None else (in_points(after), points)
        super().__init__(words, figure, functions, "values")
        self.step, self._pulled = step, derivative is not None
        self.pulls = None if derivative is None else Pulls.of(step, derivative, values[1] - values[0])
        closer = abs(before - target) - abs(after - target)
        self._told = telling[closer <= 0].format(
            before=write(before), after=write(after), target=write(target), by=number(abs(closer))
        )
        if self.pulls is not None:
            strongest = texts.LESSON_PULL_PARTS[int(np.argmax(np.abs(self._found())))][0]
            name = strongest.format(count=step.examples - 1)
            self._told = f"{self._told} {texts.LESSON_STRONGEST.format(name=name)}"

    def describe(self, column: Column) -> None:
        column.text(self._told, size=SMALL)
        column.picture(_LINE, self._draw_value)
        if self._pulled:
            column.gap(8)
            column.aside(texts.LESSON_PULLS if self.pulls else texts.LESSON_NO_PULL)
        if self.pulls:
            column.picture(_ROW * len(texts.LESSON_PULL_PARTS), self._draw_pulls)

    def _found(self) -> list[float]:
        """Return the pulls in points, in the order of their texts."""
        pulls = self.pulls
        assert pulls is not None
        return [pull / self.step.scale for pull in (pulls.own, pulls.others, pulls.earlier, pulls.bend)]

    def _draw_value(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the value before and after, and its target."""
        low, high = min(self._values), max(self._values)
        before, after, target = (
            box.left + 10 + (box.width - 20) * (value - low) / max(high - low, 1e-9) for value in self._values
        )
        y = box.centery
        canvas.line((box.left, y), (box.right, y), LINE)
        canvas.line((before, y), (after, y), NET, 2.5)
        canvas.dot((before, y), 4, FAINT)
        canvas.dot((after, y), 5, NET)
        canvas.marker("ring", (target, y), 12, HUMAN)
        for x, value, word in zip((before, after, target), self._values, texts.LESSON_VALUE_MARKS, strict=True):
            rows = [(texts.LESSON_OWN_SCALE, number(value * self.step.scale))]
            if self._pulled:
                rows.append((texts.LESSON_IN_POINTS.format(scale=f"{self.step.scale:g}"), points(value, 3)))
            canvas.explain((x - 6, y - 6, 12, 12), word, partial(told, *rows))

    def _draw_pulls(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw a bar for each pull: blue towards the target, orange away from it."""
        found, (before, _, target) = self._found(), self._values
        most, zero = max(1e-12, *map(abs, found)), box.left + 0.83 * box.width
        canvas.line((zero, box.top), (zero, box.bottom), LINE)
        for row, (pull, (word, help_)) in enumerate(zip(found, texts.LESSON_PULL_PARTS, strict=True)):
            y, length = box.top + _ROW * row + 19, 0.16 * box.width * pull / most
            canvas.text(word.format(count=self.step.examples - 1), (box.left, y), size=SMALL, colour=MUTE,
                        room=_NAMES * box.width)  # fmt: skip
            end = box.left + _FIGURES * box.width
            canvas.text(points(pull), (end, y), size=SMALL, align="right", tabular=True)
            area = canvas.rect(min(zero, zero + length), y - 8, max(abs(length), 1), 7)
            canvas.fill(area, NET if pull * (target - before) >= 0 else EMBER)
            canvas.explain((box.left, y - 14, box.width, _ROW), help_, partial(points, pull, 3))
