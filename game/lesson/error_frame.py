"""Frame of the error, and of how the cost bends it: the cost's own curve with all memories of the batch on it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Final

import numpy as np
import pygame

from ai.environment import Doubles
from ai.explain.agent_lesson import Lesson
from ai.explain.recorder import Function
from ai.nn.costs import COSTS, Cost
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import EMBER, FAINT, HUMAN, INK, LABEL, LINE, MUTE, NET
from game.lesson.frame import PICTURE, SMALL_PICTURE, Explanation, Frame, Spot, rows_of
from game.panels.figures import number, points, signed

Curve = Callable[[float], float]

_LINE: Final = 46.0  # height of the line of values
_COST, _PUSH = pygame.FRect(0, 118, 352, 166), pygame.FRect(400, 118, 352, 166)
_POINTS: Final = 121  # of a curve
_WIDEST: Final = 1.15  # the axis reaches so many times as far as the largest error of the batch


class ErrorFrame(Frame):
    """Frame of the error."""

    def __init__(self, lesson: Lesson, words: Sequence[str], functions: Sequence[Function]) -> None:
        self._scale, self._lesson = lesson.config.reward_scale, lesson
        error = texts.LESSON_POINTS.format(points=points(lesson.error / self._scale))
        super().__init__(words[0], error, f"{words[1]} {self._said()}".strip(), functions)
        self.begin = "errors"
        self._cost: Cost = COSTS[lesson.config.cost]()
        largest = max(float(np.abs(lesson.batch_errors).max()), abs(lesson.error), 1e-6)
        delta = float(self._cost.options.get("delta", 0.0))
        # Where errors are far from the bend of the cost, the bend is out of sight, and the curves say so truly.
        self._reach = max(_WIDEST * largest, 1.2 * delta if largest > 0.3 * delta else 0.0)
        self._errors: Doubles = np.linspace(-self._reach, self._reach, _POINTS)
        self._write_line()
        self._write_curve(_COST, texts.LESSON_COSTS[lesson.config.cost], self.cost_of, texts.LESSON_COST_HELP)
        self._write_curve(_PUSH, texts.LESSON_PUSH, self.push_of, texts.LESSON_PUSH_HELP)
        self._write_result()

    def cost_of(self, error: float) -> float:
        """Return the cost of one memory with an error, in the network's own scale."""
        return self._cost(np.array([error]), np.array([0.0]))

    def push_of(self, error: float) -> float:
        """Return the derivative of that cost by the value."""
        return float(self._cost.derivative(np.array([error]), np.array([0.0]))[0])

    def _said(self) -> str:
        """Return in words which way the value was wrong; nothing where it was right."""
        error = self._lesson.error / self._scale
        return texts.LESSON_TOO[error > 0].format(by=f"{abs(error):.2f}") if error else ""

    def _write_line(self) -> None:
        lesson, scale = self._lesson, self._scale
        predicted = float(lesson.predicted[int(lesson.cell.action)]) / scale
        target, error = lesson.target / scale, lesson.error / scale
        low, high = min(predicted, target), max(predicted, target)
        around = max(0.25 * (high - low), 1e-6)
        self._ends = {
            each: 90 + 570 * (each - low + around) / (high - low + 2 * around) for each in (predicted, target)
        }
        self._values = (predicted, target)
        for value, word, y in (
            (predicted, texts.LESSON_PREDICTED, _LINE - 16),
            (target, texts.LESSON_TARGET, _LINE + 30),
        ):
            text = f"{word} {points(value)}"
            own = rows_of((texts.LESSON_OWN_SCALE, number(value * scale)))
            self.label(text, self._ends[value], y, align="centre", explanation=Explanation((word,), own), room=300)
        rows = rows_of(
            (texts.LESSON_PREDICTED, points(predicted)),
            (texts.LESSON_TARGET, points(target)),
            (texts.LESSON_ERROR, points(error)),
            (texts.LESSON_OWN_SCALE, signed(lesson.error)),
        )
        box = pygame.FRect(min(self._ends.values()), _LINE - 6, abs(self._ends[predicted] - self._ends[target]), 12)
        self.spots.append(Spot(box, Explanation((texts.LESSON_ERROR_HELP,), rows)))

    def _write_curve(self, box: pygame.FRect, title: str, curve: Curve, help_: str) -> None:
        """Write the texts of a curve over errors, and what its points say."""
        self.label(title, box.left, box.top - 12, size=LABEL, colour=MUTE, explanation=Explanation((help_,)), room=340)
        end = points(self._reach / self._scale, 1)
        self.label(end.replace("+", "−"), box.left, box.bottom + 18, size=LABEL - 1, colour=MUTE)
        self.label("0", box.centerx, box.bottom + 18, size=LABEL - 1, colour=MUTE, align="centre")
        self.label(texts.LESSON_POINTS.format(points=end), box.right, box.bottom + 18, size=LABEL - 1, colour=MUTE,
                   align="right", room=120)  # fmt: skip
        for place, error in self._crowd(box, curve):
            rows = rows_of((texts.LESSON_ERROR, points(error / self._scale)), (title, number(curve(error))))
            spot = pygame.FRect(place[0] - 3, place[1] - 3, 6, 6)
            self.spots.append(Spot(spot, Explanation((texts.LESSON_ANOTHER,), rows)))
        place = self._place(box, curve, self._lesson.error)
        rows = rows_of(
            (texts.LESSON_ERROR, points(self._lesson.error / self._scale)),
            (texts.LESSON_OWN_SCALE, signed(self._lesson.error)),
            (title, number(curve(self._lesson.error))),
        )
        self.spots.append(Spot(pygame.FRect(place[0] - 4, place[1] - 4, 5, 5),
                               Explanation((texts.LESSON_THIS,), rows)))  # fmt: skip

    def _place(self, box: pygame.FRect, curve: Curve, error: float) -> tuple[float, float]:
        ends = [curve(-self._reach), curve(self._reach)]
        low, high = min(0.0, *ends), max(0.0, *ends)
        x = box.left + box.width * (error + self._reach) / (2 * self._reach)
        return x, box.bottom - box.height * (curve(error) - low) / max(high - low, 1e-12)

    def _crowd(self, box: pygame.FRect, curve: Curve) -> list[tuple[tuple[float, float], float]]:
        """Return the places of the other memories of the batch on a curve, with their errors."""
        errors = np.delete(self._lesson.batch_errors, self._lesson.step.row).tolist()
        return [(self._place(box, curve, error), error) for error in errors]

    def _write_result(self) -> None:
        lesson, count = self._lesson, len(self._lesson.batch_errors)
        y = _COST.bottom + 48
        push = self.push_of(lesson.error)
        rows = rows_of(
            (texts.LESSON_PUSH, signed(push)),
            (texts.LESSON_SHARED.format(count=count), f"÷ {count}"),
            (texts.LESSON_WEIGHTED, f"× {lesson.weight:g}"),
            (texts.LESSON_DERIVATIVE, signed(lesson.derivative)),
        )
        text = texts.LESSON_DERIVATIVE_SUM.format(
            push=signed(push), count=count, weight=f"{lesson.weight:g}", derivative=signed(lesson.derivative)
        )
        self.label(text, 0, y, explanation=Explanation((texts.LESSON_DERIVATIVE_HELP,), rows), room=PICTURE.width)
        delta = float(self._cost.options.get("delta", 0.0)) / self._scale
        bend = texts.LESSON_BENDS[lesson.config.cost].format(delta=f"{delta:g}")
        self.prose(bend, 0, y + 21, PICTURE.width)

    def paint(self, canvas: Canvas) -> None:
        """Paint the line of values, and the two curves with the batch on them."""
        predicted, target = (self._ends[value] for value in self._values)
        canvas.line((0, _LINE), (PICTURE.width, _LINE), LINE)
        canvas.line((predicted, _LINE), (target, _LINE), EMBER, 2.5)
        canvas.dot((predicted, _LINE), 5, NET)
        canvas.marker("ring", (target, _LINE), 12, HUMAN)
        for box, curve in ((_COST, self.cost_of), (_PUSH, self.push_of)):
            zero = self._place(box, lambda _: 0.0, 0.0)[0]
            canvas.line((zero, box.top), (zero, box.bottom), LINE)
            base = self._place(box, curve, 0.0)[1]
            canvas.line((box.left, base), (box.right, base), LINE)
            places = [self._place(box, curve, error) for error in self._errors.tolist()]
            for start, end in pairwise(places):
                canvas.line(start, end, MUTE, 1.5)
            for place, _ in self._crowd(box, curve):
                canvas.dot(place, 1.8, FAINT)
            here = self._place(box, curve, self._lesson.error)
            canvas.line((here[0], base), here, EMBER, 1.5)
            canvas.dot(here, 4.5, INK)

    def paint_small(self, canvas: Canvas) -> None:
        """Paint the value and its target, each on its side."""
        predicted, target = (self._ends[value] for value in self._values)
        y, (left, right) = SMALL_PICTURE[1] / 2, (5.0, SMALL_PICTURE[0] - 5)
        ends = (left, right) if predicted <= target else (right, left)
        canvas.line((ends[0], y), (ends[1], y), EMBER, 2)
        canvas.dot((ends[0], y), 4, NET)
        canvas.marker("ring", (ends[1], y), 9, HUMAN)
