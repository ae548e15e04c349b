"""What the process of a player's file makes of it, asked without a process."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ai.lander.environment import LanderEnv
from ai.lander.rewards import REWARDS, Situation
from ai.pilots.child import ACT, PAY, load, problem

PATH = "/pilots/pilot.py"
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
    "def act(o): return -1": "0 act must return a whole number from 0 to 5, and returned -1",
    "def act(o): return 2.0": "0 act must return a whole number from 0 to 5, and returned 2.0",
    "def act(o): return True": "0 act must return a whole number from 0 to 5, and returned True",
    "def act(o): pass": "0 act must return a whole number from 0 to 5, and returned None",
    "def act(o): return float('nan')": "0 act must return a whole number from 0 to 5, and returned nan",
    "def act(o): return [1, [2]]": "0 act must return a whole number from 0 to 5, and returned [1, [2]]",
    "async def act(o): return 0": "0 act is async: it must be a plain function, def act",
    "async def act_many(o): yield 0": "0 act_many is async: it must be a plain function, def act_many",
    "class P:\n    async def __call__(self, o): return 0\nact = P()": "0 act is async: it must be a plain function",
    "def act(o): yield 0": "0 act must return a whole number from 0 to 5, and returned <generator",
    "import numpy as np\ndef act(o): return np.ma.masked": "0 act must return a whole number from 0 to 5, and returned",
    MASKED: "0 act_many must return 3 whole numbers from 0 to 5, and returned masked_array(",
    "def act_many(o): return [0, 1]": "0 act_many must return 3 whole numbers from 0 to 5, and returned [0, 1]",
}


@pytest.fixture(autouse=True)
def _own_modules(monkeypatch: pytest.MonkeyPatch):
    """What a file changes of its process is put back."""
    monkeypatch.setattr(sys, "modules", sys.modules.copy())
    monkeypatch.setattr(sys, "path", sys.path.copy())


def problem_with(source: str, kind: str = ACT, question: Any = OBSERVATIONS) -> str:
    try:
        load(kind, PATH, source)[0](question)
    except BaseException as error:
        return " ".join(map(str, problem(error, PATH)))
    return ""


def test_what_is_wrong_with_a_file_is_reported_with_its_line(subtests):
    for source, words in WRONG.items():
        with subtests.test(source):
            assert problem_with(source).startswith(words)


def test_what_a_file_raises_may_be_of_any_length_and_kind():
    assert len(problem_with("raise ValueError('x\\n' * 10_000)")) < 400
    assert problem_with("class Odd(Exception):\n    def __str__(self): raise SystemExit\nraise Odd") == "3 Odd"
    assert problem_with("class Odd(Exception):\n    def __str__(self): return 3\nraise Odd") == "3 Odd"
    assert problem_with("class Odd(Exception):\n    def __str__(self): return 'a\\nb'\nraise Odd") == "3 Odd: a b"


def test_act_and_act_many_answer_row_by_row_and_may_change_what_they_get():
    rows = np.arange(27, dtype=np.float32).reshape(3, 9)
    one = load(ACT, PATH, "def act(o):\n    o += 1\n    return int(o[0]) % 6")[0](rows.copy())
    many = load(ACT, PATH, "def act_many(o):\n    o += 1\n    return o[:, 0].astype(int) % 6")[0](rows.copy())
    assert one.tolist() == many.tolist() == [1, 4, 1]


def test_a_file_may_begin_as_some_editors_begin_it_and_have_a_callable_object():
    source = "\ufeffclass Pilot:\n    def __call__(self, o): return 5\nact = Pilot()"
    assert load(ACT, PATH, source)[0](OBSERVATIONS).tolist() == [5, 5, 5]


def test_the_pay_of_the_examples_is_the_usual_pay():
    pay, _ = load(PAY, PATH, (Path(__file__).parents[3] / "examples" / "pay_as_usual.py").read_text())
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


def test_a_pay_that_is_none_is_reported(subtests):
    question = (Situation.of(LanderEnv(2)), Situation.of(LanderEnv(2)))
    for returned in ("None", "1.0", "after.tilt[:1]", "'ab'"):
        with subtests.test(returned):
            assert "pay must return 2 finite numbers" in problem_with(
                f"def pay(before, action, after): return {returned}", PAY, question
            )
    assert "finite" in problem_with("def pay(b, a, after): return after.tilt + float('nan')", PAY, question)
