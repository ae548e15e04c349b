"""Card of the target: its sum, the error, and the weights that move, forward and back."""

from __future__ import annotations

import math
from functools import partial
from typing import Final

import numpy as np
import pygame

from ai.agent.agent import DeepQAgent
from ai.explain.agent_lesson import Lesson
from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.cursor import Cursor
from game.drawing.tokens import EMBER, HUMAN, LINE, MUTE, NET, SMALL
from game.explain.figures import decimal, number, points
from game.explain.network_view import NetworkView
from game.explain.tables import Line, Part, figure_rows, formula, table
from game.scenes.lesson.card import Card, in_points
from game.scenes.lesson.moment import said_action
from game.scenes.lesson.step import LearningStep, Weight
from game.ui.panel import Column

_LEAST: Final = 300.0  # width of a column
_ERROR: Final = 64.0  # height
_NETWORK, _LOWEST = 230.0, 150.0  # height, and the least of it
_TERMS: Final = 6  # products of a unit's sum that are written out one by one; the others are summed
_MOST_DIGITS: Final = 12
_DIGITS: Final = 4  # of each, after the point, so that what is written adds up


class TargetCard(Card):
    """Card of the target, the error, and the step of each weight; `step` is that of this memory alone.

    Attributes:
        back: whether the slopes are shown that flow back, in place of the values that flow forward.
        view: the network.
        weight: the one with the steepest slope; None in a dueling layer, which mixes several.

    """

    def __init__(self, lesson: Lesson, step: LearningStep) -> None:
        words, by = texts.LESSON_CARDS["target"], decimal(abs(lesson.error) / step.scale, 2)
        said = texts.LESSON_TOO[lesson.error > 0].format(by=by) if lesson.error else ""
        super().__init__(words[0], f"{words[1]} {said}".strip(), in_points(lesson.target / step.scale),
                         (DeepQAgent.targets,), "targets")  # fmt: skip
        self._lesson, self.step, self.back, self._network = lesson, step, False, step.network.copy()
        self._network.gradients[:] = step.taken.gradient
        self.view = NetworkView((0, 0, 700, _NETWORK), step.inputs, step.outputs)
        self._high = _NETWORK
        self.view.reads_out, self.view.output_scale = False, step.scale
        self.weight = step.steepest()
        self.turn(True)

    def turn(self, back: int) -> None:
        """Show the values, or the slopes."""
        self.back, self.view.show = bool(back), "gradients" if back else "activations"
        self.view.set(self._network, self.step.observation)

    def describe(self, column: Column) -> None:
        column.add(formula(lambda: _sum(self._lesson)))
        column.aside(_roles(self._lesson))
        column.picture(_ERROR, partial(_draw_error, self._lesson))
        left, right = column.beside((1, 1), _LEAST)
        left.choice("", texts.LESSON_WAYS, int(self.back), self.turn, SMALL)
        left.add(self._write_network)
        if self.weight:
            right.text(texts.LESSON_STEP_OF.format(weight=self.step.weight_name(self.weight)), size=SMALL, colour=HUMAN)
            right.add(table((), partial(self._parts, self.weight)))
            right.aside(texts.LESSON_STEP_PARTS["rate"][1])
            right.aside(texts.LESSON_ALL_WEIGHTS.format(count=len(self.step.taken.gradient)))

    def _write_network(self, cursor: Cursor) -> None:
        if cursor.canvas is None:
            if cursor.seen:  # so that the legend at its foot is in sight below longer words, too
                self._high = min(max(cursor.seen.bottom - cursor.y, _LOWEST), _NETWORK)
            self.view.place(cursor.take(self._high))
        else:
            cursor.take(self._high)
            self._draw(cursor.canvas)

    def point(self, place: Point | None) -> None:
        self.view.hover(place)

    def update(self, still: bool) -> None:
        self.view.update()

    def _draw(self, canvas: Canvas) -> None:
        """Draw the network; each unit explains itself, and the steepest weight is amber where its ends are shown."""
        self.view.draw(canvas)
        if self.weight and len(ends := self._ends(self.weight)) == 2:
            canvas.line(ends[0], ends[1], HUMAN, 1.5)
        for column, centres in enumerate(self.view.centres):
            for place, (x, y) in enumerate(centres):
                unit = int(self.view.columns[column].units[place])
                name = self.step.unit_name(column, unit)
                canvas.explain((x - 6, y - 6, 12, 12), name, partial(self.unit, column, unit))

    def _ends(self, weight: Weight) -> list[Point]:
        """Return the two ends of a link, as far as they are shown."""
        ends = ((weight.link, weight.start), (weight.link + 1, weight.end))
        return [
            self.view.centres[column][place]
            for column, unit in ends
            for place in np.flatnonzero(self.view.columns[column].units == unit)
        ]

    def unit(self, column: int, unit: int) -> str:
        """Explain a unit: its sum, whose terms as they are written add up, and all that is made of it."""
        step = self.step
        if column == 0:
            return figure_rows((texts.LESSON_SENSED, number(float(step.given(0)[unit]))))
        link, stages, into = step.weights[column - 1], step.stages[column - 1], step.given(column - 1)
        products = into * link.weights[:, unit]
        strongest = np.argsort(-np.abs(np.nan_to_num(products)), kind="stable")[:_TERMS]
        terms = [round(float(products[start]), _DIGITS) for start in strongest]
        bias, total = (round(float(each), _DIGITS) for each in (link.bias[unit], stages[0][1][unit]))
        rows = [
            (texts.LESSON_TERM.format(
                name=step.unit_name(column - 1, int(start)), value=number(float(into[start])),
                weight=number(float(link.weights[start, unit])),
            ), decimal(term, _DIGITS, "+"))
            for start, term in zip(strongest, terms, strict=True)
        ]  # fmt: skip
        if others := len(products) - len(rows):
            rest = decimal(total - bias - sum(terms), _DIGITS, "+")
            rows.append((texts.LESSON_OTHERS.format(count=others), rest))
        rows.append((texts.NETWORK_VIEW_BIAS, decimal(bias, _DIGITS, "+")))
        rows += [
            (texts.LESSON_STAGES.get(kind, kind), decimal(float(values[unit]), _DIGITS)) for kind, values in stages
        ]
        if column == len(step.weights):
            scaled = points(float(stages[-1][1][unit]) / step.scale)
            rows.append((texts.LESSON_IN_POINTS.format(scale=f"{step.scale:g}"), scaled))
        return f"{texts.LESSON_SUM}\n{figure_rows(*rows)}"

    def _parts(self, weight: Weight) -> list[Line]:
        """Return the way from the slope of a weight to its new value."""
        taken, scale, at = self.step.taken, self.step.scale, weight.place
        old = float(taken.values_before[at])
        # The cost is the square of the error in the network's scale, so a slope of it is twice the error times that of
        # the value. Both are written in points, and so the learning rate goes with points.
        error, rate = self._lesson.error / scale, 2.0 * taken.learning_rate * scale**2
        slope = float(taken.gradient[at]) / (2.0 * scale**2 * error) if error else 0.0
        step = -slope * error * rate
        figures = {
            "slope": _digits(slope), "error": points(error), "rate": _digits(rate), "step": _digits(step),
            "before": _digits(old), "now": _digits(old + step),
        }  # fmt: skip
        words = texts.LESSON_STEP_PARTS
        return [Line((words[name][0], figure), words[name][1], lit=name == "now") for name, figure in figures.items()]


