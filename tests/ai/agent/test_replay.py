import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ai.agent.config import AgentConfig
from ai.agent.n_step import Episodes, NStep
from ai.agent.replay import PrioritisedReplayBuffer, ReplayBuffer, Transition, make_replay


def cells(first, count):
    """Transitions numbered from `first`, which their reward identifies."""
    numbers = np.arange(first, first + count)
    states = np.repeat(numbers[:, None], 2, axis=1).astype(np.float32)
    return Transition(states, states + 1, numbers % 3, numbers.astype(np.float32), numbers % 2 == 0, numbers % 5 + 1)


def test_a_memory_larger_than_the_machines_is_refused_by_the_name_of_its_setting():
    with pytest.raises(ValueError, match=r"replay_size: .* this machine has"):
        make_replay(AgentConfig(replay_size=10**6), 10**6)


def kept(buffer):
    return sorted(buffer.transitions.reward[(buffer.start + np.arange(len(buffer))) % buffer.capacity].tolist())


@pytest.mark.parametrize("kind", [ReplayBuffer, PrioritisedReplayBuffer])
@settings(deadline=None, max_examples=30)
@given(st.lists(st.integers(1, 12), max_size=12), st.integers(1, 10))
def test_the_newest_are_kept_and_the_oldest_pruned_in_one_go(kind, batches, prune):
    buffer, expected, total = kind(10, 2, prune), [], 0
    for count in batches:
        buffer.add(cells(total, count))
        new = list(range(total, total + count))[-10:]
        over = len(expected) + len(new) - 10
        expected = (expected[max(prune, over) :] if over > 0 else expected) + new
        total += count
        assert kept(buffer) == expected
        assert len(buffer) <= buffer.capacity
        drawn, rows, weights = buffer.sample(20, np.random.default_rng(0))
        assert set(drawn.reward.tolist()) <= set(expected)
        assert np.array_equal(buffer.at(rows).reward, drawn.reward)
        assert (drawn.state[:, 0] == drawn.reward).all()
        assert (drawn.next_state[:, 0] == drawn.reward + 1).all()
        assert weights.shape == (20,)


def test_the_described_buffer_falls_from_1500_to_500_and_what_is_drawn_is_a_copy():
    buffer = ReplayBuffer(1500, 2, prune=1000)
    buffer.add(cells(0, 1500))
    assert len(buffer) == 1500
    buffer.add(cells(1500, 1))
    assert len(buffer) == 501
    assert kept(buffer)[0] == 1000
    for part in buffer.at(np.array([1001])):
        part[...] = 0
    assert buffer.at(np.array([1001])).state.tolist() == [[1001, 1001]]


def test_surprising_memories_are_drawn_more_often_and_weigh_less():
    buffer = PrioritisedReplayBuffer(80, 2, exponent=1.0, importance=1.0)
    rows = buffer.add(cells(0, 64))
    assert buffer.priorities.tolist() == [1.0] * 64 + [0.0] * 16
    errors = np.where(rows == 7, -10.0, 0.1).astype(np.float32)
    buffer.update_priorities(np.array([7, *rows]), np.array([99.0, *errors], np.float32))  # of two, the last counts
    drawn, drawn_rows, weights = buffer.sample(4000, np.random.default_rng(0))
    assert drawn_rows.max() < 64
    often = drawn.reward == 7
    assert often.mean() == pytest.approx(10 / (10 + 63 * 0.101), abs=0.02)
    # Importance weights make the weighted draw uniform again.
    assert weights[often].sum() / weights.sum() == pytest.approx(1 / 64, abs=0.003)
    assert weights.max() == 1.0
    buffer.importance = 0.5
    half = buffer.sample(4000, np.random.default_rng(0))[2]
    np.testing.assert_allclose(half, np.sqrt(weights), rtol=1e-5)
    assert buffer.priorities[buffer.add(cells(64, 1))] == pytest.approx(99.001)  # what is new: the largest ever seen


@settings(deadline=None, max_examples=25)
@given(st.integers(1, 6), st.integers(1, 5), st.integers(0, 1000))
def test_every_step_becomes_one_memory_with_its_own_return(n, slots, seed):
    rng = np.random.default_rng(seed)
    n_step, steps = NStep(n, 0.9), 40
    reward = rng.normal(size=(steps, slots)).astype(np.float32)
    ended = rng.random((steps, slots)) < 0.15
    ended[-1] = True
    terminal = ended & (rng.random((steps, slots)) < 0.5)
    number = np.arange(steps * slots).reshape(steps, slots)
    seen = {}
    for step in range(steps):
        state = np.stack([number[step], number[step]], axis=1).astype(np.float32)
        made, slot = n_step.add(state, number[step], reward[step], state + 1000, terminal[step], ended[step])
        for k, which in enumerate(slot):
            assert int(made.action[k]) not in seen
            seen[int(made.action[k])] = True
            begin = int(made.action[k]) // slots
            last = min(begin + n - 1, begin + int(ended[begin:, which].argmax()))
            expected = sum(0.9 ** (t - begin) * reward[t, which] for t in range(begin, last + 1))
            assert made.reward[k] == pytest.approx(expected, abs=1e-4)
            assert made.steps[k] == last - begin + 1
            assert made.terminal[k] == terminal[last, which]
            assert made.next_state[k, 0] == number[last, which] + 1000
    assert len(seen) == steps * slots


def test_only_successful_episodes_are_passed_on_whole():
    episodes = Episodes(2)
    none = np.zeros(2, dtype=bool)
    assert not list(episodes.add(cells(0, 2), np.array([0, 1]), none, none))
    assert not list(episodes.add(cells(2, 2), np.array([0, 1]), none, none))
    both = np.ones(2, dtype=bool)
    whole = list(episodes.add(cells(4, 2), np.array([0, 1]), both, np.array([False, True])))
    assert [episode.reward.tolist() for episode in whole] == [[1.0, 3.0, 5.0]]
    whole = episodes.add(cells(6, 2), np.array([0, 1]), np.array([True, False]), both)
    assert [episode.reward.tolist() for episode in whole] == [[6.0]]
