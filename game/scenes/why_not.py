"""Why-not scene: why a digit is not read as another one, and the ink that would have to go or to come for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.explain.contrast import Contrast
from game.core import texts
from game.core.scene import Transition, push
from game.digits.answer import LEFT, DigitRow, best_two, percent
from game.digits.contrast_view import LEFT as SAID_LEFT
from game.digits.contrast_view import ContrastView, Shown, shown
from game.digits.patch_sums import figure
from game.digits.pictures import picture
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.prose import draw_wrapped
from game.drawing.sky import NightSky
from game.drawing.tokens import HUMAN, INK, LINE, MUTE, SMALL, TEXT, TITLE
from game.input.controls import Command
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
_WIDTH: Final = 344.0
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
