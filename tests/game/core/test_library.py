import errno
import json
import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from ai.training.config import Config
from ai.training.loop import Training
from ai.training.run import save
from game.core import shelf, texts
from game.core.shelf import LibraryError, is_valid_name
from game.flight import networks
from game.training.library import Library

SMALL = Config(hidden=(8,), num_envs=4, learning_starts=16, replay_size=100, batch_size=16)
DESCRIBED = {
    "env": "lander", "preset": "modern", "changes": {"care": 0.8}, "seed": 3, "decisions": 5000, "updates": 9,
    "episodes": 7, "landings": 2, "seconds": 61.5, "best": {"success": 0.75, "mean_return": 1.0},
}  # fmt: skip


@pytest.fixture(scope="module")
def trained(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("trained") / "run"
    training = Training(SMALL, seed=5, validation_episodes=4)
    training.advance()
    training.evaluate()
    save(training, folder, state=False)
    return folder


@pytest.fixture
def library(tmp_path: Path) -> Iterator[Library]:
    library = Library(tmp_path / "user")
    yield library
    library.release()


def add(library: Library, name: str, **described: object) -> Path:
    """A folder that looks like a run, for what never reads a network."""
    folder = library.folder / name
    for part in ("online", "target", "last"):
        (folder / part).mkdir(parents=True)
    (folder / "config.json").write_text("{}")
    (folder / "training.json").write_text(json.dumps({**DESCRIBED, **described}))
    return folder


def names(library: Library) -> list[str]:
    return sorted(run.name for run in library.runs())


def test_a_run_is_described_by_its_small_file(library: Library, trained: Path):
    shutil.copytree(trained, library.folder / "first")
    (run,) = library.runs()
    assert (run.name, run.folder, run.problem) == ("first", library.folder / "first", "")
    assert (run.decisions, run.resumable) == (4, True)
    assert run.preset in {"modern", "classic"}
    assert run.changes >= 5
    assert run.success is not None
    assert run.saved > 1e9


def test_a_player_without_a_folder_has_no_runs(library: Library):
    assert library.runs() == []
    assert library.problem == ""
    assert library.rescued() is None


def test_a_damaged_run_is_listed_with_its_problem_and_can_be_renamed_and_deleted(library: Library):
    nan, wrong = float("nan"), dict[str, list[object]]()
    wrong = {"decisions": ["many", float("inf"), 10**400, -1], "seconds": [None, nan],
             "best": [3, {"success": nan}], "changes": [1]}  # fmt: skip
    values = [{**DESCRIBED, name: value} for name, values in wrong.items() for value in values]
    for text in ("", "{", "[]", "[" * 100_000, '{"env": "lander"}', *map(json.dumps, values)):
        (add(library, "hurt") / "training.json").write_text(text)
        (run,) = library.runs()
        assert run.problem == "training.json is damaged", text[:80]
        assert run.flyable
        library.rename("hurt", "still hurt")
        library.delete("still hurt")
        assert library.runs() == []
    (add(library, "noise") / "training.json").write_bytes(np.random.default_rng(0).bytes(500))
    assert library.runs()[0].problem


def test_what_is_missing_is_named(library: Library):
    for part in ("training.json", "config.json", "online", "target"):
        path = add(library, "torn") / part
        path.rmdir() if path.is_dir() else path.unlink()
        (run,) = library.runs()
        assert run.problem == f"{part} is missing"
        assert run.flyable is (part == "training.json")
        shutil.rmtree(library.folder / "torn")
    add(library, "pole", env="CartPole-v1")
    assert "CartPole-v1" in library.runs()[0].problem
    assert not library.runs()[0].flyable


def forbid(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """Let a folder be one that may not be looked into; permissions alone would not hold back an administrator."""
    look = Path.stat

    def stat(path: Path, **more: bool) -> os.stat_result:
        if folder in path.parents:
            raise PermissionError(errno.EACCES, "Permission denied", str(path))
        return look(path, **more)

    monkeypatch.setattr(Path, "stat", stat)


def test_one_that_cannot_be_read_is_a_row_among_the_others(library: Library, monkeypatch: pytest.MonkeyPatch):
    for name in ("one", "locked", "two"):
        add(library, name)
    forbid(monkeypatch, library.folder / "locked")
    assert {run.name: run.problem for run in library.runs()} == {"one": "", "two": "", "locked": "Permission denied"}
    assert list(networks.folders(library.folder, library.folder.parent)) == ["locked", "one", "two"]


def test_links_that_lead_nowhere_are_rows_among_the_others(library: Library):
    add(library, "one")
    (library.folder / "lost").symlink_to("nowhere")
    (library.folder / "round").symlink_to("round")
    (library.folder / ".half.new").symlink_to("nowhere")
    found = {run.name: run.problem for run in library.runs()}
    assert found == {"one": "", "lost": texts.RUN_LINK, "round": "Too many levels of symbolic links"}
    assert library.problem == ""
    assert list(networks.folders(library.folder, library.folder.parent)) == ["lost", "one", "round"]
    assert networks.load("lost", library.folder / "lost").problem
    library.delete("lost")
    library.rename("round", "square")
    assert names(library) == ["one", "square"]


@pytest.mark.parametrize("kind", ["self", "out", "pipe", "many", "large"])
def test_what_is_no_plain_network_is_not_copied(
    library: Library, tmp_path: Path, kind: str, monkeypatch: pytest.MonkeyPatch
):
    strange = add(Library(tmp_path / "elsewhere"), "strange")
    secret = tmp_path / "secret"
    secret.mkdir()
    (secret / "diary.txt").write_text("not to be taken along")
    match kind:
        case "self":
            (strange / "again").symlink_to(strange)
        case "out":
            (strange / "online" / "more").symlink_to(secret)
        case "pipe":
            os.mkfifo(strange / "pipe")
        case "many":
            monkeypatch.setattr(shelf, "MOST_FILES", 4)
        case "large":
            monkeypatch.setattr(shelf, "MOST_BYTES", 10)
    with pytest.raises(LibraryError, match="strange is not copied"):
        library.import_folder(strange)
    assert library.runs() == []
    assert not library.folder.exists() or not [*library.folder.iterdir()]


def test_what_is_no_run_is_not_listed(library: Library):
    add(library, "run")
    add(library, ".hidden")
    (library.folder / "holiday pictures").mkdir()
    (library.folder / "notes.txt").write_text("")
    assert names(library) == ["run"]


def test_bad_names_are_refused_in_words_and_good_ones_taken(library: Library):
    for name in ("moon 2", "a", "x" * 40, "v1.2_final-b", "Zoë", "console", "com10", "2026-08-02"):
        assert is_valid_name(name), name
    add(library, "run")
    for name in (
        "", "   ", "x" * 41, "a/b", "a\\b", "..", ".hidden", "a.", " a", "a ", "a\nb", "a\0b", "CON", "nul.txt", "Com1",
        "lpt9.tar.gz", "what?", "a:b", "*", "<b>", "tab\tbed", "“quoted”",
    ):  # fmt: skip
        assert not is_valid_name(name), name
        with pytest.raises(LibraryError) as refusal:
            library.rename("run", name)
        assert str(refusal.value).endswith(".")
        assert names(library) == ["run"]


def test_rename(library: Library):
    add(library, "old")
    assert library.rename("old", "new") == library.folder / "new"
    assert library.rename("new", "NEW").name == "NEW"
    assert library.rename("NEW", "NEW").name == "NEW"
    assert names(library) == ["NEW"]


def test_a_name_that_is_taken_is_refused_and_both_runs_stay(library: Library):
    add(library, "one", decisions=1)
    add(library, "Two", decisions=2)
    (library.folder / "three").mkdir()  # whatever lies there, it is not ours to replace
    for taken in ("Two", "two", "TWO", "three"):
        with pytest.raises(LibraryError, match=r"already"):
            library.rename("one", taken)
        with pytest.raises(LibraryError, match=r"already"):
            library.new_folder(taken)
    assert {run.name: run.decisions for run in library.runs()} == {"one": 1, "Two": 2}


def test_nothing_outside_the_library_is_touched(library: Library):
    add(library, "run")
    add(library, ".training")
    for name in ("gone", "..", ".", "../user", ".training", "/"):
        for attempt in (library.delete, lambda name: library.rename(name, "taken away")):
            with pytest.raises(LibraryError, match="not there"):
                attempt(name)
    assert names(library) == ["run"]


def test_a_free_name_is_valid_and_nobodys(library: Library):
    assert library.free_name("Moon") == "Moon"
    add(library, "moon")
    assert library.free_name("Moon") == "Moon 2"
    add(library, "Moon 2")
    assert library.free_name("Moon") == "Moon 3"
    for suggestion in ("", "...", "a/b:c", "CON", "x" * 60, "\0", " .x. "):
        assert is_valid_name(library.free_name(suggestion)), suggestion
    add(library, "y" * 40)
    assert library.free_name("y" * 40) == "y" * 38 + " 2"


def test_what_is_deleted_is_gone_and_a_link_leaves_what_it_leads_to(library: Library, tmp_path: Path):
    add(library, "run")
    elsewhere = add(Library(tmp_path / "elsewhere"), "far")
    (library.folder / "link").symlink_to(elsewhere)
    for name in ("run", "link"):
        library.delete(name)
    assert [*library.folder.iterdir()] == []
    assert (elsewhere / "config.json").exists()


def test_a_full_disk_is_said_and_leaves_nothing_half_done(
    library: Library, trained: Path, monkeypatch: pytest.MonkeyPatch
):
    def full(source: Path, target: Path, **_: bool) -> None:
        (target / "half").mkdir()
        raise shutil.Error([("a", "b", "[Errno 28] No space left on device")])

    monkeypatch.setattr(shutil, "copytree", full)
    with pytest.raises(LibraryError, match=r"run could not be copied here: .*No space left on device"):
        library.import_folder(trained)
    assert list(library.folder.iterdir()) == []


def test_a_disk_that_takes_nothing_is_said(library: Library, monkeypatch: pytest.MonkeyPatch):
    add(library, "run")

    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "rename", refuse)
    monkeypatch.setattr(shutil, "rmtree", refuse)
    for attempt in (lambda: library.rename("run", "other"), lambda: library.delete("run")):
        with pytest.raises(LibraryError, match="Permission denied"):
            attempt()
    assert names(library) == ["run"]


def test_an_import_copies_a_run_under_a_free_name(library: Library, trained: Path, tmp_path: Path):
    for name in ("run", "run 2"):
        assert library.import_folder(trained).name == name
    assert library.import_folder(trained / "config.json").name == "run 3"  # which stands for its folder
    assert trained.is_dir()
    (tmp_path / "empty").mkdir()
    for strange in (tmp_path / "empty", tmp_path / "nowhere"):
        with pytest.raises(LibraryError, match="no folder with a network"):
            library.import_folder(strange)


def test_what_can_not_be_looked_at_is_not_imported_and_it_is_said(library: Library, tmp_path: Path):
    (tmp_path / "link").symlink_to("link")
    for name in ("a" * 300, "link", "nul\0", "not/text/\udcff"):
        with pytest.raises(LibraryError) as refused:
            library.import_folder(tmp_path / name)
        assert len(str(refused.value)) < 200


def test_what_had_no_name_when_the_game_died_can_be_kept(library: Library, trained: Path):
    shutil.copytree(trained, library.unsaved)
    assert library.runs() == []
    rescued = library.rescued()
    assert rescued is not None
    assert rescued.decisions == 4
    add(library, "taken")
    with pytest.raises(LibraryError, match="already"):
        library.keep_rescued("taken")
    assert library.keep_rescued(rescued.name).resumable
    assert library.rescued() is None
    assert names(library) == sorted([rescued.name, "taken"])


def test_only_one_of_two_games_has_the_place_of_a_run_without_a_name(library: Library):
    other = Library(library.folder.parent)
    assert library.hold()
    assert not other.hold()
    library.release()
    assert other.hold()
    other.release()


@pytest.mark.parametrize("name", ["run", ".training"])
def test_a_save_that_was_stopped_between_its_renames_is_put_back(library: Library, name: str):
    add(library, f".{name}.00000000.old", decisions=4)
    found = library.rescued() if name.startswith(".") else next(iter(library.runs()), None)
    assert found is not None
    assert found.decisions == 4


def test_what_a_save_never_finished_is_cleared_away_in_time(library: Library):
    old, fresh = add(library, "..training.00000000.new"), add(library, ".run.00000000.new")
    os.utime(old, (1e9, 1e9))
    assert library.runs() == []
    assert not old.exists()
    assert fresh.exists()
