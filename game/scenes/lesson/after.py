"""Frame after the step: the weights that changed most, the value again, and who pulled on it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.explain.recorder import Function
from game.core import texts
from game.drawing.tokens import EMBER, FAINT, HUMAN, LINE, MUTE, NET, SMALL
from game.panels.figures import decimal, number, points, signed
from game.panels.tables import Line, table, told
from game.scenes.lesson.frame import Frame, in_points
from game.scenes.lesson.step import LearningStep, Pulls, WeightPlace

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.ui.panel import Column

_WEIGHTS: Final = 8
_LEAST: Final = 340.0  # width of a column
_LINE, _ROW = 36.0, 22.0  # heights
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
        """Add the value, who pulled on it, and the weights that changed most."""
        left, right = column.beside((1, 1), _LEAST)
        left.text(self._told, size=SMALL)
        left.picture(_LINE, self._draw_value)
        if self._pulled:
            left.gap(8)
            left.aside(texts.LESSON_PULLS if self.pulls else texts.LESSON_NO_PULL)
        if self.pulls:
            left.picture(_ROW * len(texts.LESSON_PULL_PARTS), self._draw_pulls)
        changed = [line for place in self.step.strongest(self.step.taken.taken, _WEIGHTS) for line in self._line(place)]
        right.add(table((texts.LESSON_CHANGED, *texts.LESSON_CHANGED_COLUMNS), lambda: changed))

    def _line(self, place: WeightPlace) -> list[Line]:
        """Return the line of a weight; none for one of a dueling layer."""
        step, taken = self.step, self.step.taken
        if (index := step.index(place)) is None:
            return []
        before, after, moved, slope, share = (
            float(each[index])
            for each in (taken.values_before, taken.values_after, -taken.taken, taken.gradient, taken.share)
        )
        rows = told(
            (texts.LESSON_BEFORE, decimal(before, 6)), (texts.LESSON_STEP, signed(moved)),
            (texts.LESSON_NOW, decimal(after, 6)), (texts.LESSON_SLOPE_BATCH, signed(slope)),
            (texts.LESSON_SLOPE_SHARE, signed(share)),
        )  # fmt: skip
        return [
            Line((step.weight_name(place), number(before), number(after), signed(moved)), texts.LESSON_WEIGHT, rows)
        ]

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
            y, length = box.top + _ROW * row + 15, 0.16 * box.width * pull / most
            canvas.text(word.format(count=self.step.examples - 1), (box.left, y), size=SMALL, colour=MUTE,
                        room=_NAMES * box.width)  # fmt: skip
            end = box.left + _FIGURES * box.width
            canvas.text(points(pull), (end, y), size=SMALL, align="right", tabular=True)
            area = canvas.rect(min(zero, zero + length), y - 8, max(abs(length), 1), 7)
            canvas.fill(area, NET if pull * (target - before) >= 0 else EMBER)
            canvas.explain((box.left, y - 14, box.width, _ROW), help_, partial(points, pull, 3))
