"""What was read of files is kept as long as they stay as they are."""

from pathlib import Path

import pytest

from game.core.shelf import Kept


def test_it_is_read_once_until_a_file_changes(tmp_path: Path):
    kept, read = Kept[str](most=2), []
    file = tmp_path / "network" / "weights"
    file.parent.mkdir()
    file.write_text("one")

    def get() -> str:
        return kept.get(file.parent, lambda: read.append(file.read_text()) or read[-1])

    assert (get(), get()) == ("one", "one")
    assert len(read) == 1
    file.write_text("another")
    assert get() == "another"
    kept.clear()
    assert get() == "another"
    assert len(read) == 3


def test_what_is_unsound_or_cannot_be_read_is_tried_again(tmp_path: Path):
    kept, read = Kept[int](most=2), iter(range(9))
    file = tmp_path / "file"
    file.touch()
    assert [kept.get(file, lambda: next(read), sound=lambda value: value > 1) for _ in range(4)] == [0, 1, 2, 2]
    with pytest.raises(StopIteration):
        kept.get(tmp_path / "gone", lambda: next(iter(())))


def test_the_last_few_are_kept(tmp_path: Path):
    kept, read = Kept[str](most=2), []
    for name in "abcab":
        (tmp_path / name).touch()
        kept.get(tmp_path / name, lambda name=name: read.append(name) or name)  # type: ignore[misc]
    assert read == ["a", "b", "c", "a", "b"]
    kept.get(tmp_path / "a", lambda: read.append("again") or "a")
    assert len(read) == 5
