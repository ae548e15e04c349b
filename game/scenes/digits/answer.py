"""Answer panel: the chosen network's digit and confidence, the other network's, and correcting a wrong answer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from game.core import texts
from game.digits import percent
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, INK, LABEL, MUTE, NET, SMALL, TEXT, TITLE
from game.scenes.digits.fixing import FixRunner
from game.scenes.digits.reader import LEAST_INK, Numbers, Reading, Verdict
from game.training.digit_models import called
from game.ui.widget import PointsManager, Widget, mix

LEFT: Final = 624.0
RIGHT: Final = 848.0
FIX_TOP: Final = 554.0
_BASELINE: Final = 172.0
_FIRST_ROW: Final = 272
_ROW: Final = 26
_EASE: Final = 0.4
_SIZES: Final = 124.0, 48.0


class DigitRow(Widget):
    """Row of one digit with both networks' probabilities; pressing it names it as the right digit.

    Attributes:
        values: probabilities from the chosen network and the other, 0 to 1.

    """

    def __init__(self, manager: PointsManager, digit: int, on_press: Callable[[int], None]) -> None:
        box = (LEFT - 10, _FIRST_ROW + digit * _ROW - _ROW // 2, RIGHT - LEFT + 20, _ROW)
        super().__init__(manager, box, str(digit))
        self.digit, self._on_press = digit, on_press
        self.values = (0.0, 0.0)
        self._shown = (0.0, 0.0)
        self.best = False

    def press(self) -> None:
        """Report this digit as the one that was drawn."""
        self._on_press(self.digit)

    def ease(self, at_once: bool) -> None:
        """Ease the bars towards the values."""
        super().ease(at_once)
        part = 1.0 if at_once else _EASE
        one, other = (now + (value - now) * part for now, value in zip(self._shown, self.values, strict=True))
        self._shown = (one, other)

    def paint(self, canvas: Canvas) -> None:
        """Draw the digit, a bar for the chosen network, and a thin one for the other below."""
        if self.ringed and self.warmth > 0.02:
            canvas.outline(self.box, 6, INK, 1, 0.4 * self.warmth)
        y, left = self.box.centery, LEFT + 30
        colour = INK if self.best else mix(MUTE, INK, self.warmth)
        canvas.text(self.label, (LEFT, y + 5), size=TEXT, colour=colour, tabular=True)
        chosen, other = self._shown
        canvas.bar((left, y - 2, RIGHT - left, 4), chosen if chosen > 0.01 else 0, NET if self.best else MUTE)
        if other > 0.01:
            canvas.pill((left, y + 5, max((RIGHT - left) * other, 2), 2), MUTE, 0.8)


def best_two(probabilities: Numbers) -> tuple[int, int]:
    """Return the most probable digit and the next."""
    first, second = np.argsort(-probabilities, kind="stable")[:2].tolist()
    return first, second


def draw_answer(canvas: Canvas, reading: Reading, name: str) -> None:
    """Draw a network's answer large, and the other networks' answers small."""
    if reading.verdict(name) is Verdict.EMPTY:
        canvas.text(texts.DIGITS_EMPTY, (LEFT, 140), size=TITLE)
        canvas.text(texts.DIGITS_EMPTY_HOW, (LEFT, 164), size=SMALL, colour=MUTE)
        return
    _draw_chosen(canvas, reading, name)
    for other in reading.probabilities:
        if other != name:
            _draw_other(canvas, reading, other)


def _draw_chosen(canvas: Canvas, reading: Reading, name: str) -> None:
    probabilities, verdict = reading.probabilities[name], reading.verdict(name)
    first, second = best_two(probabilities)
    share, second_share = percent(probabilities[first]), percent(probabilities[second])
    if verdict is Verdict.UNSURE:
        canvas.text("?", (LEFT - 4, _BASELINE), size=_SIZES[0], weight="extralight", colour=MUTE)
        little = reading.stages.centred.sum() < LEAST_INK
        words = (
            texts.DIGITS_TOO_LITTLE
            if little
            else texts.DIGITS_EITHER.format(digit=first, percent=share, other=second, other_percent=second_share)
        )
        _draw_verdict(canvas, "triangle", texts.DIGITS_UNSURE, canvas.palette.warn)
        canvas.text(words, (LEFT, 228), size=SMALL, colour=MUTE)
        return
    canvas.text(str(first), (LEFT - 6, _BASELINE), size=_SIZES[0], weight="extralight")
    if verdict is Verdict.SURE:
        _draw_verdict(canvas, "check", texts.DIGITS_SURE.format(percent=share), canvas.palette.good)
    else:
        words = texts.DIGITS_LIKELY if verdict is Verdict.LIKELY else texts.DIGITS_DISPUTED
        _draw_verdict(canvas, "ring", words.format(percent=share), INK)
    if probabilities[second] >= 0.005:
        words = texts.DIGITS_OR.format(digit=second, percent=second_share)
        canvas.text(words, (LEFT, 228), size=SMALL, colour=MUTE)


def _draw_verdict(canvas: Canvas, sign: str, words: str, colour: tuple[int, int, int]) -> None:
    canvas.marker(sign, (LEFT + 5, 200), 10, colour)  # type: ignore[arg-type]
    canvas.text(words, (LEFT + 20, 205), size=TEXT, colour=colour)


def _draw_other(canvas: Canvas, reading: Reading, name: str) -> None:
    first, _ = best_two(reading.probabilities[name])
    sure = reading.verdict(name) is not Verdict.UNSURE
    label = canvas.text(called(name), (RIGHT, 122), size=LABEL, colour=MUTE, align="right")
    canvas.pill((label.left - 22, 117, 16, 2), MUTE)  # as thin as that network's bars below
    figure = str(first) if sure else "?"
    canvas.text(figure, (RIGHT, _BASELINE), size=_SIZES[1], weight="light", colour=MUTE, align="right")
    words = percent(reading.probabilities[name][first]) if sure else texts.DIGITS_UNSURE
    canvas.text(words, (RIGHT, 205), size=SMALL, colour=MUTE, align="right", tabular=True)


def draw_fix(canvas: Canvas, fixing: FixRunner, *, same: bool) -> None:
    """Draw how to correct an answer, or a fix's progress or result; `same`: whether its drawing is unchanged."""
    first, second = _fix_lines(fixing, same)
    canvas.text(first, (LEFT, FIX_TOP), size=SMALL, colour=HUMAN)
    draw_wrapped(canvas, second, (LEFT, FIX_TOP + 20), RIGHT + 30 - LEFT, colour=MUTE, most=2)


def _fix_lines(fixing: FixRunner, same: bool) -> tuple[str, str]:
    step, fixed = fixing.step, fixing.fixed
    if fixing.busy:
        now = percent(step.probability) if step else ""
        return texts.DIGITS_FIXING.format(digit=fixing.digit), now and texts.DIGITS_FIXING_NOW.format(percent=now)
    if fixing.problem and same:
        return texts.DIGITS_NOT_FIXED, fixing.problem
    if fixed is None or not same:
        return texts.DIGITS_FIX_HOW, ""
    if not fixed.steps:
        return texts.DIGITS_FIX_NEEDLESS.format(digit=fixed.digit), ""
    before, now = map(percent, fixed.probability)
    first = texts.DIGITS_FIXED.format(digit=fixed.digit, before=before, now=now)
    return first, texts.DIGITS_FIX_COST.format(before=fixed.accuracy[0], after=fixed.accuracy[1])
