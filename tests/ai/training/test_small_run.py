"""Small runs: the same for the same seed, the real memory shown as it is."""

from itertools import islice

import numpy as np
import pytest

from ai.lander.environment import OBSERVATION_SCALE, Outcome
from ai.lander.one_engine import OneEngineEnv
from ai.training.small_run import SMALL_RUN, Plan, SmallRun, small_runs


def test_one_engine_landers_move_straight_up_and_down_and_are_paid_as_any_lander():
    env = OneEngineEnv(4, np.random.default_rng(1), (1.0, 8.0))
    sensed = env.reset()
    assert ((env.altitude > 1) & (env.altitude < 8)).all()
    assert sensed[:, 0] == pytest.approx(env.altitude * OBSERVATION_SCALE[1], abs=1e-5)
    while not (result := env.step(np.array([0, 1, 0, 1]))).ended.all():
        assert np.abs(env.position[:, 0]).max() < 1e-2  # a crash shifts it a little
        assert result.reward == pytest.approx(sum(result.components.values()))
    assert set(result.outcome.tolist()) <= {Outcome.CRASHED, Outcome.LANDED, Outcome.OUT_OF_BOUNDS}


def test_the_same_seed_gives_the_same_run_alone_or_beside_another():
    both = [states for (states,) in islice(small_runs([SMALL_RUN, SMALL_RUN.changed(tau=0.5)], 3), 60)]
    alone = SmallRun(SMALL_RUN, 3)
    for states in both[1:]:
        state = alone.advance()
        assert (state.value, state.flights) == (states[0].value, states[0].flights)
        assert state.flown.height.tolist() == states[0].flown.height.tolist()
        assert state.memory.drawn.tolist() == states[0].memory.drawn.tolist()
    assert both[-1][0].value != both[-1][1].value


def test_the_memory_that_is_shown_is_the_one_that_is_drawn_from():
    run = SmallRun(SMALL_RUN.changed(replay_size=400, learning_starts=64), 0)
    seen: list[float] = []
    for _ in range(60):
        state = run.advance()
        seen += run.replay.at(run.replay.newest(16)).state[:, 0].tolist()
        assert (state.memory.oldest, state.memory.newest) == (max(0, len(seen) - 400), len(seen))
        for number, row in zip(state.memory.drawn, run.replay.drawn, strict=True):
            assert seen[number] == run.replay.transitions.state[row, 0]
    assert len(state.memory.drawn) == SMALL_RUN.batch_size * SMALL_RUN.gradient_steps


def test_a_memory_of_the_latest_drops_the_rest_when_the_day_changes():
    run = SmallRun(SMALL_RUN, 0, Plan((5.0, 8.0), change=30, later=(0.3, 1.0), keep=100))
    for _ in range(30):
        state = run.advance()
    assert state.memory.oldest == 0
    state = run.advance()
    assert state.memory.oldest == 31 * 16 - 100
    assert state.flown.height.max() < 1.2


def test_those_that_are_tested_take_no_random_actions():
    run = SmallRun(SMALL_RUN, 0, Plan(tested=(1.0, 8.0)))
    for _ in range(10):  # before it learns
        best = run.agent.act(run.tests.observation)
        assert np.array_equal(run.advance().tested.main, best == 1)


def test_a_memory_that_is_cut_down_keeps_the_newest():
    run = SmallRun(SMALL_RUN, 0, Plan(change=30, keep=50))
    for _ in range(30):
        run.advance()
    before = run.replay.state(50)
    run._change()
    assert all(np.array_equal(part, before[name]) for name, part in run.replay.state(50).items())
