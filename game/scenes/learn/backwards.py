"""Chapter 4, backwards: a digit that was misread, and the error that flows back through the network's layers."""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np
import pygame

from ai.digits.classifier import DIGITS, DigitClassifier
from ai.digits.mnist import Labels, Pixels, bright
from ai.explain.inspection import traces
from ai.nn import SGD, Array, FullyConnectedLayer
from game.core import texts
from game.core.scene import Route
from game.digits.kept import classifier_in, mnist_test
from game.digits.pictures import GREY, SIGNED, picture
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import INK, LABEL, MUTE, NET, SMALL
from game.explain.figures import percent
from game.scenes.learn.chapter import Chapter
from game.ui.context import Context
from game.ui.panel import Column

RATE: Final = 0.01
SEARCHED: Final = 1000  # test images in which misread ones are looked for
OTHERS: Final = slice(1000, 1500)  # test images that the step was not made for
MOST_STEPS: Final = 9
ANSWERS: Final = (0.0, 0.2, 1.0)  # shares of all numbers, of the answers
_MODEL: Final = "classic"
# Left end, width, columns and rows of the pictures, as shares of the whole: the image, and the two layers of units.
_BOXES: Final = ((0.0, 0.23, 28, 28), (0.28, 0.2, 10, 10), (0.53, 0.1, 5, 10))
_ANSWERS: Final = 0.69  # left end of the answers
_LINKS: Final = 24  # connections that are drawn from layer to layer: those most to blame


class Blame:
    """The shipped network of fully connected layers, a copy of it that learns, and one digit that it misreads.

    Attributes:
        digit: number of the misread digit; `chosen` is that of its test image.
        network: the copy.
        label: the digit that it is.
        reached: how many layers the error has reached: 0 none, 1 the answers, 4 the image.
        steps: learning steps taken on this digit.
        moved: how many numbers the last one has changed.
        blames: derivative of the cost by the image, by each unit's answer, and by the ten answers.
        links: for each layer, the weights that are most to blame.

    """

    def __init__(self, shipped: DigitClassifier, pixels: Pixels, labels: Labels) -> None:
        self._shipped, self._pixels, self._labels = shipped, pixels, labels
        read = shipped.predict(bright(pixels[:SEARCHED])).argmax(axis=1)
        self.misread = np.flatnonzero(read != labels[:SEARCHED]).tolist()
        self.begin(0)

    def begin(self, digit: int) -> None:
        """Begin with one of the digits that the shipped network misreads."""
        self.digit = digit
        self.chosen = self.misread[digit % len(self.misread)]
        self.classifier = DigitClassifier(self._shipped.network.copy())
        self.network = self.classifier.network
        self.label = int(self._labels[self.chosen])
        self.image = bright(self._pixels[self.chosen : self.chosen + 1])
        self._target = np.eye(DIGITS, dtype=np.float32)[[self.label]]
        self.reached = self.steps = self.moved = 0
        self._look()
        self.before, self.read_as, self.right_before = self.odds[self.label], int(self.odds.argmax()), self.right()

    def step(self) -> bool:
        """Send the error back one layer, or learn once it has reached the image; return whether it has learned."""
        if self.reached < 4:
            self.reached += 1
            return False
        if self.steps >= MOST_STEPS:
            return False
        before = self.network.values.copy()
        self.network.train_batch(self.classifier.shaped(self.image), self._target, SGD(RATE))
        self.moved = int((self.network.values != before).sum())
        self.steps += 1
        self._look()
        return True

    def _look(self) -> None:
        """Read the digit, and send the error back through all layers, as a learning step does."""
        network, shaped = self.network, self.classifier.shaped(self.image)
        self.answers = network.forward_propagate(shaped)[0].copy()
        self.odds = self.classifier.probabilities(self.answers[None])[0]
        self.units = [*(stage[0] for stage in traces(network, shaped)[1:3]), self.answers]
        error = network.cost.derivative(self.answers[None], self._target)
        network.backward_propagate(error)
        layers = [layer for layer in network.layers if isinstance(layer, FullyConnectedLayer)]
        hidden = [layer.error[0].copy() for layer in layers[1:]]  # what each sent back to the units before it
        # A pixel without ink sends nothing on: whatever its weights are, it has no part in the mistake.
        pixels = np.where(shaped.ravel() > 0, network.input_gradient(shaped, error)[0], 0.0)
        self.blames: list[Array] = [pixels, *hidden, error[0]]
        self.links = [_steepest(layer.parameters[0].gradient) for layer in layers]

    def right(self) -> int:
        """Return how many of 500 other digits it reads right."""
        read = self.classifier.predict(bright(self._pixels[OTHERS])).argmax(axis=1)
        return int((read == self._labels[OTHERS]).sum())

    def verdict(self) -> int | None:
        """Return the answer that the share of numbers which the last step moved is next to."""
        share = self.moved / self.network.values.size
        return int(np.argmin(np.abs(np.array(ANSWERS) - share))) if self.steps else None


