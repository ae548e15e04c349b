"""The seven frames of a lesson of a network that learns to read digits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pygame

from ai.digits.classifier import DigitClassifier
from ai.digits.config import build_digit_network
from ai.digits.training import DigitTraining
from ai.environment import Floats
from ai.explain.digit_lesson import DigitLesson
from ai.explain.learning_step import backward_functions, forward_functions
from ai.explain.recorder import Function
from ai.nn import OPTIMIZERS, Optimizer
from ai.nn.costs import softmax
from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.paint import mix
from game.drawing.tokens import FAINT, INK, LABEL, LINE, MUTE, NET, TITLE
from game.lesson.after_frame import AfterFrame
from game.lesson.frame import PICTURE, SMALL_PICTURE, Explanation, Frame, Spot, rows_of
from game.lesson.gradient_frame import GradientFrame
from game.lesson.network_frame import NetworkFrame
from game.lesson.part import Part
from game.lesson.step import LearningStep
from game.panels.figures import number, signed

_SIDE: Final = 28
_PIXEL: Final = 14.0  # points
_ROW: Final = 36.0
_NUMBERS: Final = 80.0  # left end of the columns of numbers
_NETWORK: Final = (0.0, 8.0, 752.0, 426.0)
_ANSWER: Final[tuple[Function, ...]] = (DigitClassifier.probabilities, softmax)
_OUTPUT, _PROBABILITY, _TARGET, _BACK = 1, 2, 3, 4  # columns, by their texts


class ImageFrame(Frame):
    """Frame of the image: its pixels, each with its number."""

    def __init__(self, lesson: DigitLesson, digit: int, words: Sequence[str], functions: Sequence[Function]) -> None:
        super().__init__(words[0], texts.LESSON_LABEL.format(digit=digit), words[1], functions)
        self.begin = "images"
        self._image = lesson.image
        right = _SIDE * _PIXEL + 32
        self.label(texts.LESSON_LABEL.format(digit=digit), right, 24, size=TITLE)
        self.prose(texts.LESSON_IMAGE_NOTE, right, 56, PICTURE.width - right)

    def spot_at(self, place: Point) -> Spot | None:
        """Return the pixel at a place."""
        column, row = int(place[0] // _PIXEL), int(place[1] // _PIXEL)
        if not (0 <= row < _SIDE and 0 <= column < _SIDE):
            return None
        box = pygame.FRect(column * _PIXEL, row * _PIXEL, _PIXEL, _PIXEL)
        rows = rows_of((texts.LESSON_INK, f"{float(self._image[row, column]):.3f}"))
        return Spot(box, Explanation((pixel_name(row * _SIDE + column),), rows))

    def paint(self, canvas: Canvas) -> None:
        """Paint the pixels."""
        self._paint_image(canvas, canvas.rect(0, 0, _SIDE * _PIXEL, _SIDE * _PIXEL))

    def paint_small(self, canvas: Canvas) -> None:
        """Paint the image small."""
        wide, high = SMALL_PICTURE
        self._paint_image(canvas, canvas.rect(wide - high, 0, high, high))

    def _paint_image(self, canvas: Canvas, area: pygame.Rect) -> None:
        levels = np.clip(255 * self._image, 0, 255).astype(np.uint8)
        picture = pygame.surfarray.make_surface(np.repeat(levels.T[:, :, None], 3, axis=2))
        canvas.surface.blit(pygame.transform.scale(picture, area.size), area)


class DigitFrame(Frame):
    """Frame with a row for each digit: some columns of numbers and bars."""

    def __init__(
        self,
        words: Sequence[str],
        figure: str,
        functions: Sequence[Function],
        digit: int,
        columns: Sequence[tuple[int, Floats]],
    ) -> None:
        super().__init__(words[0], figure, words[1], functions)
        self.begin = "targets"
        self._bars: list[tuple[pygame.FRect, bool]] = []
        self.heading(texts.LESSON_DIGIT_COLUMNS[0], 0, 14, 70)
        for each in range(10):
            self.label(str(each), 0, 48 + _ROW * each, colour=INK if each == digit else MUTE)
        room = (PICTURE.width - _NUMBERS) / len(columns)
        for place, (kind, values) in enumerate(columns):
            x, wide = _NUMBERS + place * room, room - 106
            title, help_ = texts.LESSON_DIGIT_COLUMNS[kind], texts.LESSON_DIGIT_HELP[kind]
            self.label(title, x, 14, size=LABEL, colour=MUTE, explanation=Explanation((help_,)), room=room - 12)
            most = max(float(np.abs(values).max()), 1e-9)
            for each, value in enumerate(values.tolist()):
                y = 48 + _ROW * each
                text = signed(value) if kind == _BACK else number(value)
                told = Explanation((help_,), rows_of((str(each), text)))
                tone = INK if each == digit else MUTE
                self.label(text, x + 74, y, align="right", colour=tone, explanation=told, room=74)
                self._bars.append((pygame.FRect(x + 82, y - 6, wide * abs(value) / most, 3), each == digit))

    def paint(self, canvas: Canvas) -> None:
        """Paint the bars and the lines between the digits."""
        for each in range(11):
            canvas.line((0, 24 + _ROW * each), (PICTURE.width, 24 + _ROW * each), LINE)
        for box, chosen in self._bars:
            canvas.fill(canvas.rect(*box), NET if chosen else mix(FAINT, NET, 0.4))

    def paint_small(self, canvas: Canvas) -> None:
        """Paint the bars of the last column upright, one for each digit."""
        wide, high = SMALL_PICTURE
        last = self._bars[-10:]
        most = max(1e-9, *(box.width for box, _ in last))
        for place, (box, chosen) in enumerate(last):
            tall = max(high * box.width / most, 1)
            bar = canvas.rect(wide * place / 10, high - tall, wide / 10 - 1, tall)
            canvas.fill(bar, NET if chosen else mix(FAINT, NET, 0.4))


def pixel_name(unit: int) -> str:
    """Return the name of an input by its number."""
    return texts.LESSON_PIXEL.format(row=unit // _SIDE + 1, column=unit % _SIDE + 1)


def digit_step(lesson: DigitLesson) -> LearningStep:
    """Return the optimizer's step of a lesson, with the names of what it moves."""
    network = build_digit_network(lesson.config, np.random.default_rng(0))
    network.values = lesson.step.values_before
    convolutions = lesson.config.convolutions
    observation = lesson.image.reshape(_SIDE, _SIDE, 1) if convolutions else lesson.image.ravel()

    units = next(layer.inputs for layer in network.layers if isinstance(layer.inputs, int))
    features = (texts.LESSON_FEATURE.format(number=unit + 1) for unit in range(units))
    inputs = features if convolutions else map(pixel_name, range(units))
    outputs = (texts.LESSON_DIGIT.format(digit=digit) for digit in range(10))
    return LearningStep(network, lesson.step, observation, tuple(inputs), tuple(outputs), 1.0, lesson.config.optimizer,
                        len(lesson.labels))  # fmt: skip


