"""Inside scene: one digit on its way through a network, a patch, its sums and the answer, written out in numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.nn import ActivationLayer, ConvolutionLayer, MaxPoolingLayer
from game.core import texts
from game.core.scene import Transition, push
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.sky import NightSky
from game.drawing.tokens import MUTE, SMALL, TEXT, TITLE
from game.input.controls import Command
from game.scenes.digits.patch_pictures import PatchPictures
from game.scenes.digits.patch_sums import PatchSums
from game.scenes.digits.stage_row import StageRow
from game.scenes.digits.unit_walk import UnitWalk, draw_code
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FormScene
from game.ui.hints import HintRow
from game.ui.widgets import TextButton

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier
    from ai.digits.preprocessing import Image

_LEFT: Final = 40
_RIGHT: Final = 1240.0
_ROW: Final = (_LEFT, 58, 1200, 52)
_SAYS: Final = (float(_LEFT), 140.0)
_HINTS: Final = (float(_LEFT), 690.0)
_FIRST: Final = 120  # updates before the window slides
_PACE: Final = 8  # updates that the sliding window stays where it is


class DigitInsideScene(FormScene):
    """A digit (28, 28) on its way through a network.

    Attributes:
        walk: the units that are looked at, one of each stage.
        sliding: whether the window moves by itself.
        in_code: whether the code is shown in place of the maps.

    """

    def __init__(self, context: Context, classifier: DigitClassifier, image: Image) -> None:
        super().__init__(context)
        self._classifier, self._image = classifier, np.asarray(image, np.float32)
        self.walk = UnitWalk(classifier, self._image)
        self.in_code = False
        self._steps = 0
        self._sky = NightSky(np.random.default_rng(14), ember=0.2, stars=24)
        self._sums = PatchSums()
        self._stages = self.form.add(StageRow(self.form.manager, _ROW, self.walk, self._choose))
        self._pictures = PatchPictures(self.form.manager, self.walk, self._image, self._stop)
        for picker in self._pictures.pickers:
            self.form.add(picker)
        self._add_words()
        self.sliding = self._slides and not context.settings.reduced_motion

    def actions(self) -> Table:
        """Go through the stages; let the window slide; show the code; go back."""
        slide = texts.HINT_STOP if self.sliding else texts.PATCH_SLIDE
        return [
            Action(Command.NEXT, lambda: self._choose(self.walk.number + 1), texts.PATCH_ON),
            Action(Command.PREVIOUS, lambda: self._choose(self.walk.number - 1), texts.PATCH_BACK),
            *([Action(pygame.K_SPACE, self._toggle, slide, gamepad=Command.HANDOVER)] if self._slides else []),
            Action(Command.CHOICES, self._show_code, texts.PATCH_MAPS if self.in_code else texts.PATCH_IN_CODE),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints at the foot."""
        return [HintRow(self.hints, _HINTS, room=_RIGHT - _LEFT)]

    def update(self) -> Transition | None:
        """Let the window slide, after a moment to look."""
        self._steps += 1
        if self.sliding and self._steps > _FIRST and self._steps % _PACE == 0:
            self.walk.slide()
            self._pictures.follow()
        return self.form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the stages, the sum of the unit looked at, and the pictures around it."""
        self._sky.draw(canvas)
        canvas.text(texts.PATCH_TITLE, (_LEFT, 45), size=TITLE)
        canvas.text(self._says(), _SAYS, size=SMALL, colour=MUTE, room=_RIGHT - _LEFT)
        self._sums.draw(canvas, self.walk)
        if self.in_code:
            draw_code(canvas, self.walk)
        else:
            self._pictures.draw(canvas)
        self.form.draw(canvas)
        self.draw_hints(canvas)

    # What is looked at

    @property
    def _slides(self) -> bool:
        """Whether there is a window that can slide here."""
        return self.walk.stage.kind == "convolution" and not self.walk.at_answer

    def _choose(self, number: int) -> None:
        if 0 <= number <= len(self.walk.stages) and number != self.walk.number:
            self._stop()
            self.walk.choose(number)
            self._remake()

    def _remake(self) -> None:
        """Make the pictures of another stage."""
        old = self._pictures.pickers
        self._pictures = PatchPictures(self.form.manager, self.walk, self._image, self._stop, in_code=self.in_code)
        self.form.replace([self._stages, *old], [self._stages, *self._pictures.pickers])

    def _show_code(self) -> None:
        """Show the code, or the maps again."""
        self.in_code = not self.in_code
        self._remake()

    def _stop(self) -> None:
        self.sliding = False

    def _toggle(self) -> None:
        self.sliding = not self.sliding

    # Words

    def _says(self) -> str:
        """Return what the stage does, in a sentence."""
        walk, says = self.walk, texts.PATCH_SAYS
        if walk.at_answer:
            return says["answer"]
        match walk.stage.layer:
            case ConvolutionLayer(kernel=kernel):
                return says["convolution" if walk.number == 0 else "deeper"].format(size=kernel)
            case MaxPoolingLayer(size=size):
                return says["pooling"].format(size=size)
            case ActivationLayer(activation=activation):
                return texts.PATCH_BENDS.get(activation.name or "", texts.PATCH_BENDS["other"])
        return says[walk.stage.kind]

    def _add_words(self) -> None:
        """Add the word that leads to the question why it is no other digit."""
        word = texts.WHY_NOT_WORD
        width = round(typeface.width(word, TEXT, "medium"))
        box = (_RIGHT - width, 24, width, 28)
        self.form.add(TextButton(self.form.manager, box, word, self._why_not, weight="medium"))

    def _why_not(self) -> Transition:
        return push("why_not", self._classifier, self._image)
