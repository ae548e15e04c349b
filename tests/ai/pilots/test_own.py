"""A file is flown as it is saved: what takes over when, and what flies on."""

import os
import time
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest

from ai.lander.environment import LanderEnv
from ai.pilots import own
from ai.pilots.own import MeasuredPilot, OwnPay, OwnPilot
from ai.pilots.process import PilotError

OBSERVATION = np.zeros((1, 9), np.float32)
HELD = np.array([5])


class Fake:
    """Process that answers with the number in its file; a letter says what it does instead."""

    all: ClassVar[list["Fake"]] = []

    def __init__(self, path: Path) -> None:
        self.does, self.gone = path.read_text(), False
        Fake.all.append(self)

    def ready(self, seconds: float = 0.0) -> bool:
        if self.does == "damaged":
            raise PilotError("SyntaxError", 3)
        return self.does not in ("loading", "late")

    def ask(self, observation, seconds):
        if not self.ready():
            return None
        if self.does in ("raises", "dies"):
            self.gone = self.does == "dies"
            raise PilotError(self.does, 7)
        return np.full(len(observation), int(self.does))

    def ended(self, words: str) -> PilotError:
        self.gone = True
        return PilotError(words)

    def close(self) -> None:
        self.gone = True


class Clock:
    now = 0.0

    def __call__(self) -> float:
        self.now += 1.0
        return self.now


@pytest.fixture
def pilot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(own, "PilotProcess", Fake)
    Fake.all = []
    path = tmp_path / "pilot.py"
    path.write_text("1")
    return OwnPilot(path, clock=Clock())


def save(pilot: OwnPilot, source: str) -> None:
    pilot.path.write_text(source)
    now = pilot.path.stat().st_mtime_ns
    os.utime(pilot.path, ns=(now, now + 1000 * len(Fake.all)))  # however coarse the disk's clock is


def flown(pilot: OwnPilot, times: int = 1) -> int:
    for _ in range(times):
        action = pilot.act(OBSERVATION, held=HELD)
    return int(action[0])


def running() -> list[str]:
    return [each.does for each in Fake.all if not each.gone]


def test_a_file_that_is_saved_takes_over_at_the_next_decision(pilot: OwnPilot):
    assert flown(pilot) == 1
    save(pilot, "2")
    assert flown(pilot) == 2
    save(pilot, "3")
    assert flown(pilot) == 3
    assert running() == ["3"]
    pilot.close()
    assert running() == []


@pytest.mark.parametrize("broken", ["damaged", "raises", "dies"])
def test_the_last_good_one_flies_on_where_a_new_one_fails(pilot: OwnPilot, broken: str):
    assert flown(pilot) == 1
    save(pilot, broken)
    assert flown(pilot, 3) == 1
    assert pilot.problem.startswith("line ")
    assert running() == ["1"]
    save(pilot, "2")
    assert flown(pilot) == 2
    assert pilot.problem == ""


def test_one_that_raises_now_and_then_flies_on_and_one_that_died_does_not(pilot: OwnPilot):
    assert flown(pilot) == 1
    Fake.all[-1].does = "raises"
    assert flown(pilot) == HELD[0]
    assert pilot.problem == "line 7: raises"
    assert not pilot.flies_on
    Fake.all[-1].does = "1"
    assert flown(pilot) == 1
    Fake.all[-1].does = "dies"
    assert flown(pilot) == 0  # it coasts


def test_late_decisions_are_skipped_and_three_in_a_row_end_the_process(pilot: OwnPilot):
    assert flown(pilot) == 1
    fake = Fake.all[-1]
    for _ in range(2):
        fake.does = "late"
        assert flown(pilot, 2) == HELD[0]
        fake.does = "1"
        assert flown(pilot) == 1
    fake.does = "late"
    assert flown(pilot, 3) == 0  # it coasts
    assert "3 decisions in a row took longer than 50 ms" in pilot.problem
    assert not pilot.flies_on
    assert running() == []
    save(pilot, "2")
    assert flown(pilot) == 2


