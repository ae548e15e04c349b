"""Frames of a flight: the moment, with all that is sensed of it, and what happened then."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Final

import numpy as np
import pygame

from ai.environment import Doubles, Floats
from ai.explain.agent_lesson import Lesson
from ai.explain.recorder import Function
from ai.lander.environment import ACTION_NAMES, OBSERVATION_SCALE, PARAMS, Outcome
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, INK, LABEL, LINE, MUTE, NET, VIEW_SIZE
from game.lesson.frame import PICTURE, SMALL_PICTURE, Explanation, Frame, Spot, rows_of
from game.panels.figures import number, points
from game.panels.reward_bar import PART_COLOURS
from game.world.camera import HOME, POINTS_PER_METRE, View
from game.world.craft import draw_craft
from game.world.lander import LANDER
from game.world.landscape.backdrop import Backdrop
from game.world.landscape.pad import draw_pad

_SHARE: Final = 0.31  # of the view's width that the little picture takes
_WORLD: Final = (VIEW_SIZE[0] * _SHARE, VIEW_SIZE[1] * _SHARE)
_SMALL_CRAFT: Final = 12.0  # points of a metre in the strip
_TABLE: Final = 424.0  # left end of the table of inputs
_ROW: Final = 30.0
_MOON: Final = 5
_ARROW: Final = 9.0  # points of the velocity's arrow for each metre per second
_SENSED: Final = 640.0  # right end of the figures in units
_GIVEN: Final = 745.0  # right end of the figures as the network gets them
_DIGITS: Final = (2, 2, 2, 2, 3, 3, 3)
_UNITS: Final = (0, 0, 1, 1, None, None, 2)  # of each feature, among the texts; None for a plain number


def in_units(observation: Floats) -> Doubles:
    """Return an observation (9,) in metres, metres per second, radians per second and plain numbers."""
    units: Doubles = np.asarray(observation, float) / OBSERVATION_SCALE
    return units


def pose_of(observation: Floats) -> Doubles:
    """Return the pose (x, y, angle) on the plain at which a lander senses an observation (9,)."""
    x, y, _, _, sine, cosine, *_ = in_units(observation).tolist()
    return np.array([x, y + PARAMS.pad_top + PARAMS.stand, math.atan2(sine, cosine)])


def sensed(value: float, feature: int) -> str:
    """Write a sensed quantity with its unit."""
    if feature >= 7:
        return texts.LESSON_FEET[value > 0.5]
    figure = f"{value:.{_DIGITS[feature]}f}".replace("-", "−")
    unit = _UNITS[feature]
    return figure if unit is None else texts.LESSON_UNITS[unit].format(value=figure)


class MomentFrame(Frame):
    """Frame of the moment: the little picture, and the nine inputs with their units."""

    def __init__(self, lesson: Lesson, words: Sequence[str], functions: Sequence[Function]) -> None:
        self._state = np.asarray(lesson.cell.state)
        units = in_units(self._state)
        super().__init__(words[0], sensed(float(units[1]), 1), words[1], functions)
        self.begin = "rows"
        self._action = int(lesson.cell.action)
        self.heading(texts.LESSON_INPUTS, _TABLE, 14, 100)
        self.label(texts.LESSON_IN_UNITS, _SENSED, 14, size=LABEL, colour=MUTE, align="right", room=110)
        self.label(texts.LESSON_GIVEN, _GIVEN, 14, size=LABEL, colour=MUTE, align="right", room=100)
        for feature, (name, value) in enumerate(zip(texts.INPUTS, units.tolist(), strict=True)):
            y = 44 + _ROW * feature
            given = float(np.asarray(lesson.state)[feature])
            explanation = Explanation(
                (name, texts.LESSON_INPUTS_HELP[feature]),
                rows_of(
                    (texts.LESSON_IN_UNITS, sensed(value, feature)),
                    (texts.LESSON_SCALED.format(scale=f"{OBSERVATION_SCALE[feature]:g}"),
                     number(float(self._state[feature]))),
                    (texts.LESSON_GIVEN, number(given)),
                ),
            )  # fmt: skip
            self.label(name, _TABLE, y, colour=MUTE, explanation=explanation, room=120)
            self.label(sensed(value, feature), _SENSED, y, align="right", explanation=explanation, room=110)
            self.label(number(given), _GIVEN, y, align="right", explanation=explanation, colour=NET, room=84)
        speed = math.hypot(*units[2:4])
        rows = rows_of((texts.LESSON_SPEED, texts.LESSON_UNITS[1].format(value=f"{speed:.2f}")))
        self.spots.append(Spot(pygame.FRect(0, 0, *_WORLD), Explanation((texts.LESSON_PICTURE,), rows)))
        self.prose(texts.LESSON_PICTURE_NOTE, 0, _WORLD[1] + 26, _WORLD[0])

    def paint(self, canvas: Canvas) -> None:
        """Paint the moon, the lander at its pose, an arrow along its velocity, and the table's lines."""
        draw_moment(canvas, self._state, self._action)
        for feature in range(len(texts.INPUTS) + 1):
            y = 24 + _ROW * feature
            canvas.line((_TABLE, y), (_GIVEN, y), LINE)

    def paint_small(self, canvas: Canvas) -> None:
        """Paint the lander, as it leans and with the engines it fires."""
        pose = pose_of(self._state)
        across, down = (
            (whole - small) / (2 * _SMALL_CRAFT) for whole, small in zip(VIEW_SIZE, SMALL_PICTURE, strict=True)
        )
        view = View(canvas.scale, (pose[0] + across, pose[1] - down), _SMALL_CRAFT / POINTS_PER_METRE)
        draw_craft(canvas, view, LANDER, pose, _thrust(self._action), 1.0, 0, 1.0)


