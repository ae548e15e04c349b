import json

import numpy as np
import pytest

import main
from ai.agent.agent import DeepQAgent
from ai.cli.copilot import MODEL
from ai.common.intervals import wilson
from ai.copilot import measurement as copilot_table
from ai.copilot.copilot import Mode
from ai.copilot.measurement import ALONE, OPEN, ORACLE, VALUES, one_pad, three_pads


@pytest.fixture(scope="module")
def agent():
    return DeepQAgent.load(MODEL)


@pytest.fixture
def few(monkeypatch):
    """A table small enough for a test."""
    monkeypatch.setattr(copilot_table, "PILOTS", {name: copilot_table.PILOTS[name] for name in ("laggy", "none")})
    monkeypatch.setattr(copilot_table, "INTENT_PILOTS", ("laggy",))
    monkeypatch.setattr(copilot_table, "GROUNDS", 1)
    monkeypatch.setattr(copilot_table, "ORACLE_FLIGHTS", 1)
    monkeypatch.setattr(
        copilot_table, "ONE_PAD", ((ALONE, 0.0), (Mode.TOLERANCE, 0.6), (Mode.GUARDIAN, 0.4), (VALUES, 0.4))
    )
    monkeypatch.setattr(copilot_table, "THREE_PADS", ((ALONE, 0.0), (Mode.GUARDIAN, 0.4), (OPEN, 0.4)))


@pytest.mark.slow
def test_the_co_pilot_helps_on_one_pad(agent, few, monkeypatch):
    rows = list(one_pad(agent, agent, 24))
    modes = ["alone", "tolerance", "guardian", VALUES]
    assert [(row.pilot, row.mode) for row in rows] == [
        *(("laggy", mode) for mode in modes),
        *(("none", mode) for mode in modes),
        ("co-pilot", "alone"),
    ]
    # The oracle takes as long as everything else together: one flight.
    monkeypatch.setattr(copilot_table, "PILOTS", {"laggy": copilot_table.PILOTS["laggy"]})
    monkeypatch.setattr(copilot_table, "ONE_PAD", ((ALONE, 0.0), (ORACLE, 0.0)))
    _, limit, _ = one_pad(agent, agent, 4)
    assert (limit.pilot, limit.mode) == ("laggy", ORACLE)
    assert [row.episodes for row in (*rows, limit)] == [24] * 9 + [1]
    for row in (*rows, limit):
        assert row.success + row.crash + row.out_of_bounds + row.time_out == pytest.approx(1.0)
        assert row.own_pad == row.success
        assert (row.overridden == 0) == (row.mode == "alone")
        low, high = row.success_interval
        assert 0.0 <= low <= row.success <= high <= 1.0
    laggy, tolerant, guarded, valued, nobody, *helped, network = rows
    assert min(tolerant.success, guarded.success, limit.success) > laggy.success + 0.45
    assert limit.overridden < guarded.overridden < valued.overridden
    assert nobody.success == 0.0
    assert min(row.success for row in helped) > 0.6
    assert network.success > 0.95


@pytest.mark.slow
def test_the_co_pilot_brings_a_pilot_to_the_pad_they_have_in_mind(agent, few):
    alone, guarded, all_open = three_pads(agent, agent, 40)
    assert guarded.own_pad > alone.own_pad + 0.3
    assert all_open.success > alone.success
    assert guarded.own_pad <= guarded.success


def test_an_interval_holds_the_share_and_shrinks_with_the_number_of_trials():
    assert wilson(0.0, 20) == pytest.approx((0.0, 0.1611), abs=1e-4)
    assert wilson(1.0, 20) == pytest.approx((0.8389, 1.0), abs=1e-4)
    assert wilson(0.5, 100) == pytest.approx((0.4038, 0.5962), abs=1e-4)


@pytest.mark.slow
def test_the_command_prints_both_tables_which_follow_from_the_seed(few, monkeypatch, capsys):
    monkeypatch.setattr(copilot_table, "PILOTS", {"laggy": copilot_table.PILOTS["laggy"]})
    told = []
    for _ in range(2):
        assert main.main(["copilot-table", "--episodes", "2", "--json"]) == 0
        told.append(json.loads(capsys.readouterr().out))
    assert told[0] == told[1]
    assert [len(told[0]["one_pad"]), len(told[0]["three_pads"])] == [5, 3]
    assert np.isfinite([row["mean_return"] for row in told[0]["one_pad"]]).all()
    monkeypatch.setattr(copilot_table, "ONE_PAD", copilot_table.ONE_PAD[:1])
    monkeypatch.setattr(copilot_table, "THREE_PADS", copilot_table.THREE_PADS[:1])
    assert main.main(["copilot-table", "--episodes", "2"]) == 0
    assert "own pad" in capsys.readouterr().out


def test_the_command_says_what_is_wrong(capsys, tmp_path):
    assert main.main(["copilot-table", "--episodes", "0"]) == 1
    assert main.main(["copilot-table", "--model", str(tmp_path)]) == 1
    assert str(tmp_path) in capsys.readouterr().err
