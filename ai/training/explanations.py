"""Lessons of a live run: the learning step that follows from a moment of a flight.

A run keeps the last decisions of all landers. A lesson is made from these only when one is asked for, by a copy of the
agent.
"""

from __future__ import annotations

from collections import deque
from typing import Any, NamedTuple

import numpy as np

from ai.agent.config import AgentConfig
from ai.agent.n_step import NStep
from ai.agent.replay import Transition
from ai.environment import Floats, Ints, StepResult
from ai.explain.agent_lesson import Before, Flown, Lesson, explain
from ai.explain.learning_step import shown_lines
from ai.explain.recorder import Recorder
from ai.training.loop import Training


class _Decided(NamedTuple):
    """One decision of all landers: decisions of the run and observations (n, features) before it, and actions (n,)."""

    decisions: int
    observation: Floats
    actions: Ints
    result: StepResult


class Explanations:
    """Explanations of a run's learning steps; `follow` is to be called after each decision."""

    def __init__(self, training: Training) -> None:
        self._training = training
        self._decided: deque[_Decided] = deque(maxlen=training.config.n_step)  # the oldest first

    def follow(self, actions: Ints, result: StepResult) -> None:
        """Keep one decision of all landers: what comes of it, before those that have ended begin anew."""
        decisions = self._training.agent.decisions - len(actions)
        self._decided.append(_Decided(decisions, self._training.observation, actions, result))

    def aloft(self) -> int:
        """Return the first lander that stood on no foot in all decisions kept; the first of all without one."""
        stood = [each.observation[:, -2:].any(axis=1) for each in self._decided]
        return int(np.argmin(np.any(stood, axis=0))) if stood else 0

    def explain(self, slot: int) -> Lesson:
        """Return the lesson of a lander's latest memory that is complete.

        Raises ValueError where there is nothing to learn from yet, for a lander that does not fly, and for a network
        that is too large; DivergenceError as the learning step does.
        """
        agent, seed = self._training.agent, self._training.seed
        if not 0 <= slot < self._training.env.num_envs:
            raise ValueError(f"there is no lander {slot}: {self._training.env.num_envs} fly")
        if not agent.ready or not self._decided:
            raise ValueError("the network has not begun to learn: its replay buffer holds too few transitions")
        # The run's own generator stays as it is, and the same moment gives the same lesson.
        before = Before.of(agent, np.random.default_rng((seed, agent.decisions)))
        return explain(before, *_memory(agent.config, list(self._decided), slot))


def _memory(config: AgentConfig, decided: list[_Decided], slot: int) -> tuple[Transition, Flown]:
    """Return a lander's latest memory that is complete, or of a flight's end the one that sums up most."""
    ends = [place for place, each in enumerate(decided) if each.result.ended[slot]]
    last = ends[-1] if ends else len(decided) - 1
    first = 1 + max((place for place in ends if place < last), default=-1)
    decided = decided[first : last + 1]
    mine, n_step = slice(slot, slot + 1), NStep(len(decided), config.discount)
    for each in decided:
        result = each.result
        reward = result.reward * np.float32(config.reward_scale)
        came: Any = each.observation, each.actions, reward, result.observation, result.terminated, result.ended
        # Only what the last decision sums up is shown.
        with Recorder([NStep.add] if each is decided[-1] else ()) as recorder:
            cells, _ = n_step.add(*(part[mine] for part in came))
    results = [each.result for each in decided]
    flown = Flown(
        slot,
        decided[0].decisions,
        np.array([each.observation[slot] for each in decided] + [results[-1].observation[slot]]),
        np.array([each.actions[slot] for each in decided]),
        np.array([result.reward[slot] for result in results]),
        {name: np.array([result.components[name][slot] for result in results]) for name in results[0].components},
        int(results[-1].outcome[slot]) if results[-1].ended[slot] else 0,
        shown_lines(recorder),
    )
    return Transition(*(part[0] for part in cells)), flown
