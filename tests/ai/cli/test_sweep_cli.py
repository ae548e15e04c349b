"""The commands sweep and study: one sentence for what makes no sense, before anything begins."""

import json
import socket
import sys
from importlib.util import find_spec
from threading import Thread
from typing import Any

import pytest

from ai.sweep import cluster
from ai.sweep.study import Study
from main import main
from tests.support.studies import shown_study, tiny_plan


@pytest.fixture
def study(tmp_path):
    return shown_study(tmp_path / "user" / "studies" / "mine")


def refused(capsys, *arguments):
    try:
        code: Any = main([str(each) for each in arguments])
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


@pytest.mark.skipif(find_spec("ray") is None, reason="needs the extra: sweep")
def test_what_makes_no_sense_is_one_sentence_and_nothing_is_written(tmp_path, capsys):
    for options, named in (
        (["--metric", "best"], "--metric"),
        (["--knobs", "no_such_knob"], "no_such_knob"),
        (["--knobs", "learning", "--space", "x.json"], "--space"),
        (["--space", "no such file.json"], "no such file"),
        (["--trials", "0"], "--trials"),
        (["--seeds", "-1"], "--seeds"),
        (["--search", "population", "--knobs", "n_step"], "n_step"),
        (["--search", "population", "--knobs", "tau", "--trials", "7"], "multiple"),
        (["--set", "n_step=many"], "n_step"),
        (["--digits", "--env", "CartPole-v1"], "--env"),
        (["--resume"], "no study"),
    ):
        assert named in refused(capsys, "--user-dir", tmp_path / "user", "sweep", "--study", "new", *options), options
    assert not (tmp_path / "user" / "studies" / "new").exists()


@pytest.mark.skipif(find_spec("ray") is None, reason="needs the extra: sweep")
def test_a_study_that_has_begun_keeps_its_plan(study, tmp_path, capsys):
    user = ("--user-dir", tmp_path / "user", "sweep", "--study", "mine")
    assert "--metric, --set" in refused(capsys, *user, "--resume", "--metric", "mean", "--set", "tau=1")
    assert "--resume goes on" in refused(capsys, *user)
    assert Study.load(study.folder).plan == study.plan


@pytest.fixture
def evil(tmp_path, monkeypatch):
    """Another's study whose environment is a module that lies beside it, and leaves a trace when it is imported."""
    (tmp_path / "evilcwd.py").write_text(f"open({str(tmp_path / 'trace')!r}, 'w').close()\n")
    monkeypatch.syspath_prepend(tmp_path)
    study = Study.create(tmp_path / "study", tiny_plan())
    file = study.folder / "study.json"
    saved = json.loads(file.read_text())
    saved["plan"]["settings"]["env"] = "evilcwd:X-v0"
    file.write_text(json.dumps(saved))
    yield study.folder
    sys.modules.pop("evilcwd", None)


@pytest.mark.skipif(find_spec("ray") is None, reason="needs the extra: sweep")
def test_a_study_starts_code_only_if_the_user_names_it_too(evil, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(cluster, "joined", None)  # it never comes so far
    command = ("sweep", "--study", f"{evil}/", "--resume")
    assert "--env" in refused(capsys, *command)
    assert "--env" in refused(capsys, *command, "--env", "evilcwd:Y-v0")
    assert not (tmp_path / "trace").exists()
    assert "X" in refused(capsys, *command, "--env", "evilcwd:X-v0"), "the module has no such environment"
    assert (tmp_path / "trace").exists(), "the user has named it"
    assert not Study.load(evil).trials, "what cannot begin is not finished"


@pytest.mark.skipif(find_spec("ray") is None, reason="needs the extra: sweep")
def test_what_a_study_lists_of_trials_starts_no_code_either(evil, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(cluster, "joined", None)
    file = evil / "study.json"
    saved = json.loads(file.read_text())
    saved["plan"]["settings"]["env"] = "CartPole-v1"
    saved["plan"]["space"]["env"] = {"choices": ["evilcwd:X-v0"]}
    file.write_text(json.dumps(saved))
    assert "env cannot be searched" in refused(capsys, "sweep", "--study", f"{evil}/", "--resume")
    assert not (tmp_path / "trace").exists()


@pytest.mark.skipif(find_spec("ray") is None, reason="needs the extra: sweep")
def test_an_address_where_no_cluster_answers_is_one_sentence_at_once(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(cluster, "_PATIENCE", 0.2)
    silent, website = socket.create_server(("127.0.0.1", 0)), socket.create_server(("127.0.0.1", 0))

    def refuse():
        with website.accept()[0] as link:
            link.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")

    thread = Thread(target=refuse)
    thread.start()
    with silent, website:
        free = socket.create_server(("127.0.0.1", 0))
        addresses = {f"127.0.0.1:{each.getsockname()[1]}": said for each, said in (
            (silent, "no cluster answers"), (website, "no head of a Ray cluster"), (free, "no cluster answers"),
        )}  # fmt: skip
        free.close()
        addresses |= {"here": "HOST:PORT", "local": "HOST:PORT", "a:b": "HOST:PORT", "127.0.0.1:99999": "no cluster",
                      "no.such.host.invalid:1": "no cluster", f"{'x' * 70}:1": "no cluster"}  # fmt: skip
        for number, (address, said) in enumerate(addresses.items()):
            place = tmp_path / str(number)
            printed = refused(capsys, "sweep", "--study", f"{place}/", "--trials", 2, "--address", address)
            assert said in printed, address
            assert not place.exists(), "nothing has begun"
        thread.join()


def test_a_study_is_printed_as_a_table_as_json_and_as_a_page_that_needs_nothing_else(study, tmp_path, capsys):
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


def test_a_study_that_is_not_there_is_one_sentence(tmp_path, capsys):
    for name in ("", "no such study", "../..", "a\0b"):
        assert refused(capsys, "--user-dir", tmp_path, "study", name)
