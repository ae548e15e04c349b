"""Chapter 4, backwards: a digit that was misread, and the error that flows back through the network's layers."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Final

import numpy as np
import pygame

from ai.digits.classifier import DIGITS, DigitClassifier
from ai.digits.mnist import MnistError, bright
from ai.explain.inspection import traces
from ai.nn import SGD, Array, FullyConnectedLayer, ModelFormatError, NeuralNetwork
from game.core import texts
from game.core.scene import Route
from game.digits.kept import classifier_in, mnist_test
from game.digits.pictures import GREY, SIGNED, picture
from game.drawing.canvas import Canvas
from game.drawing.figures import write_figures
from game.drawing.paint_cache import PaintCache
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, INK, LABEL, MUTE, NET, SMALL
from game.learn.chapter import STAGE, Chapter, Code
from game.ui.context import Context
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widget import PointsManager, Widget
from game.ui.widgets import TextButton

RATE: Final = 0.01
SEARCHED: Final = 1000  # test images in which misread ones are looked for
OTHERS: Final = slice(1000, 1500)  # test images that the step was not made for
MOST_STEPS: Final = 9
_MODEL: Final = "classic"
_CELL: Final = 15.0
_ROW: Final = 30.0
_MIDDLE: Final = STAGE.top + 200.0
# Left end, columns and rows of the pictures: the image, the two layers of units.
_BOXES: Final = tuple(
    pygame.FRect(STAGE.left + left, _MIDDLE - rows * cell / 2, columns * cell, rows * cell)
    for left, columns, rows, cell in ((0.0, 28, 28, 6.0), (212.0, 10, 10, _CELL), (404.0, 5, 10, _CELL))
)
_COLUMNS: Final = (28, 10, 5)
_ANSWERS: Final = pygame.FRect(STAGE.left + 524, _MIDDLE - DIGITS * _ROW / 2, STAGE.width - 524, DIGITS * _ROW)


class BackwardsChapter(Chapter):
    """The shipped network of fully connected layers, a copy of it that learns, and one digit that it misreads.

    Attributes:
        problem: why there is nothing to show; empty if there is.
        chosen: number of the test image.
        label: the digit that it is.
        reached: how many layers the error has reached: 0 none, 1 the answers, 4 the image.
        steps: learning steps taken on this digit.
        blames: derivative of the cost by the image, by each unit's answer, and by the ten answers.

    """

    key = "backwards"
    answer = 1
    door = Route("digits")

    def __init__(self, context: Context, manager: PointsManager) -> None:
        super().__init__(context, manager)
        self._cache, self.problem, self._digit = PaintCache(most=6), "", 0
        self._pointed: tuple[int, int] | None = None
        try:
            self._shipped = classifier_in(context.models_dir / "digits" / _MODEL)
            self._pixels, self._labels = mnist_test(context.assets_dir)
        except (ModelFormatError, MnistError) as error:
            self.problem = str(error)
            return
        read = self._shipped.predict(bright(self._pixels[:SEARCHED])).argmax(axis=1)
        self.misread = np.flatnonzero(read != self._labels[:SEARCHED]).tolist()
        self.restart()

    def restart(self) -> None:
        """Show the first digit again, to the network as it was shipped."""
        self._digit, self.tried = 0, False
        if not self.problem:
            self._begin()

    def _begin(self) -> None:
        self.chosen = self.misread[self._digit % len(self.misread)]
        self.classifier = DigitClassifier(self._shipped.network.copy())
        self.label = int(self._labels[self.chosen])
        self._image = bright(self._pixels[self.chosen : self.chosen + 1])
        self._target = np.zeros((1, DIGITS), np.float32)
        self._target[0, self.label] = 1.0
        self.reached = self.steps = self.moved = 0
        self._look()
        self.before, self.read_as, self._right_before = self.odds[self.label], int(self.odds.argmax()), self._right()

    @property
    def network(self) -> NeuralNetwork:
        """The network that learns."""
        return self.classifier.network

    def widgets(self) -> list[Widget]:
        """Return what sends the error back and steps, what shows another digit, and a pointer for the units."""
        if self.problem:
            return []
        label = texts.LEARN_BACKWARDS_BACK if self.reached < 4 else texts.LEARN_BACKWARDS_STEP
        return [
            TextButton(self.manager, self.row(0), label, self.go_on),
            TextButton(self.manager, self.row(1), texts.LEARN_BACKWARDS_OTHER, self.another),
            VirtualPointer(self.manager, STAGE, self.handle_event),
        ]

    def go_on(self) -> None:
        """Send the error back one layer, or take a learning step once it has reached the image."""
        self.changed = True
        if self.reached < 4:
            self.reached += 1
        elif self.steps < MOST_STEPS:
            before = self.network.values.copy()
            self.network.train_batch(self.classifier.shaped(self._image), self._target, SGD(RATE))
            self.moved = int((self.network.values != before).sum())
            self.steps += 1
            self.tried = True
            self._look()

    def another(self) -> None:
        """Show the next digit that the shipped network misreads."""
        self._digit += 1
        self.changed = True
        self._begin()

    def _look(self) -> None:
        """Read the digit, and send the error back through all layers, as a learning step does."""
        network, shaped = self.network, self.classifier.shaped(self._image)
        self.answers = network.forward_propagate(shaped)[0].copy()
        self.odds = self.classifier.probabilities(self.answers[None])[0]
        self.units = [stage[0] for stage in traces(network, shaped)][1:3]
        error = network.cost.derivative(self.answers[None], self._target)
        network.backward_propagate(error)
        layers = [layer for layer in network.layers if isinstance(layer, FullyConnectedLayer)]
        hidden = [layer.error[0].copy() for layer in layers[1:]]  # what each sent back to the units before it
        # A pixel without ink sends nothing on: whatever its weights are, it has no part in the mistake.
        pixels = np.where(shaped.ravel() > 0, network.input_gradient(shaped, error)[0], 0.0)
        self.blames: list[Array] = [pixels, *hidden, error[0]]

    def _right(self) -> int:
        """Return how many of 500 other digits it reads right."""
        read = self.classifier.predict(bright(self._pixels[OTHERS])).argmax(axis=1)
        return int((read == self._labels[OTHERS]).sum())

    # Pointing

    def handle_event(self, event: pygame.event.Event) -> bool:
        """Follow the pointer over the units; nothing is used up."""
        if not self.problem and event.type == pygame.MOUSEMOTION:
            self._pointed = next((found for stage in (1, 2, 3) if (found := _unit_at(stage, event.pos))), None)
        return False

    def _told(self) -> str:
        """Return what the pointed unit answered, and its share of the blame."""
        if self._pointed is None:
            return texts.LEARN_BACKWARDS_POINT
        stage, unit = self._pointed
        values = {"answer": float(self.units[stage - 1][unit] if stage < 3 else self.answers[unit])}
        name = texts.LEARN_BACKWARDS_UNITS[stage - 1].format(unit=unit + (stage < 3), **values)
        if self.reached < 4 - stage:
            return name
        blame = float(self.blames[stage][unit])
        kind = "less" if blame > 0 else "more" if blame < 0 else "none"
        return f"{name} {texts.LEARN_BACKWARDS_BLAME[kind].format(blame=blame)}"

    # What it tells

    def why(self, guess: int | None) -> str:  # noqa: ARG002
        """Return what the steps have changed: this digit's reading, the weights, and the reading of others."""
        return texts.LEARN_BACKWARDS_WHY.format(
            label=self.label, read=self.read_as, before=100 * self.before, after=100 * self.odds[self.label],
            steps=self.steps, moved=self.moved, share=100 * self.moved / self.network.values.size,
            count=self.network.values.size, right=self._right_before, now=self._right(),
        ) if self.steps else texts.LEARN_BACKWARDS_AGAIN  # fmt: skip

    def code(self) -> Sequence[Code]:
        """Return the way back through the layers."""
        if self.problem:
            return [Code(NeuralNetwork.backward_propagate)]
        shapes = " ← ".join(str(blame.size) for blame in self.blames[1:])
        weights = " x ".join(map(str, (self.blames[2].size, DIGITS)))
        return [
            Code(NeuralNetwork.backward_propagate, FullyConnectedLayer.backward_propagate,
                 {FullyConnectedLayer.backward_propagate: shapes}),
            Code(FullyConnectedLayer.input_error, np.dot, {np.dot: weights}),
            Code(FullyConnectedLayer.fill_gradients, np.dot),
        ]  # fmt: skip

    def draw(self, canvas: Canvas, alpha: float) -> None:  # noqa: ARG002
        """Draw the digit, the units of both layers and the answers, with the blame as far as it has come."""
        if self.problem:
            draw_wrapped(canvas, self.problem, (STAGE.left, STAGE.top + 24), STAGE.width, colour=MUTE, leading=20)
            return
        for stage, (box, columns) in enumerate(zip(_BOXES, _COLUMNS, strict=True)):
            blamed = self.reached >= 4 - stage
            shows = (stage, blamed, self.steps, self.chosen)
            self._cache.draw(canvas, box, shows, partial(self._paint, stage, blamed, columns))
            canvas.text(
                texts.LEARN_BACKWARDS_STAGES[stage], (box.left, box.top - 10), size=LABEL, colour=MUTE, room=180
            )
        if self._pointed and self._pointed[0] < 3:
            stage, unit = self._pointed
            box, (row, column) = _BOXES[stage], divmod(unit, _COLUMNS[stage])
            canvas.outline((box.left + column * _CELL, box.top + row * _CELL, _CELL, _CELL), 2, HUMAN, 1.5)
        self._draw_answers(canvas)
        write_figures(canvas, self._told(), (STAGE.left, STAGE.bottom - 30), size=SMALL + 1, colour=INK)
        words = texts.LEARN_BACKWARDS_COLOURS
        canvas.text(words, (STAGE.left, STAGE.bottom - 6), size=LABEL, colour=MUTE, room=STAGE.width)

    def _paint(self, stage: int, blamed: bool, columns: int, sheet: Canvas) -> None:
        values = self.blames[stage] if blamed else self._image[0] if stage == 0 else np.abs(self.units[stage - 1])
        shown = -values / max(float(np.abs(values).max()), 1e-9) if blamed else values
        shades = SIGNED if blamed else GREY
        sheet.surface.blit(picture(shown.reshape(-1, columns), sheet.size, shades), (0, 0))

    def _draw_answers(self, canvas: Canvas) -> None:
        largest = float(np.abs(self.blames[-1]).max())
        for digit in range(DIGITS):
            y, odds = _ANSWERS.top + (digit + 0.5) * _ROW, float(self.odds[digit])
            colour = canvas.palette.good if digit == self.label else INK
            canvas.text(str(digit), (_ANSWERS.left, y + 5), colour=colour, weight="medium")
            canvas.bar((_ANSWERS.left + 22, y - 2, 110, 4), odds, NET)
            canvas.text(
                f"{odds:.0%}", (_ANSWERS.left + 176, y + 5), size=SMALL, colour=colour, align="right", tabular=True
            )
            if self.reached:
                blame = float(self.blames[-1][digit])
                up = blame < 0
                canvas.marker("triangle" if up else "triangle_down", (_ANSWERS.left + 206, y),
                              4 + 12 * abs(blame) / max(largest, 1e-9), NET if up else canvas.palette.warn)  # fmt: skip


def _unit_at(stage: int, place: tuple[float, float]) -> tuple[int, int] | None:
    """Return the stage and the number of the unit at a place, or None."""
    if stage == 3:
        row = int((place[1] - _ANSWERS.top) // _ROW)
        return (3, row) if _ANSWERS.collidepoint(place) else None
    box, columns = _BOXES[stage], _COLUMNS[stage]
    if not box.collidepoint(place):
        return None
    return stage, int((place[1] - box.top) // _CELL) * columns + int((place[0] - box.left) // _CELL)
