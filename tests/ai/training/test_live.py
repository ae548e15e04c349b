import pickle
from dataclasses import fields
from itertools import chain, islice, pairwise

import numpy as np
import pytest

from ai.files.folder import STATE_FILE
from ai.lander.environment import Outcome
from ai.nn import ModelFormatError
from ai.training import run as keeping
from ai.training.config import Config, gym_config
from ai.training.history import REVERTED, Checkpoint, History, SettingChange, Validation
from ai.training.lander_session import LanderSession
from ai.training.loop import PARTS, Progress, Training
from ai.training.messages import NetworkState, Refused, RunStarted, Saved, SwarmState
from ai.training.run import resume
from ai.training.tasks import LanderTask

TINY = Config(
    hidden=(8,), num_envs=32, learning_starts=64, batch_size=16, gradient_steps=1, replay_size=2000, spawn="near"
)


@pytest.fixture
def begin():
    """Begins runs, and closes them."""
    begun = []

    def begin(config=TINY, seed=0, **options):
        begun.append(LanderSession.live(config, seed, **options))
        return begun[-1]

    yield begin
    for each in begun:
        each.close()


def all_the_time(monkeypatch):
    """Let runs keep themselves as often as they can."""
    for name, value in {"FIRST_SECONDS": 0.0, "KEEP_SECONDS": 0.0, "SHARE": np.inf, "PACE": np.inf}.items():
        monkeypatch.setattr(keeping, name, value)


def messages_in(run, turns):
    return [message for _ in range(turns) for message in next(run)]


def of(kind, messages):
    return [message for message in messages if isinstance(message, kind)]


def test_without_commands_it_is_the_training_it_would_be_headless(begin, tmp_path, monkeypatch):
    monkeypatch.setattr(LanderTask, "evaluate_every", 640)
    monkeypatch.setattr(LanderTask, "validation_episodes", 5)
    all_the_time(monkeypatch)
    run, headless = begin(TINY, 3, keep=tmp_path / "keep"), Training(TINY, 3)
    messages = messages_in(run, 1)
    scores = []
    for _ in range(50):
        messages += next(run)
        headless.advance()
        scores += [headless.evaluation] if headless.evaluation else []
    answer = run.send(("save", tmp_path / "run"))
    assert of(Saved, answer) == [Saved(tmp_path / "run")]
    saved = resume(Training, tmp_path / "run")
    assert headless.agent.gradient_steps > 0
    for network in ("online", "target"):
        assert np.array_equal(getattr(saved.agent, network).values, getattr(headless.agent, network).values)
    assert saved.best == headless.best is not None
    assert np.array_equal(saved.best_agent().network.values, headless.best_agent().network.values)
    tried = of(Validation, [*messages, *answer])
    assert [(each.success, each.mean_return) for each in tried] == [(each.success, each.mean_return) for each in scores]
    assert [each.decisions for each in tried] == [640, 1280]


def test_sights_and_points_tell_flights_as_they_were_and_can_be_sent_to_another_process(begin):
    run = begin()
    messages = messages_in(run, 200)
    for message in [*messages[:300], *run.send(("change", "discount", 0.9)), *run.send(("change", "nope", 1))]:
        assert type(pickle.loads(pickle.dumps(message))) is type(message)
    sights = of(SwarmState, messages)
    assert [sight.decisions for sight in sights] == [32 * number for number in range(200)]
    for before, sight in pairwise(sights):
        assert sight.position.shape == (32, 2)
        assert {part.dtype for part in (sight.position, sight.angle)} == {np.dtype(np.float32)}
        assert sight.action.dtype == sight.outcome.dtype == np.int8
        goes_on = before.outcome == Outcome.FLYING
        # No lander moves further than that in 1/15 s: those whose flight has ended are still where it did.
        assert (np.abs(sight.position - before.position)[goes_on] < 1.5).all()
    points = of(Progress, messages)
    assert (np.diff([point.decisions for point in points]) == 256).all()
    last = points[-1]
    assert last.episodes > 10
    assert sum(last.parts) == pytest.approx(last.mean_return, abs=1e-3)
    assert len(last.parts) == len(PARTS)
    assert last.success_rate + last.crashed + last.out_of_bounds + last.timed_out == pytest.approx(1.0)
    ended = np.concatenate([sight.outcome[sight.outcome != 0] for sight in sights])[: int(last.episodes)][-100:]
    assert last.crashed == pytest.approx((ended == Outcome.CRASHED).mean(), abs=0.05)


