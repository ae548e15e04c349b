"""The commands sweep and study: one sentence for what makes no sense, before anything begins."""

import json
from importlib.util import find_spec

import pytest

from ai.cli import command_line
from ai.sweep import cluster
from ai.sweep.study import Study
from main import main
from tests.support.studies import shown_study


@pytest.fixture
def study(tmp_path):
    return shown_study(tmp_path / "user" / "studies" / "mine")


def refused(capsys, *arguments):
    try:
        code = main([str(each) for each in arguments])
    except SystemExit as error:
        code = error.code
    out = capsys.readouterr()
    assert code not in (0, None)
    assert out.err.count("\n") == 1, "one sentence"
    return out.err


def test_without_the_extra_the_command_says_what_to_install(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(cluster, "find_spec", lambda name: None)
    said = refused(capsys, "--user-dir", tmp_path, "sweep", "--study", "new")
    assert 'pip install -e ".[sweep]"' in said
    assert not (tmp_path / "studies").exists()
    model = shown_study(tmp_path / "s").run_folder(Study.load(tmp_path / "s").best(), 0)
    said = refused(capsys, "evaluate", "--model", model, "--episodes", 10, "--workers", 2)
    assert 'pip install -e ".[sweep]"' in said


@pytest.mark.skipif(find_spec("ray") is None, reason="needs the extra: sweep")
@pytest.mark.parametrize(
    ("options", "named"),
    [
        (["--metric", "best"], "--metric"),
        (["--knobs", "no_such_knob"], "no_such_knob"),
        (["--knobs", "learning", "--space", "x.json"], "--space"),
        (["--space", "no such file.json"], "no such file"),
        (["--trials", "0"], "--trials"),
        (["--seeds", "-1"], "--seeds"),
        (["--search", "population", "--knobs", "n_step"], "n_step"),
        (["--search", "population", "--knobs", "tau", "--trials", "7"], "multiple"),
        (["--set", "n_step=many"], "n_step"),
        (["--epochs", "3"], "--digits"),
        (["--digits", "--env", "CartPole-v1"], "--env"),
        (["--judge", "best"], "--judge"),
        (["--resume"], "no study"),
    ],
)
def test_what_makes_no_sense_is_one_sentence_and_nothing_is_written(tmp_path, capsys, options, named):
    assert named in refused(capsys, "--user-dir", tmp_path / "user", "sweep", "--study", "new", *options)
    assert not (tmp_path / "user" / "studies" / "new").exists()


@pytest.mark.skipif(find_spec("ray") is None, reason="needs the extra: sweep")
def test_a_study_that_has_begun_keeps_its_plan(study, tmp_path, capsys):
    user = ("--user-dir", tmp_path / "user", "sweep", "--study", "mine")
    assert "--metric, --set" in refused(capsys, *user, "--resume", "--metric", "mean", "--set", "tau=1")
    assert "--resume goes on" in refused(capsys, *user)
    assert Study.load(study.folder).plan == study.plan


def test_a_study_is_told_as_a_table_as_json_and_as_a_page_that_needs_nothing_else(study, tmp_path, capsys):
    command = ["--user-dir", str(tmp_path / "user"), "study", "mine"]
    assert main([*command, "--html", str(tmp_path / "page.html")]) == 0
    table = capsys.readouterr().out
    assert "9 of 12 trials" in table
    assert str(study.run_folder(study.best(), 0)) in table
    assert main([*command, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["best"] == 0
    page = (tmp_path / "page.html").read_text()
    assert page.count("<svg") >= 4
    assert not [word for word in ("<script", "http:", "https:", "src=", "@import") if word in page]


def test_a_page_shows_names_of_folders_as_text(tmp_path, capsys):
    shown_study(tmp_path / "user" / "studies" / "<b>mine<")
    page = tmp_path / "page.html"
    assert main(["--user-dir", str(tmp_path / "user"), "study", "<b>mine<", "--html", str(page)]) == 0
    capsys.readouterr()
    assert "<b>mine<" not in page.read_text()
    assert "&lt;b&gt;mine&lt;" in page.read_text()


@pytest.mark.parametrize("name", ["", "no such study", "../..", "a\0b"])
def test_a_study_that_is_not_there_is_one_sentence(tmp_path, capsys, name):
    assert refused(capsys, "--user-dir", tmp_path, "study", name)
    assert command_line.FAILED == 1