def _digits(value: float) -> str:
    """Write a number with five digits that count, so that who multiplies it comes to what is written."""
    size = math.floor(math.log10(abs(value))) if value else 0
    return decimal(value, min(max(4 - size, 0), _MOST_DIGITS))


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
            f"{lesson.discount:.4f}", texts.LESSON_PART_DISCOUNT.format(count=steps), texts.LESSON_DISCOUNT_HELP, factor
        ),
        Part("×"),
        Part(points(value), texts.LESSON_PART_NEXT, texts.LESSON_NEXT_HELP, _values(lesson)),
    ]
    return [*parts, Part("×"), Part("0", texts.LESSON_PART_ENDED, texts.LESSON_NOTHING_AFTER)] if ended else parts


def _values(lesson: Lesson) -> str:
    """List the values of the six actions afterwards, by the network that judges."""
    judged = (lesson.next_judged / lesson.config.reward_scale).tolist()
    return figure_rows(*((said_action(action), points(value)) for action, value in enumerate(judged)))


def _roles(lesson: Lesson) -> str:
    """Say which network picks, which one judges, and what comes of it; what stands in for a second one; or why none."""
    if lesson.cell.terminal:
        return texts.LESSON_NOTHING_AFTER
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
    return " ".join(said).format(action=said_action(lesson.best), value=own, most=most)


def _draw_error(lesson: Lesson, canvas: Canvas, box: pygame.FRect) -> None:
    """Draw the value and its target on a line, and the error between them."""
    scale, y = lesson.config.reward_scale, box.centery
    predicted, target = float(lesson.predicted[int(lesson.cell.action)]) / scale, lesson.target / scale
    ends = (box.left + 0.15 * box.width, box.left + 0.85 * box.width)
    here, there = ends if predicted < target else ends[::-1]
    canvas.line((box.left, y), (box.right, y), LINE)
    canvas.line((here, y), (there, y), EMBER, 1.5)
    canvas.dot((here, y), 5, NET)
    canvas.marker("ring", (there, y), 12, HUMAN)
    for x, value, word, colour in (
        (here, predicted, texts.LESSON_PREDICTED, NET),
        (there, target, texts.LESSON_TARGET, HUMAN),
    ):
        canvas.text(f"{word} {points(value)}", (x, y - 16), size=SMALL, colour=colour, align="centre", tabular=True)
    error = f"{texts.LESSON_ERROR} {points(lesson.error / scale)}"
    canvas.text(error, ((here + there) / 2, y + 22), size=SMALL, colour=MUTE, align="centre", tabular=True)
    canvas.explain((ends[0], y - 6, ends[1] - ends[0], 12), texts.LESSON_ERROR_HELP)
