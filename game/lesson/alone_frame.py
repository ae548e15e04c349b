"""First frame of a lesson: this memory alone, learned again and again until its value is at its target."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final

import pygame

from ai.explain.agent_lesson import LearnedAlone, Lesson
from ai.explain.recorder import Function
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, LINE, MUTE, NET, NIGHT0, SMALL, TEXT, TITLE
from game.lesson.frame import PICTURE, SMALL_PICTURE, Frame
from game.lesson.moment_frame import said_action
from game.lesson.step import LearningStep
from game.panels.figures import points

_CHART: Final = pygame.FRect(64, 136, 440, 250)
_OTHERS: Final = 560.0  # left end of the six values
_ROW: Final = 28.0
_PACE: Final = 4  # frames between two steps, while it goes on by itself
_SPAN: Final = 24  # steps that the chart has room for at least
_MOST: Final = 120  # steps, with which any has arrived


class AloneFrame(Frame):
    """Frame of the memory alone; `step` is the run's own, from whose network it begins.

    Attributes:
        alone: the network that learns this memory alone.
        going: whether it goes on by itself until it has arrived.

    """

    def __init__(self, lesson: Lesson, words: Sequence[str], functions: Sequence[Function], step: LearningStep) -> None:
        self._lesson, self._step, self._scale = lesson, step, lesson.config.reward_scale
        self._action = int(lesson.cell.action)
        before, target = (
            points(value / self._scale) for value in (float(lesson.predicted[self._action]), lesson.target)
        )
        sentence = words[1].format(action=said_action(self._action), value=before, target=target)
        super().__init__(words[0], target, sentence, functions)
        self._frames = 0
        self.again()

    def again(self) -> None:
        """Begin with the network as it was before the run's step."""
        lesson = self._lesson
        self.alone = LearnedAlone(self._step.network, lesson.state, self._action, lesson.target)
        self._first = self.alone.outputs
        self.going = False
        self._write()

    def once(self) -> None:
        """Learn it once more."""
        self.going = False
        self._learn()

    def go(self) -> None:
        """Learn it until the value is at its target."""
        self.going = True

    def update(self, still: bool) -> None:
        """Take a step now and then, while it goes on; all at once with reduced motion."""
        self._frames += 1
        while self.going and (still or self._frames % _PACE == 0):
            self._learn()
            self.going = not self.alone.arrived and len(self.alone.way) <= _MOST
            if not still:
                break

    def _learn(self) -> None:
        if len(self.alone.way) <= _MOST:
            self.alone.step()
            self._write()

    def _write(self) -> None:
        self.labels.clear()
        alone, scale = self.alone, self._scale
        value, target = alone.way[-1] / scale, alone.target / scale
        self.label(points(value), 0, 34, size=TITLE, colour=NET)
        self.label(texts.LESSON_ALONE_VALUE.format(count=len(alone.way) - 1), 0, 56, size=LABEL, colour=MUTE, room=200)
        self.label(points(target), 230, 34, size=TITLE, colour=HUMAN)
        self.label(texts.LESSON_ALONE_TARGET, 230, 56, size=LABEL, colour=MUTE, room=200)
        x = 0.0
        for word, press in ((texts.LESSON_ALONE_ONCE, self.once), (texts.LESSON_ALONE_GO, self.go),
                            (texts.LESSON_ALONE_AGAIN, self.again)):  # fmt: skip
            label = self.label(word, x, 100, size=TEXT, colour=NET, press=press, room=240)
            x = label.box.right + 36
        self.label(texts.LESSON_ALONE_OTHERS, _OTHERS, 142, size=LABEL, colour=MUTE, room=PICTURE.width - _OTHERS)
        for place, (before, after) in enumerate(zip(self._first, alone.outputs, strict=True)):
            y, colour = 170 + _ROW * place, NET if place == self._action else MUTE
            self.label(said_action(place), _OTHERS, y, size=SMALL, colour=colour, room=96)
            moved = (float(after) - float(before)) / scale
            self.label(points(moved), PICTURE.width, y, align="right", size=SMALL, colour=colour, room=90)
        told = texts.LESSON_ALONE_ARRIVED if alone.arrived else texts.LESSON_ALONE_MORE
        self.prose(told.format(count=self._step.examples - 1), 0, 418, PICTURE.width, INK if alone.arrived else MUTE)
        self.changed()

    def _height(self, value: float) -> float:
        """Return where a value stands on the chart, in points from the top of the picture."""
        shown = (*self.alone.way, self.alone.target)
        low, high = min(shown), max(shown)
        around = 0.08 * max(high - low, 1e-9)
        return _CHART.bottom - _CHART.height * (value - low + around) / (high - low + 2 * around)

    def paint(self, canvas: Canvas) -> None:
        """Paint the way of the value to its target, step by step."""
        span = max(_SPAN, len(self.alone.way) - 1)
        way = [(_CHART.left + _CHART.width * at / span, self._height(value)) for at, value in enumerate(self.alone.way)]
        y = self._height(self.alone.target)
        canvas.line((_CHART.left, _CHART.top), (_CHART.left, _CHART.bottom), LINE)
        canvas.line((_CHART.left, y), (_CHART.right, y), HUMAN, 1.5)
        beyond = -6 if way[0][1] > y else 6 + LABEL  # on the side from which the way does not come
        canvas.text(texts.LESSON_TARGET, (_CHART.right, y + beyond), size=LABEL, colour=HUMAN, align="right")
        canvas.text(points(self.alone.way[0] / self._scale), (_CHART.left - 8, way[0][1] + 4), size=LABEL, colour=MUTE,
                    align="right")  # fmt: skip
        for start, end in pairwise(way):
            canvas.line(start, end, mix(NIGHT0, NET, 0.7), 1.5)
        for place in way[:-1]:
            canvas.dot(place, 2.5, FAINT)
        canvas.dot(way[-1], 6, NET)

    def paint_small(self, canvas: Canvas) -> None:
        """Paint a way that comes to its target."""
        wide, high = SMALL_PICTURE
        canvas.line((0, 5), (wide, 5), HUMAN, 1)
        places = [(wide * at / 8, 5 + (high - 8) * 0.6**at) for at in range(9)]
        for start, end in pairwise(places):
            canvas.line(start, end, NET, 1.5)
        canvas.dot(places[-1], 3, NET)
