"""Frame of the target: what was paid, plus the discounted value of the next state; one network picks, one judges."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pygame

from ai.agent.decision import in_points
from ai.environment import Floats
from ai.explain.agent_lesson import Lesson
from ai.explain.recorder import Function
from game.core import texts
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, LINE, MUTE, NET, TITLE
from game.lesson.frame import PICTURE, SMALL_PICTURE, Explanation, Frame, rows_of
from game.lesson.moment_frame import said_action
from game.panels.figures import points

_SUM: Final = 34.0  # baseline of the sum
_WORDS: Final = 56.0  # of the words under its parts
_TABLE: Final = 118.0  # first baseline of the values of the next state
_ROW: Final = 30.0
_COLUMNS: Final = (150.0, 466.0)  # left ends of the two networks' columns
_BAR: Final = 170.0


class TargetFrame(Frame):
    """Frame of the target."""

    def __init__(self, lesson: Lesson, words: Sequence[str], functions: Sequence[Function]) -> None:
        self._scale = lesson.config.reward_scale
        target = lesson.target / self._scale
        super().__init__(words[0], texts.LESSON_POINTS.format(points=points(target)), words[1], functions)
        self.begin = "targets"
        self._lesson = lesson
        self._bars: list[tuple[pygame.FRect, float, bool]] = []
        self._write_sum(target)
        self._write_values()
        self._write_roles()

    def _write_sum(self, target: float) -> None:
        lesson, scale = self._lesson, self._scale
        pay, value = float(lesson.cell.reward) / scale, lesson.next_value / scale
        steps, terminal = int(lesson.cell.steps), bool(lesson.cell.terminal)
        rows = rows_of(
            (texts.LESSON_PART_PAY, points(pay)),
            (texts.LESSON_PART_VALUE.format(factor=f"{lesson.discount:.4f}", value=points(value)),
             points(0.0 if terminal else lesson.discount * value)),
            (texts.LESSON_PART_TARGET, points(target)),
        )  # fmt: skip
        whole = Explanation((texts.LESSON_TARGET_HELP, texts.LESSON_NOTHING_AFTER if terminal else ""), rows)
        factor = Explanation(
            (texts.LESSON_DISCOUNT_HELP,),
            rows_of((f"{lesson.config.discount:g}^{steps}", f"{lesson.discount:.4f}")),
        )
        parts = [
            (points(target), texts.LESSON_PART_TARGET, whole),
            ("=", "", None),
            (points(pay), texts.LESSON_PART_PAY, Explanation((texts.LESSON_RETURN_HELP,))),
            ("+", "", None),
            (f"{lesson.discount:.3f}", texts.LESSON_PART_DISCOUNT.format(count=steps), factor),
            ("×", "", None),
            (points(value), texts.LESSON_PART_NEXT, Explanation((texts.LESSON_NEXT_HELP,))),
        ]
        if terminal:
            parts += [("×", "", None), ("0", texts.LESSON_PART_ENDED, Explanation((texts.LESSON_NOTHING_AFTER,)))]
        x = 0.0
        for text, word, explanation in parts:
            width = max(typeface.width(text, TITLE, "regular"), typeface.width(word, LABEL, "regular") if word else 0)
            self.label(text, x, _SUM, size=TITLE, explanation=explanation, colour=INK if word else MUTE)
            if word:
                self.label(word, x, _WORDS, size=LABEL, colour=MUTE, explanation=explanation)
            x += width + (
                25.0 if word else 14.0
            )  # figures of one width are wider than the plain ones that are measured

    def _write_values(self) -> None:
        lesson = self._lesson
        picks = lesson.next_online if lesson.next_online is not None else lesson.next_judged
        columns = [(lesson.next_judged, texts.LESSON_JUDGE, texts.LESSON_JUDGE_HELP)]
        if lesson.next_online is not None:
            columns.insert(0, (lesson.next_online, texts.LESSON_PICK, texts.LESSON_PICK_HELP))
        else:
            columns[0] = (lesson.next_judged, *self._alone())
        shown = np.concatenate([values for values, _, _ in columns])
        low, high = float(np.min(shown)), float(np.max(shown))
        for place in range(len(picks)):
            best = place == lesson.best
            self.label(said_action(place), 0, _TABLE + _ROW * (place + 1), colour=INK if best else MUTE, room=140)
        for x, (values, title, help_) in zip(_COLUMNS, columns, strict=False):
            self.label(title, x, _TABLE, size=LABEL, colour=MUTE, explanation=Explanation((help_,)), room=280)
            self._write_column(x, values, low, high)

    def _alone(self) -> tuple[str, str]:
        """Return title and help of the one column, where one network both picks and judges."""
        if self._lesson.config.target_judges:
            return texts.LESSON_PICK_AND_JUDGE, texts.LESSON_SINGLE_HELP
        return texts.LESSON_NEWEST_JUDGES, texts.LESSON_NEWEST_HELP

    def _write_column(self, x: float, values: Floats, low: float, high: float) -> None:
        """Write the values of the six actions by one network, in points."""
        for place, value in enumerate(in_points(values, self._scale).tolist()):
            y, best = _TABLE + _ROW * (place + 1), place == self._lesson.best
            share = (value * self._scale - low) / (high - low) if high > low else 1.0
            self._bars.append((pygame.FRect(x, y - 6, _BAR, 3), share, best))
            rows = rows_of((texts.LESSON_OWN_SCALE, f"{value * self._scale:.4f}"),
                           (texts.LESSON_IN_POINTS.format(scale=f"{self._scale:g}"), points(value)))  # fmt: skip
            self.label(points(value), x + _BAR + 80, y, align="right", colour=INK if best else MUTE,
                       explanation=Explanation((said_action(place),), rows))  # fmt: skip

    def _write_roles(self) -> None:
        """Say in words which network picks, which one judges, and what comes of it."""
        lesson, y = self._lesson, _TABLE + _ROW * 7 + 18
        values = in_points(lesson.next_judged, self._scale)
        own = points(float(values[lesson.best]))
        most = points(float(values.max()))
        picked = said_action(lesson.best)
        if lesson.next_online is None:
            said = texts.LESSON_ROLES_SINGLE if lesson.config.target_judges else self._instead()
            lines = [text.format(action=picked, value=own) for text in said]
        else:
            lines = [text.format(action=picked, value=own, most=most) for text in texts.LESSON_ROLES_DOUBLE]
        for line in lines:
            y = self.prose(line, 0, y, PICTURE.width)

    def _instead(self) -> list[str]:
        """Return who picks and judges without a copy, and what of this run stands in for one."""
        config, words = self._lesson.config, texts.LESSON_ROLES_NEWEST
        said = [words["picks"]]
        if config.n_step > 1:
            said.append(texts.LESSON_ROLES_NEWEST["pays"].format(count=int(self._lesson.cell.steps)))
        said.append(words["normalised" if config.layer_normalisation else "bare"])
        return said

    def paint(self, canvas: Canvas) -> None:
        """Paint the bars, on one scale for both networks, and a mark at the action that is picked."""
        canvas.line((0, _TABLE - 26), (PICTURE.width, _TABLE - 26), LINE)
        for box, share, best in self._bars:
            canvas.bar(box, max(share, 0.02), NET if best else mix(FAINT, NET, 0.4))
            if best:
                canvas.marker("triangle", (box.left - 10, box.centery), 7, NET)

    def paint_small(self, canvas: Canvas) -> None:
        """Paint the two parts of the target, what was paid and what is guessed, and the target itself."""
        lesson = self._lesson
        guessed = 0.0 if lesson.cell.terminal else lesson.discount * lesson.next_value
        parts = (abs(float(lesson.cell.reward)), abs(guessed))
        room, y = SMALL_PICTURE[0] - 12, SMALL_PICTURE[1] / 2
        paid = room * parts[0] / max(sum(parts), 1e-9)
        canvas.fill(canvas.rect(0, y - 3, paid, 6), MUTE)
        canvas.fill(canvas.rect(paid + 1, y - 3, max(room - paid - 1, 0), 6), mix(FAINT, NET, 0.6))
        canvas.marker("ring", (SMALL_PICTURE[0] - 5, y), 9, HUMAN)