class BackwardsChapter(Chapter):
    """The digit, the network's layers, and the blame on its way back through them."""

    key, door, shape = "backwards", Route("digits"), 0.42
    model: Blame

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._cache = PaintCache(most=6)
        self.model = Blame(classifier_in(context.models_dir / "digits" / _MODEL), *mnist_test(context.assets_dir))

    def controls(self, column: Column) -> None:
        back = self.model.reached < 4
        column.button(texts.LEARN_BACKWARDS_BACK if back else texts.LEARN_BACKWARDS_STEP, self.go_on)
        column.button(texts.LEARN_BACKWARDS_OTHER, self.another)

    def go_on(self) -> None:
        """Send the error back one layer, or take a learning step."""
        self.changed = True
        if self.model.step():
            self.found()

    def another(self) -> None:
        """Show the next digit that the shipped network misreads."""
        self.model.begin(self.model.digit + 1)
        self.changed, self.tried = True, False

    def update(self) -> None:
        """Stand still: each step is a press."""

    def why(self) -> str:
        model = self.model
        return texts.LEARN_BACKWARDS_WHY.format(
            label=model.label, read=model.read_as, before=percent(model.before), after=percent(model.odds[model.label]),
            steps=model.steps, moved=model.moved, share=percent(model.moved / model.network.values.size),
            count=model.network.values.size, right=model.right_before, now=model.right(),
        )  # fmt: skip

    def below(self, column: Column) -> None:
        column.text(lambda: texts.LEARN_BACKWARDS_COLOURS[self.model.reached > 0], size=SMALL, colour=MUTE)

    def draw(self, canvas: Canvas, box: pygame.FRect) -> None:
        for stage, links in enumerate(self.model.links):
            for start, end, slope in links if self.model.reached >= 4 - stage else ():
                line = _spot(box, stage, start).center, _spot(box, stage + 1, end).midleft
                canvas.line(*line, NET if slope < 0 else canvas.palette.warn, 1, 0.35)
        for stage, (_, _, columns, rows) in enumerate(_BOXES):
            area = _spot(box, stage, 0).union(_spot(box, stage, columns * rows - 1))
            blamed = self.model.reached >= 4 - stage
            shows = (stage, blamed, self.model.steps, self.model.chosen)
            self._cache.draw(canvas, area, shows, partial(self._paint, stage, blamed, columns))
            canvas.text(texts.LEARN_BACKWARDS_STAGES[stage], (area.left, area.top - 10), size=LABEL, colour=MUTE)
        for digit in range(DIGITS):
            self._draw_answer(canvas, _spot(box, len(_BOXES), digit), digit)

    def _paint(self, stage: int, blamed: bool, columns: int, sheet: Canvas) -> None:
        model = self.model
        if blamed:
            shown = -model.blames[stage] / max(float(np.abs(model.blames[stage]).max()), 1e-9)
        else:
            shown = np.abs(model.units[stage - 1]) if stage else model.image[0]
        shades = SIGNED if blamed else GREY
        sheet.surface.blit(picture(shown.reshape(-1, columns), sheet.size, shades), (0, 0))

    def _draw_answer(self, canvas: Canvas, box: pygame.FRect, digit: int) -> None:
        """Draw how likely a digit is said to be, and which way its answer should go."""
        odds, blame, y = float(self.model.odds[digit]), float(self.model.blames[-1][digit]), box.centery
        colour = canvas.palette.good if digit == self.model.label else INK
        canvas.text(str(digit), (box.left + 6, y + 5), size=SMALL, colour=colour, weight="medium")
        canvas.bar((box.left + 24, y - 2, max(box.width - 100, 20), 4), odds, NET)
        canvas.text(percent(odds), (box.right - 26, y + 5), size=SMALL, colour=colour, align="right", tabular=True)
        if self.model.reached:
            size = 4 + 12 * abs(blame) / max(float(np.abs(self.model.blames[-1]).max()), 1e-9)
            tint = NET if blame < 0 else canvas.palette.warn
            canvas.marker("triangle" if blame < 0 else "triangle_down", (box.right - 10, y), size, tint)


def _steepest(slopes: Array) -> list[tuple[int, int, float]]:
    """Return the weights (inputs, outputs) that are most to blame: both their ends and their slopes."""
    places = np.argsort(-np.abs(slopes), axis=None)[:_LINKS]
    starts, ends = np.unravel_index(places, slopes.shape)
    return list(zip(starts.tolist(), ends.tolist(), slopes[starts, ends].tolist(), strict=True))


def _spot(box: pygame.FRect, stage: int, unit: int) -> pygame.FRect:
    """Return where a unit of a stage stands in the picture: a pixel, a unit of a layer, an answer."""
    if stage == len(_BOXES):
        pitch, left = box.height / DIGITS, _ANSWERS * box.width
        return pygame.FRect(box.left + left, box.top + unit * pitch, box.width - left, pitch)
    left, width, columns, rows = _BOXES[stage]
    cell, (row, column) = width * box.width / columns, divmod(unit, columns)
    return pygame.FRect(box.left + left * box.width + column * cell, box.centery + (row - rows / 2) * cell, cell, cell)
