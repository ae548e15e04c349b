"""The examples run as they stand, and none is longer than forty lines but the whole thing in one file."""

import os
import re
import runpy
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from ai.lander.rewards import Situation
from ai.pilots import CRASHED, FLYING
from ai.pilots.child import PAY, load

ROOT = Path(__file__).parents[1]
EXAMPLES = ROOT / "examples"


def run(name: str, capsys: pytest.CaptureFixture[str]) -> str:
    runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")
    return capsys.readouterr().out


@pytest.fixture(scope="module")
def micro() -> SimpleNamespace:
    """The parts of `microlander`; nothing of ours is imported by it."""
    return SimpleNamespace(**runpy.run_path(str(EXAMPLES / "microlander.py")))


def test_none_is_longer_than_forty_lines_but_the_whole_thing_in_one_file():
    files = sorted(EXAMPLES.glob("*.py"))
    assert len(files) == 8
    lengths = {path.stem: len(path.read_text().splitlines()) for path in files}
    assert lengths.pop("microlander") <= 250
    assert max(lengths.values()) <= 40


def test_the_whole_thing_imports_nothing_of_ours_and_names_what_its_parts_grew_up_to_be():
    text = (EXAMPLES / "microlander.py").read_text()
    imports = {name.split(".")[0] for name in re.findall(r"^\s*(?:import|from) (\S+)", text, re.MULTILINE)}
    assert imports <= {"numpy", *sys.stdlib_module_names}
    parts = re.findall(r"^ *# (\d+)\. .*Grown up: (\S+)$", text, re.MULTILINE)
    assert [int(number) for number, _ in parts] == list(range(1, len(parts) + 1))
    assert len(parts) >= 12
    assert not [path for _, path in parts if not (ROOT / path).is_file()]


def test_microlanders_slopes_are_those_that_finite_differences_find(micro: SimpleNamespace):
    rng = np.random.default_rng(1)
    network = micro.Network(rng, np.float64)
    seen, towards = rng.normal(size=(4, 7)), rng.normal(size=(4, 6))
    network.forward(seen)
    slopes = network.backward(towards)
    for values, slope in zip(network.parameters, slopes, strict=True):
        assert slope.shape == values.shape
        for place in rng.integers(values.size, size=12):
            was, costs = values.flat[place], []
            for change in (1e-6, -1e-6):
                values.flat[place] = was + change
                costs.append((network.forward(seen) * towards).sum())
            values.flat[place] = was
            assert slope.flat[place] == pytest.approx((costs[0] - costs[1]) / 2e-6, rel=1e-5, abs=1e-7)


def test_microlander_falls_as_on_the_moon_and_turns_by_a_jet(micro: SimpleNamespace):
    state = np.array([[0.0], [20.0], [0.0], [0.0], [0.0], [0.0]])
    for _ in range(30):
        state = micro.fly(state, np.array([0]))
    assert state[3, 0] == pytest.approx(-1.62 * 2.0)
    assert state[1, 0] == pytest.approx(20.0 - 1.62 * 2.0**2 / 2, abs=1.62 * 2.0 / 15)  # one step late, at the most
    right = micro.fly(state, np.array([2]))
    assert right[2, 0] > 0 > right[5, 0]


def test_microlander_lands_on_both_sides_of_its_limits(micro: SimpleNamespace):
    #                  gentle   fast  slides  leans  beside  in the air  gone
    state = np.array([[0.0,     0.0,   0.0,   0.0,    4.0,      0.0,    23.0],
                      [0.95,    0.95,  0.95,  0.95,   0.95,     1.0,    10.0],
                      [0.0,     0.0,   1.5,   0.0,    0.0,      0.0,     0.0],
                      [-1.5,   -2.1,  -1.5,  -0.5,   -0.5,     -1.0,     0.0],
                      [0.0,     0.0,   0.0,   0.4,    0.0,      0.0,     0.0],
                      [0.0,     0.0,   0.0,   0.0,    0.0,      0.0,     0.0]])  # fmt: skip
    landed, lost = micro.judge(state)
    assert landed.tolist() == [True, False, False, False, False, False, False]
    assert lost.tolist() == [False, True, True, True, True, False, True]
    assert not micro.judge(state, strictness=0.7)[0].any()


def test_microlander_of_one_seed_runs_the_same_and_learns(micro: SimpleNamespace):
    one, again, other = (micro.train(seed, steps=24, landers=16, tell=list).parameters for seed in (3, 3, 4))
    assert all(np.array_equal(a, b) for a, b in zip(one, again, strict=True))
    assert not np.array_equal(one[0], other[0])
    new = micro.Network(np.random.default_rng(3)).parameters
    assert not np.array_equal(one[0], new[0])


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 6))
def test_microlander_lands_in_a_minute_of_one_core(seed: int):
    told = subprocess.run(
        [sys.executable, str(EXAMPLES / "microlander.py"), "--seed", str(seed)],
        capture_output=True,
        text=True,
        check=True,
    ).stdout.splitlines()
    last = re.fullmatch(r"landed (\d+\.\d) % of 1,000 unseen starts after (\d+) s", told[-1])
    assert last, told[-1]
    assert float(last[1]) >= 90
    assert int(last[2]) <= 60


def test_xor_is_learnt(capsys: pytest.CaptureFixture[str]):
    answers = [float(line.split("=")[1]) for line in run("xor", capsys).splitlines()]
    assert np.round(answers).tolist() == [0, 1, 1, 0]


@pytest.mark.slow
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
    pay, _ = load(PAY, str(EXAMPLES / "pay_that_goes_wrong.py"))
    before = Situation(*np.zeros((9, 2), int))
    after = replace(before, steps=np.array([4, 4]), outcome=np.array([FLYING, CRASHED]))
    assert pay((before, after)) == pytest.approx([4 / 60, 4 / 60 - 10])


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
