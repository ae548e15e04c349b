"""The five cards of a lesson, in the order of time, each with the lines of code that ran for it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ai.agent.network import build_network
from ai.explain.agent_lesson import LearnedAlone, Lesson
from ai.explain.recorder import Line
from game.scenes.lesson.again import AgainCard
from game.scenes.lesson.card import Card, LitCode
from game.scenes.lesson.moment import came_card, moment_card, values_card
from game.scenes.lesson.target import TargetCard


class Part(NamedTuple):
    """One card of a lesson, and the code that belongs to it."""

    card: Card
    code: LitCode


def parts_of(lesson: Lesson) -> list[Part]:
    """Take a lesson apart: the steps are of this memory alone, from the network as it was."""
    network = build_network(len(lesson.state), len(lesson.predicted), lesson.config, np.random.default_rng(0))
    network.values = lesson.step.values_before
    alone = LearnedAlone(network, lesson.state, int(lesson.cell.action), lesson.target)
    taken = alone.recorded()
    ran = (*(lesson.flown.lines if lesson.flown else ()), *lesson.step.lines)
    cards: Sequence[tuple[Card, Sequence[Line]]] = [
        (moment_card(lesson), ran),
        (values_card(lesson), ran),
        (came_card(lesson), ran),
        (TargetCard(lesson, network, taken), ran),
        (AgainCard(lesson, network, alone), taken.lines),
    ]
    return [Part(card, LitCode(lines, card)) for card, lines in cards]