def test_checkpoints_come_by_decisions_and_fly_as_the_run_did(begin):
    config = TINY.changed(normalise_inputs=True)
    run = begin(config)
    begins = next(run)
    assert of(RunStarted, begins) == [RunStarted(config, 0, 0)]
    assert len(of(SwarmState, begins)) == len(of(NetworkState, begins)) == 1
    first, second = of(Checkpoint, [*begins, *messages_in(run, 89)])
    assert (first.decisions, first.seconds, second.decisions) == (0, 0.0, 2528)
    training = Training(config, 0, evaluate_every=0)
    while training.agent.decisions < 2528:
        training.advance()
    agent = second.agent(training.config)
    assert np.array_equal(agent.q_values(training.observation), training.agent.q_values(training.observation))
    with pytest.raises(ValueError, match="parameters"):
        second.agent(TINY.changed(hidden=(9,)))


REFUSED = [
    ("no_such_knob", 1, "no setting"), ("", 1, "no setting"), ("reward_weights.charm", 1.0, "no setting"),
    ("discount.time", 1.0, "no setting"), ("hidden", (4,), "cannot change"), ("num_envs", 4, "cannot change"),
    ("learning_rate", 1e9, "between"), ("learning_rate", float("nan"), "finite"),
    ("learning_rate", "fast", "finite"), ("batch_size", 2.5, "whole"), ("double", 1, "true nor false"),
    ("reward_weights.time", float("inf"), "finite"), ("reward_weights.time", None, "finite"),
    ("reward_weights", 3, "no table"),
]  # fmt: skip


def test_what_cannot_be_changed_is_refused_and_nothing_else_happens(begin):
    run, quiet = begin(), begin()
    messages_in(run, 10)
    for name, value, words in REFUSED:
        (answer,) = run.send(("change", name, value))
        assert isinstance(answer, Refused), (name, value)
        assert words in answer.problem
    assert not of(SettingChange, messages_in(quiet, 10))
    actual, expected = of(SwarmState, messages_in(run, 30))[-1], of(SwarmState, messages_in(quiet, 30))[-1]
    assert np.array_equal(actual.position, expected.position)


def test_every_live_knob_reaches_the_agent(begin):
    run, learnt = begin(), 0
    for knob in fields(Config):
        if not knob.metadata["live"] or knob.name == "reward_weights":
            continue
        now, described = getattr(run.training.config, knob.name), knob.metadata
        ends = [type(now)(described[end] or 0) for end in ("low", "high")]
        values = described["choices"] or ((not now,) if isinstance(now, bool) else ends)
        value = next(each for each in values if each != now)
        assert not of(Refused, run.send(("change", knob.name, value))), knob.name
        assert getattr(run.training.agent.config, knob.name) == value
        learnt += 1
    assert learnt > 20


def test_turned_weights_pay_in_the_run_that_goes_on(begin):
    run = begin(TINY.changed(spawn="fixed"))
    messages_in(run, 20)
    run.send(("change", "reward_weights.time", -100.0))
    earned = run.training.statistics.earned
    before = earned.copy()
    next(run)
    assert ((earned - before) < -300).all()  # four physics steps


def test_it_goes_back_to_a_checkpoint_and_time_goes_on(begin):
    run = begin()
    messages = messages_in(run, 120)
    first, second = of(Checkpoint, messages)
    answer = run.send(("restore", second.decisions + 5))
    assert of(SettingChange, answer) == [SettingChange(119 * 32, REVERTED, None, second.decisions)]
    assert np.array_equal(of(NetworkState, answer)[0].values, second.values)
    answer = run.send(("restore", 0))
    assert np.array_equal(of(NetworkState, answer)[0].values, first.values)
    assert of(SwarmState, next(run))[0].decisions == 120 * 32


def test_a_run_that_is_closed_has_kept_itself(begin, tmp_path):
    run = begin(TINY, keep=tmp_path / "keep", clock=Clock())  # no time passes, so it was not kept before
    messages_in(run, 50)
    assert not (tmp_path / "keep").exists()
    run.close()
    assert resume(Training, tmp_path / "keep").agent.decisions == 49 * 32
    unused = begin(TINY, keep=tmp_path / "unused")
    next(unused)
    unused.close()
    assert not (tmp_path / "unused").exists()


