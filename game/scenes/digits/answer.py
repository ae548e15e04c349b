"""What a network reads and why: its digit and confidence, how to correct it, and the picture that it sees."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
import pygame

from ai.digits.preprocessing import Image
from game.core import texts
from game.digits import percent
from game.digits.pictures import AMBER, picture
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, INK, LABEL, LINE, MUTE, NET, NIGHT0, SMALL, TEXT, TITLE
from game.scenes.digits.fixing import FixRunner
from game.scenes.digits.reader import LEAST_INK, Reading, Verdict, best_two
from game.training.digit_models import called
from game.ui.widget import PointsManager, Widget, mix
from game.ui.widgets import Toggle, draw_switch

LEFT: Final = 624.0
RIGHT: Final = 848.0
EXPLAINED, END = 900.0, 1244.0  # left and right of the explanation
FIX_TOP: Final = 554.0
_BASELINE: Final = 172.0
_FIRST_ROW: Final = 272
_ROW: Final = 26
_EASE: Final = 0.4
_SIZES: Final = 124.0, 48.0
STEPS: Final = ("crop", "fit", "width", "centre")  # each turns one stage into the next
_TILE: Final = 62.0
_PITCH: Final = (END - EXPLAINED - _TILE) / len(STEPS)
_TILES_TOP: Final = 58.0
_SWITCH: Final = 26.0, 13.0
_WHY: Final = (EXPLAINED, 240.0, 344.0)  # left, top and side


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


class StageSwitch(Toggle):
    """Switch for one preprocessing step, under the picture of that step's result."""

    def __init__(self, manager: PointsManager, number: int, on_change: Callable[[bool], None]) -> None:
        left = EXPLAINED + (number + 1) * _PITCH
        box = (round(left), round(_TILES_TOP + _TILE + 22), round(_TILE), 20)
        super().__init__(manager, box, texts.DIGITS_STAGES[number + 1], True, on_change)

    def paint(self, canvas: Canvas) -> None:
        """Draw the switch without a label, since its name stands above."""
        if self.ringed and self.warmth > 0.02:
            canvas.outline(self.box.inflate(0, 4), 8, INK, 1, 0.4 * self.warmth)
        (width, height), box = _SWITCH, self.box
        draw_switch(canvas, (box.centerx - width / 2, box.centery - height / 2, width, height), self._slid)


class Explanation:
    """Pictures of a reading: the stages of preprocessing, and which ink speaks for the answer."""

    def __init__(self) -> None:
        self._stages, self._why = PaintCache(), PaintCache()

    def draw(self, canvas: Canvas, reading: Reading, name: str, why: Image | None, steps: Sequence[bool]) -> None:
        """Draw both; `steps` says which preprocessing steps are on, `why` is (28, 28) in -1 to 1."""
        taken = (True, *steps)
        width, y = END - EXPLAINED, 58.0 + _TILE + 16
        canvas.text(texts.DIGITS_SEES, (EXPLAINED, 42), size=LABEL, colour=MUTE, weight="medium")
        strip = (EXPLAINED, _TILES_TOP, width, _TILE)
        self._stages.draw(canvas, strip, (reading, taken), lambda sheet: _paint_stages(sheet, reading, taken))
        for number, words in enumerate(texts.DIGITS_STAGES):
            place = (EXPLAINED + number * _PITCH + _TILE / 2, y)
            colour = INK if number == len(STEPS) else MUTE
            alpha = 1.0 if taken[number] else 0.5
            canvas.text(words, place, size=LABEL, colour=colour, align="centre", alpha=alpha)
        if why is None:
            return
        left, top, size = _WHY
        words = texts.DIGITS_WHY_EMPTY
        if reading.verdict(name) is not Verdict.EMPTY:
            first, second = best_two(reading.probabilities[name])
            words = texts.DIGITS_WHY.format(digit=first, other=second)
            x, y = left, top + size + 20
            for word, colour in zip(texts.DIGITS_WHY_LEGEND, (HUMAN, MUTE), strict=True):
                canvas.rounded((x, y - 7, 7, 7), 1.5, colour)
                x += 12 + canvas.text(word, (x + 12, y), size=LABEL, colour=MUTE).width + 12
        canvas.text(words, (left, top - 12), size=LABEL, colour=MUTE, weight="medium")

        def paint(sheet: Canvas) -> None:
            sheet.surface.blit(picture(why, sheet.rect(0, 0, size, size).size, AMBER), (0, 0))

        self._why.draw(canvas, (left, top, size, size), why.tobytes(), paint)


def _paint_stages(sheet: Canvas, reading: Reading, taken: Sequence[bool]) -> None:
    for number, image in enumerate(reading.stages):
        area = sheet.rect(number * _PITCH, 0, _TILE, _TILE)
        stage = _fitted(image, area.width)
        stage.set_alpha(None if taken[number] else 90)  # an alpha of 255 would take forty times as long
        sheet.surface.blit(stage, area)
        pygame.draw.rect(sheet.surface, LINE, area, 1)


def _fitted(image: Image, side: int) -> pygame.Surface:
    """Return an image of any shape fitted into a square; small images keep sharp pixels."""
    coarse = max(image.shape) // side
    if coarse > 1:
        rows, columns = (max(1, length // coarse) for length in image.shape)
        part = np.pad(image, [(0, max(0, coarse - length)) for length in image.shape])
        part = part[: rows * coarse, : columns * coarse].reshape(rows, coarse, -1).mean(axis=1)
        image = part.reshape(rows, columns, coarse) @ np.full(coarse, 1 / coarse, np.float32)
    height, width = image.shape
    scale = side / max(height, width)
    size = (max(1, round(width * scale)), max(1, round(height * scale)))
    surface = pygame.Surface((side, side))
    surface.fill(NIGHT0)
    surface.blit(picture(image, size), ((side - size[0]) // 2, (side - size[1]) // 2))
    return surface
