import json

import pytest

import main
from ai.agent.agent import DeepQAgent
from ai.cli.copilot import MODEL
from ai.copilot import measurement
from ai.copilot.measurement import ALONE, GUARD, TABLES, VALUES, rows
from ai.lander.environment import LanderEnv
from ai.training.statistics import wilson


@pytest.fixture(scope="module")
def agent():
    return DeepQAgent.load(MODEL)


def near(slots, rng):
    """Landers just above the pad, so that a table is small enough for a test."""
    return LanderEnv(slots, rng, "rung_1")


@pytest.fixture
def few(monkeypatch):
    monkeypatch.setattr(measurement, "TABLES", dict.fromkeys(TABLES, (near, ("holds right", "thrust 0.3"))))


@pytest.mark.slow
def test_the_co_pilot_helps(agent, few):
    found = rows(agent, agent, "one_pad", ("laggy", "holds right"), ((ALONE, 0.0), (VALUES, 0.4), GUARD), 3, 1)
    assert [(row.pilot, row.mode) for row in found] == [
        (pilot, mode) for pilot in ("laggy", "holds right") for mode in (ALONE, VALUES, "guardian")
    ]
    for row in found:
        assert row.success + row.crash + row.out_of_bounds + row.time_out == pytest.approx(1.0)
        assert row.own_pad == row.success
        assert (row.held > 0) == (row.mode == "guardian")
        assert row.lost_held == 0
        assert row.mode != ALONE or row.overridden == 0
        low, high = row.success_interval
        assert 0.0 <= low <= row.success <= high <= 1.0
    assert [row.success for row in found if row.mode == "guardian"] == [1.0, 1.0]
    assert found[3].success == 0.0


def test_an_interval_holds_the_share_and_shrinks_with_the_number_of_trials():
    assert wilson(0.0, 20) == pytest.approx((0.0, 0.1611), abs=1e-4)
    assert wilson(1.0, 20) == pytest.approx((0.8389, 1.0), abs=1e-4)
    assert wilson(0.5, 100) == pytest.approx((0.4038, 0.5962), abs=1e-4)


def test_the_command_prints_tables(few, monkeypatch, capsys):
    monkeypatch.setattr(measurement, "HELPS", ((ALONE, 0.0), (VALUES, 0.4)))
    outputs = []
    for form in (["--json"], []):
        assert main.main(["copilot-table", "--episodes", "1", *form]) == 0
        outputs.append(capsys.readouterr().out)
    found = json.loads(outputs[0])
    assert [len(found[name]) for name in TABLES] == [4, 4, 4]
    assert "own pad" in outputs[1]


def test_the_command_says_what_is_wrong(capsys, tmp_path):
    assert main.main(["copilot-table", "--episodes", "0"]) == 1
    assert main.main(["copilot-table", "--model", str(tmp_path)]) == 1
    assert str(tmp_path) in capsys.readouterr().err
