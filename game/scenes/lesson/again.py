"""Last card of a lesson: the same moment again, learned from this memory alone until its value is at its target."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import pygame

from ai.explain.agent_lesson import LearnedAlone, Lesson
from ai.nn import NeuralNetwork, Optimizer
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import FAINT, HUMAN, LABEL, MUTE, NET, NIGHT0
from game.explain.figures import points
from game.explain.tables import Line, from_zero, table
from game.scenes.lesson.card import Card
from game.scenes.lesson.moment import said_action
from game.ui.panel import Column

_HEIGHT: Final = 200.0  # of the way
_PACE: Final = 8  # frames between two steps, while it goes on by itself
_SPAN: Final = 24  # steps that the way has room for at least
_MOST: Final = 120  # steps, with which any has arrived
_LEAST: Final = 240.0  # width of a column


class AgainCard(Card):
    """Card of the same moment again: what its value has become, having learned this memory alone.

    Attributes:
        alone: the network that learns it, with the step of the card before already taken.
        going: whether it goes on by itself until it has arrived, as it does at first.

    """

    def __init__(self, lesson: Lesson, network: NeuralNetwork, alone: LearnedAlone) -> None:
        super().__init__(texts.LESSON_CARDS["again"][0], "", Optimizer.step, "values")
        self._lesson, self._network, self._scale, self.alone = lesson, network, lesson.config.reward_scale, alone
        self._action, self._frames, self.going = int(lesson.cell.action), 0, True
        self._say()

    def _say(self) -> None:
        """Say what has become of the value."""
        way, target = self.alone.way, self.alone.target
        before, now, goal = (points(each / self._scale) for each in (way[0], way[-1], target))
        self.sentence = texts.LESSON_LEARNED.format(
            action=said_action(self._action), count=len(way) - 1, before=before, now=now, target=goal
        )

    def begin_anew(self) -> None:
        """Begin with the network as it was before the step of the card before, and learn."""
        self.alone = LearnedAlone(self._network, self._lesson.state, self._action, self._lesson.target)
        self.going = True
        self._say()

    def once(self) -> None:
        """Learn it once more."""
        self.going = False
        self._learn()

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
        self._say()

    def describe(self, column: Column) -> None:
        column.words([(texts.LESSON_ONCE, self.once), (texts.LESSON_ANEW, self.begin_anew)])
        way, six = column.beside((3, 2), _LEAST)
        way.picture(_HEIGHT, self._draw_way)
        six.add(table(texts.LESSON_SIX_HEAD, self._values))

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
        beyond = -8 if way[0][1] > y else 8 + LABEL  # on the side from which the way does not come
        canvas.text(texts.LESSON_TARGET, (chart.right, y + beyond), size=LABEL, colour=HUMAN, align="right")
        canvas.text(points(alone.way[0] / self._scale), (chart.left - 10, way[0][1] + 4), size=LABEL, colour=MUTE,
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
        before, now = (each / self._scale for each in (self._lesson.predicted, self.alone.outputs))
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
