"""Last card of a lesson: the same moment again, learned from this memory alone until its value is at its target."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import pygame

from ai.explain.agent_lesson import LearnedAlone, Lesson
from ai.nn import Optimizer
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import CAPTION, FAINT, HUMAN, MUTE, NET, NIGHT0, SMALL
from game.explain.figures import points, signed
from game.explain.tables import Line, Part, formula, from_left, from_zero, table
from game.scenes.lesson.card import Card, in_points
from game.scenes.lesson.moment import said_action
from game.scenes.lesson.step import LearningStep, Pulls
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
        more: whether it is said what the run's own step did with its value, which learns from a whole batch.

    """

    def __init__(self, lesson: Lesson, own: LearningStep, alone: LearnedAlone) -> None:
        self._lesson, self._own, self._scale, self.alone = lesson, own, lesson.config.reward_scale, alone
        self._action, self._frames = int(lesson.cell.action), 0
        self.going, self.more = True, False
        super().__init__(texts.LESSON_CARDS["again"][0], "", "", (Optimizer.step,), "values")

        self._say()

    def _say(self) -> None:
        """Say what has become of the value."""
        count, before, now, target = len(self.alone.way) - 1, self.alone.way[0], self.alone.way[-1], self.alone.target
        self.figure = in_points(now / self._scale)
        said = texts.LESSON_LEARNED.format(
            action=said_action(self._action), count=count, before=points(before / self._scale),
            now=points(now / self._scale), target=points(target / self._scale),
        )  # fmt: skip
        nearer = texts.LESSON_NEARER if abs(now - target) < abs(before - target) else ""
        self.sentence = f"{said} {nearer}".strip()

    def take(self, alone: LearnedAlone) -> None:
        """Go on with another network, to where it arrives."""
        self.alone, self.going = alone, not alone.arrived
        self._say()

    def begin_anew(self) -> None:
        """Begin with the network as it was before the step of the card before, and learn."""
        self.take(LearnedAlone(self._own.network, self._lesson.state, self._action, self._lesson.target))

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
        way.add(formula(self._figures))
        way.picture(_HEIGHT, self._draw_way)
        six.add(table(texts.LESSON_SIX_HEAD, self._values))
        column.gap()
        column.button(texts.LESSON_MORE[self.more], self._open)
        if self.more:
            self._describe_own(column)

    def _open(self) -> None:
        self.more, self.changed = not self.more, True

    def _describe_own(self, column: Column) -> None:
        """Add what the run's own step did with this value, and what pulled it there."""
        lesson, scale = self._lesson, self._scale
        before, after = (float(each[self._action]) / scale for each in (lesson.predicted, lesson.predicted_after))
        pulls = Pulls.of(self._own, lesson.derivative, (after - before) * scale)
        found = [pull / scale for pull in pulls]
        others, most = self._own.examples - 1, max(1e-12, *map(abs, found))
        column.text(texts.LESSON_OWN_STEP.format(count=others, before=points(before, 4), after=points(after, 4)),
                    size=SMALL)  # fmt: skip
        lines = [
            Line((word.format(count=others), signed(pull)), help_,
                 lit=pull * (lesson.target / scale - before) >= 0, bars=[from_left(abs(pull) / most)])
            for pull, (word, help_) in zip(found, texts.LESSON_PULL_PARTS, strict=True)
        ]  # fmt: skip
        column.beside((1, 1), _LEAST)[0].add(table((), lambda: lines))

    def _figures(self) -> list[Part]:
        """Return the value, and its target."""
        count = texts.LESSON_TIMES.format(count=len(self.alone.way) - 1)
        return [
            Part(points(self.alone.way[-1] / self._scale), count, colour=NET),
            Part("→"),
            Part(points(self.alone.target / self._scale), texts.LESSON_TARGET, colour=HUMAN),
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
