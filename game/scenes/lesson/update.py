"""Frames of the update: the target of a value with its error, and what the step did to the value."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Final

import numpy as np
import pygame

from ai.agent.agent import DeepQAgent
from ai.explain.agent_lesson import Lesson
from ai.nn import NeuralNetwork, Optimizer
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import EMBER, FAINT, HUMAN, LINE, MUTE, NET, SMALL
from game.explain.figures import decimal, number, points
from game.explain.tables import Line, Part, figure_rows, formula, from_left, table
from game.scenes.lesson.flight import said_action
from game.scenes.lesson.frame import Frame, in_points, pulled
from game.scenes.lesson.step import LearningStep, Pulls
from game.ui.panel import Column

_LEAST: Final = 300.0  # width of a column
_ERROR, _MOVED = 72.0, 60.0  # heights


def target_frame(lesson: Lesson) -> Frame:
    """Return the frame of the target: its sum, the error, and the values afterwards with who picks and who judges."""
    words = texts.LESSON_FRAMES["target"]
    by = decimal(abs(lesson.error) / lesson.config.reward_scale, 2)
    said = texts.LESSON_TOO[lesson.error > 0].format(by=by) if lesson.error else ""

    def describe(column: Column) -> None:
        column.add(formula(lambda: _sum(lesson)))
        column.picture(_ERROR, partial(_draw_error, lesson))
        column.gap(4)
        left, right = column.beside((1, 1), _LEAST)
        lines = _values(lesson)
        left.add(table(_head(lesson), lambda: lines))
        for words in _roles(lesson):
            right.text(words, size=SMALL, colour=MUTE)
            right.gap(4)

    functions = (DeepQAgent.targets, DeepQAgent._next_value, NeuralNetwork.predict)
    figure = in_points(lesson.target / lesson.config.reward_scale)
    return Frame(words, figure, functions, "targets", describe, f"{words[1]} {said}".strip())


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


def _draw_error(lesson: Lesson, canvas: Canvas, box: pygame.FRect) -> None:
    """Draw the value and its target on a line, and the error between them."""
    scale, y = lesson.config.reward_scale, box.centery
    predicted, target = float(lesson.predicted[int(lesson.cell.action)]) / scale, lesson.target / scale
    ends = (box.left + 0.15 * box.width, box.left + 0.85 * box.width)
    _, here, there = draw_on_line(canvas, box, ends, (predicted, predicted, target))
    canvas.line((here, y), (there, y), EMBER, 1.5)
    for x, value, word, colour in (
        (here, predicted, texts.LESSON_PREDICTED, NET),
        (there, target, texts.LESSON_TARGET, HUMAN),
    ):
        canvas.text(f"{word} {points(value)}", (x, y - 16), size=SMALL, colour=colour, align="centre", tabular=True)
    error = f"{texts.LESSON_ERROR} {points(lesson.error / scale)}"
    canvas.text(error, ((here + there) / 2, y + 22), size=SMALL, colour=MUTE, align="centre", tabular=True)
    canvas.explain((ends[0], y - 6, ends[1] - ends[0], 12), texts.LESSON_ERROR_HELP)


class AfterFrame(Frame):
    """Frame after the step: where the value went, and what pulled it there.

    Attributes:
        pulls: what moved the value, in the network's scale.

    """

    def __init__(self, lesson: Lesson, step: LearningStep) -> None:
        action, scale = int(lesson.cell.action), lesson.config.reward_scale
        raw = float(lesson.predicted[action]), float(lesson.predicted_after[action]), lesson.target
        self._values = before, after, target = [value / scale for value in raw]
        functions = (Optimizer.step, DeepQAgent._update_target)
        super().__init__(texts.LESSON_FRAMES["after"], in_points(after), functions, "values")
        self.step, self.pulls = step, Pulls.of(step, lesson.derivative, raw[1] - raw[0])
        self._found = [pull / scale for pull in self.pulls]  # in points, in the order of their texts
        closer = abs(before - target) - abs(after - target)
        self._result_words = texts.LESSON_NEARER[closer <= 0].format(
            before=points(before), after=points(after), target=points(target), by=number(abs(closer))
        )
        strongest = int(np.argmax(np.abs(self._found)))
        name = texts.LESSON_PULL_PARTS[strongest][0].format(count=step.examples - (strongest > 0))
        self._result_words = f"{self._result_words} {texts.LESSON_STRONGEST.format(name=name)}"

    def describe(self, column: Column) -> None:
        column.text(self._result_words, size=SMALL)
        column.picture(_MOVED, self._draw_value)
        column.gap(8)
        column.aside(texts.LESSON_PULLS)
        column.beside((1, 1), _LEAST)[0].add(table((), self._lines))

    def _draw_value(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the value before and after, and its target."""
        places, y = draw_on_line(canvas, box, (box.left + 10, box.right - 10), self._values), box.centery
        for x, value, word in zip(places, self._values, texts.LESSON_VALUE_MARKS, strict=True):
            canvas.explain((x - 6, y - 6, 12, 12), word, partial(points, value))

    def _lines(self) -> list[Line]:
        """Return a line for each pull; those towards the target are lit."""
        (before, _, target), most = self._values, max(1e-12, *map(abs, self._found))
        return [
            Line((word.format(count=self.step.examples - (row > 0)), pulled(pull)), help_,
                 lit=pull * (target - before) >= 0, bars=[from_left(abs(pull) / most)])
            for row, (pull, (word, help_)) in enumerate(zip(self._found, texts.LESSON_PULL_PARTS, strict=True))
        ]  # fmt: skip
