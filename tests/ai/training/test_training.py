import json
from dataclasses import replace
from itertools import count, islice

import numpy as np
import pytest

from ai.agent.schedule import linear
from ai.environment import finished
from ai.files.schema import read_as
from ai.lander.environment import LIMITS, LanderEnv, Outcome
from ai.lander.pilots import NoPilot, ScriptedPilot
from ai.training.config import PRESETS, Config
from ai.training.loop import Training, run
from ai.training.run import Limit, save
from ai.training.statistics import wilson
from ai.training.tasks import Evaluation, LanderTask, flights

SMALL = PRESETS["modern"].changed(
    hidden=(16,), batch_size=16, gradient_steps=1, learning_starts=32, replay_size=2000, num_envs=8, spawn="near"
)
QUICK = {"evaluate_every": 0, "validation_episodes": 4}


def advanced(config=SMALL, decisions=30, **options):
    training = Training(config, 0, **(QUICK | options))
    for _ in range(decisions):
        progress = training.advance()
    return training, progress


def test_evaluating_changes_nothing_about_the_training():
    quiet, _ = advanced(SMALL, 40)
    measured, _ = advanced(SMALL, 40, evaluate_every=80)
    assert np.array_equal(quiet.agent.online.values, measured.agent.online.values)
    assert measured.best is not None


def test_progress_counts_what_happened():
    training = Training(SMALL, 0, **QUICK)
    training.clock = map(float, count(0, 0.5)).__next__
    assert isinstance(training.env, LanderEnv)
    for _ in range(80):
        progress = training.advance()
        assert not training._held[training.env.steps == 0].any(), "a new flight holds no action yet"
    assert progress.steps_per_second == 8 * 4 / 0.5, "by the clock it is given"
    assert (progress.decisions, progress.steps) == (80 * 8, 80 * 8 * 4)
    assert progress.updates == training.agent.gradient_steps
    assert progress.episodes == training.episodes > 0
    assert 0.0 <= progress.success_rate <= 1.0
    assert progress.epsilon == pytest.approx(linear(1.0, 0.05, 80 * 8, SMALL.epsilon_decisions))


def test_a_run_is_a_generator_that_takes_live_knobs():
    training, progress = advanced(SMALL, 20)
    running = run(SMALL, 0, **QUICK)
    *_, last = islice(running, 20)
    assert (last.decisions, last.loss) == (progress.decisions, progress.loss)
    changed = SMALL.changed(learning_rate=1e-4)
    training.apply_live(changed)
    assert running.send(changed).loss == training.advance().loss
    assert next(running).loss == training.advance().loss


def test_what_was_paid_otherwise_is_forgotten():
    for prioritised in (False, True):
        training, _ = advanced(SMALL.changed(prioritised=prioritised), 30)
        training.apply_live(training.config.changed(learning_rate=1e-4))
        assert len(training.agent.replay) > 100
        training.apply_live(training.config.turned("reward_weights.time", 5.0))
        assert len(training.agent.replay) == 0
        for _ in range(20):
            progress = training.advance()
        assert np.isfinite(progress.loss)
        assert 0 < len(training.agent.replay) <= (20 + SMALL.n_step) * 8  # and what was open


def test_a_change_of_what_cannot_change_while_a_run_goes_on_changes_nothing():
    training, _ = advanced(decisions=2)
    training.apply_live(SMALL.changed(hidden=(3,), num_envs=2, n_step=3, gradient_steps=3, discount=0.9))
    assert training.config == training.agent.config == SMALL.changed(gradient_steps=3, discount=0.9)
    assert training.agent.n_step.discount == 0.9
    assert training.advance().decisions == 24


def test_evaluation_shares_add_up_and_the_pilot_is_asked_for_living_slots_only():
    result = finished(flights(NoPilot(), 8, 0))
    assert result.success == 0.0
    assert result.crash + result.out_of_bounds + result.time_out == 1.0
    assert result.switches == 0.0
    assert result.mean_time is None
    assert finished(flights(ScriptedPilot(), 6, 3, "near")) == finished(flights(ScriptedPilot(), 6, 3, "near"))


