"""Why not another digit: which ink is in its way, and which it lacks, measured spot by spot."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.digits.classifier import DIGITS
from ai.digits.preprocessing import SIDE, Image
from ai.explain.contrast import SQUARE, Contrast, InkChange
from game.core import texts
from game.digits import certainty
from game.digits.pictures import SIGNED, Numbers, framed, visible
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import MUTE, NET, SMALL
from game.input.controls import Command
from game.scenes.digits.answer import DigitBars, write_legend
from game.scenes.digits.reader import best_two
from game.scenes.digits.sums import figure
from game.ui.actions import Action, digit_actions
from game.ui.hints import Hint

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier
    from game.ui.actions import Table
    from game.ui.context import Context
    from game.ui.panel import Panel

_DIGIT, _MAP = 400.0, 240.0  # sides of pictures
_EVERY: Final = 8  # updates from one picture of what is being measured to the next
_INDENT: Final = 16.0


@dataclass(frozen=True, eq=False)
class Shown:
    """What is shown of a contrast for one asked digit.

    Attributes:
        asked, answer: the two digits.
        ink: rows and columns of the digit's ink, first and last of each.
        take, put: the ink to take away and to put that brings the asked digit nearest; None if none does.
        says: (28, 28) in -1 to 1, what the ink there, or ink where there is none, says for the asked digit.
        measured: whether all has been measured.

    """

    asked: int
    answer: int
    ink: tuple[tuple[int, int], tuple[int, int]]
    take: InkChange | None
    put: InkChange | None
    says: Numbers
    measured: bool


class WhyNotTab:
    """A digit (28, 28), the network's answer, and the question why it is not another.

    Attributes:
        image: the digit as it is now.
        asked: the digit that is asked about.
        contrast: the evidence; None for a network that cannot be asked.
        seen: what is shown of it; None likewise, and without ink.

    """

    def __init__(self, context: Context, classifier: DigitClassifier, image: Image, build: Callable[[], None]) -> None:
        self._context, self._classifier, self._first, self._build = context, classifier, image, build
        self._painted, self._map = PaintCache(), PaintCache()
        self._steps = 0
        self.asked = best_two(classifier.predict(image)[0])[1]
        self._bars = DigitBars(self.ask)
        self._set_image(image)

    def ask(self, digit: int) -> None:
        """Ask about another digit."""
        self.asked = digit
        self._show()
        self._build()

    def actions(self) -> Table:
        controls = self._context.controls
        by_gamepad = f"{controls.word(Command.PREVIOUS)} {controls.word(Command.NEXT)}"
        return [
            Hint(by_gamepad if controls.gamepad_in_use else "0 – 9", texts.HINT_DIGIT),
            *digit_actions(self.ask),
            Action(Command.NEXT, lambda: self.ask((self.asked + 1) % DIGITS)),
            Action(Command.PREVIOUS, lambda: self.ask((self.asked - 1) % DIGITS)),
            Action(Command.RETRY, self._restore),
        ]

    def update(self) -> None:
        if self.contrast and not self.contrast.done:
            self.contrast.advance()
            self._steps += 1
            if self._steps % _EVERY == 0 or self.contrast.done:
                self._show()

    # The digit and its evidence

    def _set_image(self, image: Image) -> None:
        self.image = image
        self.probabilities = self._classifier.predict(image)[0]
        try:
            self.contrast: Contrast | None = Contrast(self._classifier, image)
        except ValueError:
            self.contrast = None
        self._show()

    def _show(self) -> None:
        known = self.contrast is not None and bool(self.image.any())
        self.seen: Shown | None = shown(self.contrast, self.asked) if known and self.contrast else None

    def _change(self, ink: int) -> None:
        """Take the ink away that is in the asked digit's way (0), or put the ink that it lacks (1)."""
        if self.contrast and self.seen and self.seen.measured and self.asked != self.contrast.answer:
            change = self.seen.put if ink else self.seen.take
            if change:
                self._set_image(self.contrast.changed(change.row, change.column, ink))
                self._build()

    def _restore(self) -> None:
        if self.image is not self._first:
            self._set_image(self._first)
            self._build()

    # Rows

    def describe(self, panel: Panel) -> None:
        left, right = panel.beside((44, 60), least=170.0, apart=32.0)
        answer, evidence = right.beside((22, 33), least=130.0)
        left.picture(lambda width: min(width, _DIGIT), self._draw_image)
        left.words([
            (texts.WHY_NOT_TAKE_IT, lambda: self._change(0)),
            (texts.WHY_NOT_PUT_IT, lambda: self._change(1)),
            (texts.WHY_NOT_UNDO, self._restore),
        ])  # fmt: skip
        answer.add(self._write_answer)
        eased = self._bars.shown
        self._bars = answer.widget(DigitBars(self.ask, self.asked))
        self._bars.shown, self._bars.best = eased, int(self.probabilities.argmax())
        self._bars.values = [(value, 0.0) for value in self.probabilities.tolist()]
        if self.seen is None:
            evidence.text(texts.WHY_NOT_STRANGE if self.contrast is None else texts.WHY_NOT_EMPTY, colour=MUTE)
            return
        evidence.add(self._write_sentences)
        if self.asked != self.seen.answer:
            evidence.gap()
            evidence.picture(lambda width: min(width, _MAP), self._draw_map)
            legend = [each.format(asked=self.asked) for each in texts.WHY_NOT_LEGEND]
            evidence.add(lambda cursor: write_legend(cursor, zip(legend, (NET, cursor.palette.warn), strict=True)))

    def _write_answer(self, cursor: Cursor) -> None:
        answer = int(self.probabilities.argmax())
        words = texts.WHY_NOT_READS.format(digit=answer, percent=certainty(float(self.probabilities[answer])))
        if self.contrast:
            words += texts.WHY_NOT_SCORE.format(score=figure(float(self.contrast.scores[answer])))
        cursor.styled(words, tabular=True)
        cursor.gap()

    def _write_sentences(self, cursor: Cursor) -> None:
        assert self.seen
        marked = self.seen.measured and self.asked != self.seen.answer
        for words, colour in zip(sentences(self.seen), (cursor.palette.warn, NET), strict=False):
            if marked and cursor.canvas:
                cursor.canvas.rounded((cursor.left, cursor.y + 5, 8, 8), 2, colour)
            cursor.styled(words, SMALL, indent=_INDENT * marked)
            cursor.gap(4)

    # Pictures

    def _draw_image(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the digit, with both squares of ink in it."""
        side = box.height
        self._painted.draw(canvas, (*box.topleft, side, side), self.image.tobytes(), framed(self.image))
        if (seen := self.seen) is None or not seen.measured or seen.asked == seen.answer:
            return
        pixel = side / SIDE
        for change, colour in ((seen.take, canvas.palette.warn), (seen.put, NET)):
            if change:
                left = box.left + (change.column - SQUARE // 2) * pixel
                top = box.top + (change.row - SQUARE // 2) * pixel
                canvas.outline((left, top, SQUARE * pixel, SQUARE * pixel), 3, colour, 2)
                canvas.text("+" if change.ink else "−", (left + SQUARE * pixel + 6, top + 14), colour=colour)

    def _draw_map(self, canvas: Canvas, box: pygame.FRect) -> None:
        if seen := self.seen:
            self._map.draw(canvas, (*box.topleft, box.height, box.height), seen, framed(seen.says, SIGNED))


def shown(contrast: Contrast, asked: int) -> Shown:
    """Return what is to be shown of a contrast as far as it is measured."""
    between = [each[..., asked] - each[..., contrast.answer] for each in (contrast.taken, contrast.put)]
    taken, put = (np.nan_to_num(each) for each in between)
    scale = max(float(np.abs(taken).max()), float(np.abs(put).max()), 1e-9)
    changes = [contrast.best(asked, ink) for ink in (0, 1)]
    take, add = (each if each and figure(each.before) != figure(each.after) else None for each in changes)
    says = visible(np.where(contrast.image > 0, -taken, put) / scale)
    return Shown(asked, contrast.answer, _inked(contrast.image), take, add, says, contrast.done)


def _inked(image: Image) -> tuple[tuple[int, int], tuple[int, int]]:
    """Return the first and last row with ink, and the first and last column; those of the whole picture without ink."""
    rows, columns = (np.flatnonzero(image.any(axis=axis)) for axis in (1, 0))
    if not len(rows):
        return (0, SIDE - 1), (0, SIDE - 1)
    return (int(rows[0]), int(rows[-1])), (int(columns[0]), int(columns[-1]))


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
