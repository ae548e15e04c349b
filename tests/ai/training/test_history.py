import json
import pickle

import numpy as np
import pytest

from ai.nn import ModelFormatError
from ai.training import history as module
from ai.training.history import (
    CAPACITY,
    CHECKPOINTS_FILE,
    COLUMNS,
    CURVES_FILE,
    HISTORY_FILE,
    MOST_CHECKPOINTS,
    Checkpoint,
    History,
    SettingChange,
    Validation,
)
from ai.training.loop import PARTS, Progress


def point(number):
    same = dict.fromkeys(COLUMNS[: -len(PARTS)], float(number))
    return Progress(**same | {"crashed": 0.25, "parts": tuple(range(len(PARTS)))})


def checkpoint(number, scale=None):
    return Checkpoint(0.5 * number, number, 0.5, np.full(7, number, np.float32), scale)


def full_history():
    history = History()
    for number in range(10):
        history.append(point(number))
    history.append(checkpoint(0))
    history.append(checkpoint(300, {"count": 1, "origin": [0.0], "mean": [0.5], "squares": [0.0]}))
    history.append(SettingChange(200, "learning_rate", 0.002, 0.001))
    history.append(SettingChange(200, "mirror", True, False))
    history.append(Validation(100, 0.75, -3.5, True))
    return history


@pytest.fixture
def short(monkeypatch):
    """Let histories be full after forty points."""
    monkeypatch.setattr(module, "CAPACITY", 40)


@pytest.mark.usefixtures("short")
def test_points_are_thinned_evenly_and_the_latest_is_always_there():
    for count in (1, 2, 40, 41, 42, 203, 320):
        history = History()
        for number in range(count):
            history.append(point(number))
        decisions = history["decisions"]
        assert min(count, 20) <= len(decisions) == len(history) <= 40, count
        assert (decisions[0], decisions[-1]) == (0, count - 1), count
        gaps = np.diff(decisions)
        assert (gaps > 0).all(), count
        assert len(np.unique(gaps[:-1])) <= 1, count


def test_checkpoints_are_thinned_and_the_first_and_last_are_kept():
    history = History()
    for number in range(5 * MOST_CHECKPOINTS):
        history.append(checkpoint(number))
        decisions = [each.decisions for each in history.checkpoints]
        assert decisions[0] == 0
        assert decisions[-1] == number
        assert decisions == sorted(decisions)
        assert len(decisions) <= MOST_CHECKPOINTS
    assert max(np.diff(decisions)) <= 2 * 5 + 1


def same(one, other):
    assert np.array_equal(one.points, other.points)
    assert one.setting_changes == other.setting_changes
    assert one.validations == other.validations
    assert len(one.checkpoints) == len(other.checkpoints)
    for first, second in zip(one.checkpoints, other.checkpoints, strict=True):
        assert (first.decisions, first.seconds, first.success) == (second.decisions, second.seconds, second.success)
        assert first.normalizer == second.normalizer
        assert np.array_equal(first.values, second.values)
        assert second.values.dtype == np.float32


@pytest.mark.usefixtures("short")
def test_what_is_written_is_read_and_goes_on_alike(tmp_path):
    for extra in (0, 45, 120):
        history = full_history()
        for number in range(10, extra):
            history.append(point(number))
        history.write(tmp_path)
        again = History.read(tmp_path)
        same(history, again)
        for number in range(extra, extra + 40):
            history.append(point(number))
            again.append(point(number))
        same(history, again)


def test_it_has_what_was_appended_and_can_be_sent_to_another_process_and_copied():
    history = full_history()
    assert history["crashed"].tolist() == [0.25] * 10
    assert history[PARTS[-1]].tolist() == [len(PARTS) - 1] * 10
    same(history, pickle.loads(pickle.dumps(history)))
    twin = history.copy()
    history.append(point(99))
    history.append(checkpoint(999))
    same(full_history(), twin)


def test_a_run_without_a_history_has_an_empty_one(tmp_path):
    assert len(History.read(tmp_path)) == 0
    History().write(tmp_path)
    same(History(), History.read(tmp_path))