def test_it_keeps_itself_by_the_clock(tmp_path):
    training = Training(TINY)
    training.clock = clock = Clock()
    saving = keeping.Keeper(training, tmp_path / "keep", History())
    for seconds, kept in ((1.4, 0), (0.2, 2), (9.9, 2), (0.2, 4)):
        clock.now += seconds
        training.advance()
        assert saving.go_on(clock.now) == []
        saving.wait()
        assert (tmp_path / "keep").exists() == bool(kept)
        assert not kept or resume(Training, tmp_path / "keep").agent.decisions == 32 * kept
    saving.end()


def full(*_):
    raise OSError(28, "No space left on device")


def test_a_full_disk_is_reported_once_and_training_goes_on(begin, tmp_path, monkeypatch):
    all_the_time(monkeypatch)
    run = begin(TINY, keep=tmp_path / "keep")
    messages_in(run, 10)
    assert of(Saved, run.send(("save", tmp_path / "run"))) == [Saved(tmp_path / "run")]
    monkeypatch.setattr(History, "write", full)
    assert of(Saved, run.send(("save", tmp_path / "run"))) == [Saved(tmp_path / "run", "No space left on device")]
    assert resume(Training, tmp_path / "run").agent.decisions == 9 * 32  # what was there before is whole
    messages = []
    while not of(Saved, messages):  # a thread writes, as fast as the disk is
        messages += next(run)
    messages += messages_in(run, 20)
    assert of(Saved, messages) == [Saved(tmp_path / "keep", "No space left on device")]
    turns = len(of(SwarmState, messages))
    assert turns > 20
    monkeypatch.undo()
    run.close()
    assert resume(Training, tmp_path / "keep").agent.decisions == (9 + turns) * 32


def test_numbers_that_run_away_stop_the_run_and_the_last_good_network_is_kept(begin, tmp_path):
    run = begin(TINY, keep=tmp_path / "keep")
    messages = messages_in(run, 90)
    run.training.agent.replay.transitions.reward[:] = np.nan
    with pytest.raises(FloatingPointError, match=r"learning step \d+; most likely the learning rate of 0.0"):
        messages.extend(chain.from_iterable(islice(run, 200)))
    good = of(Checkpoint, messages)[-1]
    assert good.decisions > 0
    kept = resume(Training, tmp_path / "keep")
    assert np.array_equal(kept.agent.network.values, good.values)
    assert History.read(tmp_path / "keep").checkpoints[-1].decisions == good.decisions
    again = begin(TINY, resume=tmp_path / "keep")
    assert of(Progress, messages_in(again, 30))


def test_there_must_be_a_run_to_go_on_with_and_it_must_be_of_landers(begin, tmp_path):
    with pytest.raises(ModelFormatError):
        next(begin(resume=tmp_path / "nothing"))
    pytest.importorskip("gymnasium")
    with pytest.raises(ValueError, match="CartPole"):
        next(begin(gym_config("CartPole-v1")))


def test_a_run_that_goes_on_goes_on_with_its_curves_and_learns_at_once(begin, tmp_path):
    run = begin(seed=3)
    messages_in(run, 103)
    run.send(("save", tmp_path / "run"))
    again = begin(resume=tmp_path / "run")
    (started,) = of(RunStarted, next(again))
    assert (started.lost, started.decisions) == ("", 102 * 32)
    points = of(Progress, messages_in(again, 40))
    assert points[0].decisions == 103 * 32
    assert np.isfinite([points[0].loss, points[0].mean_q]).all(), "its memory is there"
    assert np.isnan(points[0].success_rate), "none of its new flights has ended"
    again.send(("save", tmp_path / "again"))
    history = History.read(tmp_path / "again")
    assert (np.diff(history["decisions"]) > 0).all()
    assert history["decisions"][-1] == points[-1].decisions


def test_without_its_state_a_run_goes_on_and_draws_no_spike(begin, tmp_path):
    run = begin()
    before = of(Progress, messages_in(run, 150))
    assert np.isnan(before[0].mean_return), "no flight had ended"
    assert np.isnan(before[0].loss)
    assert before[-1].mean_return < -50
    run.send(("save", tmp_path / "run"))
    (tmp_path / "run" / STATE_FILE).unlink()
    messages = messages_in(begin(resume=tmp_path / "run"), 60)
    assert "empty memory" in of(RunStarted, messages)[0].lost
    after = of(Progress, messages)
    assert after[0].mean_return != 0.0, "of the hundred flights before"
    assert np.isnan([after[0].loss, after[0].mean_q]).all(), "it has not learnt since"
    assert np.isfinite([after[-1].loss, after[-1].mean_q]).all()


class Clock:
    now = 100.0

    def __call__(self):
        return self.now
