"""What anybody's environment may do to a run: it is named in a line, or does no harm."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from ai.agent.normalizer import Normalizer
from ai.agent.storage import LAST
from ai.cli.command_line import stoppable
from ai.environment import ForeignEnvError, finished
from ai.training.config import gym_config, load_agent
from ai.training.gym_task import AT_ONCE, GymScore, GymTask
from ai.training.loop import Training
from ai.training.run import resume
from main import main

pytest.importorskip("gymnasium")
from tests.support import odd_environments as odd

MODULE = "tests.support.odd_environments"
ROOT = Path(__file__).parents[3]
QUICK = {"num_envs": 4, "learning_starts": 64, "hidden": (8,), "gradient_steps": 1, "epsilon_decisions": 500}


def name(kind):
    return f"{MODULE}:odd/{kind}-v0"


def config(kind, **changes):
    return gym_config(name(kind)).changed(**(QUICK | changes))


@pytest.fixture(autouse=True)
def _all_closed():
    odd.OPEN.clear()
    odd.Odd.most_open = 0
    yield
    assert odd.OPEN == []


def trained(kind, turns=60, **changes):
    training = Training(config(kind, **changes), evaluate_every=0, validation_episodes=4)
    try:
        for _ in range(turns):
            training.advance()
        score = training.evaluate()
    finally:
        training.close()
    return training, score


SOUND = (
    "Odd", "Far", "Tiny", "Huge", "FarAndFine", "Typed", "PaysArrays", "PaysOneNumber", "StartsAtOne", "Numbered",
    "Numpys", "Pixels", "Lists", "Scalar", "CannotClose", "Truncates",
)  # fmt: skip
AT_ONCE_WRONG = {
    "OldReset": r"reset returns an array of float64 of shape \[2\], and should return an observation and a dict",
    "WrongShape": r"environment 0: reset observes an array of float64 of shape \[3\], and its space is Box",
    "OneForTwo": r"environment 0: reset observes an array of float64 of shape \[1\], and its space is Box",
    "TextSeen": r'environment 0: reset observes "?\'?a door',
    "ResetCrashes": "reset raised ZeroDivisionError: division by zero$",
    "NoSeed": "reset raised TypeError",
    "CannotBeMade": "cannot be made: FileNotFoundError: .*No such file",
}
LATER_WRONG = {
    "NanSeen": r"environment \d: its observation is nan at place 1, and no finite number",
    "InfiniteSeen": r"environment \d: its observation is inf at place 0",
    "TooLargeSeen": r"environment \d: its observation is 1e\+300 at place 0",
    "NanPaid": r"environment \d: its reward is nan, and no finite number",
    "InfinitePaid": r"environment \d: its reward is -inf",
    "NonePaid": r"environment \d: its reward is null, and no number",
    "TextPaid": r"environment \d: its reward is '?\"?much",
    "TwoPaid": r"environment \d: its reward is a list of 2, and no number",
    "LoseConnection": "step raised ConnectionResetError: .*Connection reset by peer",
    "NoNumberOne": "step raised KeyError: 'x'",
    "Exits": "step raised SystemExit: 3",
    "OldStep": "step returns a tuple of 4, and should return observation, reward, terminated, truncated and info",
    "NothingBack": "step returns null, and should",
    "Shorter": r"step observes an array of float64 of shape \[1\], and its space is Box",
    "OneNumber": r"step observes 0\.5, and its space is Box",
    "Words": "step observes '?\"?left",
    "Objects": r"step observes an array of object of shape \[2\]",
    "Ragged": "step observes a list of 2",
    "OutOfSpace": r"step observes 7, and its space is Discrete\(4, start=-1\)",
    "HalfNumber": r"step observes 0\.5, and its space is Discrete",
}


def test_what_is_sound_is_trained_on_measured_and_closed(subtests):
    for kind in SOUND:
        with subtests.test(kind):
            training, score = trained(kind)
            assert training.agent.gradient_steps > 0
            assert np.isfinite(training.agent.online.values).all()
            assert (score.episodes, score.mean_length, score.cut) == (4, 20, 0)
            assert odd.OPEN == []


def test_what_is_wrong_is_named_where_it_comes_in_and_everything_is_closed(subtests):
    for kind, said in (AT_ONCE_WRONG | LATER_WRONG).items():
        with subtests.test(kind), pytest.raises(ForeignEnvError, match=said) as raised:
            trained(kind)
        assert name(kind) in str(raised.value)
        assert "\n" not in str(raised.value)
        assert odd.OPEN == []


def test_spaces_that_q_learning_has_no_use_for_are_refused(subtests):
    for kind in ("Dicts", "Tuples", "Texts", "Pushes", "Switches"):
        with (
            subtests.test(kind),
            pytest.raises(ValueError, match="a Box or Discrete observations, and Discrete actions"),
        ):
            trained(kind)


def test_a_numbered_observation_becomes_one_1_among_0s():
    env = GymTask(config("Numbered")).make_env(np.random.default_rng(0))
    seen = env.reset()
    env.close()
    assert seen.shape == (4, 4)
    assert np.array_equal(seen.sum(axis=1), np.ones(4))
    assert set(seen.argmax(axis=1)) <= {0, 1}


def learnt(kind):
    training = Training(config(kind, learning_rate=0.01, epsilon_spread=0.0), evaluate_every=0, validation_episodes=20)
    for _ in range(500):
        training.advance()
    score = training.evaluate()
    training.close()
    return score.mean_return / 20


@pytest.mark.parametrize("kind", ["Odd", "Far", "Huge", "FarAndFine", "Numbered"])
def test_what_tells_two_actions_apart_is_learnt_in_any_unit(kind):
    assert learnt(kind) > 0.95


def test_a_scale_is_the_same_wherever_zero_is_and_whatever_the_unit_and_what_is_constant_stays_0():
    plain = np.random.default_rng(0).normal(size=(50, 3)) * [1.0, 1.0, 0.0]
    scales = []
    for offset, unit in ((0.0, 1.0), (1e8, 1.0), (0.0, 1e-8), (-3e5, 1e-2), (0.0, 1e25)):
        seen, normalizer = offset + unit * plain, Normalizer(3)
        normalizer.begin(seen)
        normalizer.update(normalizer.measured(seen))
        scales.append(normalizer(seen))
        again = Normalizer(3)
        again.load(json.loads(json.dumps(normalizer.to_json())))
        assert np.array_equal(again(seen), scales[-1])
    for scaled in scales:
        np.testing.assert_allclose(scaled, scales[0], atol=1e-5)
    np.testing.assert_allclose(scales[0].std(axis=0), [1, 1, 0], atol=1e-5)


def test_an_episode_without_end_is_cut_and_the_score_says_so(monkeypatch):
    monkeypatch.setattr("ai.training.gym_task.LIMIT", 50)
    _, score = trained("Endless", 10)
    assert (score.cut, score.limit, score.mean_length) == (4, 50, 50)
    assert "4 of them ended after 50 steps" in str(score)
    _, score = trained("Endless", 10, env_arguments='{"max_episode_steps": 30}')
    assert (score.cut, score.limit, score.mean_length) == (0, 30, 30), "as whoever asks for it wants"
    _, score = trained("Odd", 10)
    assert score.cut == 0
    assert "ended after" not in str(score)


def test_a_measurement_opens_sixteen_at_once_and_each_episode_is_of_its_own_seed():
    task = GymTask(config("Odd"))

    class Blind:
        def act(self, observation, held=None):
            return np.zeros(len(observation), int)

    odd.Odd.most_open = 0
    score = finished(task.trial(Blind(), 40, 3))
    assert odd.Odd.most_open == AT_ONCE
    assert score.episodes == 40
    alone = [finished(task.trial(Blind(), count, 3)).mean_return * count for count in (1, 2, 40)]
    assert alone[2] == score.mean_return * 40
    assert 0 <= alone[1] - alone[0] <= 20


def test_a_decision_is_held_as_in_training_unless_asked_otherwise_and_the_score_says_how_long():
    task = GymTask(config("Odd", frame_skip=4))
    pilot = Training(config("Odd", frame_skip=4), evaluate_every=0)
    scores = [finished(task.trial(pilot.agent, 2, 0))]
    trial = task.trial(pilot.agent, 2, 0, 1)
    while len(scores) == 1:
        try:
            next(trial)
        except StopIteration as done:
            scores.append(done.value)
    pilot.close()
    assert [(score.frame_skip, score.mean_length) for score in scores] == [(4, 5), (1, 20)]


def test_a_nan_is_never_the_best():
    good, bad = (GymScore(4, None, value, 20.0, 0, 1000, 1) for value in (1.0, float("nan")))
    assert good.better_than(bad)
    assert not bad.better_than(good)
    assert not bad.better_than(None)


def test_training_keeps_what_there_was_before_an_environment_failed_and_goes_on_from_there(tmp_path, capsys):
    out, sets = tmp_path / "run", ["--set=num_envs=4", "--set=hidden=[8]", "--set=learning_starts=64"]
    for kind, said in (("LoseConnection", "ConnectionResetError"), ("NanSeen", "is nan at place 1")):
        command = ["train", "--env", name(kind), "--decisions", "4000", "--output", str(out), "--replace", *sets]
        assert main(command) == 1
        error = capsys.readouterr().err
        assert error.count("\n") == 1
        assert said in error
        assert "learning rate" not in error
        assert "could not write" not in error
        assert str(out) in error
        agent, _ = load_agent(out / LAST, env=name(kind))
        assert agent.decisions == 29 * 4
        again = resume(Training, out, env=name(kind))
        assert len(again.agent.replay) > 0
        again.close()
        for path in out.rglob("*.json"):
            json.loads(path.read_text(), parse_constant=pytest.fail)


def test_where_an_environments_error_comes_from_is_in_a_log(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("ai.files.folder.user_dir", lambda: tmp_path / "user")
    command = ["train", "--env", name("ResetCrashes"), "--seconds", "1", "--output", str(tmp_path / "run")]
    assert main(command) == 1
    assert "environment.log" in capsys.readouterr().err
    assert (
        "return 1 / 0" in (tmp_path / "user" / "environment.log").read_text()
        or "ZeroDivisionError" in (tmp_path / "user" / "environment.log").read_text()
    )


def test_names_that_are_no_environments_are_refused_in_a_sentence(tmp_path, capsys, subtests):
    with pytest.raises(ValueError, match=r"\.\./\.\./x is no name of a module"):
        Training(gym_config("../../x:Y"))
    for env in ("../../x:Y", "nowhere_at_all:Y-v0", "..:Y", ":", "a:b:c", "os:Y-v0", "Nowhere-v0", "x y", "-v0", "/:/"):
        with subtests.test(env):
            assert main(["train", f"--env={env}", "--seconds", "1", "--output", str(tmp_path / "run")]) == 1
            error = capsys.readouterr().err
            assert error.count("\n") == 1
            assert "Traceback" not in error


def test_arguments_of_an_environment_are_given_kept_and_evaluated_with(tmp_path, capsys):
    out = str(tmp_path / "run")
    sets = ["--set=num_envs=2", "--set=hidden=[8]", "--validation", "2"]
    command = ["train", "--env", name("Odd"), "--env-set", "length=7", "--decisions", "40", "--output", out, *sets]
    assert main(command) == 0
    capsys.readouterr()
    assert main(["evaluate", "--model", out, "--env", name("Odd"), "--episodes", "3", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["mean_length"] == 7
    assert main(["train", "--env", name("Odd"), "--env-set", "wide=7", "--seconds", "1", "--output", out]) == 1
    assert "wide" in capsys.readouterr().err
    assert main(["train", "--env", name("Odd"), "--env-set", "wide", "--seconds", "1", "--output", out]) == 1
    assert "--env-set takes NAME=VALUE" in capsys.readouterr().err


def test_a_memory_larger_than_the_machines_is_refused_by_the_settings_name():
    with pytest.raises(ValueError, match=r"replay_size: 1,000,000 memories of 4,000,000 numbers each take"):
        trained("Vast", hidden=(1,))


def test_a_validation_hears_a_stop_between_two_decisions():
    training, asked = Training(config("Endless"), evaluate_every=8, validation_episodes=4), iter(range(10))
    training.stopping = lambda: next(asked) >= 5
    for _ in range(2):
        training.advance()
        assert training.evaluation is None
    assert next(asked) == 6
    training.close()


def test_whoever_asks_five_times_ends_even_what_never_comes_back():
    with stoppable() as stop:
        for _ in range(4):
            signal.raise_signal(signal.SIGTERM)
        assert stop == [signal.SIGTERM] * 4
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.skipif(os.name == "nt", reason="signals of another kind")
def test_a_signal_in_the_midst_of_a_validation_ends_a_run_that_is_kept(tmp_path, number):
    code = (
        "import sys; from ai.training.gym_task import GymTask as T\n"
        "T.evaluate_every, T.validation_episodes = 64, 50000\n"
        "T.test_episodes = 2; from main import main; sys.exit(main(sys.argv[1:]))"
    )
    command = ["train", "--env", name("Endless"), "--decisions", "100000", "--output", str(tmp_path / "run")]
    run = [sys.executable, "-c", code, *command]
    child = subprocess.Popen(run, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    threading.Timer(8.0, lambda: child.send_signal(number)).start()
    threading.Timer(10.0, lambda: child.send_signal(number)).start()  # and the measurement that follows
    began = time.monotonic()
    child.wait(60)
    assert time.monotonic() - began < 30
    assert load_agent(tmp_path / "run", env=name("Endless"))[0].decisions > 0
    assert child.returncode in (0, 128 + number)
