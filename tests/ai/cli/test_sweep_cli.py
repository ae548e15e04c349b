"""The command sweep: one sentence for what makes no sense, before anything begins."""

import json
import socket
import sys
from importlib.util import find_spec
from typing import Any

import pytest

from ai.sweep import cluster
from ai.sweep.study import Study
from main import main
from tests.support.studies import made_study, tiny_design


@pytest.fixture
def study(tmp_path):
    return made_study(tmp_path / "user" / "studies" / "mine")


NOWHERE = ("", " ", ".", "..", "a\0b", "a\nb", "/")


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
        (["--digits", "--set", "held_out=0", "--set", "batch_size=500"], "held_out"),
        (["--trials", "0"], "--trials"),
        (["--seeds", "-1"], "--seeds"),
        (["--knobs", ""], "--knobs"),
        (["--knobs", "tau,,"], "--knobs"),
        (["--knobs", ",tau"], "--knobs"),
        (["--set", "n_step=many"], "n_step"),
        (["--digits", "--env", "CartPole-v1"], "--env"),
        (["--resume"], "no study"),
        *((["--study", name], "--study" if name.strip(".") == "" and name else "folder") for name in NOWHERE),
    ):
        assert named in refused(capsys, "--user-dir", tmp_path / "user", "sweep", "--study", "new", *options), options
    assert not (tmp_path / "user" / "studies" / "new").exists()


@pytest.mark.skipif(find_spec("ray") is None, reason="needs the extra: sweep")
def test_a_study_that_has_begun_keeps_its_design(study, tmp_path, capsys):
    user = ("--user-dir", tmp_path / "user", "sweep", "--study", "mine")
    assert "--metric, --set" in refused(capsys, *user, "--resume", "--metric", "return", "--set", "tau=1")
    assert "--resume goes on" in refused(capsys, *user)
    assert Study.load(study.folder).design == study.design


@pytest.fixture
def evil(tmp_path, monkeypatch):
    """Another's study whose environment is a module that lies beside it, and leaves a trace when it is imported."""
    (tmp_path / "evilcwd.py").write_text(f"open({str(tmp_path / 'trace')!r}, 'w').close()\n")
    monkeypatch.syspath_prepend(tmp_path)
    study = Study.create(tmp_path / "study", tiny_design())
    file = study.folder / "study.json"
    saved = json.loads(file.read_text())
    saved["design"]["settings"]["env"] = "evilcwd:X-v0"
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
    saved["design"]["settings"]["env"] = "CartPole-v1"
    saved["design"]["knobs"] = ["env"]
    file.write_text(json.dumps(saved))
    assert "env has no range" in refused(capsys, "sweep", "--study", f"{evil}/", "--resume")
    assert not (tmp_path / "trace").exists()


@pytest.mark.skipif(find_spec("ray") is None, reason="needs the extra: sweep")
def test_an_address_where_no_cluster_answers_is_one_sentence_at_once(tmp_path, capsys):
    with socket.create_server(("127.0.0.1", 0)) as free:
        nobody = f"127.0.0.1:{free.getsockname()[1]}"
    addresses = {nobody: "no cluster answers", "here": "HOST:PORT", "local": "HOST:PORT", "a:b": "HOST:PORT",
                 "127.0.0.1:99999": "no cluster", "no.such.host.invalid:1": "no cluster",
                 f"{'x' * 70}:1": "no cluster"}  # fmt: skip
    for number, (address, said) in enumerate(addresses.items()):
        place = tmp_path / str(number)
        assert said in refused(capsys, "sweep", "--study", f"{place}/", "--trials", 2, "--address", address), address
        assert not place.exists(), "nothing has begun"


@pytest.mark.skipif(find_spec("ray") is None, reason="needs the extra: sweep")
def test_a_study_that_is_whole_prints_its_table_again(study, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(cluster, "joined", None)  # there is nothing to run
    assert main(["--user-dir", str(tmp_path / "user"), "sweep", "--study", "mine", "--resume", "--trials", "2"]) == 0
    out = capsys.readouterr().out
    assert "2 of 2 trials" in out
    assert str(study.trial_folder(1) / "seed-0") in out