@pytest.mark.slow
def test_who_is_taught_hard_starts_is_chosen_by_them_too():
    pilot = ScriptedPilot()
    tasks = (LanderTask(Config(spawn=spawn)) for spawn in ("widening", "thorough"))
    taught, other = (finished(task.trial(pilot, 12, 3)) for task in tasks)
    assert other == finished(flights(pilot, 12, 3, "random"))
    assert replace(taught, hard=None) == other, "what is reported of random starts is of those alone"
    nothing = finished(LanderTask(Config(spawn="widening")).trial(NoPilot(), 2, 3))
    assert taught.hard
    assert taught.hard > 0.5
    assert nothing.hard == nothing.success == 0.0
    assert read_as(LanderTask.score, taught.to_json()) == taught


def test_more_landings_count_before_quicker_ones_where_hard_starts_were_flown():
    quick = Evaluation(500, 0.998, 0.002, 0.0, 0.0, 260.0, 7.0, 3.0, 8.0, hard=0.99)
    sure = replace(quick, success=1.0, crash=0.0, mean_return=220.0, mean_time=9.0)
    assert sure.better_than(quick)
    assert not quick.better_than(sure)
    assert replace(sure, mean_return=221.0).better_than(sure)
    assert quick.better_than(replace(sure, hard=0.986))
    assert quick.better_than(replace(sure, hard=None)), "as runs were compared that flew no hard starts"
    assert not replace(sure, hard=None).better_than(quick)


def test_the_best_checkpoint_is_kept_as_it_was_while_training_goes_on():
    training, _ = advanced(SMALL.changed(normalise_inputs=True))
    training.evaluate()
    kept, scale = training.best_network[0].copy(), training.best_network[1].to_json()
    assert not Evaluation(4, 0.0, 1.0, 0.0, 0.0, -1e9, 1.0, 1.0, 1.0).better_than(training.best)
    training.best = Evaluation(4, 1.0, 0.0, 0.0, 0.0, 1e9, 1.0, 1.0, 1.0)
    for _ in range(5):
        training.advance()
    training.evaluate()
    assert np.array_equal(training.best_network[0], kept)
    assert training.best_network[1].to_json() == scale != training.agent.normalizer.to_json()
    assert np.array_equal(training.best_agent().network.values, kept)


def test_a_run_is_kept_with_what_it_is(tmp_path, monkeypatch):
    monkeypatch.setattr(LanderTask, "test_episodes", 5)
    training, _ = advanced()
    training.seconds = 12.0
    save(training, tmp_path / "run", final=True, state=False)
    described = json.loads((tmp_path / "run" / "training.json").read_text())
    assert described["decisions"] == 240
    assert described["preset"] == "modern"
    assert Config.from_json(PRESETS["modern"].to_json() | described["changes"]) == SMALL
    assert described["evaluation"]["episodes"] == 5


def test_a_run_stops_at_the_decisions_or_seconds_asked_for_whichever_comes_first():
    for limit, decisions, seconds in (
        (Limit(moment=80), 80, 10.0),
        (Limit(seconds=5.0, moment=800), 40, 5.0),
        (Limit(seconds=500.0, moment=40), 40, 5.0),
    ):
        training = Training(SMALL, 0, **QUICK)
        training.clock = map(float, count()).__next__
        assert [progress.decisions for progress in limit.run(training)][-1] == decisions
        assert limit.share(training) == 1.0
        assert training.seconds == seconds, "a step looks at the clock twice"


def test_a_curriculum_run_climbs_its_stages():
    training, _ = advanced(SMALL.changed(spawn="curriculum"), 1)
    training.env.landings = 300
    training.env.reset()
    assert isinstance(training.env, LanderEnv)
    assert training.advance().stage == 3
    assert (training.env.outcome == Outcome.FLYING).all()


def test_care_sets_in_over_the_horizon():
    training = Training(SMALL.changed(final_touchdown_limits=0.5, schedule_decisions=1000), evaluate_every=0)
    assert isinstance(training.env, LanderEnv)
    held = []
    for _ in range(127):
        held.append(training.env.limits.touch_speed / LIMITS.touch_speed)
        training.advance()
    np.testing.assert_allclose(held, [1.0, *np.maximum(0.5, 1 - 0.5 * np.arange(126) * 8 / 1000)])


def test_an_interval_holds_the_share_and_shrinks_with_the_number_of_trials():
    assert wilson(0.0, 20) == pytest.approx((0.0, 0.1611), abs=1e-4)
    assert wilson(1.0, 20) == pytest.approx((0.8389, 1.0), abs=1e-4)
    assert wilson(0.5, 100) == pytest.approx((0.4038, 0.5962), abs=1e-4)
