"""Frames of the update: the target of a value, its error, and what the step did to it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import pairwise
from typing import Final

import numpy as np
import pygame

from ai.agent.agent import DeepQAgent
from ai.explain.agent_lesson import Lesson
from ai.explain.recorder import Function
from ai.nn import NeuralNetwork
from ai.nn.costs import COSTS, Cost
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import CAPTION, EMBER, FAINT, HUMAN, INK, LINE, MUTE, NET, SMALL
from game.explain.figures import decimal, number, points, signed
from game.explain.tables import Line, Part, figure_rows, formula, from_left, table
from game.scenes.lesson.flight import said_action
from game.scenes.lesson.frame import Frame, in_points, pulled
from game.scenes.lesson.step import LearningStep, Pulls
from game.ui.panel import Column

_LEAST: Final = 300.0  # width of a column


def target_frame(lesson: Lesson) -> Frame:
    """Return the frame of the target: its sum, and the values afterwards with who picks and who judges."""

    def describe(column: Column) -> None:
        column.add(formula(lambda: _sum(lesson)))
        column.gap(4)
        left, right = column.beside((1, 1), _LEAST)
        lines = _values(lesson)
        left.add(table(_head(lesson), lambda: lines))
        for words in _roles(lesson):
            right.text(words, size=SMALL, colour=MUTE)
            right.gap(4)

    functions = (DeepQAgent.targets, DeepQAgent._next_value, NeuralNetwork.predict)
    figure = in_points(lesson.target / lesson.config.reward_scale)
    return Frame(texts.LESSON_FRAMES["target"], figure, functions, "targets", describe)


def _sum(lesson: Lesson) -> list[Part]:
    """Return the target as pay, plus the discounted value afterwards."""
    steps, ended = int(lesson.cell.steps), bool(lesson.cell.terminal)
    target, pay, value = (
        float(each) / lesson.config.reward_scale for each in (lesson.target, lesson.cell.reward, lesson.next_value)
    )
    whole = figure_rows(
        (texts.LESSON_PART_PAY, points(pay)),
        (
            texts.LESSON_PART_VALUE.format(factor=f"{lesson.discount:.4f}", value=points(value)),
            points(0.0 if ended else lesson.discount * value),
        ),
        (texts.LESSON_TARGET, points(target)),
    )
    factor = figure_rows((f"{lesson.config.discount:g}^{steps}", f"{lesson.discount:.4f}"))
    parts = [
        Part(points(target), texts.LESSON_TARGET, texts.LESSON_TARGET_HELP, whole),
        Part("="),
        Part(points(pay), texts.LESSON_PART_PAY, texts.LESSON_RETURN_HELP),
        Part("+"),
        Part(
            f"{lesson.discount:.3f}", texts.LESSON_PART_DISCOUNT.format(count=steps), texts.LESSON_DISCOUNT_HELP, factor
        ),
        Part("×"),
        Part(points(value), texts.LESSON_PART_NEXT, texts.LESSON_NEXT_HELP),
    ]
    return [*parts, Part("×"), Part("0", texts.LESSON_PART_ENDED, texts.LESSON_NOTHING_AFTER)] if ended else parts


def _head(lesson: Lesson) -> tuple[str, ...]:
    """Return the heads of the values' table: one network, or one that picks and one that judges."""
    if lesson.next_online is not None:
        return "", texts.LESSON_PICK, texts.LESSON_JUDGE
    return "", texts.LESSON_PICK_AND_JUDGE if lesson.config.target_judges else texts.LESSON_NEWEST_JUDGES


def _values(lesson: Lesson) -> list[Line]:
    """Return the values of the six actions afterwards, by each of the networks, on one scale."""
    scale = lesson.config.reward_scale
    shown = np.stack([each for each in (lesson.next_online, lesson.next_judged) if each is not None], axis=1) / scale
    low, span = float(shown.min()), max(float(np.ptp(shown)), 1e-9)
    return [
        Line((said_action(action), *map(points, row)), texts.LESSON_NEXT_HELP,
             figure_rows((texts.LESSON_OWN_SCALE, " ".join(number(value * scale) for value in row))),
             lit=action == lesson.best, bars=[from_left((value - low) / span) for value in row])
        for action, row in enumerate(shown.tolist())
    ]  # fmt: skip


