"""The files of a study may say anything: `study` ends with a table or a sentence, not with a traceback or a warning."""

import json
import shutil
from functools import cache

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from main import main
from tests.support.studies import shown_study

FILES = ("study.json", "trials/0000/trial.json")
NASTY = (
    None, True, -1, 0, 2, 0.5, 1e308, -1e308, 5e-324, 10**30, 10**39, "", "x", "\ud800\x1b[2J", "x" * 5000, "٣", [], {},
    [[]], [None], [1e308] * 2, {"a": None}, float("nan"), float("inf"),
)  # fmt: skip
GONE = object()


def make(folder, metric):
    """Make a study of nine trials without their runs."""
    shown_study(folder)
    for run in folder.glob("trials/*/seed-*"):
        shutil.rmtree(run)
    plan = json.loads((folder / "study.json").read_text())
    plan["plan"]["metric"] = metric
    (folder / "study.json").write_text(json.dumps(plan))
    return folder


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    return [make(tmp_path_factory.mktemp("studies") / metric, metric) for metric in ("time_to_99", "return")]


def places(value, path=()):
    """Yield the path of every value within one from JSON; of a list, of its first two."""
    yield path
    inside = value.items() if isinstance(value, dict) else list(enumerate(value))[:2] if isinstance(value, list) else ()
    for key, each in inside:
        yield from places(each, (*path, key))


def changed(value, path, new):
    """Return a value from JSON with what lies at a path replaced, or gone."""
    if not path:
        return None if new is GONE else new
    copy = json.loads(json.dumps(value))
    within = copy
    for key in path[:-1]:
        within = within[key]
    if new is GONE:
        del within[path[-1]]
    else:
        within[path[-1]] = new
    return copy


def printed(folder, capsys, *options):
    """Return what the command prints, once it has ended as it should."""
    code = main(["study", str(folder), "--html", str(folder.parent / "page.html"), *options])
    out, err = capsys.readouterr()
    assert (code, err.count("\n")) in ((0, 0), (1, 1)), err
    assert not [sign for sign in "\x1b\ud800" if sign in out + err]
    return out or err


@cache
def sound(folder, name):
    return json.loads((folder / name).read_text())


@given(st.data())
@settings(max_examples=80, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_study_bears_any_value_in_any_place(folders, capsys, data):
    folder, name = data.draw(st.sampled_from(folders)), data.draw(st.sampled_from(FILES))
    path = data.draw(st.sampled_from(list(places(sound(folder, name)))))
    new = data.draw(st.sampled_from([*NASTY, GONE]) | st.floats() | st.integers() | st.text())
    try:
        (folder / name).write_text(json.dumps(changed(sound(folder, name), path, new)))
        printed(folder, capsys, *data.draw(st.sampled_from([(), ("--json",)])))
    finally:
        (folder / name).write_text(json.dumps(sound(folder, name)))


def test_settings_that_make_no_sense_are_reported(folders, capsys):
    folder, name = folders[0], "trials/0003/trial.json"
    nothing = {"value": None, "seeds": [], "problem": "too many\x1b[2J layers"}
    try:
        (folder / name).write_text(json.dumps(sound(folder, name) | nothing))
        assert main(["study", str(folder)]) == 0
        assert "of 1, the settings make no sense: 3: too many\\x1b[2J layers" in capsys.readouterr().out
    finally:
        (folder / name).write_text(json.dumps(sound(folder, name)))
