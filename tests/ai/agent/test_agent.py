import json

import numpy as np
import pytest

from ai.agent.agent import TOGETHER, DeepQAgent
from ai.agent.replay import Transition
from ai.agent.symmetry import Symmetry
from ai.environment import StepResult
from ai.lander.environment import NUM_ACTIONS, NUM_FEATURES, LanderEnv
from ai.nn import ModelFormatError
from ai.training.config import PRESETS, Config, load_agent
from ai.training.tasks import LANDER_SYMMETRY

SMALL = Config(
    hidden=(16,), batch_size=8, gradient_steps=2, learning_starts=8, replay_size=200, n_step=1, num_envs=4, mirror=False
)


def result(observation, reward, terminated, truncated=None):
    terminated = np.asarray(terminated)
    truncated = np.zeros_like(terminated) if truncated is None else np.asarray(truncated)
    return StepResult(observation, np.asarray(reward, dtype=np.float32), terminated, truncated, terminated.astype(int))


def fed(config, count=40, seed=0):
    """An agent that remembers `count` random decisions."""
    agent, rng = DeepQAgent(3, 2, config, np.random.default_rng(seed)), np.random.default_rng(seed)
    for _ in range(count // 4):
        states = rng.normal(size=(4, 3)).astype(np.float32)
        after = rng.normal(size=(4, 3)).astype(np.float32)
        agent.store(states, rng.integers(0, 2, 4), result(after, rng.normal(size=4), rng.random(4) < 0.3))
    return agent


def test_without_a_configuration_it_is_the_preset_modern():
    agents = DeepQAgent(), DeepQAgent(config=PRESETS["modern"])
    for agent in agents:
        assert agent.config.to_json().items() <= PRESETS["modern"].to_json().items()
    assert np.array_equal(agents[0].online.values, agents[1].online.values)


def test_the_targets_of_many_memories_are_those_of_each_alone():
    for changes in ({}, {"target_judges": True}, {"target_judges": True, "double": True}):
        agent, rng, count = DeepQAgent(3, 2, SMALL.changed(**changes)), np.random.default_rng(4), 2 * TOGETHER + 5
        agent.online.values = rng.normal(size=agent.online.values.shape)
        states = rng.normal(size=(count, 3)).astype(np.float32)
        cells = Transition(states, states, np.zeros(count, int), rng.normal(size=count).astype(np.float32),
                           rng.random(count) < 0.2, rng.integers(1, 5, count))  # fmt: skip
        targets, values = agent.targets(cells)
        for row in (0, 7, TOGETHER - 1, TOGETHER, count - 1):
            online, target = (network.predict(states[row : row + 1])[0] for network in (agent.online, agent.target))
            judge = target if agent.config.target_judges else online
            value = judge[(online if agent.config.double else judge).argmax()]
            left = 0.0 if cells.terminal[row] else agent.config.discount ** int(cells.steps[row]) * value
            assert values[row] == pytest.approx(value, rel=1e-4, abs=1e-5)
            assert targets[row] == pytest.approx(cells.reward[row] + left, rel=1e-4, abs=1e-5)


def test_an_update_moves_only_the_chosen_action_towards_its_target():
    agent = DeepQAgent(3, 2, SMALL.changed(optimizer="sgd", learning_rate=0.01, cost="mse"))
    states = np.ones((1, 3), dtype=np.float32)
    before = agent.online.predict(states)[0]
    target = before[:1] + 1
    slope = []
    original = agent.online.backward_propagate
    agent.online.backward_propagate = lambda output_error: slope.append(output_error.copy()) or original(output_error)
    agent.gradient_step(states, np.array([0]), target, np.ones(1, dtype=np.float32))
    assert slope[0] == pytest.approx(np.array([[-2.0, 0.0]]))
    assert abs(agent.online.predict(states)[0, 0] - target[0]) < 1


def test_a_soft_target_follows_by_its_rate():
    agent = fed(SMALL.changed(target_update_interval=1, tau=0.25, gradient_steps=1))
    before = agent.target.values.copy()
    agent.learn()
    assert agent.target.values == pytest.approx(0.75 * before + 0.25 * agent.online.values, abs=1e-6)


def test_a_memory_that_is_pruned_below_the_warm_up_does_not_stop_learning():
    agent = fed(SMALL.changed(learning_starts=60, replay_size=100, replay_prune=90), count=56)
    assert agent.learn() is None
    assert agent.gradient_steps == 0
    sizes, learnt = [], []
    for seed in range(1, 10):
        agent.replay.add(fed(SMALL, count=20, seed=seed).replay.at(np.arange(20)))
        sizes.append(len(agent.replay))
        learnt.append(agent.learn() is not None)
    assert all(learnt)
    assert min(sizes) < 60


def test_greedy_actions_and_random_ones():
    agent = DeepQAgent(3, 2, SMALL, action_chances=np.array([0.9, 0.1]))
    states = np.random.default_rng(0).normal(size=(5000, 3)).astype(np.float32)
    assert np.array_equal(agent.act(states), agent.q_values(states).argmax(axis=1))
    assert (agent.act(states, epsilon=1.0) == 0).mean() == pytest.approx(0.9, abs=0.02)
    assert agent.act(states[0]).shape == (1,)


def test_it_learns_a_problem_whose_answer_is_known():
    """Two actions, one paid: Q must come out as the reward, and the policy as the paid action."""
    agent = DeepQAgent(3, 2, SMALL.changed(learning_rate=5e-3, final_learning_rate=5e-3, reward_scale=1.0,
                                           batch_size=32, gradient_steps=10, fly_target=False))  # fmt: skip
    rng = np.random.default_rng(0)
    for _ in range(60):
        states = rng.normal(size=(4, 3)).astype(np.float32)
        actions = rng.integers(0, 2, 4)
        paid = (actions == (states[:, 0] > 0)).astype(np.float32)
        agent.store(states, actions, result(states, paid, np.ones(4, dtype=bool)))
        agent.learn()
    states = rng.normal(size=(500, 3)).astype(np.float32)
    assert (agent.act(states) == (states[:, 0] > 0)).mean() > 0.93


def test_the_success_pass_learns_from_good_endings_only():
    agent, rng = DeepQAgent(3, 2, SMALL.changed(success_pass=True, success_batch_size=4)), np.random.default_rng(0)
    states = rng.normal(size=(2, 3)).astype(np.float32)
    for step in range(6):
        ended = np.array([step == 5] * 2)
        agent.store(states, np.array([0, 1]), result(states, [step, 100 + step], ended), np.array([True, False]))
    assert len(agent.successes) == 6
    assert agent.successes.transitions.action[:6].tolist() == [0] * 6


def test_a_mirrored_memory_is_its_own_mirror_image_twice():
    rng = np.random.default_rng(0)
    states = rng.normal(size=(6, NUM_FEATURES)).astype(np.float32)
    cell = Transition(states.copy(), states[::-1].copy(), np.arange(NUM_ACTIONS), np.zeros(6), np.zeros(6, bool))
    mirrored = LANDER_SYMMETRY.apply(cell, 6, 6)
    assert mirrored.action.tolist() == [0, 2, 1, 3, 5, 4]
    assert np.array_equal(mirrored.state[:, 7], states[:, 8])
    assert np.array_equal(mirrored.state[:, 0], -states[:, 0])
    assert np.array_equal(mirrored.next_state, mirrored.state[::-1])
    assert np.array_equal(cell.state, states)  # what was given stays as it is
    assert cell.action.tolist() == list(range(6))
    again = LANDER_SYMMETRY.apply(mirrored, 6, 6)
    assert np.array_equal(again.state, states)
    assert again.action.tolist() == list(range(6))


@pytest.mark.parametrize("changes", [{}, {"prioritised": True, "normalise_inputs": True}])
def test_half_of_each_batch_is_learnt_in_the_mirror(changes):
    agent = fed(SMALL.changed(mirror=True, **changes))
    agent.symmetry = Symmetry(np.array([100, 1, 1], np.float32), np.array([2, 1, 0]), np.array([1, 0]))
    agent.replay.transitions.state[:] += 3  # where means are 0, it makes no difference when a state is scaled
    if agent.normalizer:
        agent.normalizer.update(agent.replay.transitions.state[:40] * np.array([60, 1, 1], np.float32))
    sample, update, drawn, learnt = agent.replay.sample, agent.gradient_step, [], []
    agent.replay.sample = lambda *how: drawn.append(sample(*how)) or drawn[0]
    agent.gradient_step = lambda *batch: learnt.append([part.copy() for part in batch]) or update(*batch)
    agent.learn()
    scale = agent.normalizer.scaled if agent.normalizer else (lambda states: states)
    assert len(learnt) == 2
    for number, (states, actions, *_) in enumerate(learnt):
        cells = drawn[0][0]
        batch = slice(8 * number, 8 * number + 8)
        raw, taken = cells.state[batch], cells.action[batch]
        assert states[:4] == pytest.approx(scale(raw[:4, [2, 1, 0]] * np.array([100, 1, 1], np.float32)))
        assert states[4:] == pytest.approx(scale(raw[4:]))
        assert actions.tolist() == [*(1 - taken[:4]), *taken[4:]]


def test_an_error_that_is_not_finite_stops_learning_even_where_its_gradient_is():
    agent = fed(SMALL)
    agent.replay.transitions.reward[:] = np.inf
    before = agent.online.values.copy()
    with pytest.raises(FloatingPointError, match="cost was not finite at learning step 1"):
        agent.learn()
    assert np.array_equal(agent.online.values, before)
    assert agent.gradient_steps == 0


def fed_with_successes(config):
    """An agent that remembers ordinary decisions, and successes whose states it values quite otherwise."""
    agent = fed(config.changed(success_pass=True, success_batch_size=4))
    rng = np.random.default_rng(9)
    states = (5 + rng.normal(size=(20, 3))).astype(np.float32)
    agent.successes.add(Transition(states, states, np.zeros(20, int), np.ones(20), np.zeros(20, bool), np.ones(20)))
    return agent


def test_the_target_counts_training_calls_and_the_second_pass_belongs_to_its_call():
    both, alone = fed_with_successes(SMALL.changed(gradient_steps=1)), fed(SMALL.changed(gradient_steps=1))
    assert both.learn() == alone.learn() == both.loss  # loss and mean Q tell of the first pass
    assert both.mean_q == alone.mean_q
    assert both.optimizer.steps == 2 * alone.optimizer.steps
    agent = fed_with_successes(SMALL.changed(target_update_interval=5, tau=1.0, gradient_steps=1))
    first, changed = agent.target.values.copy(), []
    for _ in range(15):
        before = agent.target.values.copy()
        agent.learn()
        changed.append(not np.array_equal(agent.target.values, before))
    assert changed == ([False] * 4 + [True]) * 3
    assert agent.gradient_steps == 15
    assert not np.array_equal(agent.target.values, first)


@pytest.mark.parametrize("preset", PRESETS)
def test_save_and_load(tmp_path, preset):
    agent = DeepQAgent(NUM_FEATURES, NUM_ACTIONS, PRESETS[preset].changed(learning_starts=1))
    agent.save(tmp_path / "agent")
    loaded = DeepQAgent.load(tmp_path / "agent")
    states = np.random.default_rng(0).normal(size=(10, NUM_FEATURES)).astype(np.float32)
    assert np.array_equal(loaded.q_values(states), agent.q_values(states))
    assert Config.of(loaded) == agent.config
    loaded.save(tmp_path / "again")
    kept, _ = load_agent(tmp_path / "again")
    assert kept.config == agent.config, "settings of the run are kept by an agent that does not know them"
    assert not list(tmp_path.glob(".*"))


def test_loading_goes_on_exactly_where_saving_stopped(tmp_path):
    agent = fed(SMALL)
    agent.learn()
    agent.save(tmp_path / "agent")
    loaded = DeepQAgent.load(tmp_path / "agent", np.random.default_rng(5))
    loaded.replay = agent.replay
    agent.rng = np.random.default_rng(5)
    agent.learn()
    loaded.learn()
    assert np.array_equal(agent.online.values, loaded.online.values)
    assert loaded.gradient_steps == agent.gradient_steps


def damaged(config):
    values = np.zeros(DeepQAgent(3, 2, SMALL).online.values.size, np.float32)
    return {
        "newer": lambda f: (f / "config.json").write_text(json.dumps(config | {"version": 99})),
        "unknown setting": lambda f: (f / "config.json").write_text(json.dumps(config | {"config": {"x": 1}})),
        "other sizes": lambda f: (f / "config.json").write_text(json.dumps(config | {"features": 4})),
        "no network": lambda f: (f / "online" / "config.json").unlink(),
        "optimizer": lambda f: (f / "optimizer.npz").write_bytes(b"PK"),
        "an optimizer of another kind": lambda f: np.savez(f / "optimizer.npz", steps=3, velocity=values),
    }


def test_a_damaged_folder_is_named_and_refused(tmp_path, subtests):
    for damage in damaged({}):
        folder = tmp_path / damage
        fed(SMALL).save(folder)
        damaged(json.loads((folder / "config.json").read_text()))[damage](folder)
        with subtests.test(damage):
            with pytest.raises(ModelFormatError) as caught:
                DeepQAgent.load(folder)
            assert str(folder) in str(caught.value)
            assert ("optimizer.npz" in str(caught.value)) == ("optimizer" in damage)


def test_one_step_of_training_acts_stores_and_learns():
    env, agent = LanderEnv(4, 0, "near"), DeepQAgent(config=SMALL.changed(learning_starts=4))
    observation = env.reset()
    actions, after = agent.train_step(env, observation, 0.0, np.zeros(4, np.intp))
    stored = agent.replay.at(np.arange(4))
    assert np.array_equal(stored.state, observation)
    assert np.array_equal(stored.next_state, after.observation)
    assert np.array_equal(stored.action, actions)
    assert (agent.decisions, agent.gradient_steps) == (4, SMALL.gradient_steps)
