from collections.abc import Iterator
from pathlib import Path

import pytest

from game.scenes.menus.menu import MenuScene
from tests.support.monkey import Monkey, playground


@pytest.fixture
def folder() -> Iterator[Path]:
    with playground() as place:
        yield place


@pytest.mark.slow
def test_a_monkey_finds_no_fault_and_leaves_nothing_behind(folder: Path):
    monkey = Monkey(folder, seed=7)
    monkey.play(1000)
    assert not monkey.faults.found
    assert not monkey.left_behind()
    assert len(monkey.visits) > 8  # scenes


@pytest.mark.slow
def test_it_does_find_faults(folder: Path, monkeypatch: pytest.MonkeyPatch):
    def fail(*_: object) -> None:
        raise ZeroDivisionError("a fault on purpose")

    monkeypatch.setattr(MenuScene, "draw", fail)
    monkey = Monkey(folder)
    monkey.play(10)
    assert "a fault on purpose" in monkey.faults.found[0]
