"""Frame of the error, and of how the cost bends it: the cost's own curve with all memories of the batch on it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.agent.agent import DeepQAgent
from ai.explain.agent_lesson import Lesson
from ai.nn.costs import COSTS, Cost
from game.core import texts
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import CAPTION, EMBER, FAINT, HUMAN, INK, LINE, MUTE, NET, SMALL
from game.panels.figures import decimal, number, points, signed
from game.panels.tables import Part, formula, told
from game.scenes.lesson.frame import Frame, in_points

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.ui.panel import Column

Curve = Callable[[float], float]
_LINE, _CHART = 72.0, 180.0  # heights
_POINTS: Final = 121  # of a curve
_WIDEST: Final = 1.15  # the axis reaches so many times as far as the largest error of the batch
_LEAST: Final = 260.0  # width of a chart


class ErrorFrame(Frame):
    """Frame of the error."""

    def __init__(self, lesson: Lesson) -> None:
        self._scale, self._lesson = lesson.config.reward_scale, lesson
        words, error = texts.LESSON_FRAMES["error"], lesson.error / self._scale
        self._cost: Cost = COSTS[lesson.config.cost]()
        said = texts.LESSON_TOO[error > 0].format(by=decimal(abs(error), 2)) if error else ""
        functions = (DeepQAgent.gradient_step, self._cost.function, self._cost.derivative)
        super().__init__(words, in_points(error), functions, "errors", f"{words[1]} {said}".strip())
        largest = max(float(np.abs(lesson.batch_errors).max()), abs(lesson.error), 1e-6)
        self._delta = float(self._cost.options.get("delta", 0.0))
        # Where errors are far from the bend of the cost, the bend is out of sight, and the curves say so truly.
        self._reach = max(_WIDEST * largest, 1.2 * self._delta if largest > 0.3 * self._delta else 0.0)
        self._cache = PaintCache(most=2)

    def cost_of(self, error: float) -> float:
        """Return the cost of one memory with an error, in the network's own scale."""
        return self._cost(np.array([error]), np.array([0.0]))

    def push_of(self, error: float) -> float:
        """Return the derivative of that cost by the value."""
        return float(self._cost.derivative(np.array([error]), np.array([0.0]))[0])

    def describe(self, column: Column) -> None:
        """Add the value beside its target, the two curves, and what goes back into the network."""
        column.picture(_LINE, self._draw_line)
        cost = self._lesson.config.cost
        curves = ((texts.LESSON_COSTS[cost], self.cost_of, texts.LESSON_COST_HELP),
                  (texts.LESSON_PUSH, self.push_of, texts.LESSON_PUSH_HELP))  # fmt: skip
        for side, (title, curve, help_) in zip(column.beside((1, 1), _LEAST), curves, strict=True):
            rows = told((texts.LESSON_ERROR, points(self._lesson.error / self._scale)),
                        (texts.LESSON_OWN_SCALE, signed(self._lesson.error)),
                        (title, number(curve(self._lesson.error))))  # fmt: skip
            side.caption(title)
            side.picture(_CHART, partial(self._draw_curve, curve))
            side.rows[-1].what, side.rows[-1].now = help_, partial(str, rows)
        column.add(formula(self._result))
        column.aside(texts.LESSON_BENDS[cost].format(delta=f"{self._delta / self._scale:g}"))

    def _result(self) -> list[Part]:
        """Return how the push of this memory becomes what goes back into the network."""
        lesson, count = self._lesson, len(self._lesson.batch_errors)
        return [
            Part(signed(self.push_of(lesson.error)), texts.LESSON_PUSHES, texts.LESSON_PUSH_HELP),
            Part("÷"),
            Part(str(count), texts.LESSON_SHARED, texts.LESSON_SHARED_HELP),
            Part("×"),
            Part(f"{lesson.weight:g}", texts.LESSON_WEIGHTED),
            Part("="),
            Part(signed(lesson.derivative), texts.LESSON_DERIVATIVE, texts.LESSON_DERIVATIVE_HELP),
        ]

    def _draw_line(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the value and its target on a line, and the error between them."""
        lesson, y = self._lesson, box.top + 34
        predicted, target = float(lesson.predicted[int(lesson.cell.action)]) / self._scale, lesson.target / self._scale
        ends = (box.left + 0.15 * box.width, box.left + 0.85 * box.width)
        here, there = ends if predicted <= target else ends[::-1]
        canvas.line((box.left, y), (box.right, y), LINE)
        canvas.line((here, y), (there, y), EMBER, 2.5)
        canvas.dot((here, y), 5, NET)
        canvas.marker("ring", (there, y), 12, HUMAN)
        for x, value, word, colour in ((here, predicted, texts.LESSON_PREDICTED, NET),
                                       (there, target, texts.LESSON_TARGET, HUMAN)):  # fmt: skip
            canvas.text(f"{word} {points(value)}", (x, y - 16), size=SMALL, colour=colour, align="centre", tabular=True)
        middle = ((here + there) / 2, y + 22)
        told_error = f"{texts.LESSON_ERROR} {points(lesson.error / self._scale)}"
        canvas.text(told_error, middle, size=SMALL, colour=MUTE, align="centre", tabular=True)
        canvas.explain((ends[0], y - 6, ends[1] - ends[0], 12), texts.LESSON_ERROR_HELP)

    def _draw_curve(self, curve: Curve, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw a curve over errors, with each memory of the batch on it."""
        chart = pygame.FRect(0, 8, box.width, box.height - 28)
        self._cache.draw(canvas, box, curve.__name__, lambda sheet: self._paint_curve(sheet, chart, curve))

    def _paint_curve(self, sheet: Canvas, box: pygame.FRect, curve: Curve) -> None:
        errors, own = np.linspace(-self._reach, self._reach, _POINTS).tolist(), self._lesson.error
        low, high = min(0.0, *map(curve, errors[:: _POINTS - 1])), max(0.0, *map(curve, errors[:: _POINTS - 1]))

        def place(error: float) -> tuple[float, float]:
            x = box.left + box.width * (error + self._reach) / (2 * self._reach)
            return x, box.bottom - box.height * (curve(error) - low) / max(high - low, 1e-12)

        base = place(0.0)[1]
        sheet.line((box.centerx, box.top), (box.centerx, box.bottom), LINE)
        sheet.line((box.left, base), (box.right, base), LINE)
        for start, end in pairwise(map(place, errors)):
            sheet.line(start, end, MUTE, 1.5)
        for error in np.delete(self._lesson.batch_errors, self._lesson.step.row).tolist():
            sheet.dot(place(error), 1.8, FAINT)
        sheet.line((place(own)[0], base), place(own), EMBER, 1.5)
        sheet.dot(place(own), 4.5, INK)
        widest, y = points(self._reach / self._scale, 1), box.bottom + 18
        sheet.text(widest.replace("+", "−"), (box.left, y), size=CAPTION, colour=MUTE)
        sheet.text("0", (box.centerx, y), size=CAPTION, colour=MUTE, align="centre")
        sheet.text(texts.LESSON_POINTS.format(points=widest), (box.right, y), size=CAPTION, colour=MUTE, align="right")
