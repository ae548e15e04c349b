"""Card of the target: its sum, the error, and the weights that move, forward and back."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.explain.agent_lesson import Lesson
from ai.explain.inspection import links
from ai.explain.learning_step import Step
from ai.lander.environment import ACTION_NAMES
from ai.nn import DuelingLayer, NeuralNetwork
from game.core import texts
from game.drawing.canvas import Point
from game.drawing.cursor import Cursor
from game.drawing.tokens import HUMAN, SMALL
from game.explain.figures import decimal, points
from game.explain.network_view import NetworkView
from game.explain.tables import Line, Part, formula, table
from game.scenes.lesson.card import Card
from game.scenes.lesson.moment import said_action
from game.ui.panel import Column

_LEAST: Final = 300.0  # width of a column
_NETWORK, _LOWEST = 230.0, 150.0  # height, and the least of it
_MOST_DIGITS: Final = 12


class TargetCard(Card):
    """Card of the target, the error, and the step of each weight; `taken` is that of this memory alone.

    Attributes:
        view: the network.
        weight: the one with the steepest slope: its link, and the units at its ends; none of a dueling layer, which
            mixes several.

    """

    def __init__(self, lesson: Lesson, network: NeuralNetwork, taken: Step) -> None:
        (name, general), scale = texts.LESSON_CARDS["target"], lesson.config.reward_scale
        said = texts.LESSON_TOO[lesson.error > 0].format(by=decimal(abs(lesson.error) / scale, 2))
        super().__init__(name, f"{general} {said}", DeepQAgent.targets, "targets")
        self._lesson, self._network, self.taken, self._scale = lesson, network, taken, scale
        network.gradients[:] = taken.gradient
        self.view = NetworkView((0, 0, 700, _NETWORK), texts.INPUTS, tuple(map(texts.said, ACTION_NAMES)))
        self.view.output_scale, self._high, self.view.lit = scale, _NETWORK, int(lesson.cell.action)
        self.weight = _steepest(network)
        self.turn(True)

    def turn(self, back: int) -> None:
        """Show the slopes that flow back, or the values that flow forward."""
        self.view.show = "gradients" if back else "activations"
        self.view.set(self._network, self._lesson.state)

    def describe(self, column: Column) -> None:
        column.add(formula(lambda: _sum(self._lesson)))
        column.aside(_roles(self._lesson))
        left, right = column.beside((1, 1), _LEAST)
        left.choice("", texts.LESSON_WAYS, int(self.view.show == "gradients"), self.turn, SMALL)
        left.add(self._write_network)
        if self.weight:
            link, start, end = self.weight
            name = f"{self.view.unit_name(link, start)} → {self.view.unit_name(link + 1, end)}"
            right.text(texts.LESSON_STEP_OF.format(weight=name), size=SMALL, colour=HUMAN)
            right.add(table((), self._parts))
            right.aside(texts.LESSON_ALL_WEIGHTS.format(count=len(self.taken.gradient)))

    def _write_network(self, cursor: Cursor) -> None:
        """Draw the network; the steepest weight is amber where both its ends are shown."""
        if cursor.seen:  # so that the legend at its foot is in sight below longer words, too
            self._high = min(max(cursor.seen.bottom - cursor.y, _LOWEST), _NETWORK)
        box = cursor.take(self._high)
        if cursor.canvas is None:
            self.view.place(box)
            return
        self.view.draw(cursor.canvas)
        link, *units = self.weight or (0,)
        ends = [
            self.view.centres[column][place]
            for column, unit in enumerate(units, link)
            for place in np.flatnonzero(self.view.columns[column].units == unit)
        ]
        if len(ends) == 2:
            cursor.canvas.line(ends[0], ends[1], HUMAN, 1.5)

    def point(self, place: Point | None) -> None:
        self.view.hover(place)

    def update(self, still: bool) -> None:
        self.view.update()

    def _parts(self) -> list[Line]:
        """Return the way from the slope of the steepest weight to its new value."""
        assert self.weight is not None
        link, at = links(self._network)[self.weight[0]], self.weight[1:]
        # The cost is the square of the error in the network's scale, so a slope of it is twice the error times that of
        # the value. Both are written in points, and so the step length goes with points.
        scale, old = self._scale, float(link.weights[at])
        error, rate = self._lesson.error / scale, 2.0 * self.taken.learning_rate * scale**2
        slope = float(link.gradient[at]) / (2.0 * scale**2 * error) if error else 0.0
        step = -slope * error * rate
        figures = _digits(slope), points(error), _digits(rate), _digits(step), _digits(old), _digits(old + step)
        lines = zip(texts.LESSON_STEP_PARTS, figures, strict=True)
        return [Line(cells, lit=place == len(figures) - 1) for place, cells in enumerate(lines)]


def _steepest(network: NeuralNetwork) -> tuple[int, int, int] | None:
    """Return the weight with the steepest slope, but for a dueling layer's, which are sums of several."""
    dueling = any(isinstance(layer, DuelingLayer) for layer in network.layers)
    slopes = [np.abs(np.nan_to_num(link.gradient)) for link in links(network)]
    found = max(range(len(slopes) - dueling), key=lambda link: slopes[link].max(), default=None)
    if found is None:
        return None
    start, end = np.unravel_index(int(slopes[found].argmax()), slopes[found].shape)
    return found, int(start), int(end)


def _digits(value: float) -> str:
    """Write a number with five digits that count, so that who multiplies it comes to what is written."""
    size = math.floor(math.log10(abs(value))) if value else 0
    return decimal(value, min(max(4 - size, 0), _MOST_DIGITS))


def _sum(lesson: Lesson) -> list[Part]:
    """Return the target as pay, plus the discounted value afterwards."""
    target, pay, value = (
        points(float(each) / lesson.config.reward_scale)
        for each in (lesson.target, lesson.cell.reward, lesson.next_value)
    )
    discount = texts.LESSON_PART_DISCOUNT.format(count=int(lesson.cell.steps))
    parts = [
        Part(target, texts.LESSON_TARGET, texts.LESSON_TARGET_HELP),
        Part("="),
        Part(pay, texts.LESSON_PART_PAY),
        Part("+"),
        Part(f"{lesson.discount:.4f}", discount, texts.LESSON_DISCOUNT_HELP),
        Part("×"),
        Part(value, texts.LESSON_PART_NEXT),
    ]
    return [*parts, Part("×"), Part("0", texts.LESSON_PART_ENDED)] if lesson.cell.terminal else parts


def _roles(lesson: Lesson) -> str:
    """Say which network picks the action afterwards, and which one judges it; or why none does."""
    config = lesson.config
    role = "double" if config.double else "single"
    kind = "ended" if lesson.cell.terminal else role if config.target_judges else "newest"
    value = points(lesson.next_value / config.reward_scale)
    return texts.LESSON_ROLES[kind].format(action=said_action(lesson.best), value=value)
