"""Why-not scene: why a digit is not read as another one, and the ink that would have to go or to come for it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt
import pygame

from ai.digits.preprocessing import SIDE, Image
from ai.explain.contrast import SQUARE, Contrast, InkChange
from game.core import texts
from game.core.scene import Transition, push
from game.digits import percent
from game.digits.pictures import SIGNED, Numbers, picture
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.prose import draw_wrapped
from game.drawing.sky import NightSky
from game.drawing.tokens import HUMAN, INK, LABEL, LINE, MUTE, NET, SMALL, TEXT, TITLE, Colour
from game.input.controls import Command
from game.scenes.digits.answer import LEFT, DigitRow
from game.scenes.digits.patch_sums import figure
from game.scenes.digits.reader import best_two
from game.ui.actions import Action, Table, one_of_ten
from game.ui.context import Context
from game.ui.form_scene import FOOT, FormScene
from game.ui.hints import HintRow
from game.ui.widgets import TextButton

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier
    from ai.digits.preprocessing import Image


_DIGITS: Final = 10
_FRAME: Final = pygame.Rect(40, 86, 504, 504)  # eighteen points to a pixel
_BELOW: Final = 604
SAID_LEFT: Final = 900.0
_WIDTH: Final = 344.0
_SAID: Final = 122.0  # first baseline of the sentences
_LEADING: Final = 18.0
_MAPS: Final = (SAID_LEFT, 266.0, 160.0)
_SECOND_MAP: Final = 184.0  # from the left of the first map
_EVERY: Final = 8  # updates from one picture of what is being measured to the next


class WhyNotScene(FormScene):
    """A digit (28, 28), the network's answer, and the question why it is not another.

    Attributes:
        image: the digit as it is now.
        asked: the digit that is asked about.
        contrast: the evidence; None for a network that cannot be asked.
        seen: what is shown of it; None likewise, and without ink.

    """

    def __init__(self, context: Context, classifier: DigitClassifier, image: Image) -> None:
        super().__init__(context)
        self._classifier, self._first = classifier, np.asarray(image, np.float32)
        self._sky = NightSky(np.random.default_rng(15), ember=0.2, stars=24)
        self._view, self._painted = ContrastView(), PaintCache()
        self._steps = 0
        self._rows = [self.form.add(DigitRow(self.form.manager, digit, self.ask)) for digit in range(_DIGITS)]
        self._add_words()
        self.asked = best_two(classifier.predict(self._first)[0])[1]
        self._set_image(self._first)
        self.form.focus(self._rows[self.asked])

    def ask(self, digit: int) -> None:
        """Ask about another digit."""
        self.asked = digit
        self._show()

    def actions(self) -> Table:
        """Ask about a digit by its key, or the next one; change the ink; go back."""
        return [
            *one_of_ten(self.context.controls, self.ask, lambda: self.asked),
            Action(Command.RETRY, self._restore, texts.WHY_NOT_UNDO.lower()),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints below the picture."""
        return [HintRow(self.hints, (_FRAME.left, FOOT[1]))]

    def update(self) -> Transition | None:
        """Measure the effect of the next squares of ink."""
        if self.contrast and not self.contrast.done:
            self.contrast.advance()
            self._steps += 1
            if self._steps % _EVERY == 0 or self.contrast.done:
                self._show()
        return self.form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the digit, the answer, and the evidence."""
        self._sky.draw(canvas)
        canvas.text(texts.WHY_NOT_TITLE.format(digit=self.asked), (_FRAME.left, 45), size=TITLE)
        canvas.text(texts.WHY_NOT_LINE, (_FRAME.left, 70), size=SMALL, colour=MUTE, room=1200)
        self._painted.draw(canvas, _FRAME, self.image.tobytes(), self._paint_image)
        if self.seen:
            self._view.draw(canvas, self.seen)
            self._view.draw_marks(canvas, self.seen, (*_FRAME.topleft, *_FRAME.size))
        else:
            words = texts.WHY_NOT_STRANGE if self.contrast is None else texts.WHY_NOT_EMPTY
            draw_wrapped(canvas, words, (SAID_LEFT, 122), _WIDTH, size=TEXT, colour=MUTE, leading=22)
        if self.image.any():
            self._draw_answer(canvas)
        self.form.draw(canvas)
        self.draw_hints(canvas)

    def _paint_image(self, sheet: Canvas) -> None:
        area = sheet.rect(0, 0, *_FRAME.size)
        sheet.surface.blit(picture(self.image, area.size), area)
        pygame.draw.rect(sheet.surface, LINE, area, 1)

    def _draw_answer(self, canvas: Canvas) -> None:
        answer, probability = int(self.probabilities.argmax()), float(self.probabilities.max())
        canvas.text(str(answer), (LEFT - 6, 200), size=124, weight="extralight", colour=INK)
        words = texts.WHY_NOT_READS.format(digit=answer, percent=percent(probability))
        if self.contrast:
            words += texts.WHY_NOT_SCORE.format(score=figure(float(self.contrast.scores[answer])))
        canvas.text(words, (LEFT, 232), size=TEXT, colour=MUTE, tabular=True)
        canvas.marker("triangle", (LEFT - 16, self._rows[self.asked].box.centery), 8, HUMAN)

    # The picture

    def _set_image(self, image: Image) -> None:
        self.image = image
        self.probabilities = self._classifier.predict(image)[0]
        best = int(self.probabilities.argmax())
        for row in self._rows:
            row.values, row.best = (float(self.probabilities[row.digit]), 0.0), row.digit == best
        try:
            self.contrast: Contrast | None = Contrast(self._classifier, image)
        except ValueError:
            self.contrast = None
        self._show()

    def _show(self) -> None:
        known = self.contrast is not None and bool(self.image.any())
        self.seen: Shown | None = shown(self.contrast, self.asked) if known and self.contrast else None

    def _take(self) -> None:
        self._change(0)

    def _put(self) -> None:
        self._change(1)

    def _change(self, ink: int) -> None:
        """Take the ink away that is in the asked digit's way, or put the ink that it lacks."""
        if self.contrast and self.seen and self.seen.measured and self.asked != self.contrast.answer:
            change = self.seen.put if ink else self.seen.take
            if change:
                self._set_image(self.contrast.changed(change.row, change.column, ink))

    def _restore(self) -> None:
        if self.image is not self._first:
            self._set_image(self._first)

    def _inside(self) -> Transition:
        return push("digit_inside", self._classifier, self.image)

    def _add_words(self) -> None:
        left = float(_FRAME.left)
        for word, press in ((texts.WHY_NOT_TAKE_IT, self._take), (texts.WHY_NOT_PUT_IT, self._put),
                            (texts.WHY_NOT_UNDO, self._restore)):  # fmt: skip
            width = typeface.width(word, TEXT, "regular")
            self.form.add(TextButton(self.form.manager, (left, _BELOW, width, 28), word, press))
            left += width + 26
        width = typeface.width(texts.WHY_NOT_INSIDE, TEXT, "medium")
        box = (SAID_LEFT + _WIDTH - width, 24, width, 28)
        self.form.add(TextButton(self.form.manager, box, texts.WHY_NOT_INSIDE, self._inside, weight="medium"))