def _roles(lesson: Lesson) -> list[str]:
    """Say which network picks, which one judges, and what comes of it; or what stands in for a second one."""
    config, words = lesson.config, texts.LESSON_ROLES_NEWEST
    if lesson.next_online is not None:
        said = [*texts.LESSON_ROLES_DOUBLE]
    elif config.target_judges:
        said = [*texts.LESSON_ROLES_SINGLE]
    else:
        pays = [words["pays"].format(count=int(lesson.cell.steps))] if config.n_step > 1 else []
        said = [words["picks"], *pays, words["normalised" if config.layer_normalisation else "bare"]]
    judged = lesson.next_judged / config.reward_scale
    own, most = points(float(judged[lesson.best])), points(float(judged.max()))
    return [text.format(action=said_action(lesson.best), value=own, most=most) for text in said]


def draw_on_line(canvas: Canvas, box: pygame.FRect, ends: tuple[float, float], marks: Sequence[float]) -> list[float]:
    """Draw a value on its way, `marks`: where it begins, where it is, and its target; return where they stand."""
    low, high, y = min(marks), max(marks), box.centery
    start, now, target = (ends[0] + (ends[1] - ends[0]) * (mark - low) / max(high - low, 1e-9) for mark in marks)
    canvas.line((box.left, y), (box.right, y), LINE)
    canvas.line((start, y), (now, y), NET, 2.5)
    canvas.dot((start, y), 4, FAINT)
    canvas.dot((now, y), 5, NET)
    canvas.marker("ring", (target, y), 12, HUMAN)
    return [start, now, target]


_LINE, _CHART = 72.0, 180.0  # heights
_POINTS: Final = 121  # of a curve
_WIDEST: Final = 1.15  # the axis reaches so many times as far as the largest error of the batch


class ErrorFrame(Frame):
    """Frame of the error."""

    def __init__(self, lesson: Lesson) -> None:
        self._scale, self._lesson = lesson.config.reward_scale, lesson
        words, error = texts.LESSON_FRAMES["error"], lesson.error / self._scale
        self._cost: Cost = COSTS[lesson.config.cost]()
        said = texts.LESSON_TOO[error > 0].format(by=decimal(abs(error), 2)) if error else ""
        functions = (DeepQAgent.gradient_step, self._cost.function, self._cost.derivative)
        super().__init__(words, in_points(error), functions, "errors", sentence=f"{words[1]} {said}".strip())
        self._reach = _WIDEST * max(float(np.abs(lesson.batch_errors).max()), abs(lesson.error), 1e-6)
        self._cache = PaintCache()

    def cost_of(self, error: float) -> float:
        """Return the cost of one memory with an error, in the network's own scale."""
        return self._cost(np.array([error]), np.array([0.0]))

    def push_of(self, error: float) -> float:
        """Return the derivative of that cost by the value."""
        return float(self._cost.derivative(np.array([error]), np.array([0.0]))[0])

    def describe(self, column: Column) -> None:
        column.picture(_LINE, self._draw_line)
        cost, delta = self._lesson.config.cost, float(self._cost.options.get("delta", 0.0))
        column.caption(texts.LESSON_COSTS[cost])
        column.picture(_CHART, self._draw_curve)
        column.explain(texts.LESSON_COST_HELP)
        column.add(formula(self._result))
        column.aside(texts.LESSON_BENDS[cost].format(delta=f"{delta / self._scale:g}"))

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
        lesson, y = self._lesson, box.centery
        predicted, target = float(lesson.predicted[int(lesson.cell.action)]) / self._scale, lesson.target / self._scale
        ends = (box.left + 0.15 * box.width, box.left + 0.85 * box.width)
        _, here, there = draw_on_line(canvas, box, ends, (predicted, predicted, target))
        canvas.line((here, y), (there, y), EMBER, 1.5)
        for x, value, word, colour in (
            (here, predicted, texts.LESSON_PREDICTED, NET),
            (there, target, texts.LESSON_TARGET, HUMAN),
        ):
            canvas.text(f"{word} {points(value)}", (x, y - 16), size=SMALL, colour=colour, align="centre", tabular=True)
        error_words = f"{texts.LESSON_ERROR} {points(lesson.error / self._scale)}"
        canvas.text(error_words, ((here + there) / 2, y + 22), size=SMALL, colour=MUTE, align="centre", tabular=True)
        canvas.explain((ends[0], y - 6, ends[1] - ends[0], 12), texts.LESSON_ERROR_HELP)

    def _draw_curve(self, canvas: Canvas, box: pygame.FRect) -> None:
        chart = pygame.FRect(0, 8, box.width, box.height - 28)
        self._cache.draw(canvas, box, (), lambda sheet: self._paint_curve(sheet, chart))

    def _paint_curve(self, sheet: Canvas, box: pygame.FRect) -> None:
        """Paint the cost over errors, with each memory of the batch on it."""
        errors, own = np.linspace(-self._reach, self._reach, _POINTS).tolist(), self._lesson.error
        high = max(self.cost_of(self._reach), 1e-12)

        def place(error: float) -> tuple[float, float]:
            x = box.left + box.width * (error + self._reach) / (2 * self._reach)
            return x, box.bottom - box.height * self.cost_of(error) / high

        sheet.line((box.centerx, box.top), (box.centerx, box.bottom), LINE)
        sheet.line((box.left, box.bottom), (box.right, box.bottom), LINE)
        for start, end in pairwise(map(place, errors)):
            sheet.line(start, end, MUTE, 1.5)
        for error in np.delete(self._lesson.batch_errors, self._lesson.step.row).tolist():
            sheet.dot(place(error), 1.8, FAINT)
        sheet.line((place(own)[0], box.bottom), place(own), EMBER, 1.5)
        sheet.dot(place(own), 4.5, INK)
        widest, y = points(self._reach / self._scale, 1), box.bottom + 18
        sheet.text(widest.replace("+", "−"), (box.left, y), size=CAPTION, colour=MUTE)
        sheet.text("0", (box.centerx, y), size=CAPTION, colour=MUTE, align="centre")
        sheet.text(texts.LESSON_POINTS.format(points=widest), (box.right, y), size=CAPTION, colour=MUTE, align="right")


