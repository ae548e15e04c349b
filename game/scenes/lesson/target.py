"""Frame of the target: what was paid, plus the discounted value of the next state; one network picks, one judges."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.explain.agent_lesson import Lesson
from ai.nn import NeuralNetwork
from game.core import texts
from game.drawing.tokens import MUTE, SMALL
from game.panels.figures import number, points
from game.panels.tables import Line, Part, formula, table, told
from game.scenes.lesson.flight import said_action
from game.scenes.lesson.frame import Frame, in_points

if TYPE_CHECKING:
    from game.ui.panel import Column

_LEAST: Final = 300.0  # width of a column


class TargetFrame(Frame):
    """Frame of the target."""

    def __init__(self, lesson: Lesson) -> None:
        self._lesson, self._scale = lesson, lesson.config.reward_scale
        functions = (DeepQAgent.targets, DeepQAgent._next_value, NeuralNetwork.predict)
        super().__init__(texts.LESSON_FRAMES["target"], in_points(lesson.target / self._scale), functions, "targets")

    def describe(self, column: Column) -> None:
        """Add the sum, and who picks and judges the value in it."""
        column.add(formula(self._sum))
        column.gap(4)
        left, right = column.beside((1, 1), _LEAST)
        left.add(table(self._head(), self._values))
        for words in self._roles():
            right.text(words, size=SMALL, colour=MUTE)
            right.gap(4)

    def _sum(self) -> list[Part]:
        lesson, steps, ended = self._lesson, int(self._lesson.cell.steps), bool(self._lesson.cell.terminal)
        target, pay, value = (float(each) / self._scale for each in (lesson.target, lesson.cell.reward,
                                                                     lesson.next_value))  # fmt: skip
        whole = told(
            (texts.LESSON_PART_PAY, points(pay)),
            (texts.LESSON_PART_VALUE.format(factor=f"{lesson.discount:.4f}", value=points(value)),
             points(0.0 if ended else lesson.discount * value)),
            (texts.LESSON_TARGET, points(target)),
        )  # fmt: skip
        factor = told((f"{lesson.config.discount:g}^{steps}", f"{lesson.discount:.4f}"))
        parts = [
            Part(points(target), texts.LESSON_TARGET, texts.LESSON_TARGET_HELP, whole),
            Part("="),
            Part(points(pay), texts.LESSON_PART_PAY, texts.LESSON_RETURN_HELP),
            Part("+"),
            Part(f"{lesson.discount:.3f}", texts.LESSON_PART_DISCOUNT.format(count=steps), texts.LESSON_DISCOUNT_HELP,
                 factor),
            Part("×"),
            Part(points(value), texts.LESSON_PART_NEXT, texts.LESSON_NEXT_HELP),
        ]  # fmt: skip
        return [*parts, Part("×"), Part("0", texts.LESSON_PART_ENDED, texts.LESSON_NOTHING_AFTER)] if ended else parts

    def _head(self) -> tuple[str, ...]:
        """Return the heads of the values' table: one network, or one that picks and one that judges."""
        if self._lesson.next_online is not None:
            return "", texts.LESSON_PICK, texts.LESSON_JUDGE
        judge = texts.LESSON_PICK_AND_JUDGE if self._lesson.config.target_judges else texts.LESSON_NEWEST_JUDGES
        return "", judge

    def _values(self) -> list[Line]:
        """Return the values of the six actions afterwards, by each of the networks, on one scale."""
        lesson = self._lesson
        columns = [each for each in (lesson.next_online, lesson.next_judged) if each is not None]
        shown = np.stack(columns, axis=1) / self._scale
        low, span = float(shown.min()), max(float(np.ptp(shown)), 1e-9)
        return [
            Line((said_action(action), *map(points, row)), texts.LESSON_NEXT_HELP,
                 told((texts.LESSON_OWN_SCALE, " ".join(number(value * self._scale) for value in row))),
                 lit=action == lesson.best, bars=[(value - low) / span for value in row])
            for action, row in enumerate(shown.tolist())
        ]  # fmt: skip

    def _roles(self) -> list[str]:
        """Say which network picks, which one judges, and what comes of it; or what stands in for a second one."""
        lesson, config, words = self._lesson, self._lesson.config, texts.LESSON_ROLES_NEWEST
        if lesson.next_online is not None:
            said = [*texts.LESSON_ROLES_DOUBLE]
        elif config.target_judges:
            said = [*texts.LESSON_ROLES_SINGLE]
        else:
            pays = [words["pays"].format(count=int(lesson.cell.steps))] if config.n_step > 1 else []
            said = [words["picks"], *pays, words["normalised" if config.layer_normalisation else "bare"]]
        judged = lesson.next_judged / self._scale
        own, most = points(float(judged[lesson.best])), points(float(judged.max()))
        return [text.format(action=said_action(lesson.best), value=own, most=most) for text in said]