@pytest.mark.parametrize("does", ["loading", "late"])
def test_one_that_never_gives_a_first_answer_is_ended_and_reported(pilot: OwnPilot, does: str):
    assert flown(pilot) == 1
    save(pilot, does)
    assert flown(pilot, 10) == 1
    assert running() == ["1", does]
    assert flown(pilot, 100) == 1
    assert pilot.problem == "it gave no answer within 25 seconds"
    assert pilot.flies_on
    assert running() == ["1"]


def test_until_the_first_answer_it_coasts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(own, "PilotProcess", Fake)
    (tmp_path / "pilot.py").write_text("loading")
    pilot = OwnPilot(tmp_path / "pilot.py", clock=Clock())
    assert flown(pilot) == 0
    assert not pilot.ready
    save(pilot, "damaged")
    assert flown(pilot) == 0
    assert pilot.problem
    assert not pilot.flies_on  # for there was none
    save(pilot, "loading")
    assert flown(pilot) == 0
    Fake.all[-1].does = "3"
    assert flown(pilot) == 3
    assert pilot.ready


def test_a_real_file_flies_as_it_is_saved_and_one_that_loops_does_not_take_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    path = tmp_path / "pilot.py"
    path.write_text("def act(o): return 4")
    pilot = OwnPilot(path, patience=1.0)
    until = time.monotonic() + 60
    for action in (4, 2):
        path.write_text(f"def act(o): return {action}")
        while flown(pilot) != action:
            assert time.monotonic() < until
    monkeypatch.setattr(own, "LOADING", 0.1)
    path.write_text("while True: pass")
    while not pilot.problem:
        flown(pilot)
        assert time.monotonic() < until
    assert pilot.flies_on
    assert flown(pilot) == 2
    pilot.close()


def test_measuring_raises_what_is_wrong(tmp_path: Path):
    path = tmp_path / "pilot.py"
    path.write_text("def act(o): return 7")
    pilot = MeasuredPilot(path)
    with pytest.raises(PilotError, match="whole number"):
        pilot.act(OBSERVATION)
    pilot.close()
    path.write_text("x")
    with pytest.raises(PilotError, match="line 1: NameError"):
        MeasuredPilot(path)


def test_measuring_keeps_the_order_of_landers_and_ends_a_loop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    path = tmp_path / "pilot.py"
    rows = np.zeros((150, 9), np.float32)
    rows[:, 0] = np.arange(150) % 6
    for source in (
        "def act(o): return int(o[0])",
        "def act_many(o):\n    assert len(o) == 150\n    return o[:, 0].astype(int)",
    ):
        path.write_text(source)
        pilot = MeasuredPilot(path)
        assert np.array_equal(pilot.act(rows), rows[:, 0])
        pilot.close()
    monkeypatch.setattr(own, "ALONE", 0.2)
    path.write_text("def act(o):\n    while True:\n        o += 1")
    pilot = MeasuredPilot(path)
    with pytest.raises(PilotError, match="64 decisions took longer"):
        pilot.act(rows)
    assert pilot._process.gone


def test_landers_are_paid_by_a_file(tmp_path: Path):
    path = tmp_path / "pay.py"
    path.write_text("def pay(before, action, after):\n    return after.steps * 2.0 + action")
    pay = OwnPay(path)
    env, usual = LanderEnv(3, 5, pay=pay), LanderEnv(3, 5)
    for each in (env, usual):
        each.reset()
    result, other = env.step([0, 3, 4]), usual.step([0, 3, 4])
    assert result.reward.tolist() == [8.0, 11.0, 12.0]
    assert np.array_equal(result.observation, other.observation)
    pay.close()
    with pytest.raises(PilotError, match="ended"):
        env.step([0, 0, 0])
