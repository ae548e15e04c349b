"""Lessons of a live run: the learning step that follows from a moment of a flight, now or earlier in the run.

A run keeps the last decisions of all landers, and now and then all that its next learning step depends on. A lesson is
made from these only when one is asked for, by a copy of the agent.
"""

from __future__ import annotations

from collections import deque
from typing import Any, Final, NamedTuple

import numpy as np

from ai.agent.n_step import NStep
from ai.agent.replay import Transition
from ai.environment import Floats, Ints, StepResult
from ai.explain.agent_lesson import Before, Flown, Lesson, explain
from ai.explain.learning_step import shown_lines
from ai.explain.recorder import Recorder
from ai.lander.environment import Outcome
from ai.training.loop import Training

_MOST_KEPT: Final = 40  # moments of a run; with twice as many, every second one is dropped
_MOST_BYTES: Final = 32 << 20  # of them all, at the end of a long run with a large network
_FIRST_EVERY: Final = 16  # decisions of each lander between two of the first that are kept


class _Decided(NamedTuple):
    """One decision of all landers: decisions of the run and observations (n, features) before it, and actions (n,)."""

    decisions: int
    observation: Floats
    actions: Ints
    result: StepResult


class _Moment(NamedTuple):
    """Moment of a run that can be explained: the last decisions, oldest first, and the step that follows."""

    decided: tuple[_Decided, ...]
    before: Before


class Explanations:
    """Explanations of a run's learning steps; `follow` is to be called after each decision, `keep` now and then."""

    def __init__(self, training: Training) -> None:
        self._training = training
        self._decided: deque[_Decided] = deque(maxlen=training.config.n_step)
        self._moments: list[_Moment] = []
        self._first: _Moment | None = None  # in which a lander landed, and the network could learn of it
        self._every = _FIRST_EVERY * training.env.num_envs
        self._keep_at = training.agent.decisions

    def follow(self, actions: Ints, result: StepResult) -> int | None:
        """Keep one decision of all landers: what comes of it, before those that have ended begin anew.

        Return the lander that has landed, if it is the first from which there is anything to learn: its moment is kept.
        """
        agent = self._training.agent
        self._decided.append(_Decided(agent.decisions - len(actions), self._training.observation, actions, result))
        landed = np.flatnonzero(result.outcome == Outcome.LANDED)
        if self._first is not None or not len(landed) or not agent.ready:
            return None
        self._first = self._now()
        return int(landed[0])

    def keep(self) -> None:
        """Keep the present moment, if one is due."""
        agent = self._training.agent
        if agent.decisions < self._keep_at or not agent.ready:
            return
        self._moments.append(self._now())
        most = max(4, min(_MOST_KEPT, _MOST_BYTES // _size(self._moments[-1])))
        if len(self._moments) >= 2 * most:
            self._moments = self._moments[::2]
            self._every *= 2
        self._keep_at = agent.decisions + self._every

    def explain(self, slot: int, decisions: int | None = None) -> Lesson:
        """Return the lesson of a lander's latest memory that is complete, now or at the kept moment nearest to a time.

        `decisions` are those of the run at that time. Raises ValueError where there is nothing to learn from yet, for a
        lander that does not fly, and for a network that is too large; DivergenceError as the learning step does.
        """
        if not 0 <= slot < self._training.env.num_envs:
            raise ValueError(f"there is no lander {slot}: {self._training.env.num_envs} fly")
        if not self._training.agent.ready or not self._decided:
            raise ValueError("the network has not begun to learn: its replay buffer holds too few transitions")
        kept = [*self._moments, *([self._first] if self._first else [])] if decisions is not None else []
        moment = min(kept, key=lambda each: abs(each.before.agent.decisions - (decisions or 0)), default=None)
        moment = moment or self._now()
        cell, flown = _memory(moment, slot)
        return explain(moment.before, cell, flown)

    def _now(self) -> _Moment:
        agent = self._training.agent
        # The run's own generator stays as it is, and the same moment gives the same lesson.
        rng = np.random.default_rng((self._training.seed, agent.decisions))
        return _Moment(tuple(self._decided), Before.of(agent, rng))


def _memory(moment: _Moment, slot: int) -> tuple[Transition, Flown]:
    """Return a lander's latest memory that is complete, or of a flight's end the one that sums up most."""
    config, decided = moment.before.agent.config, list(moment.decided)
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


def _size(moment: _Moment) -> int:
    """Return the number of bytes of a moment, about."""
    agent, decided = moment.before.agent, moment.decided[0]
    networks = (4 + len(agent.optimizer.memory)) * agent.online.values.nbytes  # both with room for gradients
    parts = sum(part.nbytes for part in decided.result.components.values())
    return int(networks + len(moment.decided) * (2 * decided.observation.nbytes + parts))
