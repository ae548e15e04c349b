import errno
import json
import os
from pathlib import Path

import pytest

from ai.nn.files import write_text
from game.settings import DAMAGED_NAME, FILE_NAME, Settings, SettingsFile

DAMAGED = [
    b"",
    b"{",
    b"[1, 2]",
    b"null",
    b"\xff\xfe\x00",
    b'{"full_screen": tru',
    b"[" * 100_000,
    b"\x00" * 64,
]


def test_what_is_saved_is_loaded(tmp_path: Path):
    settings = Settings(colour_safe=True, model="eagle")
    assert SettingsFile(tmp_path / "new" / "folder").save(settings)
    assert SettingsFile(tmp_path / "new" / "folder").load() == settings


def test_no_file_means_defaults_without_a_word(tmp_path: Path):
    file = SettingsFile(tmp_path)
    assert file.load() == Settings()
    assert not file.problem


@pytest.mark.parametrize("content", DAMAGED)
def test_a_damaged_file_is_kept_aside(tmp_path: Path, content: bytes):
    (tmp_path / FILE_NAME).write_bytes(content)
    file = SettingsFile(tmp_path)
    assert file.load() == Settings()
    assert DAMAGED_NAME in file.problem
    assert (tmp_path / DAMAGED_NAME).read_bytes() == content
    assert not (tmp_path / FILE_NAME).exists()


@pytest.mark.parametrize("wrong", ["yes", 1, None, [], {}, 0.5])
def test_a_wrong_type_is_defaulted_by_itself(tmp_path: Path, wrong):
    (tmp_path / FILE_NAME).write_text(json.dumps({"full_screen": wrong, "colour_safe": True}))
    file = SettingsFile(tmp_path)
    assert file.load() == Settings(colour_safe=True)
    assert not file.problem


def test_unknown_settings_are_kept(tmp_path: Path):
    (tmp_path / FILE_NAME).write_text('{"volume": 0.3, "unknown": 1, "colour_safe": true}')
    file = SettingsFile(tmp_path)
    settings = file.load()
    settings.reduced_motion = True
    file.save(settings)
    written = json.loads((tmp_path / FILE_NAME).read_text())
    assert (written["volume"], written["unknown"], written["colour_safe"]) == (0.3, 1, True)


def test_a_full_disk_leaves_the_old_file_whole(tmp_path: Path, monkeypatch):
    file = SettingsFile(tmp_path)
    file.save(Settings(model="old"))

    def full(descriptor: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    assert not file.save(Settings(model="new"))
    assert "No space left" in file.problem
    monkeypatch.undo()
    assert file.load().model == "old"
    assert [path.name for path in tmp_path.iterdir()] == [FILE_NAME]


def test_a_folder_that_cannot_be_made_is_a_message(tmp_path: Path):
    (tmp_path / "file").write_text("in the way")
    file = SettingsFile(tmp_path / "file")
    assert not file.save(Settings())
    assert "could not be saved" in file.problem
    assert file.load() == Settings()


def test_a_folder_in_the_files_place_is_a_message(tmp_path: Path):
    (tmp_path / FILE_NAME).mkdir()
    file = SettingsFile(tmp_path)
    assert file.load() == Settings()
    assert "could not be read" in file.problem
    assert not file.save(Settings())


def test_a_file_that_cannot_be_read_is_put_aside_and_never_overwritten(tmp_path: Path, monkeypatch):
    file = SettingsFile(tmp_path)
    file.save(Settings(model="precious"))
    locked = PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    with monkeypatch.context() as patch:
        patch.setattr("game.settings.read_text", raising(locked))
        settings = file.load()
        assert "Permission denied" in file.problem
    with monkeypatch.context() as patch:
        patch.setattr(Path, "replace", raising(locked))  # still locked
        assert not file.save(settings)
        assert file.load().model == "precious"
    settings.model = "new"
    assert file.save(settings)
    assert file.save(settings)
    assert file.load() == Settings(model="new")
    assert json.loads((tmp_path / DAMAGED_NAME).read_text())["model"] == "precious"
    assert "unread" not in json.loads((tmp_path / FILE_NAME).read_text())


def raising(error: OSError):
    def fail(*_: object, **__: object) -> None:
        raise error

    return fail


def test_writing_leaves_no_temporary_file(tmp_path: Path):
    write_text(tmp_path / "a.txt", "one")
    write_text(tmp_path / "a.txt", "two")
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]
    assert (tmp_path / "a.txt").read_text() == "two"


def test_two_games_at_once_keep_what_each_has_chosen(tmp_path: Path):
    SettingsFile(tmp_path).save(Settings(model="first"))
    one, two = SettingsFile(tmp_path).load(), SettingsFile(tmp_path).load()
    one.reduced_motion = True
    SettingsFile(tmp_path).save(one)
    two.colour_safe, two.keys = True, {"up": ["w"]}
    SettingsFile(tmp_path).save(two)
    one.model = "second"
    SettingsFile(tmp_path).save(one)
    SettingsFile(tmp_path).save(two)
    expected = Settings(model="second", reduced_motion=True, colour_safe=True, keys={"up": ["w"]})
    assert SettingsFile(tmp_path).load() == expected


def test_a_huge_file_and_a_pipe_are_put_aside_unread(tmp_path: Path):
    path = tmp_path / FILE_NAME
    with path.open("wb") as file:
        file.truncate(200_000_000)
    for _ in range(2):
        file = SettingsFile(tmp_path)
        settings = file.load()
        assert settings == Settings()
        assert "could not be read" in file.problem
        settings.model = "mine"
        assert file.save(settings)
        assert SettingsFile(tmp_path).load().model == "mine"
        assert (tmp_path / DAMAGED_NAME).exists()
        path.unlink()
        if not hasattr(os, "mkfifo"):
            break
        os.mkfifo(path)