@dataclass(frozen=True, eq=False)
class Shown:
    """What is shown of a contrast for one asked digit.

    Attributes:
        asked, answer: the two digits.
        ink: rows and columns of the digit's ink, first and last of each.
        take, put: the ink to take away and to put that brings the asked digit nearest; None if none does.
        there, missing: (28, 28) in -1 to 1, of ink that is there and that is not, what it says for the asked digit.
        measured: whether all has been measured.

    """

    asked: int
    answer: int
    ink: tuple[tuple[int, int], tuple[int, int]]
    take: InkChange | None
    put: InkChange | None
    there: Numbers
    missing: Numbers
    measured: bool


def shown(contrast: Contrast, asked: int) -> Shown:
    """Return what is to be shown of a contrast as far as it is measured."""
    between = [each[..., asked] - each[..., contrast.answer] for each in (contrast.taken, contrast.put)]
    taken, put = (np.nan_to_num(each) for each in between)
    scale = max(float(np.abs(taken).max()), float(np.abs(put).max()), 1e-9)
    changes = [contrast.best(asked, ink) for ink in (0, 1)]
    take, add = (each if each and figure(each.before) != figure(each.after) else None for each in changes)
    return Shown(asked, contrast.answer, _inked(contrast.image), take, add, _clear(-taken / scale), _clear(put / scale),
                 contrast.done)  # fmt: skip


def _inked(image: Image) -> tuple[tuple[int, int], tuple[int, int]]:
    """Return the first and last row with ink, and the first and last column; those of the whole picture without ink."""
    rows, columns = (np.flatnonzero(image.any(axis=axis)) for axis in (1, 0))
    if not len(rows):
        return (0, SIDE - 1), (0, SIDE - 1)
    return (int(rows[0]), int(rows[-1])), (int(columns[0]), int(columns[-1]))


