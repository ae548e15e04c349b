"""The five cards of a lesson, in the order of time, each with the lines of code that ran for it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ai.agent.network import build_network
from ai.explain.agent_lesson import LearnedAlone, Lesson
from ai.explain.learning_step import Step
from ai.explain.recorder import Line
from ai.lander.environment import ACTION_NAMES
from game.core import texts
from game.scenes.lesson.again import AgainCard
from game.scenes.lesson.card import Card, LitCode, in_points_of_reward
from game.scenes.lesson.moment import came_card, moment_card, values_card
from game.scenes.lesson.step import LearningStep
from game.scenes.lesson.target import TargetCard


class Part(NamedTuple):
    """One card of a lesson, and the code that belongs to it."""

    card: Card
    code: LitCode


def parts_of(lesson: Lesson) -> list[Part]:
    """Take a lesson apart: the steps are of this memory alone, but for those of the run, which come last."""
    own = learning_step(lesson, lesson.step)
    alone = LearnedAlone(own.network, lesson.state, int(lesson.cell.action), lesson.target)
    taken = alone.recorded()
    ran = (*(lesson.flown.lines if lesson.flown else ()), *lesson.step.lines)
    cards: Sequence[tuple[Card, Sequence[Line]]] = [
        (moment_card(lesson), ran),
        (values_card(lesson), ran),
        (came_card(lesson), ran),
        (TargetCard(lesson, learning_step(lesson, taken)), ran),
        (AgainCard(lesson, own, alone), taken.lines),
    ]
    scale = lesson.config.reward_scale
    return [Part(card, LitCode([in_points_of_reward(line, scale) for line in lines], card)) for card, lines in cards]


def learning_step(lesson: Lesson, taken: Step) -> LearningStep:
    """Return a step of a lesson, with the names of what it moves."""
    config = lesson.config
    network = build_network(len(lesson.state), len(lesson.predicted), config, np.random.default_rng(0))
    network.values = taken.values_before
    actions = tuple(map(texts.said, ACTION_NAMES))
    return LearningStep(
        network, taken, lesson.state, texts.INPUTS, actions, config.reward_scale, len(lesson.batch_errors)
    )
