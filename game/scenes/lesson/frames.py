"""The frames of a lesson with their code: of the agent that learns to land, and of a network that reads digits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.network import build_network, make_optimizer
from ai.digits.classifier import DigitClassifier
from ai.digits.config import build_digit_network
from ai.digits.training import DigitTraining
from ai.environment import Floats
from ai.explain.agent_lesson import Lesson
from ai.explain.digit_lesson import DigitLesson
from ai.explain.learning_step import backward_functions, forward_functions
from ai.explain.recorder import Function
from ai.lander.environment import ACTION_NAMES
from ai.nn import OPTIMIZERS, Optimizer
from ai.nn.costs import softmax
from game.core import texts
from game.digits.pictures import GREY, picture
from game.drawing.cursor import Cursor
from game.drawing.tokens import TITLE
from game.explain.figures import number, points, signed
from game.explain.tables import Line, figure_rows, from_left, table
from game.scenes.lesson.alone import AloneFrame
from game.scenes.lesson.flight import happened_frame, moment_frame, said_action
from game.scenes.lesson.frame import CodeWalk, Frame, in_points, in_points_of_reward
from game.scenes.lesson.network import GradientFrame, NetworkFrame
from game.scenes.lesson.step import LearningStep
from game.scenes.lesson.update import AfterFrame, ErrorFrame, target_frame
from game.ui.panel import Column


@dataclass(frozen=True)
class Part:
    """One frame of a lesson, and the walk through the code that belongs to it."""

    frame: Frame
    code: CodeWalk


def parts_of(lesson: Lesson | DigitLesson) -> list[Part]:
    """Take a lesson apart."""
    if isinstance(lesson, DigitLesson):
        frames, lines = digit_frames(lesson), (*lesson.step.lines, *lesson.lines)
    else:
        ran = (*(lesson.flown.lines if lesson.flown else ()), *lesson.step.lines)
        frames, lines = (
            agent_frames(lesson),
            tuple(in_points_of_reward(line, lesson.config.reward_scale) for line in ran),
        )
    return [Part(frame, CodeWalk(lines, frame)) for frame in frames]


def learning_step(lesson: Lesson) -> LearningStep:
    """Return the optimizer's step of a lesson of the agent, with the names of what it moves."""
    config, taken = lesson.config, lesson.step
    network = build_network(len(lesson.state), len(lesson.predicted), config, np.random.default_rng(0))
    network.values = taken.values_before
    actions = tuple(map(texts.said, ACTION_NAMES))
    return LearningStep(network, taken, lesson.state, texts.INPUTS, actions, config.reward_scale, config.optimizer,
                        len(lesson.batch_errors))  # fmt: skip


def agent_frames(lesson: Lesson) -> list[Frame]:
    """Return the frames of a lesson of the agent: its memory alone, then the seven of the run's own step."""
    step, scale, words = learning_step(lesson), lesson.config.reward_scale, texts.LESSON_FRAMES
    action, network = int(lesson.cell.action), step.network
    predicted, after = float(lesson.predicted[action]), float(lesson.predicted_after[action])
    sentence = words["values"][1].format(action=said_action(action), value=points(predicted / scale))
    if (best := int(lesson.predicted.argmax())) != action:
        higher = points(float(lesson.predicted[best]) / scale)
        sentence = f"{sentence} {texts.LESSON_NOT_THE_BEST.format(action=said_action(best), value=higher)}"
    return [
        AloneFrame(lesson, step),
        moment_frame(lesson),
        NetworkFrame(words["values"], in_points(predicted / scale), sentence, forward_functions(network), step),
        happened_frame(lesson),
        target_frame(lesson),
        ErrorFrame(lesson),
        GradientFrame(words["gradient"], backward_functions(network, make_optimizer(lesson.config)), step),
        AfterFrame(words["after"], (Optimizer.step, DeepQAgent._update_target), step,
                   (predicted, after, lesson.target), lesson.derivative, texts.LESSON_NEARER),
    ]  # fmt: skip


# A network that reads digits

SIDE: Final = 28  # pixels of an image
OUTPUT, PROBABILITY, TARGET, BACK = 1, 2, 3, 4  # columns, by their texts
_HIGHEST, _LEAST = 400.0, 260.0  # height of the image, width of a column