def _clear(parts: npt.NDArray[np.floating[Any]]) -> Numbers:
    """Return signed square roots, so that small values are visible too."""
    return np.asarray(np.sign(parts) * np.sqrt(np.abs(parts)), np.float32)


def sentences(seen: Shown) -> list[str]:
    """Return in words which ink the asked digit would not need, and which it would."""
    if not seen.measured:
        return [texts.WHY_NOT_MEASURING]
    if seen.asked == seen.answer:
        return [texts.WHY_NOT_SAME]
    nothing = texts.WHY_NOT_NOTHING_TAKEN, texts.WHY_NOT_NOTHING_PUT
    words = texts.WHY_NOT_TAKE, texts.WHY_NOT_PUT
    return [
        none.format(asked=seen.asked) if change is None else said.format(
            asked=seen.asked, where=texts.WHY_NOT_PLACES[_region(change, seen.ink)], before=figure(change.before),
            after=figure(change.after))
        for change, said, none in zip((seen.take, seen.put), words, nothing, strict=True)
    ]  # fmt: skip


def _region(change: InkChange, ink: tuple[tuple[int, int], tuple[int, int]]) -> int:
    """Return the ninth of the box around the ink, row by row, in which a change lies, or the one nearest to it."""
    row, column = (
        min(max(3 * (at - first) // (last - first + 1), 0), 2)
        for at, (first, last) in zip((change.row, change.column), ink, strict=True)
    )
    return 3 * row + column


class ContrastView:
    """Draws what is shown of a contrast; pictures are kept until that changes."""

    def __init__(self) -> None:
        self._painted = PaintCache()

    def draw(self, canvas: Canvas, seen: Shown) -> None:
        """Draw sentences and both maps."""
        self._painted.draw(canvas, (SAID_LEFT, 0, _WIDTH + 30, 720), seen, lambda sheet: _paint(sheet, seen))

    def draw_marks(self, canvas: Canvas, seen: Shown, box: tuple[float, float, float, float]) -> None:
        """Mark both squares in a picture of the digit."""
        if not seen.measured or seen.asked == seen.answer:
            return
        pixel = box[2] / SIDE
        for change, colour in ((seen.take, canvas.palette.warn), (seen.put, NET)):
            if change:
                left, top = (
                    box[0] + (change.column - SQUARE // 2) * pixel,
                    box[1] + (change.row - SQUARE // 2) * pixel,
                )
                canvas.outline((left, top, SQUARE * pixel, SQUARE * pixel), 3, colour, 2)
                sign = "+" if change.ink else "−"
                canvas.text(sign, (left + SQUARE * pixel + 6, top + 14), colour=colour)


def _paint(sheet: Canvas, seen: Shown) -> None:
    y = _SAID
    colours: tuple[Colour, ...] = (sheet.palette.warn, NET)
    for words, colour in zip(sentences(seen), colours, strict=False):
        indent = 16 if seen.measured and seen.asked != seen.answer else 0
        if indent:
            sheet.rounded((0, y - 8, 8, 8), 2, colour)
        y = draw_wrapped(sheet, words, (indent, y), _WIDTH - indent, size=SMALL, leading=_LEADING, most=4) + 6
    if seen.asked != seen.answer:
        _paint_maps(sheet, seen)


def _paint_maps(sheet: Canvas, seen: Shown) -> None:
    left, top, size = _MAPS
    for number, (values, words) in enumerate(((seen.there, texts.WHY_NOT_INK), (seen.missing, texts.WHY_NOT_ROOM))):
        x = left - SAID_LEFT + number * _SECOND_MAP
        area = sheet.rect(x, top, size, size)
        sheet.surface.blit(picture(values, area.size, SIGNED), area)
        sheet.outline((x, top, size, size), 0, LINE)
        sheet.text(words, (x, top - 10), size=LABEL, colour=MUTE, weight="medium", room=size)
    x, y = 0.0, top + size + 18
    for words, colour in zip(texts.WHY_NOT_LEGEND, (NET, sheet.palette.warn), strict=True):
        sheet.rounded((x, y - 7, 7, 7), 1.5, colour)
        x += 12 + sheet.text(words.format(asked=seen.asked), (x + 12, y), size=LABEL, colour=MUTE).width + 12
