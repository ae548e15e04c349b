import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from ai.agent import DeepQAgent
from main import main

ROOT = Path(__file__).parents[2]
SMALL = [f"--set={change}" for change in ("num_envs=8", "hidden=[8]", "batch_size=16", "warm_up=32", "updates=1")]


def test_train_evaluate_resume(tmp_path, capsys):
    run = str(tmp_path / "run")
    assert main(["train", "--decisions", "400", "--output", run, *SMALL]) == 0
    assert run in capsys.readouterr().out
    assert main(["evaluate", "--model", run, "--episodes", "20", "--seed", "3", "--json"]) == 0
    measured = json.loads(capsys.readouterr().out)
    shares = [measured[name] for name in ("success", "crash", "out_of_bounds", "time_out")]
    assert sum(shares) == pytest.approx(1.0)
    assert {"mean_return", "mean_time", "mean_fuel", "episodes"} <= set(measured)
    assert main(["train", "--decisions", "800", "--resume", run]) == 0
    assert json.loads((tmp_path / "run" / "training.json").read_text())["decisions"] == 800
    assert main(["evaluate", "--model", run, "--episodes", "20"]) == 0
    assert "success" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["train", "--seconds", "1"], "--output"),
        (["train", "--output", "x"], "when to stop"),
        (["train", "--output", "x", "--seconds", "1", "--preset", "magic"], "--preset is one of"),
        (["train", "--output", "x", "--seconds", "1", "--set", "warp=9"], "warp=9"),
        (["train", "--output", "x", "--seconds", "1", "--set", "n_step=0"], "n_step lies between"),
        (["train", "--resume", "nowhere", "--seconds", "1"], "nowhere"),
        (["evaluate", "--model", "nowhere"], "nowhere"),
        (["evaluate", "--model", "nowhere", "--episodes", "0"], "--episodes"),
        (["evaluate", "--model", "nowhere", "--spawn", "mars"], "--spawn is one of"),
    ],
)
def test_what_cannot_be_done_is_said_in_a_line(arguments, message, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 1
    told = capsys.readouterr().err
    assert message in told
    assert "Traceback" not in told
    assert not list(tmp_path.iterdir())


def test_ctrl_c_keeps_the_work(tmp_path):
    process = subprocess.Popen(
        [sys.executable, "main.py", "train", "--seconds", "600", "--output", str(tmp_path / "run"), *SMALL],
        cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ | {"PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
    time.sleep(3)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 0, err
    assert "kept in" in out
    assert (tmp_path / "run" / "last" / "config.json").exists()


def test_a_gradient_that_is_not_finite_ends_the_run_with_the_reason_and_keeps_the_work(tmp_path, capsys, monkeypatch):
    learn = DeepQAgent.learn

    def blow_up(agent):
        if agent.train_count == 20:
            agent.replay.cells.reward[:] = np.inf
        return learn(agent)

    monkeypatch.setattr(DeepQAgent, "learn", blow_up)
    with np.errstate(all="ignore"):
        assert main(["train", "--decisions", "4000", "--output", str(tmp_path / "run"), *SMALL]) == 1
    told = capsys.readouterr().err
    assert "learning step 21" in told
    assert "learning rate" in told
    assert DeepQAgent.load(tmp_path / "run").train_count == 20
