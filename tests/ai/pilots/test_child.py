"""What the process of a player's file makes of it, asked without a process."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ai.lander.environment import LanderEnv
from ai.lander.rewards import REWARDS, Situation
from ai.pilots.child import ACT, PAY, load, problem

OBSERVATIONS = np.zeros((3, 9), np.float32)
RAISING = """
def far(o):
    return o[9]

def act(observation):
    return far(observation)
"""
MASKED = "import numpy as np\ndef act_many(o): return np.ma.array([1, 2, 3], mask=[0, 1, 0])"

# What stands in a file, and what is said of it.
WRONG = {
    "def act(o)\n    return 0": "1 SyntaxError: expected ':'",
    "\nimport nowhere": "2 ModuleNotFoundError: No module named 'nowhere'",
    "x = 1": "0 there is no function act in it",
    "act = 3": "0 there is no function act in it",
    "exit()": "1 SystemExit",
    RAISING: "3 IndexError: index 9 is out of bounds for axis 0 with size 9",
    "def act(o): return 6": "0 act must return a whole number from 0 to 5, and returned 6",
    "def act(o): return 2.0": "0 act must return a whole number from 0 to 5, and returned 2.0",
    "def act(o): pass": "0 act must return a whole number from 0 to 5, and returned None",
    "def act(o): yield 0": "0 act must return a whole number from 0 to 5, and returned <generator",
    "async def act(o): yield 0": "0 act must return a whole number from 0 to 5, and returned <async_generator",
    MASKED: "0 act_many must return 3 whole numbers from 0 to 5, and returned masked_array(",
    "def act_many(o): return [0, 1]": "0 act_many must return 3 whole numbers from 0 to 5, and returned [0, 1]",
}


@pytest.fixture(autouse=True)
def _own_modules(monkeypatch: pytest.MonkeyPatch):
    """What a file changes of its process is put back."""
    monkeypatch.setattr(sys, "modules", sys.modules.copy())
    monkeypatch.setattr(sys, "path", sys.path.copy())
    monkeypatch.setattr(sys, "dont_write_bytecode", True)


@pytest.fixture
def loaded(tmp_path: Path):
    def load_text(source: str, kind: str = ACT) -> Any:
        (tmp_path / "pilot.py").write_text(source)
        return load(kind, str(tmp_path / "pilot.py"))[0]

    return load_text


@pytest.fixture
def problem_with(loaded, tmp_path: Path):
    def said(source: str, kind: str = ACT, question: Any = OBSERVATIONS) -> str:
        with pytest.raises(BaseException) as raised:  # noqa: PT011
            loaded(source, kind)(question)
        return " ".join(map(str, problem(raised.value, str(tmp_path / "pilot.py"))))

    return said


def test_what_is_wrong_with_a_file_is_reported_with_its_line(problem_with, subtests):
    for source, words in WRONG.items():
        with subtests.test(source):
            assert problem_with(source).startswith(words)
    assert len(problem_with("raise ValueError('x\\n' * 10_000)")) < 400


def test_act_and_act_many_answer_row_by_row_and_may_change_what_they_get(loaded):
    rows = np.arange(27, dtype=np.float32).reshape(3, 9)
    one = loaded("def act(o):\n    o += 1\n    return int(o[0]) % 6")(rows.copy())
    many = loaded("\ufeffdef act_many(o):\n    o += 1\n    return o[:, 0].astype(int) % 6")(rows.copy())
    assert one.tolist() == many.tolist() == [1, 4, 1]


def test_the_pay_of_the_examples_is_the_usual_pay():
    pay, _ = load(PAY, str(Path(__file__).parents[3] / "examples" / "pay_as_usual.py"))
    env, rng = LanderEnv(64, 3), np.random.default_rng(4)
    env.reset()
    ended = 0
    for _ in range(80):
        before = Situation.of(env)
        result = env.step(rng.choice([0, 3, 3, 4, 5], 64))
        after = Situation.of(env)
        assert pay((before, after)) == pytest.approx(result.reward, abs=1e-3)
        ended += int(result.terminated.sum())
    assert ended
    assert len(REWARDS) == 9


def test_a_pay_that_is_none_is_reported(problem_with, subtests):
    question = (Situation.of(LanderEnv(2)), Situation.of(LanderEnv(2)))
    for returned in ("None", "1.0", "after.tilt[:1]", "'ab'", "after.tilt + float('nan')"):
        with subtests.test(returned):
            words = problem_with(f"def pay(before, action, after): return {returned}", PAY, question)
            assert "pay must return 2 finite numbers" in words
