"""The frames of a lesson with their code: of the agent that learns to land, and of a network that reads digits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.network import build_network, make_optimizer
from ai.digits.classifier import DigitClassifier
from ai.digits.config import build_digit_network
from ai.digits.training import DigitTraining
from ai.explain.agent_lesson import Lesson
from ai.explain.digit_lesson import DigitLesson
from ai.explain.learning_step import backward_functions, forward_functions
from ai.lander.environment import ACTION_NAMES
from ai.nn import OPTIMIZERS, Optimizer
from ai.nn.costs import softmax
from game.core import texts
from game.explain.figures import number, points, signed
from game.scenes.lesson.alone import AloneFrame
from game.scenes.lesson.digit import BACK, OUTPUT, PROBABILITY, SIDE, TARGET, DigitFrame, ImageFrame, pixel_name
from game.scenes.lesson.flight import HappenedFrame, MomentFrame, said_action
from game.scenes.lesson.frame import CodeWalk, Frame, in_points, in_points_of_reward
from game.scenes.lesson.network import GradientFrame, NetworkFrame
from game.scenes.lesson.step import LearningStep
from game.scenes.lesson.update import AfterFrame, ErrorFrame, TargetFrame


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
        MomentFrame(lesson),
        NetworkFrame(words["values"], in_points(predicted / scale), sentence, forward_functions(network), step),
        HappenedFrame(lesson),
        TargetFrame(lesson),
        ErrorFrame(lesson),
        GradientFrame(words["gradient"], backward_functions(network, make_optimizer(lesson.config)), step),
        AfterFrame(words["after"], (Optimizer.step, DeepQAgent._update_target), step,
                   (predicted, after, lesson.target), lesson.derivative, texts.LESSON_NEARER),
    ]  # fmt: skip


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
        ImageFrame(lesson),
        NetworkFrame(words["values"], value, sentence, forward_functions(network), step),
        DigitFrame(words["answer"], str(lesson.probabilities_before.argmax()), (DigitClassifier.probabilities, softmax),
                   digit, (output, (PROBABILITY, lesson.probabilities_before))),
        DigitFrame(words["target"], str(digit), (DigitTraining.advance,), digit, (output, target)),
        DigitFrame(words["error"], signed(float(lesson.derivative[digit])), cost, digit,
                   (output, target, (BACK, lesson.derivative))),
        GradientFrame(words["gradient"], backward_functions(network, optimizer), step),
        AfterFrame(words["after"], (Optimizer.step,), step, (before, after, 1.0), None, texts.LESSON_DIGIT_NEARER),
    ]  # fmt: skip
