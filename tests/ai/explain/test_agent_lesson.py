"""Lesson: every number of it is that of the learning step which the agent takes when nobody looks, bit for bit."""

import inspect
import pickle
from dataclasses import replace

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.agent.replay import ReplayBuffer, Transition
from ai.explain import learning_step
from ai.explain.agent_lesson import Before, explain
from ai.nn import Optimizer
from ai.training.config import PRESETS
from ai.training.loop import Training
from ai.training.tasks import LANDER_SYMMETRY

MODERN = replace(PRESETS["modern"], num_envs=8, batch_size=16, gradient_steps=2, learning_starts=32, n_step=3,
                 hidden=(16, 12), replay_size=2000)  # fmt: skip
SMALL = {
    "modern": MODERN,
    "double": replace(MODERN, target_judges=True, double=True),
    "classic": replace(PRESETS["classic"], hidden=(16, 12), batch_size=16, learning_starts=32),
    "all": replace(MODERN, gradient_steps=1, n_step=2, hidden=(16,), prioritised=True, dueling=True,
                   normalise_inputs=True, activation="leaky_relu", cost="mse", double=False, gradient_clip=0.1,
                   optimizer="momentum"),
}  # fmt: skip


def trained(name):
    training = Training(SMALL[name], seed=3, evaluate_every=0)
    while training.agent.gradient_steps < 20:
        training.advance()
    return training.agent


class Drawn(ReplayBuffer):
    """Replay buffer that draws what it was given."""

    def __init__(self, cells, weights):
        super().__init__(len(weights), cells.state.shape[1])
        self.added, self.size, self.drawn = 10**6, len(weights), (cells, np.arange(len(weights)), weights)

    def sample(self, count, rng):
        return self.drawn


def minibatch(before, cell):
    """The minibatch of the lesson, with the memory in the row of it that is returned."""
    row = len(before.weights) // 2
    cells = Transition(*(np.array(part) for part in before.cells))
    for part, own in zip(cells, cell, strict=True):
        part[row] = own
    return cells, row


def unobserved(before, cell, agent):
    """The same step by an agent that nobody looks at: it is handed the same minibatch, and learns."""
    cells, _ = minibatch(before, cell)
    twin = DeepQAgent(9, 6, before.agent.config.changed(gradient_steps=1, success_pass=False), np.random.default_rng(5),
                      symmetry=LANDER_SYMMETRY, replay=Drawn(cells, before.weights))  # fmt: skip
    twin.copy_from(agent)
    twin.learn()
    return twin


@pytest.fixture(scope="module", params=sorted(SMALL))
def case(request):
    agent = trained(request.param)
    before = Before.of(agent, np.random.default_rng(1))
    cell = Transition(*(part[0] for part in agent.replay.at(np.array([7]))))
    state = agent.online.values.copy(), agent.optimizer.state(), agent.rng.bit_generator.state
    lesson = explain(before, cell)
    return agent, before, cell, lesson, state


def test_the_step_is_the_one_that_is_taken_when_nobody_looks(case):
    agent, before, cell, lesson, _ = case
    alone = unobserved(before, cell, agent)
    step = lesson.step
    np.testing.assert_array_equal(step.values_after, alone.online.values)
    np.testing.assert_array_equal(step.gradient, alone.online.gradients)
    assert step.learning_rate == alone.optimizer.learning_rate
    np.testing.assert_array_equal(step.values_before, agent.online.values)
    np.testing.assert_allclose(lesson.predicted, agent.online.predict(lesson.state), rtol=2e-5, atol=2e-6)


def test_the_target_is_the_agents(case):
    agent, before, cell, lesson, _ = case
    cells, row = minibatch(before, cell)
    if agent.normalizer:
        cells = cells._replace(
            state=agent.normalizer.scaled(cells.state), next_state=agent.normalizer.scaled(cells.next_state)
        )
    targets, values = agent.targets(cells)
    assert lesson.target == targets[row]
    assert lesson.next_value == values[row]
    assert lesson.error == lesson.predicted[int(cell.action)] - np.float32(lesson.target)
    picks = agent.online if agent.double or not agent.config.target_judges else agent.target
    assert lesson.best == int(np.argmax(picks.predict(cells.next_state)[row]))
    sum_up = float(cell.reward) + lesson.discount * lesson.next_value * (not cell.terminal)
    assert lesson.target == pytest.approx(sum_up, rel=1e-6)


def test_the_agent_is_as_before_and_a_lesson_can_be_sent(case, monkeypatch):
    agent, before, cell, lesson, (values, optimizer, rng) = case
    np.testing.assert_array_equal(agent.online.values, values)
    for name, kept in agent.optimizer.state().items():
        np.testing.assert_array_equal(kept, optimizer[name])
    assert agent.rng.bit_generator.state == rng
    again = pickle.loads(pickle.dumps(lesson))
    np.testing.assert_array_equal(again.step.values_after, lesson.step.values_after)
    monkeypatch.setattr(learning_step, "MOST_PARAMETERS", len(before.agent.online.values) - 1)
    with pytest.raises(ValueError, match="too large"):
        explain(before, cell)


def test_the_lines_are_those_of_the_running_code(case):
    lesson = case[3]
    functions = (DeepQAgent.targets, DeepQAgent.gradient_step, Optimizer.step)
    ran = [line.function for line in lesson.step.lines]
    for function in functions:
        lines, first = inspect.getsourcelines(function)
        numbers = [line.number for line in lesson.step.lines if line.function == function.__qualname__]
        assert first <= min(numbers) <= max(numbers) < first + len(lines)
    order = [ran.index(function.__qualname__) for function in functions]
    assert order == sorted(order)
    said = {name: value for line in lesson.step.lines for name, value in line.values.items()
            if line.function == "DeepQAgent.gradient_step"}  # fmt: skip
    assert said["errors"].shape == (16,)
    assert said["errors"].case == np.float32(lesson.error)
