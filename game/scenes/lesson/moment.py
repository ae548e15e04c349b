"""The first three cards of a lesson: the moment, the six values for it, and what came of the one that was taken."""

from __future__ import annotations

import math
from functools import partial
from typing import Final

import numpy as np
import pygame

from ai.agent.n_step import NStep
from ai.environment import Doubles, Floats
from ai.explain.agent_lesson import Flown, Lesson
from ai.lander.environment import ACTION_NAMES, OBSERVATION_SCALE, PARAMS, LanderEnv, Outcome
from ai.nn import NeuralNetwork
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, SMALL
from game.explain.figures import decimal, points, what_is_sensed
from game.explain.tables import Line, figure_rows, from_zero, table
from game.scenes.lesson.card import Card
from game.ui.panel import Column
from game.world.camera import HOME, WORLD_WIDTH, View
from game.world.craft import draw_craft
from game.world.lander import LANDER
from game.world.landscape.pad import draw_pad

_LEAST, _HIGH = 300.0, 300.0  # width of a column, height of the picture
_ARROW: Final = 9.0  # points of the velocity's arrow for each metre per second
_DIGITS: Final = (2, 2, 2, 2, 3, 3, 3)
_UNITS: Final = (0, 0, 1, 1, None, None, 2)  # of each feature, among the texts; None for a plain number


def said_action(action: int) -> str:
    """Return the word for an action."""
    return texts.said(ACTION_NAMES[action])


def in_units(observation: Floats) -> Doubles:
    """Return an observation (9,) in metres, metres per second, radians per second and plain numbers."""
    units: Doubles = np.asarray(observation, float) / OBSERVATION_SCALE
    return units


def sensed(value: float, feature: int) -> str:
    """Write a sensed quantity with its unit."""
    if feature >= len(_DIGITS):
        return texts.LESSON_FEET[value > 0.5]
    figure, unit = decimal(value, _DIGITS[feature]), _UNITS[feature]
    return figure if unit is None else texts.LESSON_UNITS[unit].format(value=figure)


def moment_card(lesson: Lesson) -> Card:
    """Return the card of the moment: where the lander is, and the nine numbers that say so."""
    units = in_units(lesson.cell.state).tolist()

    def describe(column: Column) -> None:
        left, right = column.beside((1, 1), _LEAST)
        left.picture(_HIGH, partial(_draw_moment, units))
        lines = [
            Line((name, sensed(units[feature], feature)), what_is_sensed(feature))
            for feature, name in enumerate(texts.INPUTS)
        ]
        right.add(table((), lambda: lines))

    words, slot = texts.LESSON_CARDS["moment"], lesson.flown.slot + 1 if lesson.flown else 1
    return Card(words[0], words[1].format(slot=slot), LanderEnv.observe, describe=describe)


def _draw_moment(units: list[float], canvas: Canvas, box: pygame.FRect) -> None:
    """Draw the pad, the lander, and an arrow for its velocity."""
    view = View.within(box, canvas.scale, HOME, box.width / WORLD_WIDTH)
    place = np.array([units[0], units[1] + PARAMS.pad_top + PARAMS.stand])
    (x, y), across, up = view.points(place).tolist(), units[2] * _ARROW, units[3] * _ARROW
    with canvas.clipped(box):
        draw_pad(canvas, view, (0.0, PARAMS.pad_top), PARAMS.pad_width)
        draw_craft(canvas, view, LANDER, np.array([*place, math.atan2(units[4], units[5])]), np.zeros(3), 1.0, 0, 1.5)
        canvas.line((x, y), (x + across, y - up), INK, 1.5)


def values_card(lesson: Lesson) -> Card:
    """Return the card of the six values, and which action was taken."""
    values = (lesson.predicted / lesson.config.reward_scale).tolist()
    taken, best = int(lesson.cell.action), int(lesson.predicted.argmax())
    lines = [
        Line((said_action(action), points(value)), lit=action == taken,
             bars=[from_zero(value, min(values), max(values))])
        for action, value in enumerate(values)
    ]  # fmt: skip
    words, why = texts.LESSON_CARDS["values"], texts.LESSON_TAKEN[taken == best]
    said = why.format(action=said_action(taken), best=said_action(best))

    def describe(column: Column) -> None:
        column.beside((1, 1), _LEAST)[0].add(table((), lambda: lines))

    return Card(words[0], f"{words[1]} {said}", NeuralNetwork.predict, describe=describe)


def came_card(lesson: Lesson) -> Card:
    """Return the card of what came: the pay of each decision, how the flight ended, and the state after."""
    flown, count, discount = lesson.flown, int(lesson.cell.steps), lesson.config.discount
    pay = float(lesson.cell.reward) / lesson.config.reward_scale
    before, after = (in_units(each).tolist() for each in (lesson.cell.state, lesson.cell.next_state))

    def describe(column: Column) -> None:
        left, right = column.beside((1, 1), _LEAST)
        words = texts.LESSON_RETURN.format(discount=f"{discount:g}", count=count)
        whole = Line((words, *[""] * (2 if flown else 0), points(pay)), lit=True)
        lines = _decisions(flown, discount) if flown else []
        left.add(table(texts.LESSON_PAY if flown else (), lambda: [*lines, whole]))
        if flown and flown.outcome != Outcome.FLYING:
            left.text(texts.LESSON_OUTCOMES[flown.outcome - 1], size=SMALL)
        changes = [
            Line((name, sensed(before[feature], feature), sensed(after[feature], feature)))
            for feature, name in enumerate(texts.INPUTS)
        ]
        head = (texts.LESSON_AFTER.format(count=count), texts.LESSON_BEFORE, texts.LESSON_NOW)
        right.add(table(head, lambda: changes))

    words = texts.LESSON_CARDS["came"]
    return Card(words[0], words[1], NStep.add, "self._returns", describe)


def _decisions(flown: Flown, discount: float) -> list[Line]:
    """Return a line for each decision: its action, its pay, how much that counts, and that much of it."""
    lines = []
    for place, (action, pay) in enumerate(zip(flown.actions.tolist(), flown.rewards.tolist(), strict=True)):
        names = {name: texts.REWARD_PARTS.get(name, (name,))[0] for name in flown.parts}
        parts = ((names[name], points(float(paid[place]))) for name, paid in flown.parts.items() if paid[place])
        factor, what = discount**place, texts.LESSON_DECISION.format(number=place + 1)
        cells = (said_action(action), points(pay), f"× {factor:.4f}", points(pay * factor))
        lines.append(Line(cells, what, figure_rows(*parts)))
    return lines
