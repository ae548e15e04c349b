import json
import shlex
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import ai.training.loop
import ai.training.run
from ai.agent.agent import DeepQAgent
from ai.cli.command_line import configured, stoppable
from ai.environment import finished
from ai.training.config import PRESETS
from ai.training.loop import Training
from ai.training.messages import Saved
from ai.training.tasks import VALIDATION_SEED, Evaluation, LanderTask, flights
from game.core.assets import MODELS_DIR
from main import main

ROOT = Path(__file__).parents[3]
SMALL = [
    f"--set={change}"
    for change in ("num_envs=8", "hidden=[8]", "batch_size=16", "learning_starts=32", "gradient_steps=1")
]


@pytest.fixture(autouse=True)
def _measured_quickly(monkeypatch):
    monkeypatch.setattr(LanderTask, "test_episodes", 4)


def test_evaluate_flies_as_the_network_was_trained_and_prints_an_interval_around_the_share(capsys):
    model = MODELS_DIR / "lander" / "modern"
    assert main(["evaluate", "--model", str(model), "--episodes", "10", "--seed", "3", "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    low, high = values.pop("success_interval")
    assert low < values["success"] <= high
    assert values == finished(flights(DeepQAgent.load(model), 10, 3)).to_json()
    assert main(["evaluate", "--model", str(model), "--episodes", "10", "--seed", "3"]) == 0
    assert f"(95%: {low:.2%} to {high:.2%})" in capsys.readouterr().out


def test_train_evaluate_resume(tmp_path, capsys):
    run = str(tmp_path / "run")
    assert main(["train", "--decisions", "400", "--output", run, "--validation", "4", *SMALL]) == 0
    assert run in capsys.readouterr().out
    assert main(["evaluate", "--model", run, "--episodes", "4", "--seed", "3", "--json"]) == 0
    measured = json.loads(capsys.readouterr().out)
    shares = [measured[name] for name in ("success", "crash", "out_of_bounds", "time_out")]
    assert sum(shares) == pytest.approx(1.0)
    assert {"mean_return", "mean_time", "mean_fuel", "episodes"} <= set(measured)
    assert main(["train", "--decisions", "800", "--resume", run, "--validation", "4"]) == 0
    assert json.loads((tmp_path / "run" / "training.json").read_text())["decisions"] == 800
    assert main(["evaluate", "--model", run, "--episodes", "2"]) == 0
    assert "success" in capsys.readouterr().out


def test_a_run_is_paid_by_a_file_of_ones_own(tmp_path, capsys):
    pay, run = tmp_path / "pay.py", tmp_path / "run"
    pay.write_text("def pay(before, action, after):\n    return 3.0 * (after.steps - before.steps)")
    command = ["train", "--decisions", "400", "--validation", "4", *SMALL, "--pay", str(pay)]
    assert main([*command, "--output", str(run)]) == 0
    pay.write_text("def pay(before, action, after):\n    return 1 / 0")
    assert main([*command, "--output", str(tmp_path / "another")]) == 1
    assert "line 2: ZeroDivisionError" in capsys.readouterr().err
    assert main([*command, "--output", str(tmp_path / "another"), "--env", "CartPole-v1"]) == 1
    assert "--pay is for landers" in capsys.readouterr().err


def test_what_cannot_be_done_is_said_in_a_line(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for arguments, message in [
        ("train --seconds 1", "--output"),
        ("train --output x", "when to stop"),
        ("train --output x --seconds 1 --preset magic", "--preset is one of"),
        ("train --output x --seconds 1 --set warp=9", "warp=9"),
        ("train --output x --seconds 1 --set n_step=0", "n_step lies between"),
        ("train --resume nowhere --seconds 1", "nowhere"),
        ("evaluate --model nowhere --episodes 0", "--episodes"),
        ("evaluate --model nowhere --spawn mars", "--spawn is one of"),
        ("train-digits", "--output"),
        ("train-digits --output x --epochs 0", "epochs lies between"),
        ("evaluate-digits --model nowhere", "nowhere"),
    ]:
        assert main(arguments.split()) == 1, arguments
        stderr = capsys.readouterr().err
        assert message in stderr
        assert "Traceback" not in stderr
        assert not list(tmp_path.iterdir()), arguments


ENDINGS = [("SIGINT", 0), ("SIGTERM", 128 + 15), ("SIGHUP", 128 + 1)]


@pytest.fixture
def heard():
    """Signals that end a run; those that the tests were asked to ignore, as under nohup, are heard again."""
    numbers = [getattr(signal, name) for name, _ in ENDINGS if hasattr(signal, name)]
    before = {number: signal.getsignal(number) for number in numbers}
    for number, handler in before.items():
        if handler is signal.SIG_IGN:
            signal.signal(number, signal.SIG_DFL)
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.usefixtures("heard")
@pytest.mark.parametrize(("name", "code"), [ending for ending in ENDINGS if hasattr(signal, ending[0])])
def test_whoever_ends_a_run_by_a_signal_keeps_the_work(tmp_path, name, code, capsys, monkeypatch):
    advance, before = Training.advance, signal.getsignal(getattr(signal, name))

    def signalled(training):
        if training.agent.decisions == 160:
            signal.raise_signal(getattr(signal, name))
        return advance(training)

    monkeypatch.setattr(Training, "advance", signalled)
    run = str(tmp_path / "run")
    assert main(["train", "--seconds", "600", "--output", run, "--validation", "4", *SMALL]) == code
    assert "kept in" in capsys.readouterr().out
    described = json.loads((tmp_path / "run" / "training.json").read_text())
    assert described["decisions"] == 168
    assert described["best"]["episodes"] == 4, "what is kept is measured"
    assert (tmp_path / "run" / "last" / "config.json").exists()
    assert signal.getsignal(getattr(signal, name)) == before


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="there is no such signal")
@pytest.mark.usefixtures("heard")
def test_a_hang_up_that_is_ignored_as_under_nohup_ends_no_run():
    for handler, collected in ((signal.SIG_IGN, []), (signal.SIG_DFL, [signal.SIGHUP])):
        signal.signal(signal.SIGHUP, handler)
        with stoppable() as stop:
            signal.raise_signal(signal.SIGHUP)
        assert stop == collected
        assert signal.getsignal(signal.SIGHUP) is handler


def test_the_network_of_the_last_moment_stands_for_election_too(tmp_path, monkeypatch):
    measured = []

    def score(task, pilot, episodes, seed):
        measured.append((pilot.decisions, seed))
        yield
        return Evaluation(episodes, 0.0, 1.0, 0.0, 0.0, float(pilot.decisions), None, None, 0.0)

    monkeypatch.setattr(LanderTask, "trial", score)
    monkeypatch.setattr(LanderTask, "evaluate_every", 320)
    assert main(["train", "--decisions", "800", "--output", str(tmp_path / "run"), *SMALL]) == 0
    assert [decisions for decisions, seed in measured if seed == VALIDATION_SEED] == [320, 640, 800]
    last, best = DeepQAgent.load(tmp_path / "run" / "last"), DeepQAgent.load(tmp_path / "run")
    assert np.array_equal(best.network.values, last.network.values)
    measured.clear()
    assert main(["train", "--decisions", "1280", "--resume", str(tmp_path / "run")]) == 0
    # At the same moments as if it had never stopped, and the last one only once.
    assert [decisions for decisions, seed in measured if seed == VALIDATION_SEED] == [960, 1280]


def test_what_can_change_in_a_run_is_changed_when_it_is_resumed_and_the_rest_is_refused_by_name(tmp_path, capsys):
    run = tmp_path / "run"
    assert main(["train", "--decisions", "80", "--seed", "3", "--output", str(run), "--validation", "4", *SMALL]) == 0
    before = {file: file.read_bytes() for file in run.rglob("*") if file.is_file()}
    resume = ["train", "--resume", str(run), "--decisions", "160", "--validation", "4"]
    for changes, named in (
        (["--set", "hidden=[9]"], "hidden"),
        (["--set", "n_step=3", "--set", "gradient_steps=2"], "n_step"),
        (["--seed", "4"], "seed"),
        (["--preset", "classic"], "optimizer"),
        (["--env", "CartPole-v1"], "env"),
        (["--decisions", "80"], "whole run"),
        (["--set", "gradient_steps=0"], "gradient_steps lies"),
    ):
        assert main([*resume, *changes]) == 1
        stderr = capsys.readouterr().err
        assert named in stderr
        assert "epsilon_end" not in stderr, "that can change"
        assert before == {file: file.read_bytes() for file in run.rglob("*") if file.is_file()}
    assert main([*resume, "--set", "gradient_steps=2", "--set", "hidden=[8]", "--seed", "3", "--env", "lander"]) == 0
    agent = DeepQAgent.load(run / "last")
    assert (agent.config.gradient_steps, agent.config.hidden, agent.decisions) == (2, (8,), 160)
    assert json.loads((run / "training.json").read_text())["seed"] == 3


def full(*_, **__):
    raise OSError(28, "No space left on device")


def test_a_disk_that_is_full_for_a_while_ends_no_training(tmp_path, capsys, monkeypatch):
    failures = [[Saved(tmp_path / "run", "No space left on device")]]
    monkeypatch.setattr(ai.training.run.Keeper, "go_on", lambda keeper, now: failures.pop() if failures else [])
    assert main(["train", "--decisions", "240", "--output", str(tmp_path / "run"), "--validation", "4", *SMALL]) == 0
    assert capsys.readouterr().err.count("No space left on device; training goes on") == 1
    assert DeepQAgent.load(tmp_path / "run" / "last").decisions == 240


@pytest.mark.parametrize("trouble", ["full", "not finite", "best"])
def test_numbers_that_run_away_on_a_bad_day_end_in_a_sentence(tmp_path, capsys, monkeypatch, trouble):
    advance = Training.advance

    def diverging(training):
        if training.agent.decisions < 400:
            return advance(training)
        if trouble == "not finite":
            training.agent.online.values[:] = np.inf
        if trouble == "best":  # what has run away need not be infinite
            training.agent.online.values[:] = 1e30
        raise FloatingPointError("the error was not finite at learning step 7")

    monkeypatch.setattr(Training, "advance", diverging)
    if trouble == "full":
        monkeypatch.setattr(ai.training.loop, "write_agent", full)
    if trouble == "best":
        monkeypatch.setattr(LanderTask, "evaluate_every", 320)
    run = tmp_path / "run"
    assert main(["train", "--decisions", "4000", "--output", str(run), "--validation", "4", *SMALL]) == 1
    stderr = capsys.readouterr().err
    assert "learning step 7" in stderr
    assert {"full": "No space", "not finite": "Nothing new is kept", "best": "What was best"}[trouble] in stderr
    assert run.exists() == (trouble == "best")
    if trouble == "best":
        last = DeepQAgent.load(run / "last").online.values
        assert np.array_equal(last, DeepQAgent.load(run).online.values), "a wreck is nothing to go on from"
        assert json.loads((run / "training.json").read_text())["best"] is not None


def test_weights_of_the_reward_that_are_not_named_stay_the_presets():
    for preset in PRESETS.values():
        changed = configured(preset, ['reward_weights={"time": -0.3}', 'reward_weights={"feet": 2.0}'])
        assert changed.reward_weights == replace(preset.reward_weights, time=-0.3, feet=2.0)


def test_an_earlier_run_is_replaced_only_by_who_says_so(tmp_path, capsys):
    run, other = tmp_path / "run", tmp_path / "other"
    train = ["train", "--decisions", "80", "--validation", "4", *SMALL]
    for output in (run, other):
        assert main([*train, "--output", str(output), "--seed", "3"]) == 0
    before = {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()}
    for command in (
        [*train, "--output", str(run)],
        ["train", "--decisions", "160", "--resume", str(run), "--output", str(other)],
    ):
        capsys.readouterr()
        assert main(command) == 1
        assert f"{command[-1]} holds an earlier run: --resume {command[-1]} goes" in capsys.readouterr().err
        assert {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()} == before
    assert (
        main(["train", "--decisions", "160", "--resume", str(run), "--output", f"{run}/../run", "--validation", "4"])
        == 0
    )
    assert main([*train, "--output", str(run), "--seed", "5", "--replace"]) == 0
    assert json.loads((run / "training.json").read_text())["seed"] == 5


@pytest.mark.skipif(sys.platform == "win32", reason="file descriptors of a shell")
@pytest.mark.slow
def test_a_run_without_standard_streams_is_kept(tmp_path):
    for closed in ("2>&-", ">&-", "<&- >&- 2>&-", "2>/dev/full"):
        run = tmp_path / f"run {closed.replace('/', ' ')}"
        command = shlex.join(
            [sys.executable, "main.py", "train", "--decisions", "80", "--validation", "4", "--output", str(run), *SMALL]
        )
        assert subprocess.run(["sh", "-c", f"{command} {closed}"], cwd=ROOT, check=False).returncode == 0, closed
        assert json.loads((run / "training.json").read_text())["decisions"] == 80, closed


def test_ctrl_c_while_modules_are_imported_ends_quietly(monkeypatch, capsys):
    def interrupted(parser):
        raise KeyboardInterrupt

    def in_a_class():
        try:
            raise KeyboardInterrupt
        except KeyboardInterrupt as error:
            raise RuntimeError("Error calling __set_name__ on 'cached_property' instance") from error

    monkeypatch.setattr("tranquility.__main__._parser", in_a_class)
    assert main([]) == 130
    monkeypatch.setattr("tranquility.__main__._parser", lambda: interrupted(None))
    assert main([]) == 130
    assert capsys.readouterr() == ("", "")


def test_nothing_is_imported_before_ctrl_c_is_looked_after():
    program = """
import sys
before = set(sys.modules)
import main
print(*sorted(set(sys.modules) - before - {"main", "tranquility", "tranquility.__main__", "__future__"}))
"""
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout == "\n"
