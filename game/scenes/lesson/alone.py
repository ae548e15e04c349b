"""First frame of a lesson: this memory alone, learned again and again until its value is at its target."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import pygame

from ai.explain.agent_lesson import LearnedAlone, Lesson
from ai.nn import NeuralNetwork
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import CAPTION, FAINT, HUMAN, MUTE, NET, NIGHT0, SMALL
from game.explain.figures import points
from game.explain.tables import Line, Part, formula, from_zero, table
from game.scenes.lesson.flight import said_action
from game.scenes.lesson.frame import Frame, pulled
from game.scenes.lesson.step import LearningStep, Pulls
from game.ui.panel import Column

_HEIGHT: Final = 220.0  # of the way
_PACE: Final = 4  # frames between two steps, while it goes on by itself
_SPAN: Final = 24  # steps that the way has room for at least
_MOST: Final = 120  # steps, with which any has arrived
_LEAST: Final = 240.0  # width of a column


class AloneFrame(Frame):
    """Frame of the memory alone; `step` is the run's own, from whose network it begins.

    Attributes:
        alone: the network that learns this memory alone.
        going: whether it goes on by itself until it has arrived.

    """

    def __init__(self, lesson: Lesson, step: LearningStep) -> None:
        self._lesson, self._step, self._scale = lesson, step, lesson.config.reward_scale
        self._action, words = int(lesson.cell.action), texts.LESSON_FRAMES["alone"]
        before, target = (points(each / self._scale) for each in (lesson.predicted[self._action], lesson.target))
        sentence = words[1].format(action=said_action(self._action), value=before, target=target)
        super().__init__(words, target, (NeuralNetwork.correct,), sentence=sentence)
        self._moved = float(lesson.predicted_after[self._action]) - float(lesson.predicted[self._action])
        self._frames = 0
        self.again()

    def again(self) -> None:
        """Begin with the network as it was before the run's step."""
        self.alone = LearnedAlone(self._step.network, self._lesson.state, self._action, self._lesson.target)
        self._first, self.going = self.alone.outputs, False

    def once(self) -> None:
        """Learn it once more."""
        self.going = False
        self._learn()

    def go(self) -> None:
        """Learn it until the value is at its target."""
        self.going = True

    def update(self, still: bool) -> None:
        self._frames += 1
        while self.going and (still or self._frames % _PACE == 0):
            self._learn()
            self.going = not self.alone.arrived and len(self.alone.way) <= _MOST
            if not still:
                break

    def _learn(self) -> None:
        if len(self.alone.way) <= _MOST:
            self.alone.step()

    def describe(self, column: Column) -> None:
        column.words([(texts.LESSON_ALONE_ONCE, self.once), (texts.LESSON_ALONE_GO, self.go),
                      (texts.LESSON_ALONE_AGAIN, self.again)])  # fmt: skip
        way, six = column.beside((3, 2), _LEAST)
        way.add(formula(self._figures))
        way.picture(_HEIGHT, self._draw_way)
        six.add(table(texts.LESSON_ALONE_HEAD, self._values))
        column.text(self._result_words, size=SMALL, colour=MUTE)

    def _result_words(self) -> str:
        arrived = f"{texts.LESSON_ALONE_ARRIVED} " if self.alone.arrived else ""
        own = pulled(Pulls.of(self._step, self._lesson.derivative, self._moved).own / self._scale)
        return f"{arrived}{texts.LESSON_ALONE_MORE.format(count=self._step.examples, own=own)}"

    def _figures(self) -> list[Part]:
        """Return the value, and its target."""
        count = texts.LESSON_ALONE_VALUE.format(count=len(self.alone.way) - 1)
        return [
            Part(points(self.alone.way[-1] / self._scale), count, colour=NET),
            Part("→"),
            Part(points(self.alone.target / self._scale), texts.LESSON_ALONE_TARGET, colour=HUMAN),
        ]

    def _draw_way(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the way of the value to its target, step by step."""
        chart = pygame.FRect(box.left + 56, box.top + 24, box.width - 80, box.height - 48)
        alone = self.alone
        low, high = min(*alone.way, alone.target), max(*alone.way, alone.target)
        span, per_unit = max(_SPAN, len(alone.way) - 1), chart.height / max(high - low, 1e-9)
        way = [
            (chart.left + chart.width * at / span, chart.bottom - per_unit * (value - low))
            for at, value in enumerate(alone.way)
        ]
        y = chart.bottom - per_unit * (alone.target - low)
        canvas.line((chart.left, y), (chart.right, y), HUMAN, 1.5, 0.8)
        beyond = -8 if way[0][1] > y else 8 + CAPTION  # on the side from which the way does not come
        canvas.text(texts.LESSON_TARGET, (chart.right, y + beyond), size=CAPTION, colour=HUMAN, align="right")
        canvas.text(points(alone.way[0] / self._scale), (chart.left - 10, way[0][1] + 4), size=CAPTION, colour=MUTE,
                    align="right")  # fmt: skip
        for start, end in pairwise(way):
            canvas.line(start, end, mix(NIGHT0, NET, 0.7), 1.5)
        for place in way[:-1]:
            canvas.dot(place, 2.5, FAINT)
        canvas.glow(way[-1], 22, NET, 0.5)
        canvas.dot(way[-1], 6, NET)
        if alone.arrived:
            canvas.marker("ring", way[-1], 20, HUMAN)

    def _values(self) -> list[Line]:
        """Return each action's value now, its change, and the bar of the change, from 0; the target is on the scale."""
        before, now = (each / self._scale for each in (self._first, self.alone.outputs))
        goal = self.alone.target / self._scale - float(before[self._action])
        changes = [goal, *(now - before).tolist()]
        return [
            Line(
                (said_action(action), points(end), points(end - start)),
                lit=action == self._action,
                bars=[from_zero(end - start, min(changes), max(changes))],
            )
            for action, (start, end) in enumerate(zip(before.tolist(), now.tolist(), strict=True))
        ]