def pixel_name(unit: int) -> str:
    """Return the name of an input by its number."""
    return texts.LESSON_PIXEL.format(row=unit // SIDE + 1, column=unit % SIDE + 1)


def image_frame(lesson: DigitLesson) -> Frame:
    """Return the frame of the image."""
    said = texts.LESSON_LABEL.format(digit=lesson.labels[lesson.step.row])

    def write(cursor: Cursor) -> None:
        box = cursor.take(min(cursor.width, _HIGHEST))
        if canvas := cursor.canvas:
            area = canvas.rect(box.left, box.top, box.height, box.height)
            canvas.surface.blit(picture(lesson.image, area.size, GREY), area)

    def describe(column: Column) -> None:
        left, right = column.beside((1, 1), _LEAST)
        left.add(write)
        right.text(said, size=TITLE)
        right.aside(texts.LESSON_IMAGE_NOTE)

    return Frame(texts.LESSON_DIGIT_FRAMES["image"], said, (DigitTraining.advance,), "images", describe)


def digit_frame(
    words: Sequence[str],
    figure: str,
    functions: Sequence[Function],
    digit: int,
    columns: Sequence[tuple[int, Floats]],
) -> Frame:
    """Return a frame with a line for each digit, and columns of figures: some of `OUTPUT` to `BACK`, (10,) each."""
    heads, helps = texts.LESSON_DIGIT_COLUMNS, texts.LESSON_DIGIT_HELP
    shares = [np.abs(values) / max(float(np.abs(values).max()), 1e-9) for _, values in columns]
    lines = []
    for each in range(10):
        figures = [(signed if kind == BACK else number)(float(values[each])) for kind, values in columns]
        rows = figure_rows(*((helps[kind], written) for (kind, _), written in zip(columns, figures, strict=True)))
        bars = [from_left(float(share[each])) for share in shares]
        lines.append(Line((str(each), *figures), helps[columns[-1][0]], rows, each == digit, bars))
    head = [heads[0], *(heads[kind] for kind, _ in columns)]

    def describe(column: Column) -> None:
        left, _ = column.beside((3, 2), _LEAST)
        left.add(table(head, lambda: lines))

    return Frame(words, figure, functions, "targets", describe)


def digit_step(lesson: DigitLesson) -> LearningStep:
    """Return the optimizer's step of a lesson of a digit network, with the names of what it moves."""
    network, convolutions = build_digit_network(lesson.config, np.random.default_rng(0)), lesson.config.convolutions
    network.values = lesson.step.values_before
    observation = lesson.image.reshape(SIDE, SIDE, 1) if convolutions else lesson.image.ravel()
    units = next(layer.inputs for layer in network.layers if isinstance(layer.inputs, int))
    features = (texts.LESSON_FEATURE.format(number=unit + 1) for unit in range(units))
    inputs = features if convolutions else map(pixel_name, range(units))
    outputs = (texts.LESSON_DIGIT.format(digit=digit) for digit in range(10))
    return LearningStep(network, lesson.step, observation, tuple(inputs), tuple(outputs), 1.0, lesson.config.optimizer,
                        len(lesson.labels))  # fmt: skip


def digit_frames(lesson: DigitLesson) -> list[Frame]:
    """Return the seven frames of a lesson of a digit network."""
    step, words, digit = digit_step(lesson), texts.LESSON_DIGIT_FRAMES, int(lesson.labels[lesson.step.row])
    network, optimizer = step.network, OPTIMIZERS[lesson.config.optimizer](lesson.step.learning_rate)
    value = number(float(lesson.outputs[digit]))
    before, after = float(lesson.probabilities_before[digit]), float(lesson.probabilities_after[digit])
    output, target, cost = (
        (OUTPUT, lesson.outputs),
        (TARGET, lesson.target),
        (network.cost.function, network.cost.derivative),
    )
    sentence = words["values"][1].format(digit=digit, value=value)
    if lesson.config.dropout:
        sentence = f"{sentence} {texts.LESSON_DROPOUT_NOTE}"
    return [
        image_frame(lesson),
        NetworkFrame(words["values"], value, sentence, forward_functions(network), step),
        digit_frame(words["answer"], str(lesson.probabilities_before.argmax()),
                    (DigitClassifier.probabilities, softmax), digit,
                    (output, (PROBABILITY, lesson.probabilities_before))),
        digit_frame(words["target"], str(digit), (DigitTraining.advance,), digit, (output, target)),
        digit_frame(words["error"], signed(float(lesson.derivative[digit])), cost, digit,
                    (output, target, (BACK, lesson.derivative))),
        GradientFrame(texts.LESSON_FRAMES["gradient"], backward_functions(network, optimizer), step),
        AfterFrame(words["after"], (Optimizer.step,), step, (before, after, 1.0), None, texts.LESSON_DIGIT_NEARER),
    ]  # fmt: skip
