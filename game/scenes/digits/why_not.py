"""Why not another digit: which ink is in its way, and which it lacks, measured spot by spot."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.digits.preprocessing import SIDE, Image
from ai.explain.contrast import SQUARE, Contrast, InkChange
from game.core import texts
from game.digits import certainty
from game.digits.pictures import SIGNED, Picture, visible
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import MUTE, NET, SMALL
from game.scenes.digits.answer import DigitBars, write_legend
from game.scenes.digits.reader import best_two
from game.scenes.digits.sums import figure

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier
    from game.ui.panel import Panel

_DIGIT, _MAP = 400.0, 240.0  # sides of pictures
_INDENT: Final = 16.0


class WhyNotTab:
    """A digit (28, 28), the network's answer, and the question why it is not another.

    Attributes:
        image: the digit as it is now.
        asked: the digit that is asked about.
        contrast: the evidence; None for a network that cannot be asked.
        changes: the ink to take away and to put that brings the asked digit nearest, once all is measured.
        says: (28, 28) in -1 to 1, what the ink there, or ink where there is none, says for the asked digit.

    """

    def __init__(self, classifier: DigitClassifier, image: Image, build: Callable[[], None]) -> None:
        self._classifier, self._first, self._build = classifier, image, build
        self._painted, self._map = Picture(), Picture(SIGNED)
        self.asked = -1  # none yet
        self._set_image(image)

    def ask(self, digit: int) -> None:
        """Ask about another digit."""
        self.asked = digit
        self._compare()
        self._build()

    def update(self) -> None:
        if self.contrast and self.contrast.left and self.contrast.advance():
            self._compare()
            self._build()

    # The digit and its evidence

    def _set_image(self, image: Image) -> None:
        self.image = image
        self.probabilities = self._classifier.predict(image)[0]
        answer, second = best_two(self.probabilities)
        if self.asked in (-1, answer):  # what it reads is not to be asked about
            self.asked = second
        try:
            self.contrast: Contrast | None = Contrast(self._classifier, image)
        except ValueError:
            self.contrast = None
        self._compare()

    def _compare(self) -> None:
        """Compare what ink does to the asked digit's score and to the answer's."""
        contrast, asked = self.contrast, self.asked
        self.changes: list[InkChange] = []
        self.says = np.zeros((SIDE, SIDE), np.float32)
        if contrast and not contrast.left and asked != contrast.answer:
            changes = [contrast.best(asked, ink) for ink in (0, 1)]
            self.changes = [each for each in changes if each and figure(each.before) != figure(each.after)]
            between = [each[..., asked] - each[..., contrast.answer] for each in (contrast.taken, contrast.put)]
            taken, put = (np.nan_to_num(each) for each in between)
            scale = max(float(np.abs(taken).max()), float(np.abs(put).max()), 1e-9)
            self.says = visible(np.where(contrast.image > 0, -taken, put) / scale)

    def _show(self, image: Image) -> None:
        """Show the digit with other ink, or as it was."""
        self._set_image(image)
        self._build()

    # Rows

    def describe(self, panel: Panel) -> None:
        left, right = panel.beside((44, 60), least=170.0, apart=32.0)
        answer, evidence = right.beside((22, 33), least=130.0)
        left.picture(lambda width: min(width, _DIGIT), self._draw_image)
        images = [(texts.WHY_NOT_UNDO, self._first)]
        if contrast := self.contrast:
            words = texts.WHY_NOT_TAKE_IT, texts.WHY_NOT_PUT_IT
            images += [(words[each.ink], contrast.changed(each.row, each.column, each.ink)) for each in self.changes]
        left.words([(word, partial(self._show, image)) for word, image in images])
        best = int(self.probabilities.argmax())
        answer.text(texts.WHY_NOT_READS.format(digit=best, percent=certainty(float(self.probabilities[best]))))
        answer.gap()
        answer.widget(DigitBars(self.ask, self.asked)).values = self.probabilities.tolist()
        if self.changes:
            answer.aside(texts.WHY_NOT_SCORE)
        if contrast is None:
            evidence.text(texts.WHY_NOT_STRANGE, colour=MUTE)
        elif contrast.left:
            evidence.text(lambda: texts.WHY_NOT_MEASURING.format(left=contrast.left), tabular=True)
        elif self.asked == contrast.answer:
            evidence.text(texts.WHY_NOT_SAME)
        else:
            evidence.add(self._write_changes)
            evidence.gap()
            evidence.picture(lambda width: min(width, _MAP), self._draw_map)
            legend = [each.format(asked=self.asked) for each in texts.WHY_NOT_LEGEND]
            evidence.add(lambda cursor: write_legend(cursor, zip(legend, (NET, cursor.palette.warn), strict=True)))

    def _write_changes(self, cursor: Cursor) -> None:
        for change in self.changes:
            if cursor.canvas:
                colour = NET if change.ink else cursor.palette.warn
                cursor.canvas.rounded((cursor.left, cursor.y + 5, 8, 8), 2, colour)
            words = texts.WHY_NOT_PUT if change.ink else texts.WHY_NOT_TAKE
            before, after = figure(change.before), figure(change.after)
            cursor.styled(words.format(asked=self.asked, before=before, after=after), SMALL, indent=_INDENT)
            cursor.gap(4)
        if not self.changes:
            cursor.styled(texts.WHY_NOT_NOTHING.format(asked=self.asked), SMALL)

    # Pictures

    def _draw_image(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the digit, with both squares of ink in it."""
        self._painted.draw(canvas, box, self.image)
        pixel = box.height / SIDE
        for change in self.changes:
            colour = NET if change.ink else canvas.palette.warn
            left = box.left + (change.column - SQUARE // 2) * pixel
            top = box.top + (change.row - SQUARE // 2) * pixel
            canvas.outline((left, top, SQUARE * pixel, SQUARE * pixel), 3, colour, 2)
            canvas.text("+" if change.ink else "−", (left + SQUARE * pixel + 6, top + 14), colour=colour)

    def _draw_map(self, canvas: Canvas, box: pygame.FRect) -> None:
        self._map.draw(canvas, box, self.says)
