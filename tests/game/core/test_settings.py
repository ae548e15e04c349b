import errno
import json
import os
from pathlib import Path
from threading import Event, current_thread

import pytest

from game.core import texts
from game.core.settings import DAMAGED_NAME, FILE_NAME, Settings, SettingsFile, SettingsWriter

DAMAGED = [b"", b"{", b"[1, 2]", b"null", b"\xff\xfe\x00", b'{"full_screen": tru', b"[" * 100_000, b"\x00" * 64]


def test_what_is_saved_is_loaded(tmp_path: Path):
    settings = Settings(colour_safe=True, model="eagle")
    assert SettingsFile(tmp_path / "new" / "folder").save(settings)
    assert SettingsFile(tmp_path / "new" / "folder").load() == settings


def test_no_file_means_defaults_without_a_word(tmp_path: Path):
    file = SettingsFile(tmp_path)
    assert file.load() == Settings()
    assert not file.problem


def test_a_damaged_file_is_kept_aside(tmp_path: Path):
    for content in DAMAGED:
        (tmp_path / FILE_NAME).write_bytes(content)
        file = SettingsFile(tmp_path)
        assert file.load() == Settings(), content[:20]
        assert DAMAGED_NAME in file.problem
        assert (tmp_path / DAMAGED_NAME).read_bytes() == content
        assert not (tmp_path / FILE_NAME).exists()


def test_a_wrong_type_is_defaulted_by_itself(tmp_path: Path):
    for wrong in ("yes", 1, None, [], {}, 0.5):
        (tmp_path / FILE_NAME).write_text(json.dumps({"full_screen": wrong, "colour_safe": True}))
        file = SettingsFile(tmp_path)
        assert file.load() == Settings(colour_safe=True), wrong
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
    assert sorted(path.name for path in tmp_path.iterdir()) == [FILE_NAME]


def test_a_folder_that_cannot_be_made_or_is_in_the_files_place_is_a_message(tmp_path: Path):
    (tmp_path / "file").write_text("in the way")
    file = SettingsFile(tmp_path / "file")
    assert not file.save(Settings())
    assert "could not be saved" in file.problem
    assert file.load() == Settings()
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
        patch.setattr("game.core.settings.read_text", raising(locked))
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


def test_a_huge_file_and_a_pipe_are_put_aside_unread(tmp_path: Path):
    path = tmp_path / FILE_NAME
    with path.open("wb") as huge:
        huge.truncate(200_000_000)
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


# In a thread of its own


def opened(folder: Path) -> tuple[SettingsWriter, Settings]:
    """A game on a folder."""
    file = SettingsFile(folder)
    settings = file.load()
    return SettingsWriter(file, settings), settings


def test_of_two_windows_on_one_folder_the_first_writes_and_the_second_says_so(tmp_path: Path):
    SettingsFile(tmp_path).save(Settings(model="eagle"))
    (one, mine), (other, yours) = opened(tmp_path), opened(tmp_path)
    yours.reduced_motion = True
    other.save(yours)
    other.wait()
    assert other.problem() == texts.SETTINGS_ELSEWHERE
    mine.colour_safe = True
    one.close(mine)
    other.close(yours)
    assert not other.problem()
    assert SettingsFile(tmp_path).load() == Settings(model="eagle", colour_safe=True)
    again, settings = opened(tmp_path)
    settings.muted = True
    again.close(settings)
    assert not again.problem()
    assert SettingsFile(tmp_path).load().muted
    assert [path.name for path in tmp_path.iterdir()] == [FILE_NAME]


def test_nothing_that_was_not_changed_is_written(tmp_path: Path):
    SettingsFile(tmp_path).save(Settings())
    writer, settings = opened(tmp_path)
    (tmp_path / FILE_NAME).write_text("edited meanwhile")
    writer.close(settings)
    assert (tmp_path / FILE_NAME).read_text() == "edited meanwhile"


def test_a_change_never_waits_for_the_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    threads, flush, slow = set(), os.fsync, Event()

    def fsync(handle: int) -> None:
        threads.add(current_thread())
        assert slow.wait(30)
        flush(handle)

    monkeypatch.setattr(os, "fsync", fsync)
    writer, settings = opened(tmp_path)
    for number in range(20):
        settings.master_volume = number / 20
        writer.save(settings)
    assert not (tmp_path / FILE_NAME).exists()
    settings.master_volume = 1.0  # which was not asked to be saved
    slow.set()
    writer.wait()
    assert current_thread() not in threads
    assert SettingsFile(tmp_path).load().master_volume == 19 / 20


def test_a_full_disk_is_reported_once_and_tried_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    writer, settings = opened(tmp_path)
    settings.colour_safe = True
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", lambda _: (_ for _ in ()).throw(OSError(errno.ENOSPC, "No space left on device")))
        writer.save(settings)
        writer.wait()
    assert "No space left" in writer.problem()
    assert writer.problem() == ""
    writer.close(settings)
    assert SettingsFile(tmp_path).load().colour_safe