def digit_frames(lesson: DigitLesson) -> list[Part]:
    """Return the seven frames of a lesson of a digit network."""
    step, words = digit_step(lesson), texts.LESSON_DIGIT_FRAMES
    network, optimizer = step.network, OPTIMIZERS[lesson.config.optimizer](lesson.step.learning_rate)
    forward, backward = forward_functions(network), backward_functions(network, optimizer)
    cost = network.cost.function, network.cost.derivative
    digit = int(lesson.labels[lesson.step.row])
    value = float(lesson.outputs[digit])
    before, after = float(lesson.probabilities_before[digit]), float(lesson.probabilities_after[digit])
    output, probability = (_OUTPUT, lesson.outputs), (_PROBABILITY, lesson.probabilities_before)
    target, back = (_TARGET, lesson.target), (_BACK, lesson.derivative)
    sentence = words["values"][1].format(digit=digit, value=number(value))
    if lesson.config.dropout:
        sentence = f"{sentence} {texts.LESSON_DROPOUT_NOTE}"
    length = texts.LESSON_LENGTH.format(length=number(lesson.step.gradient_length))
    downhill = f"{words['gradient'][1]} {texts.LESSON_DOWNHILL[step.carries_on]}"
    gradient = GradientFrame(words["gradient"][0], length, downhill, backward, step)
    names = [gradient.weight_name(place) for place in step.strongest(lesson.step.taken, 8)]
    answer = int(lesson.probabilities_before.argmax())
    frames: list[Frame] = [
        ImageFrame(lesson, digit, words["image"], (DigitTraining.advance,)),
        NetworkFrame(words["values"][0], number(value), sentence, forward, step, _NETWORK, "activations",
                     lesson.step.gradient),
        DigitFrame(words["answer"], str(answer), _ANSWER, digit, (output, probability)),
        DigitFrame(words["target"], str(digit), (DigitTraining.advance,), digit, (output, target)),
        DigitFrame(words["error"], signed(float(lesson.derivative[digit])), cost, digit, (output, target, back)),
        gradient,
        AfterFrame(words["after"], (Optimizer.step,), step, names, (before, after, 1.0), None,
                   texts.LESSON_DIGIT_NEARER),
    ]  # fmt: skip
    lines = (*lesson.step.lines, *lesson.lines)
    return [Part.of(frame, lines) for frame in frames]
