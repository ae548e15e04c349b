"""What an agent reckons with as it goes: schedules, and the scale of what it observes."""

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.agent.config import AgentConfig
from ai.agent.normalizer import REACH, Normalizer
from ai.agent.schedule import exploration, exploration_of_each, importance, learning_rate


def test_rates_move_in_a_straight_line_and_stay_at_their_end(subtests):
    config = AgentConfig(learning_rate=0.01, final_learning_rate=0.001, importance_exponent=0.4, epsilon_end=0.1)
    config = config.changed(schedule_decisions=1000, epsilon_decisions=500, epsilon_spread=1.0)
    for decisions, rate, beta, epsilon in [
        (0, 0.01, 0.4, 1.0),
        (250, 0.00775, 0.55, 0.55),
        (500, 0.0055, 0.7, 0.1),
        (1000, 0.001, 1.0, 0.1),
        (9000, 0.001, 1.0, 0.1),
    ]:
        with subtests.test(decisions=decisions):
            found = learning_rate(config, decisions), importance(config, decisions), exploration(config, decisions, 0)
            assert found == pytest.approx((rate, beta, epsilon))
    by_episode = config.changed(epsilon_decisions=0, epsilon_decay=0.9)
    assert exploration(by_episode, 0, 3) == pytest.approx(0.9**3)
    assert exploration(by_episode, 0, 1000) == config.epsilon_end
    np.testing.assert_allclose(exploration_of_each(config, 0.1, 3), [0.1, 0.1**0.5, 1.0])


def test_prioritised_replay_is_corrected_as_the_schedule_says():
    config = AgentConfig(hidden=(4,), prioritised=True, learning_starts=4, batch_size=8, gradient_steps=1)
    config = config.changed(importance_exponent=0.5, schedule_decisions=1000)
    agent = DeepQAgent(2, 2, config)
    agent.replay.add(agent.replay.at(np.zeros(4, np.intp)))
    for agent.decisions, expected in ((0, 0.5), (500, 0.75), (2000, 1.0)):
        agent.learn()
        assert agent.replay.importance == expected


def test_a_normalizer_knows_mean_and_deviation_of_all_it_has_seen():
    rng = np.random.default_rng(0)
    seen = (rng.normal(size=(60, 3)) * [1, 100, 0.01] + [5, -300, 0]).astype(np.float32)
    seen[:, 0] += np.arange(60)  # parts with means of their own
    normalizer = Normalizer(3)
    for part in np.split(seen, [1, 7, 40]):
        normalizer.update(part)
    assert normalizer.count == 60
    np.testing.assert_allclose(normalizer.mean, seen.mean(axis=0), rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(normalizer.squares / 60, seen.var(axis=0, dtype=float), rtol=1e-5)
    scaled = normalizer(seen)
    np.testing.assert_allclose(scaled.std(axis=0), 1, rtol=1e-4)
    assert scaled.dtype == np.float32
    assert normalizer(seen + np.float32(1e6)).max() == REACH
    again = Normalizer(3)
    again.load(normalizer.to_json())
    np.testing.assert_array_equal(again(seen), scaled)
    constant = Normalizer(1)
    constant.update(np.full((5, 1), 2.0, np.float32))
    assert constant(np.full((1, 1), 2.5, np.float32)) == 0.5, "what never varies keeps its unit"
