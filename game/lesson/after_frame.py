"""Frame after the step: the weights that changed most, the value again, and who pulled on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pygame

from ai.explain.recorder import Function
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import EMBER, FAINT, HUMAN, INK, LABEL, LINE, MUTE, NET
from game.lesson.frame import PICTURE, SMALL_PICTURE, Explanation, Frame, Spot, rows_of
from game.lesson.pulls import Pulls
from game.lesson.step import LearningStep
from game.panels.figures import number, points, signed

_WEIGHTS: Final = 8
_ROW: Final = 25.0
_NAME, _BEFORE, _AFTER, _STEP = 0.0, 470.0, 590.0, 752.0  # the last three are right ends
_VALUE: Final = 270.0  # first baseline of the second half
_LINE: Final = _VALUE + 36.0  # height of the line of values
_PULLS: Final = (0.0, 160.0, 210.0)  # name, right end of the figure, left end of the bars


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
        names: Sequence[str],
        values: tuple[float, float, float],
        derivative: float | None,
        telling: Sequence[str],
    ) -> None:
        before, after, target = (value / step.scale for value in values)
        self._in_points = derivative is not None
        figure = texts.LESSON_POINTS.format(points=points(after)) if self._in_points else number(after)
        super().__init__(words[0], figure, words[1], functions)
        self.step, self._values = step, (before, after, target)
        self.pulls = None if derivative is None else Pulls.of(step, derivative, values[1] - values[0])
        self.begin = "values"
        self._bars: list[tuple[pygame.FRect, bool]] = []
        self._write_weights(names)
        self._write_value(telling)
        if derivative is not None:
            self._write_pulls()

    def _write_weights(self, names: Sequence[str]) -> None:
        self.heading(texts.LESSON_CHANGED, _NAME, 12, 300)
        for right, word in zip((_BEFORE, _AFTER, _STEP), texts.LESSON_CHANGED_COLUMNS, strict=True):
            self.label(word, right, 12, size=LABEL, colour=MUTE, align="right", room=110)
        step = self.step
        for row, (place, name) in enumerate(zip(step.strongest(step.taken.taken, _WEIGHTS), names, strict=False)):
            index = step.index(place)
            if index is None:
                continue
            y = 36 + _ROW * row
            before, after = float(step.taken.values_before[index]), float(step.taken.values_after[index])
            moved = -float(step.taken.taken[index])
            rows = rows_of(
                (texts.LESSON_BEFORE, f"{before:.6f}".replace("-", "−")),
                (texts.LESSON_STEP, signed(moved)),
                (texts.LESSON_NOW, f"{after:.6f}".replace("-", "−")),
                (texts.LESSON_SLOPE_BATCH, signed(float(step.taken.gradient[index]))),
                (texts.LESSON_SLOPE_SHARE, signed(float(step.taken.share[index]))),
            )
            told = Explanation((name,), rows)
            self.label(name, _NAME, y, colour=MUTE, explanation=told, room=340)
            for right, text in ((_BEFORE, number(before)), (_AFTER, number(after)), (_STEP, signed(moved))):
                self.label(text, right, y, align="right", explanation=told, room=100)

    def _write_value(self, telling: Sequence[str]) -> None:
        before, after, target = self._values
        write = points if self._in_points else number
        closer = abs(before - target) - abs(after - target)
        sentence = telling[closer <= 0].format(
            before=write(before), after=write(after), target=write(target), by=number(abs(closer))
        )
        if self.pulls is not None:
            strongest = int(np.argmax(np.abs(self._pulled())))
            name = texts.LESSON_PULL_PARTS[strongest][0].format(count=self.step.examples - 1)
            sentence = f"{sentence} {texts.LESSON_STRONGEST.format(name=name)}"
        self.prose(sentence, 0, _VALUE, PICTURE.width, INK)
        low, high = min(self._values), max(self._values)
        around = max(0.1 * (high - low), 1e-9)
        self._ends = [30 + 692 * (each - low + around) / (high - low + 2 * around) for each in self._values]
        for x, value, word in zip(self._ends, self._values, texts.LESSON_VALUE_MARKS, strict=True):
            rows = rows_of((texts.LESSON_OWN_SCALE, number(value * self.step.scale)))
            if self._in_points:
                rows += rows_of((texts.LESSON_IN_POINTS.format(scale=f"{self.step.scale:g}"), points(value, 3)))
            self.spots.append(Spot(pygame.FRect(x - 6, _LINE - 6, 12, 12), Explanation((word,), rows)))

    def _write_pulls(self) -> None:
        y = _LINE + 32
        self.heading(texts.LESSON_PULLS, 0, y, 720)
        if self.pulls is None:
            self.label(texts.LESSON_NO_PULL, 0, y + 24, colour=MUTE, room=PICTURE.width)
            return
        found = self._pulled()
        most = max(1e-12, *map(abs, found))
        for row, (pull, (word, help_)) in enumerate(zip(found, texts.LESSON_PULL_PARTS, strict=True)):
            baseline = y + 24 + 22 * row
            told = Explanation((help_,), rows_of((word.format(count=self.step.examples - 1), points(pull, 3))))
            self.label(word.format(count=self.step.examples - 1), _PULLS[0], baseline, colour=MUTE,
                       explanation=told, room=_PULLS[1] + 90)  # fmt: skip
            self.label(points(pull), _PULLS[1] + 160, baseline, align="right", explanation=told, room=64)
            length = 150 * pull / most
            middle = 560.0
            box = pygame.FRect(min(middle, middle + length), baseline - 8, max(abs(length), 1), 7)
            self._bars.append((box, pull * (self._values[2] - self._values[0]) >= 0))

    def _pulled(self) -> list[float]:
        """Return the pulls in points, in the order of their texts."""
        pulls, scale = self.pulls, self.step.scale
        assert pulls is not None
        return [pull / scale for pull in (pulls.own, pulls.others, pulls.earlier, pulls.bend)]

    def paint(self, canvas: Canvas) -> None:
        """Paint the line of values with an arrow from before to after, and the bars of the pulls."""
        y = _LINE
        before, after, target = self._ends
        canvas.line((0, y), (PICTURE.width, y), LINE)
        canvas.line((before, y), (after, y), NET, 2.5)
        canvas.dot((before, y), 4, FAINT)
        canvas.dot((after, y), 5, NET)
        canvas.marker("ring", (target, y), 12, HUMAN)
        if self._bars:
            canvas.line((560, _LINE + 42), (560, _LINE + 124), LINE)
        for box, towards in self._bars:
            canvas.fill(canvas.rect(*box), NET if towards else EMBER)
        canvas.line((0, _VALUE - 22), (PICTURE.width, _VALUE - 22), LINE)

    def paint_small(self, canvas: Canvas) -> None:
        """Paint the value before and after, and its target."""
        low, y = min(self._ends), SMALL_PICTURE[1] / 2
        span = max(max(self._ends) - low, 1e-9)
        before, after, target = (5 + (SMALL_PICTURE[0] - 10) * (end - low) / span for end in self._ends)
        canvas.line((0, y), (SMALL_PICTURE[0], y), LINE)
        canvas.marker("ring", (target, y), 9, HUMAN)
        canvas.line((before, y), (after, y), NET, 2)
        canvas.dot((before, y), 2.5, FAINT)
        canvas.dot((after, y), 3.5, NET)
