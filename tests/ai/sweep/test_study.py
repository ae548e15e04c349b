"""Studies on disk: whole trials only, whatever happens, and nothing that a file says is believed unseen."""

import json
import os
from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ai.sweep.study import Study, StudyError, median
from tests.support.studies import made_study, result

NASTY = (
    None, True, -1, 0, 2, 0.5, 1e308, -1e308, 5e-324, 10**30, 10**39, "", "x", "\ud800\x1b[2J", "x" * 5000, "٣", [], {},
    [[]], [None], [1e308] * 2, {"a": None}, float("nan"), float("inf"),
)  # fmt: skip
FILES = ("study.json", "trials/0000/trial.json")


@pytest.fixture
def study(tmp_path):
    return made_study(tmp_path / "made")


def test_a_study_reads_what_it_wrote_and_its_table_has_the_best_first(study):
    again = Study.load(study.folder)
    assert (again.trials, again.design, again.damaged) == (study.trials, study.design, [])
    table = again.table()
    assert "2 of 4 trials, 2 seeds each, compared by return" in table
    assert table.index("learning_rate=0.002 tau=0.02 double=false") < table.index("learning_rate=0.001")
    assert str(study.trial_folder(1) / "seed-0") in table, "the best network"
    assert [median(each) for each in ([1.0, 9.0, 2.0], [0.5, None], [])] == [2.0, None, None]


def test_a_full_disk_keeps_no_half_of_a_trial_and_the_next_record_succeeds(study, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("ai.sweep.study.write_text", full)  # the runs have been written then
    with pytest.raises(OSError, match="No space"):
        study.record(result(2), {"seed-0/config.json": b"{}"})
    monkeypatch.undo()
    assert sorted(study.trials) == [0, 1]
    assert sorted(path.name for path in (study.folder / "trials").iterdir()) == ["0000", "0001"]
    study.record(result(2), {})
    assert Study.load(study.folder).trials[2] == result(2)


def test_what_a_kill_leaves_half_written_is_no_trial_and_is_cleared_away(study):
    half = study.folder / "trials" / ".0002.0123abcd.new"
    half.mkdir()
    (half / "trial.json").write_text("{")
    os.utime(half, (1e9, 1e9))
    assert sorted(Study.load(study.folder).trials) == [0, 1]
    with study.claimed():
        assert not half.exists()
        with pytest.raises(BlockingIOError), Study.load(study.folder).claimed():
            pass


def test_a_damaged_trial_is_named_and_the_others_are_read_and_a_damaged_study_is_refused(study):
    whole = (study.folder / "study.json").read_bytes()
    for content in (b"", b"{}", b"[1]", b"\xff\xfe", b'{"number": 0}', b"[" * 5000):
        (study.trial_folder(0) / "trial.json").write_bytes(content)
        left = Study.load(study.folder)
        assert (left.damaged, sorted(left.trials)) == ([0], [1]), content[:20]
        assert "cannot be read: 0" in left.table()
        (study.folder / "study.json").write_bytes(content)
        with pytest.raises(StudyError, match="no study"):
            Study.load(study.folder)
        (study.folder / "study.json").write_bytes(whole)
    (study.folder / "study.json").write_text(json.dumps(json.loads(whole) | {"version": 2}))
    with pytest.raises(StudyError, match="version 2"):
        Study.load(study.folder)
    with pytest.raises(StudyError, match="--resume"):
        Study.create(study.folder, study.design)


def test_a_trial_of_other_settings_or_seeds_or_with_a_value_out_of_nowhere_is_damaged(study):
    file = study.trial_folder(0) / "trial.json"
    sound = json.loads(file.read_text())
    one, two = sound["seeds"]
    for name, change in {
        "another knob": {"params": sound["params"] | {"env": "evil:X-v0"}},
        "a knob less": {"params": {"tau": 0.1}},
        "out of the range": {"params": sound["params"] | {"tau": 5.0}},
        "not a number": {"params": sound["params"] | {"tau": float("nan")}},
        "a text": {"params": sound["params"] | {"tau": "0.1"}},
        "no seeds": {"seeds": []},
        "one seed": {"seeds": [one]},
        "seeds in another order": {"seeds": [two, one]},
        "a seed without a value": {"seeds": [one, two | {"value": None}]},
    }.items():
        file.write_text(json.dumps(sound | change))
        assert Study.load(study.folder).damaged == [0], name


def test_settings_that_make_no_sense_are_told_and_the_study_goes_on(study):
    study.record(replace(result(2), value=None, seeds=(), problem="too many\x1b[2J layers"), {})
    assert "of 1, the settings make no sense: 2: too many" in Study.load(study.folder).table()


def places(value, path=()):
    """Yield the path of every value within one from JSON; of a list, of its first two."""
    yield path
    inside = value.items() if isinstance(value, dict) else list(enumerate(value))[:2] if isinstance(value, list) else ()
    for key, each in inside:
        yield from places(each, (*path, key))


@given(st.data())
@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_study_bears_any_value_in_any_place(study, data):
    file = study.folder / data.draw(st.sampled_from(FILES))
    sound = file.read_text()
    values = json.loads(sound)
    *path, last = data.draw(st.sampled_from(list(places(values))[1:]))
    within = values
    for key in path:
        within = within[key]
    within[last] = data.draw(st.sampled_from(NASTY) | st.floats() | st.integers() | st.text())
    try:
        file.write_text(json.dumps(values))
        Study.load(study.folder).table()
    except StudyError:
        pass
    finally:
        file.write_text(sound)
