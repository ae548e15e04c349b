"""Dream scene: images that maximise a network's output for a digit (activation maximisation)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.digits.dream import STEPS, ActivationMaximisation
from ai.digits.preprocessing import SIDE
from game.core import texts
from game.core.scene import Transition
from game.digits import percent
from game.digits.pictures import Numbers, picture
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.sky import NightSky
from game.drawing.tokens import INK, LABEL, LINE, MUTE, NET, SMALL, TEXT, TITLE
from game.input.controls import Command
from game.scenes.digits.answer import LEFT, DigitRow
from game.ui.actions import Action, Table, one_of_ten
from game.ui.context import Context
from game.ui.form_scene import FOOT, FormScene
from game.ui.hints import HintRow
from game.ui.widget import PointsManager, Widget
from game.ui.widgets import Choice, Slider, TextButton

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier

_DIGITS: Final = 10
_FRAME: Final = pygame.Rect(40, 86, 504, 504)  # eighteen points to a pixel
_RIGHT: Final = 900.0
_TILE: Final = 60
_PITCH: Final = 71.0
_COLUMNS: Final = 5
_FAINTEST: Final = 0.3  # least peak brightness for scaling: dimmer images stay dim
_CALM: Final = 0.7


class DreamTile(Widget):
    """Thumbnail of one dream; a press shows it large."""

    def __init__(self, manager: PointsManager, digit: int, on_press: Callable[[int], None]) -> None:
        row, column = divmod(digit, _COLUMNS)
        super().__init__(manager, (_RIGHT + column * _PITCH, 58 + row * (_TILE + 28), _TILE, _TILE), str(digit))
        self.digit, self._on_press = digit, on_press
        self.chosen = False
        self.image: Numbers | None = None

    def press(self) -> None:
        """Show this dream large."""
        self._on_press(self.digit)

    def paint(self, canvas: Canvas) -> None:
        """Draw the picture and its digit."""
        box = self.box
        area = canvas.rect(*box)
        if self.image is not None:
            canvas.surface.blit(picture(_bright(self.image), area.size), area)
        pygame.draw.rect(canvas.surface, NET if self.chosen else LINE, area, max(1, canvas.px(1)))
        if self.ringed and self.warmth > 0.02:
            canvas.outline(box.inflate(8, 8), 6, INK, 1, 0.6 * self.warmth)
        canvas.text(
            self.label,
            (box.centerx, box.bottom + 16),
            size=SMALL,
            align="centre",
            colour=INK if self.chosen else self.tint(),
        )


class DreamScene(FormScene):
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
        self._sky = NightSky(np.random.default_rng(13), ember=0.2, stars=24)
        self._add_widgets()
        self.restart()

    def restart(self) -> None:
        """Restart all dreams."""
        start = self._drawing if self._from_drawing else None
        seed = int(self.context.rng.integers(1 << 31))
        self.dreams = [
            ActivationMaximisation(self._classifier, digit, np.random.default_rng((seed, digit)), start, self._calm)
            for digit in range(_DIGITS)
        ]
        self._show()

    def choose(self, digit: int) -> None:
        """Show another digit large."""
        self.digit = digit
        self._show()

    def actions(self) -> Table:
        """Choose a digit by its key, or the next one; restart; go back."""
        return [
            *one_of_ten(self.context.controls, self.choose, lambda: self.digit),
            Action(Command.RETRY, self.restart, texts.DREAM_AGAIN.lower()),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints below the large dream."""
        return [HintRow(self.hints, (_FRAME.left, FOOT[1]))]

    def update(self) -> Transition | None:
        """Take one step of the dream shown large or, once that is done, of the next unfinished one."""
        dream = next((each for each in (self.dreams[self.digit], *self.dreams) if not each.done), None)
        if dream is not None:
            dream.advance()
            self._show()
        return self.form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the large dream, the network's reading of it, and the others."""
        self._sky.draw(canvas)
        dream = self.dreams[self.digit]
        canvas.text(texts.DREAM_TITLE.format(numeral=texts.NUMERALS[self.digit]), (_FRAME.left, 45), size=TITLE)
        canvas.text(
            texts.DREAM_LINE.format(numeral=texts.NUMERALS[self.digit]), (_FRAME.left, 68), size=SMALL, colour=MUTE
        )
        area = canvas.rect(*_FRAME)
        small = picture(_bright(dream.image), (SIDE, SIDE)).convert(canvas.surface)
        canvas.surface.blit(pygame.transform.smoothscale(small, area.size), area)
        pygame.draw.rect(canvas.surface, LINE, area, 1)
        steps = texts.DREAM_STEPS.format(step=dream.step, steps=STEPS)
        canvas.text(steps, (_FRAME.right, _FRAME.bottom + 20), size=LABEL, colour=MUTE, align="right", tabular=True)
        best = int(dream.probabilities.argmax())
        canvas.text(str(self.digit), (LEFT - 6, 172), size=124, weight="extralight", colour=NET)
        words = texts.DREAM_READS.format(
            numeral=texts.NUMERALS[best], percent=percent(float(dream.probabilities[best]))
        )
        colour = canvas.palette.good if best == self.digit else canvas.palette.warn
        canvas.marker("check" if best == self.digit else "triangle", (LEFT + 5, 203), 10, colour)
        canvas.text(words, (LEFT + 18, 208), size=TEXT, colour=colour, tabular=True)
        canvas.text(texts.DREAM_ALL, (_RIGHT, 42), size=LABEL, colour=MUTE, weight="medium")
        draw_wrapped(canvas, texts.DREAM_CALM_HELP, (_RIGHT, 312), 344, size=LABEL, colour=MUTE)
        self.form.draw(canvas)
        self.draw_hints(canvas)

    # Widgets

    def _add_widgets(self) -> None:
        manager, add = self.form.manager, self.form.add
        self._rows = [add(DigitRow(manager, digit, self.choose)) for digit in range(_DIGITS)]
        self._tiles = [add(DreamTile(manager, digit, self.choose)) for digit in range(_DIGITS)]
        self._slider = add(Slider(manager, (_RIGHT, 258, 344, 28), texts.DREAM_CALM, self._calm, (0.0, 1.0),
                                  self._set_calm, step=0.1, label_width=90, figure_width=40,
                                  figure="{:.1f}".format))  # fmt: skip
        if self._drawing is not None:
            add(Choice(manager, (_RIGHT, 372, 344, 28), texts.DREAM_START, texts.DREAM_STARTS, 0, self._set_start,
                       label_width=110))  # fmt: skip
        width = typeface.width(texts.DREAM_AGAIN, TEXT, "regular")
        top = 372 if self._drawing is None else 416
        add(TextButton(manager, (_RIGHT, top, width, 28), texts.DREAM_AGAIN, self.restart))
        self.form.focus(self._tiles[self.digit])

    def _set_calm(self, calm: float) -> None:
        self._calm = calm
        self.restart()

    def _set_start(self, index: int) -> None:
        self._from_drawing = index == 1
        self.restart()

    def _show(self) -> None:
        """Update the widgets to the state of the dreams."""
        for tile, dream in zip(self._tiles, self.dreams, strict=True):
            tile.image, tile.chosen = dream.image, tile.digit == self.digit
        probabilities = self.dreams[self.digit].probabilities
        for row in self._rows:
            row.values = (float(probabilities[row.digit]), 0.0)
            row.best = row.digit == self.digit


def _bright(image: Numbers) -> Numbers:
    """Return an image scaled to full brightness; one with hardly any ink stays dim."""
    return np.asarray(image / max(float(image.max()), _FAINTEST), np.float32)