def draw_moment(canvas: Canvas, observation: Floats, action: int) -> None:
    """Draw the moon with one lander and its velocity into the top left corner."""
    canvas.surface.blit(_moon(_pixels(canvas)), (0, 0))
    span = (1 - _SHARE) / (2 * _SHARE * POINTS_PER_METRE)
    view = View(canvas.scale, (HOME[0] + span * VIEW_SIZE[0], HOME[1] - span * VIEW_SIZE[1]), _SHARE)
    canvas.surface.set_clip(pygame.Rect((0, 0), _pixels(canvas)))
    draw_pad(canvas, view, (0.0, PARAMS.pad_top), PARAMS.pad_width, 0.0)
    pose = pose_of(observation)
    draw_craft(canvas, view, LANDER, pose, _thrust(action), 1.0, 0, 1.5)
    x, y = view.points(pose[:2]).tolist()
    across, up = (in_units(observation)[2:4] * _ARROW).tolist()
    if math.hypot(across, up) > 2:
        tip = (x + across, y - up)
        canvas.line((x, y), tip, INK, 1.5)
        canvas.dot(tip, 2.5, INK)
    canvas.surface.set_clip(None)


def _thrust(action: int) -> Doubles:
    """Return how hard each engine fires for an action, (3,)."""
    return np.array([action >= 3, action % 3 == 2, action % 3 == 1], float)


def _pixels(canvas: Canvas) -> tuple[int, int]:
    return round(_WORLD[0] * canvas.scale), round(_WORLD[1] * canvas.scale)


@lru_cache(maxsize=2)
def _moon(size: tuple[int, int]) -> pygame.Surface:
    """Return the landscape of the little picture."""
    picture = pygame.Surface(size)
    Backdrop(size, np.random.default_rng(_MOON), reduced_motion=True).paint(picture)
    return picture