def rewritten(folder, **changes):
    """Change what is said of a history, or its "curves", a text, or its "values"."""
    if "curves" in changes:
        (folder / CURVES_FILE).write_text(changes.pop("curves"))
    if "values" in changes:
        np.savez(folder / CHECKPOINTS_FILE, values=changes.pop("values"))
    if changes:
        (folder / HISTORY_FILE).write_text(json.dumps(json.loads((folder / HISTORY_FILE).read_text()) | changes))


HEADER = ",".join(COLUMNS)
ROW = ",".join(["1.0"] * len(COLUMNS))


def test_nonsense_is_named(tmp_path, subtests):
    moment = {"seconds": 1.0, "decisions": 3, "success": 0.5, "normalizer": None}
    for changes in [
        {"version": 1}, {"stride": 0}, {"appended": 1}, {"stride": "x"},
        *({"reward_scale": scale} for scale in (-1.0, float("nan"), float("inf"), "much")),
        {"curves": ""}, {"curves": f"{HEADER}\n1,2,3"}, {"curves": f"{HEADER}\n{ROW}\n1,2"},
        {"curves": f"{HEADER}\n{ROW},1"}, {"curves": f"{HEADER}\n{ROW.replace('1.0', 'x', 1)}"},
        {"curves": "\n".join([HEADER, *[ROW] * (CAPACITY + 1)]), "appended": 10**6},
        {"values": np.full((2, 7), np.nan, np.float32)}, {"values": np.zeros((1, 7), np.float32)},
        {"validations": [[1, 2]]},
        {"validations": [{"decisions": 3, "success": "x", "mean_return": 1.0, "best": True}]},
        {"checkpoints": 5},
        *({"checkpoints": [moment | wrong] * 2}
          for wrong in ({"decisions": "many"}, {"seconds": []}, {"success": 10**400}, {"normalizer": 7})),
        {"changes": [{"decisions": 3}]},
        {"changes": [{"decisions": 3, "name": 5, "before": 1, "after": 2}]},
        {"changes": [{"decisions": 3, "name": "care", "before": 1, "after": {}}]},
    ]:  # fmt: skip
        with subtests.test(changes=changes):
            full_history().write(tmp_path)
            rewritten(tmp_path, **changes)
            with pytest.raises(ModelFormatError, match=r"history\.json|curves\.csv|checkpoints\.npz"):
                History.read(tmp_path)


def test_curves_of_other_columns_are_refused(tmp_path):
    for columns in ([*COLUMNS[:-1], "gone"], [*COLUMNS, "more"], COLUMNS[::-1]):
        full_history().write(tmp_path)
        rewritten(tmp_path, curves=",".join(columns))
        with pytest.raises(ModelFormatError, match="of another version"):
            History.read(tmp_path)


def test_curves_are_a_table_that_any_program_opens(tmp_path):
    full_history().write(tmp_path)
    table = np.genfromtxt(tmp_path / CURVES_FILE, delimiter=",", names=True)
    assert table.dtype.names == COLUMNS
    assert table["decisions"].tolist() == list(range(10))


def test_a_history_knows_in_which_unit_its_values_are(tmp_path):
    history = full_history()
    history.reward_scale = 0.1
    history.write(tmp_path)
    assert History.read(tmp_path).reward_scale == 0.1


def test_a_knob_that_is_dragged_leaves_one_mark_with_its_last_value():
    history = History()
    for seconds, before, after in ((10.0, 0.1, 0.2), (10.5, 0.2, 0.3), (11.4, 0.3, 0.5), (15.0, 0.5, 0.6)):
        history.append(SettingChange(0, "tau", before, after, seconds))
    history.append(SettingChange(0, "discount", 0.9, 0.8, 15.1))
    marks = [(0.1, 0.5), (0.5, 0.6), (0.9, 0.8)]
    assert [(each.before, each.after) for each in history.setting_changes] == marks
    history.append(SettingChange(0, "tau", 0.6, 0.5, 15.2))
    assert [(each.before, each.after) for each in history.setting_changes] == [marks[0], marks[2]], "back where it was"
