"""Lesson: one learning step of an agent around one memory, recorded while the agent's own code takes it.

The step is taken by a copy of the agent, on the minibatch that it is handed, so that the run goes on as if nobody had
looked. Nothing here computes what the agent computes: all numbers are read from the recording, or are arrays that the
step has read or written. One memory's share of the gradient is the same backward pass with the others' errors at 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.config import AgentConfig
from ai.agent.n_step import NStep
from ai.agent.network import build_network, make_optimizer
from ai.agent.normalizer import Normalizer
from ai.agent.replay import MemoryCell, ReplayBuffer
from ai.common.environment import Floats, Ints
from ai.explain.learning_step import MOST_PARAMETERS, Line, Step, kept_by, network_functions, recorded_step
from ai.explain.recorder import RETURN, Function, Recorder


@dataclass(frozen=True, eq=False)
class Flown:
    """The k decisions that a memory sums up, as they were flown.

    Attributes:
        slot: which lander flew them.
        decisions: of all landers, before the first of the k.
        observations: (k + 1, features) before each, and after the last, in the environment's units.
        actions: (k,).
        rewards: (k,) in points.
        parts: by name, what each part of the reward brought, (k,) in points.
        outcome: how the episode ended with the last of them; 0 if it went on.
        lines: the lines of `NStep.add` that summed the rewards up, for the last of the decisions.

    """

    slot: int
    decisions: int
    observations: Floats
    actions: Ints
    rewards: Floats
    parts: dict[str, Floats]
    outcome: int
    lines: tuple[Line, ...] = ()


@dataclass(frozen=True, eq=False)
class Lesson:
    """One learning step of a deep Q-learning agent, around one memory.

    Values, rewards and errors are as the agent computes with them, in points times `config.reward_scale`.

    Attributes:
        config: settings of the run; the step shown is the first of its `gradient_steps`.
        decisions: of the run, when the step was taken.
        flown: the decisions that the memory sums up; None if that is not known.
        cell: the memory, (features,) and numbers, as it lies in the replay buffer.
        state, next_state: (features,) of it as the networks are given them.
        weight: its weight in the cost, by importance sampling; 1 in uniform replay.
        target_values: (parameters,) of the target network.
        predicted: (actions,) values of the state by the online network, before the step.
        next_online: (actions,) values of the next state by the online network; None if it picks for no other.
        next_judged: (actions,) the same by the network that judges.
        best: the action that is picked in the next state.
        next_value: its value by the network that judges.
        discount: γ to the power of the memory's decisions.
        target: what the value should have been.
        error: the value of the action taken, less its target.
        batch_errors: (batch,) the same of all memories of the minibatch.
        derivative: of the cost by that value, divided by the size of the minibatch already.
        predicted_after: (actions,) values of the state after the step.
        step: the step of the optimizer.

    """

    config: AgentConfig
    decisions: int
    flown: Flown | None
    cell: MemoryCell
    state: Floats
    next_state: Floats
    weight: float
    target_values: Floats
    predicted: Floats
    next_online: Floats | None
    next_judged: Floats
    best: int
    next_value: float
    discount: float
    target: float
    error: float
    batch_errors: Floats
    derivative: float
    predicted_after: Floats
    step: Step


@dataclass(frozen=True, eq=False)
class Before:
    """All that a learning step depends on: the agent before it, and the minibatch that it is handed.

    Attributes:
        online, target: (parameters,) of the two networks.
        optimizer: what `Optimizer.state` returned.
        normalizer: of observations, or None.
        cells: the minibatch, (batch, ...), as it was drawn; one of them gives way to the memory of the lesson.
        weights: (batch,) of them in the cost.

    """

    config: AgentConfig
    decisions: int
    online: Floats
    target: Floats
    optimizer: dict[str, Any]
    normalizer: dict[str, Any] | None
    cells: MemoryCell
    weights: Floats

    @classmethod
    def of(cls, agent: DeepQAgent, rng: np.random.Generator) -> Before:
        """Return a copy of all that the next learning step of an agent depends on; `rng` draws the minibatch."""
        cells, _, weights = agent.replay.sample(agent.config.batch_size, rng)
        normalizer = agent.normalizer.to_json() if agent.normalizer else None
        online, target = agent.online.values.copy(), agent.target.values.copy()
        optimizer = agent.optimizer.state()
        return cls(agent.config, agent.decisions, online, target, optimizer, normalizer, cells, weights)


def functions(config: AgentConfig) -> dict[str, Function]:
    """Return the functions that a learning step runs through and a lesson records, by their qualified names."""
    network = build_network(2, 2, config, np.random.default_rng(0))
    return Recorder([*_AGENT, *network_functions(network, make_optimizer(config))]).functions


def explain(before: Before, cell: MemoryCell, agent: DeepQAgent, flown: Flown | None = None) -> Lesson:
    """Take the learning step that follows from `before` with `cell` in its minibatch, and return all of it.

    `agent` is one of the same sizes and symmetry, which is not changed. Raises DivergenceError as the step does, and
    ValueError for a network of more than MOST_PARAMETERS.
    """
    if len(before.online) > MOST_PARAMETERS:
        raise ValueError(f"a network of more than {MOST_PARAMETERS:,} parameters is too large to be explained")
    row = len(before.weights) // 2  # the first half of a minibatch may be mirrored
    twin = _twin(before, cell, row, agent)
    kept = kept_by(twin.optimizer, before.online)
    with Recorder([*_AGENT, *network_functions(twin.online, twin.optimizer)], row) as recorder:
        twin.learn()
    step = recorded_step(recorder, twin.online, twin.optimizer, before.online, kept, row)
    action, last = int(cell.action), recorder.last
    # Recorded of `predict` is what both networks said of the next states.
    said = {id(event.owner): event.values[RETURN] for event in recorder.of("NeuralNetwork.predict")
            if RETURN in event.values}  # fmt: skip
    picks = said.get(id(twin.online)) if twin.double else None
    states, errors = last("DeepQAgent.gradient_step", "states"), last("DeepQAgent.gradient_step", "errors")
    return Lesson(
        config=before.config,
        decisions=before.decisions,
        flown=flown,
        cell=cell,
        state=states[row],
        next_state=last("DeepQAgent._next_value", "states")[row],
        weight=float(before.weights[row]),
        target_values=before.target,
        predicted=last("DeepQAgent.gradient_step", "predicted")[row],
        next_online=None if picks is None else picks[row],
        next_judged=last("DeepQAgent._next_value", "values")[row],
        best=int(last("DeepQAgent._next_value", "best")[row]),
        next_value=float(last("DeepQAgent._next_value", "value")[row]),
        discount=float(last("DeepQAgent.targets", "discount")[row]),
        target=float(last("DeepQAgent.targets", "targets")[row]),
        error=float(errors[row]),
        batch_errors=errors,
        derivative=float(last("DeepQAgent.gradient_step", "derivative")[row, action]),
        predicted_after=twin.online.predict(states)[row],
        step=step,
    )


_AGENT: Final = (
    DeepQAgent.learn, DeepQAgent._learn_from, DeepQAgent.targets, DeepQAgent._next_value,
    DeepQAgent.gradient_step, DeepQAgent._update_target, Normalizer.__call__, NStep.add,
)  # fmt: skip


class _HandedBatch(ReplayBuffer):
    """Replay buffer that always draws the minibatch that it was handed."""

    def __init__(self, cells: MemoryCell, weights: Floats) -> None:
        super().__init__(len(weights), cells.state.shape[1])
        self.added, self._drawn = 2**62, (cells, np.arange(len(weights)), weights)

    def sample(self, count: int, rng: np.random.Generator) -> tuple[MemoryCell, Ints, Floats]:  # noqa: ARG002
        """Return the minibatch."""
        return self._drawn


def _twin(before: Before, cell: MemoryCell, row: int, agent: DeepQAgent) -> DeepQAgent:
    """Return an agent that is about to take the learning step, with the memory in a row of its minibatch."""
    cells = MemoryCell(*(np.array(part) for part in before.cells))
    for part, own in zip(cells, cell, strict=True):
        part[row] = own
    config = before.config.changed(gradient_steps=1, success_pass=False, batch_size=len(before.weights))
    twin = DeepQAgent(agent.num_features, agent.num_actions, config, np.random.default_rng(0),
                      symmetry=agent.symmetry, replay=_HandedBatch(cells, before.weights))  # fmt: skip
    twin.online.values, twin.target.values = before.online, before.target
    twin.optimizer.load_state(before.optimizer, before.online)
    if before.normalizer is not None and twin.normalizer is not None:
        twin.normalizer.load(before.normalizer)
    twin.decisions = before.decisions
    return twin