_MOVED: Final = 60.0  # height


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
        self.step, self._write = step, write
        self.pulls = None if derivative is None else Pulls.of(step, derivative, values[1] - values[0])
        self._found = [pull / step.scale for pull in self.pulls or ()]  # in points, in the order of their texts
        closer = abs(before - target) - abs(after - target)
        self._result_words = telling[closer <= 0].format(
            before=write(before), after=write(after), target=write(target), by=number(abs(closer))
        )
        if self._found:
            strongest = int(np.argmax(np.abs(self._found)))
            name = texts.LESSON_PULL_PARTS[strongest][0].format(count=step.examples - (strongest > 0))
            self._result_words = f"{self._result_words} {texts.LESSON_STRONGEST.format(name=name)}"

    def describe(self, column: Column) -> None:
        column.text(self._result_words, size=SMALL)
        column.picture(_MOVED, self._draw_value)
        if self._found:
            column.gap(8)
            column.aside(texts.LESSON_PULLS)
            column.beside((1, 1), _LEAST)[0].add(table((), self._lines))

    def _draw_value(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the value before and after, and its target."""
        places, y = draw_on_line(canvas, box, (box.left + 10, box.right - 10), self._values), box.centery
        for x, value, word in zip(places, self._values, texts.LESSON_VALUE_MARKS, strict=True):
            canvas.explain((x - 6, y - 6, 12, 12), word, partial(self._write, value))

    def _lines(self) -> list[Line]:
        """Return a line for each pull; those towards the target are lit."""
        (before, _, target), most = self._values, max(1e-12, *map(abs, self._found))
        return [
            Line((word.format(count=self.step.examples - (row > 0)), pulled(pull)), help_,
                 lit=pull * (target - before) >= 0, bars=[from_left(abs(pull) / most)])
            for row, (pull, (word, help_)) in enumerate(zip(self._found, texts.LESSON_PULL_PARTS, strict=True))
        ]  # fmt: skip
