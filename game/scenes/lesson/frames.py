"""The five frames of a lesson, each with the lines of code that ran for it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ai.agent.network import build_network
from ai.explain.agent_lesson import Lesson
from ai.lander.environment import ACTION_NAMES
from game.core import texts
from game.scenes.lesson.alone import AloneFrame
from game.scenes.lesson.flight import happened_frame
from game.scenes.lesson.frame import Frame, LitCode, in_points_of_reward
from game.scenes.lesson.network import NetworkFrame
from game.scenes.lesson.step import LearningStep
from game.scenes.lesson.update import AfterFrame, target_frame


@dataclass(frozen=True)
class Part:
    """One frame of a lesson, and the code that belongs to it."""

    frame: Frame
    code: LitCode


def parts_of(lesson: Lesson) -> list[Part]:
    """Take a lesson apart."""
    ran = (*(lesson.flown.lines if lesson.flown else ()), *lesson.step.lines)
    lines = [in_points_of_reward(line, lesson.config.reward_scale) for line in ran]
    return [Part(frame, LitCode(lines, frame)) for frame in frames_of(lesson)]


def learning_step(lesson: Lesson) -> LearningStep:
    """Return the optimizer's step of a lesson, with the names of what it moves."""
    config, taken = lesson.config, lesson.step
    network = build_network(len(lesson.state), len(lesson.predicted), config, np.random.default_rng(0))
    network.values = taken.values_before
    actions = tuple(map(texts.said, ACTION_NAMES))
    return LearningStep(network, taken, lesson.state, texts.INPUTS, actions, config.reward_scale, config.optimizer,
                        len(lesson.batch_errors))  # fmt: skip


def frames_of(lesson: Lesson) -> list[Frame]:
    """Return the frames: the memory alone, then what the run's own step made of it."""
    step = learning_step(lesson)
    return [
        AloneFrame(lesson, step),
        happened_frame(lesson),
        target_frame(lesson),
        NetworkFrame(lesson, step),
        AfterFrame(lesson, step),
    ]
