"""The frames of a lesson of the agent that learns to land: its memory alone, then the seven of the run's own step."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.n_step import NStep
from ai.agent.network import build_network, make_optimizer
from ai.agent.normalizer import Normalizer
from ai.explain.agent_lesson import Lesson
from ai.explain.learning_step import backward_functions, forward_functions
from ai.lander.environment import ACTION_NAMES
from ai.nn import NeuralNetwork, Optimizer
from game.core import texts
from game.lesson.after_frame import AfterFrame
from game.lesson.alone_frame import AloneFrame
from game.lesson.code import in_points_of_reward
from game.lesson.error_frame import ErrorFrame
from game.lesson.frame import Frame
from game.lesson.gradient_frame import GradientFrame
from game.lesson.moment_frame import HappenedFrame, MomentFrame, said_action
from game.lesson.network_frame import NetworkFrame
from game.lesson.part import Part
from game.lesson.step import LearningStep
from game.lesson.target_frame import TargetFrame
from game.panels.figures import number, points

_NETWORK: Final = (0.0, 8.0, 752.0, 426.0)


def learning_step(lesson: Lesson) -> LearningStep:
    """Return the optimizer's step of a lesson, with the names of what it moves."""
    config, taken = lesson.config, lesson.step
    network = build_network(len(lesson.state), len(lesson.predicted), config, np.random.default_rng(0))
    network.values = taken.values_before
    actions = tuple(map(texts.said, ACTION_NAMES))
    return LearningStep(network, taken, lesson.state, texts.INPUTS, actions, config.reward_scale, config.optimizer,
                        len(lesson.batch_errors))  # fmt: skip


def agent_frames(lesson: Lesson) -> list[Part]:
    """Return the frames of a lesson of the agent."""
    step, scale = learning_step(lesson), lesson.config.reward_scale
    action, words, network = int(lesson.cell.action), texts.LESSON_FRAMES, step.network
    forward, backward = forward_functions(network), backward_functions(network, make_optimizer(lesson.config))
    predicted, after = float(lesson.predicted[action]), float(lesson.predicted_after[action])
    derivative = lesson.derivative
    name, sentence = words["values"]
    sentence = sentence.format(action=said_action(action), value=points(predicted / scale))
    if (best := int(lesson.predicted.argmax())) != action:
        higher = points(float(lesson.predicted[best]) / scale)
        sentence = f"{sentence} {texts.LESSON_NOT_THE_BEST.format(action=said_action(best), value=higher)}"
    figure = texts.LESSON_POINTS.format(points=points(predicted / scale))
    values = NetworkFrame(name, figure, sentence, forward, step, _NETWORK, "activations", step.taken.gradient)
    name, sentence = words["gradient"]
    length = texts.LESSON_LENGTH.format(length=number(step.taken.gradient_length))
    gradient = GradientFrame(name, length, f"{sentence} {texts.LESSON_DOWNHILL[step.carries_on]}", backward, step)
    places = step.strongest(step.taken.taken, 8)
    frames: list[Frame] = [
        AloneFrame(lesson, words["alone"], (NeuralNetwork.correct,), step),
        MomentFrame(lesson, words["moment"], (DeepQAgent.learn, DeepQAgent._learn_from, Normalizer.__call__)),
        values,
        HappenedFrame(lesson, words["happened"], (NStep.add,)),
        TargetFrame(lesson, words["target"], (DeepQAgent.targets, DeepQAgent._next_value, NeuralNetwork.predict)),
        ErrorFrame(lesson, words["error"], (DeepQAgent.gradient_step, network.cost.function, network.cost.derivative)),
        gradient,
        AfterFrame(words["after"], (Optimizer.step, DeepQAgent._update_target), step,
                    [gradient.weight_name(place) for place in places],
                    (predicted, after, lesson.target), derivative, texts.LESSON_NEARER),
    ]  # fmt: skip
    lines = (*(lesson.flown.lines if lesson.flown else ()), *lesson.step.lines)
    lines = tuple(in_points_of_reward(line, scale) for line in lines)
    return [Part.of(frame, lines) for frame in frames]
