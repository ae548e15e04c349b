"""Dream scene: images that maximise a network's output for a digit (activation maximisation)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.digits.dream import STEPS, ActivationMaximisation
from ai.digits.preprocessing import SIDE
from game.core import texts
from game.core.scene import Transition
from game.digits import certainty
from game.digits.cells import CellPicker
from game.digits.pictures import GREY, Numbers, picture
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import LINE, NET, TITLE
from game.input.controls import Command
from game.scenes.digits.answer import DigitBars, write_large, write_marked
from game.scenes.digits.pad import side_in
from game.scenes.digits.scene import COLUMNS, LEAST
from game.ui.actions import Action, Table, one_of_ten
from game.ui.context import Context
from game.ui.panel import Panel
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier

_DIGITS: Final = 10
_TILES: Final = 150.0  # height of the pictures of all ten
_FAINTEST: Final = 0.3  # least peak brightness for scaling: dimmer images stay dim
_CALM: Final = 0.7


class DreamScene(PanelScene):
    """Dreams of all ten digits, one of them large. `drawing` (28, 28) is an optional starting image.

    Attributes:
        digit: the digit shown large.
        dreams: one per digit; the one shown large is computed first, then the others.

    """

    def __init__(
        self, context: Context, classifier: DigitClassifier, digit: int = 0, drawing: Numbers | None = None
    ) -> None:
        super().__init__(context)
        self.digit = digit if digit in range(_DIGITS) else 0
        self._classifier = classifier
        self._drawing = drawing if drawing is not None and drawing.any() else None
        self._calm, self._from_drawing = _CALM, False
        self._begin()
        self.build()
        self._show()
        self.form.focus(self._tiles)

    def restart(self) -> None:
        """Restart all dreams."""
        self._begin()
        self._show()

    def _begin(self) -> None:
        start = self._drawing if self._from_drawing else None
        seed = int(self.context.rng.integers(1 << 31))
        self.dreams = [
            ActivationMaximisation(self._classifier, digit, np.random.default_rng((seed, digit)), start, self._calm)
            for digit in range(_DIGITS)
        ]

    def choose(self, digit: int) -> None:
        """Show another digit large."""
        self.digit = digit
        self._show()

    def _show(self) -> None:
        """Update the widgets to the state of the dreams."""
        tiles = np.stack([_bright(dream.image) for dream in self.dreams])
        self._tiles.show_tiles(tiles, texts.DREAM_ALL, self.digit)
        self._bars.values = [(value, 0.0) for value in self.dreams[self.digit].probabilities.tolist()]
        self._bars.best = self._bars.digit = self.digit

    def actions(self) -> Table:
        return [
            *one_of_ten(self.context.controls, self.choose, lambda: self.digit),
            Action(Command.RETRY, self.restart, texts.DREAM_AGAIN.lower()),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def update(self) -> Transition | None:
        dream = next((each for each in (self.dreams[self.digit], *self.dreams) if not each.done), None)
        if dream is not None:
            dream.advance()
            self._show()
        return super().update()

    def describe(self, panel: Panel) -> None:
        left, right = panel.beside(COLUMNS, least=LEAST, apart=40.0)
        left.text(lambda: texts.DREAM_TITLE.format(numeral=texts.NUMERALS[self.digit]), size=TITLE)
        left.aside(lambda: texts.DREAM_LINE.format(numeral=texts.NUMERALS[self.digit]))
        left.gap()
        left.picture(side_in, self._draw_dream)
        left.aside(lambda: texts.DREAM_STEPS.format(step=self.dreams[self.digit].step, steps=STEPS))
        read, others = right.beside((22, 33), least=160.0)
        read.add(self._write_read)
        self._bars = read.widget(DigitBars(self.choose))
        self._tiles = others.widget(
            CellPicker(lambda row, column: self.choose(row * self._tiles.columns + column), _TILES, GREY)
        )
        others.slider(texts.DREAM_CALM, self._calm, (0.0, 1.0), self._set_calm, step=0.1, figure="{:.1f}".format,
                      aside=texts.DREAM_CALM_HELP)  # fmt: skip
        if self._drawing is not None:
            others.choice(texts.DREAM_START, texts.DREAM_STARTS, int(self._from_drawing), self._set_start)
        others.button(texts.DREAM_AGAIN, self.restart)

    def _draw_dream(self, canvas: Canvas, box: pygame.FRect) -> None:
        area = canvas.rect(*box.topleft, box.height, box.height)
        small = picture(_bright(self.dreams[self.digit].image), (SIDE, SIDE)).convert(canvas.surface)
        canvas.surface.blit(pygame.transform.smoothscale(small, area.size), area)
        pygame.draw.rect(canvas.surface, LINE, area, 1)

    def _write_read(self, cursor: Cursor) -> None:
        write_large(cursor, str(self.digit), NET)
        probabilities = self.dreams[self.digit].probabilities
        best = int(probabilities.argmax())
        words = texts.DREAM_READS.format(numeral=texts.NUMERALS[best], percent=certainty(float(probabilities[best])))
        right, palette = best == self.digit, cursor.palette
        write_marked(cursor, "check" if right else "triangle", words, palette.good if right else palette.warn)

    def _set_calm(self, calm: float) -> None:
        self._calm = calm
        self.restart()

    def _set_start(self, index: int) -> None:
        self._from_drawing = index == 1
        self.restart()


def _bright(image: Numbers) -> Numbers:
    """Return an image scaled to full brightness; one with hardly any ink stays dim."""
    return np.asarray(image / max(float(image.max()), _FAINTEST), np.float32)
