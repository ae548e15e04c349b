import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.agent.decision import decide
from ai.training.config import PRESETS

SEEN = np.zeros((3, 9), np.float32)
VALUES = np.array([[0.5, 0.49, 0.1], [0.5, 0.47, 0.1], [0.1, 0.2, 0.3]], np.float32)


def test_what_is_held_is_kept_only_where_it_is_nearly_as_good_and_that_is_said():
    decision = decide(SEEN, VALUES, np.array([1, 1, 2]), steadiness=0.02, reward_scale=0.01)
    assert decision.action.tolist() == [1, 0, 2]
    assert decision.best.tolist() == [0, 0, 2]
    assert decision.kept.tolist() == [True, False, False]
    assert decision.margin == pytest.approx(2.0)
    assert decision.points is not None
    np.testing.assert_allclose(decision.points, 100 * VALUES, rtol=1e-5)
    assert decide(SEEN, VALUES, np.array([1, 1, 2])).action.tolist() == [0, 0, 2]


def test_one_slot_is_a_copy_and_an_update_leaves_the_older_decision_alone():
    older = decide(SEEN, VALUES)
    one = older.of(2)
    newer = older.updated(np.array([2]), decide(SEEN[:1] + 1, VALUES[:1]))
    assert older.action.tolist() == [0, 0, 2]
    assert newer.action.tolist() == [0, 0, 0]
    assert newer.observation[:, 0].tolist() == [0, 0, 1]
    assert newer.points is not None
    np.testing.assert_array_equal(newer.points[2], VALUES[0])
    assert (one.action.tolist(), one.observation.shape) == ([2], (1, 9))


@pytest.mark.parametrize("preset", PRESETS)
def test_an_agent_acts_as_it_decides_and_counts_in_its_own_unit(preset: str):
    agent = DeepQAgent(config=PRESETS[preset].changed(hidden=(16,)))
    rng = np.random.default_rng(1)
    seen, held = rng.normal(size=(200, 9)).astype(np.float32), rng.integers(6, size=200)
    decision = agent.decide(seen, held=held)
    assert np.array_equal(decision.action, agent.act(seen, held=held))
    assert decision.values is not None
    assert np.array_equal(decision.values, agent.q_values(seen))
    assert decision.reward_scale == agent.config.reward_scale
    assert decision.kept.any() == (agent.config.steadiness > 0)
    before = decision.action.copy()
    agent.act(seen, 1.0, held)
    assert np.array_equal(decision.action, before)
