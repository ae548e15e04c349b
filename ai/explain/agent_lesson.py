"""Lesson: one learning step of an agent around one memory, recorded while the agent's own code takes it.

The step is taken by a copy of the agent, on the minibatch that it is handed, so that the run goes on as if nobody had
looked. Nothing here computes what the agent computes: all numbers are read from the recording, or are arrays that the
step has read or written.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.config import AgentConfig
from ai.agent.replay import ReplayBuffer, Transition
from ai.environment import Floats, Ints
from ai.explain.learning_step import Step, recorded_step
from ai.explain.recorder import Function, Line
from ai.nn import SGD, CostFunctions, NeuralNetwork

_PART: Final = 0.2  # of the way to its target: the first step of a memory learned alone, were the network a line


@dataclass(frozen=True, eq=False)
class Flown:
    """The k decisions that a memory sums up, as they were flown."""

    slot: int  # which lander flew them
    decisions: int  # of all landers, before the first of the k
    observations: Floats  # (k + 1, features) before each, and after the last, in the environment's units
    actions: Ints  # (k,)
    rewards: Floats  # (k,) in points
    parts: dict[str, Floats]  # by name, what each part of the reward brought, (k,) in points
    outcome: int  # how the episode ended with the last of them; 0 if it went on
    lines: tuple[Line, ...] = ()  # of `NStep.add`, which summed the rewards up, for the last of the decisions


@dataclass(frozen=True, eq=False)
class Lesson:
    """One learning step of a deep Q-learning agent, around one memory.

    Values, rewards and errors are as the agent computes with them, in points times `config.reward_scale`.
    """

    config: AgentConfig  # of the run; the step shown is the first of its `gradient_steps`
    decisions: int  # of the run, when the step was taken
    flown: Flown | None  # None if that is not known
    cell: Transition  # the memory, (features,) and numbers, as it lies in the replay buffer
    state: Floats  # (features,) of it as the networks are given them
    predicted: Floats  # (actions,) values of the state by the online network, before the step
    best: int  # the action that is picked in the next state
    next_value: float  # its value by the network that judges
    discount: float  # gamma to the power of the memory's decisions
    target: float  # what the value should have been
    error: float  # the value of the action taken, less its target
    step: Step  # of the optimizer


@dataclass(frozen=True, eq=False)
class Before:
    """All that a learning step depends on: a copy of the agent before it, and the minibatch that it is handed."""

    agent: DeepQAgent
    cells: Transition  # the minibatch, (batch, ...), as it was drawn; one of them gives way to the memory of the lesson
    weights: Floats  # (batch,) of them in the cost

    @classmethod
    def of(cls, agent: DeepQAgent, rng: np.random.Generator) -> Before:
        """Return a copy of all that the next learning step of an agent depends on; `rng` draws the minibatch."""
        cells, _, weights = agent.replay.sample(agent.config.batch_size, rng)
        return cls(_copied(agent, agent.config), cells, weights)


def _copied(agent: DeepQAgent, config: AgentConfig, **parts: Any) -> DeepQAgent:
    """Return an agent that goes on from another, by a configuration whose networks are of the same sizes."""
    sizes, rng = (agent.num_features, agent.num_actions), np.random.default_rng(0)
    twin = DeepQAgent(*sizes, config, rng, symmetry=agent.symmetry, **parts)
    twin.copy_from(agent)
    twin.gradient_steps = 0
    return twin


def explain(before: Before, cell: Transition, flown: Flown | None = None) -> Lesson:
    """Take the learning step that follows from `before` with `cell` in its minibatch, and return all of it.

    Raises DivergenceError as the step does, and ValueError for a network that is too large.
    """
    row = len(before.weights) // 2  # the first half of a minibatch may be mirrored
    twin = _twin(before, cell, row)
    recorder, step = recorded_step(twin.learn, twin.online, twin.optimizer, _AGENT, row)
    taken, judged, target = (
        recorder.call(each).values for each in (DeepQAgent.gradient_step, DeepQAgent._next_value, DeepQAgent.targets)
    )
    return Lesson(
        config=before.agent.config,
        decisions=before.agent.decisions,
        flown=flown,
        cell=cell,
        state=taken["states"][row],
        predicted=taken["predicted"][row],
        best=int(judged["best"][row]),
        next_value=float(judged["value"][row]),
        discount=float(target["discount"][row]),
        target=float(target["targets"][row]),
        error=float(taken["errors"][row]),
        step=step,
    )


_AGENT: Final[tuple[Function, ...]] = (DeepQAgent.targets, DeepQAgent._next_value, DeepQAgent.gradient_step)


class _HandedBatch(ReplayBuffer):
    """Replay buffer that always draws the minibatch that it was handed."""

    def __init__(self, cells: Transition, weights: Floats) -> None:
        super().__init__(len(weights), cells.state.shape[1])
        self.added, self.size, self._drawn = 2**62, len(weights), (cells, np.arange(len(weights)), weights)

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Transition, Ints, Floats]:  # noqa: ARG002
        """Return the minibatch."""
        return self._drawn


def _twin(before: Before, cell: Transition, row: int) -> DeepQAgent:
    """Return an agent that is about to take the learning step, with the memory in a row of its minibatch."""
    cells = Transition(*(np.array(part) for part in before.cells))
    for part, own in zip(cells, cell, strict=True):
        part[row] = own
    config = before.agent.config.changed(gradient_steps=1, success_pass=False, batch_size=len(before.weights))
    return _copied(before.agent, config, replay=_HandedBatch(cells, before.weights))


class LearnedAlone:
    """One output of a copy of a network that learns its target, which stands still, and nothing else.

    No other example is in its batch, and plain gradient descent on the squared error carries nothing on.

    Attributes:
        network: the copy.
        way: the output before the first step and after each, in the network's scale.
        outputs: (outputs,) all of them now.
        rate: the learning rate of all steps.

    """

    def __init__(self, network: NeuralNetwork, state: Floats, output: int, target: float) -> None:
        self.network, self._state, self._output, self.target = network.copy(), state[None], output, target
        self.network.cost = CostFunctions.use_mse()
        self.outputs = self.network.predict(self._state)[0].copy()
        self.way = [float(self.outputs[output])]
        self.rate = self._rate()
        self._optimizer = SGD(self.rate)

    @property
    def error(self) -> float:
        """The output now, less its target."""
        return self.way[-1] - self.target

    @property
    def arrived(self) -> bool:
        """Whether no more than a hundredth of the first error is left."""
        return abs(self.error) <= 0.01 * abs(self.way[0] - self.target)

    def step(self) -> None:
        """Learn it once more."""
        # The other outputs are their own targets, so that nothing is to be learned of them.
        self.network.train_batch(self._state, self._wanted(), self._optimizer)
        self.outputs = self.network.predict(self._state)[0].copy()
        self.way.append(float(self.outputs[self._output]))

    def recorded(self) -> Step:
        """Learn it once more, and return the step."""
        return recorded_step(self.step, self.network, self._optimizer, (), 0)[1]

    def _wanted(self) -> Floats:
        wanted: Floats = self.network.predict(self._state).copy()
        wanted[0, self._output] = self.target
        return wanted

    def _rate(self) -> float:
        """Return the learning rate with which the first step goes that part of the way, to first order."""
        network = self.network
        derivative = network.cost.derivative(network.forward_propagate(self._state), self._wanted())
        network.backward_propagate(derivative)
        slope = float(derivative[0, self._output])
        squared = float(np.square(network.gradients.astype(float)).sum())
        return _PART * self.error * slope / squared if squared > 0.0 else 1e-3