class HappenedFrame(Frame):
    """Frame of what happened: the action, the pay of each decision by its parts, and the state after."""

    _LEFT, _BARS, _SUM, _AFTER = 0.0, 150.0, 470.0, 510.0

    def __init__(self, lesson: Lesson, words: Sequence[str], functions: Sequence[Function]) -> None:
        scale = lesson.config.reward_scale
        pay = float(lesson.cell.reward) / scale
        super().__init__(words[0], texts.LESSON_POINTS.format(points=points(pay)), words[1], functions)
        self.begin = "self._returns"
        self._bars: list[tuple[pygame.FRect, tuple[int, int, int]]] = []
        self._keys: list[tuple[pygame.FRect, tuple[int, int, int]]] = []
        self._zero = self._BARS
        self.heading(texts.LESSON_PAY, self._LEFT, 14, 400)
        if lesson.flown is None:
            self.label(texts.LESSON_NOT_KNOWN, self._LEFT, 44, colour=MUTE, room=460)
            bottom = 60.0
        else:
            bottom = self._write_pay(lesson)
        words_of = texts.LESSON_RETURN.format(discount=f"{lesson.config.discount:g}", count=int(lesson.cell.steps))
        explanation = self._explain_return(lesson)
        self.label(words_of, self._LEFT, bottom + 26, explanation=explanation, colour=MUTE, room=370)
        self.label(points(pay), self._SUM, bottom + 26, align="right", explanation=explanation, room=90)
        self._rule = bottom + 8
        if lesson.flown is not None:
            self._write_legend([name for name, paid in lesson.flown.parts.items() if paid.any()], bottom + 58)
        self._write_after(lesson)

    def _write_pay(self, lesson: Lesson) -> float:
        flown = lesson.flown
        assert flown is not None
        names = [name for name, paid in flown.parts.items() if np.abs(paid).max() > 0]
        paid = np.array([flown.parts[name] for name in names]).reshape(len(names), len(flown.actions))
        high, low = (max(float(np.where(sign * paid > 0, sign * paid, 0).sum(axis=0).max()), 1e-9) for sign in (1, -1))
        room = self._SUM - 64 - self._BARS
        per_point = room / (high + low)
        self._zero = self._BARS + low * per_point
        pitch = min(26.0, 300.0 / len(flown.actions))
        for place, action in enumerate(flown.actions.tolist()):
            y = 40 + pitch * place
            word = said_action(action)
            first = Explanation((texts.LESSON_DECISION.format(number=place + 1), word))
            self.label(word, self._LEFT, y, size=min(LABEL + 1, pitch), explanation=first,
                       colour=INK if place == 0 else MUTE, room=140)  # fmt: skip
            ends = {True: self._zero, False: self._zero}
            for name, value in zip(names, paid[:, place].tolist(), strict=True):
                start = ends[value > 0]
                ends[value > 0] = end = start + value * per_point
                box = pygame.FRect(min(start, end), y - 0.5 * pitch + 1, abs(end - start), 0.5 * pitch)
                self._bars.append((box, PART_COLOURS.get(name, MUTE)))
                part, help_ = texts.REWARD_PARTS.get(name, (name, ""))
                rows = rows_of((part, texts.LESSON_POINTS.format(points=points(value))))
                self.spots.append(Spot(box, Explanation((help_,), rows)))
            parts = [(texts.REWARD_PARTS.get(name, (name, ""))[0], points(value))
                     for name, value in zip(names, paid[:, place].tolist(), strict=True) if value]  # fmt: skip
            total = float(flown.rewards[place])
            rows = rows_of(*parts, (texts.LESSON_SUM_OF_PARTS, texts.LESSON_POINTS.format(points=points(total))))
            whole = Explanation(first.lines, rows)
            size = min(LABEL + 1, pitch)
            self.label(points(total), self._SUM, y, size=size, align="right", room=60, explanation=whole)
        return 40 + pitch * (len(flown.actions) - 1)

    def _write_legend(self, names: Sequence[str], y: float) -> None:
        """Write which colour is which part of the pay, on three columns."""
        for place, name in enumerate(names):
            x, baseline = 160.0 * (place % 3), y + 20 * (place // 3)
            part, help_ = texts.REWARD_PARTS.get(name, (name, ""))
            self._keys.append((pygame.FRect(x, baseline - 8, 8, 8), PART_COLOURS.get(name, MUTE)))
            self.label(part, x + 14, baseline, size=LABEL, colour=MUTE, explanation=Explanation((help_,)), room=140)

    def _explain_return(self, lesson: Lesson) -> Explanation:
        flown, scale = lesson.flown, lesson.config.reward_scale
        rows: list[tuple[str, str]] = []
        if flown is not None:
            factors = lesson.config.discount ** np.arange(len(flown.rewards))
            rows = [
                (texts.LESSON_DISCOUNTED.format(points=points(reward), factor=f"{factor:.3f}"), points(reward * factor))
                for reward, factor in zip(flown.rewards.tolist(), factors.tolist(), strict=True)
            ]
        rows.append((texts.LESSON_IN_ALL, points(float(lesson.cell.reward) / scale)))
        return Explanation((texts.LESSON_RETURN_HELP,), rows_of(*rows))

    def _write_after(self, lesson: Lesson) -> None:
        before, after = in_units(lesson.cell.state).tolist(), in_units(lesson.cell.next_state).tolist()
        ended = bool(lesson.flown and lesson.flown.outcome != Outcome.FLYING)
        count = int(lesson.cell.steps)
        self.heading(texts.LESSON_AFTER.format(count=count), self._AFTER, 14, 240)
        for feature, name in enumerate(texts.INPUTS):
            y = 40 + 26.0 * feature
            rows = rows_of(
                (texts.LESSON_BEFORE, sensed(before[feature], feature)),
                (texts.LESSON_NOW, sensed(after[feature], feature)),
            )
            explanation = Explanation((name, texts.LESSON_INPUTS_HELP[feature]), rows)
            self.label(name, self._AFTER, y, colour=MUTE, explanation=explanation, room=112)
            self.label(sensed(after[feature], feature), PICTURE.width, y, align="right",
                       explanation=explanation, room=110)  # fmt: skip
        if ended:
            assert lesson.flown is not None
            self.prose(texts.LESSON_OUTCOMES[lesson.flown.outcome - 1], self._AFTER, 40 + 26.0 * 9 + 8, 240)

    def paint(self, canvas: Canvas) -> None:
        """Paint the bars, with a line at nothing paid."""
        for box, colour in self._bars + self._keys:
            canvas.fill(canvas.rect(*box), colour)
        if self._bars:
            canvas.line((self._zero, 24), (self._zero, self._rule - 2), FAINT)
        canvas.line((self._LEFT, self._rule), (self._SUM, self._rule), LINE)

    def paint_small(self, canvas: Canvas) -> None:
        """Paint the bars small."""
        wide, high = SMALL_PICTURE[0] / (self._SUM - self._BARS - 64), SMALL_PICTURE[1] / (self._rule - 24)
        for box, colour in self._bars:
            place = ((box.left - self._BARS) * wide, (box.top - 24) * high)
            canvas.fill(canvas.rect(*place, box.width * wide, max(box.height * high, 1)), colour)


def said_action(action: int) -> str:
    """Return the word for an action."""
    return texts.said(ACTION_NAMES[action])
