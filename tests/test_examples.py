"""The examples run as they stand, and none is longer than forty lines."""

import os
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from ai.pilots.child import PAY, load

ROOT = Path(__file__).parents[1]
EXAMPLES = ROOT / "examples"


def run(name: str, capsys: pytest.CaptureFixture[str]) -> str:
    runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")
    return capsys.readouterr().out


def test_none_is_longer_than_forty_lines():
    files = sorted(EXAMPLES.glob("*.py"))
    assert len(files) == 7
    assert not [path.name for path in files if len(path.read_text().splitlines()) > 40]


def test_xor_is_learnt(capsys: pytest.CaptureFixture[str]):
    answers = [float(line.split("=")[1]) for line in run("xor", capsys).splitlines()]
    assert np.round(answers).tolist() == [0, 1, 1, 0]


def test_digits_are_read(capsys: pytest.CaptureFixture[str]):
    lines = run("read_a_digit", capsys).splitlines()
    assert len(lines) == 10
    assert sum(line.split(",")[0][-1] == line.split("read as ")[1][0] for line in lines) >= 9


def test_the_stack_comes_to_rest(capsys: pytest.CaptureFixture[str]):
    heights = [float(line.split()[2]) for line in run("stack_of_boxes", capsys).splitlines()]
    assert len(heights) == 11
    assert heights[-1] == pytest.approx(heights[-2], abs=0.01)
    assert 0 < heights[-1] < heights[0]


def test_the_pay_that_goes_wrong_is_a_pay():
    pay, _ = load(PAY, "pay.py", (EXAMPLES / "pay_that_goes_wrong.py").read_text())
    question = np.zeros((18, 2))
    question[9 + 6] = 4  # steps flown
    question[9 + 4] = [0, 2]  # the second has crashed
    assert pay(question) == pytest.approx([4 / 60, 4 / 60 - 10])


@pytest.mark.slow
def test_cartpole_is_balanced_and_every_example_runs_as_a_module():
    pytest.importorskip("gymnasium")
    told = subprocess.run(
        [sys.executable, "-m", "examples.cartpole"],
        cwd=ROOT,
        env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=True,
    ).stdout.splitlines()
    assert float(told[-1].split(":")[1].split()[0]) > 150
