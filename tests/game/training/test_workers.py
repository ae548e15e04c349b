"""One run after another, and a window that waits for none of them."""

import time
from collections.abc import Callable
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

import pytest

from game.core.worker import Worker, WorkerState
from game.training.library import Library
from game.training.run import TrainingRun
from game.training.run_kind import LANDERS
from tests.support.chores import keep


class Notebook(TrainingRun):
    """Runs that note when they begin and end."""

    def __init__(self, path: Path) -> None:
        super().__init__(LANDERS, Library(path.parent))
        self.path, self.closing = path, False

    def close(self) -> None:
        self.closing, self._next = True, None
        if self._worker:
            self._worker.close(5.0)

    def note(self, name: str, seconds: float = 0.0, note: str = "") -> None:
        self.begin((name, seconds, note), 0)

    def _launch(self, config: Any, seed: int, resume: Path | None) -> None:
        name, seconds, note = config
        self._worker = Worker(keep, self.path, name, seconds)
        self._notes.append(note)

    @property
    def lines(self) -> list[str]:
        return self.path.read_text().splitlines() if self.path.exists() else []


@pytest.fixture
def notebook(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    join = BaseProcess.join

    def joined(process: BaseProcess, timeout: float | None = None) -> None:
        assert learner.closing or not process.is_alive(), "the window waits for a process"
        join(process, timeout)

    learner = Notebook(tmp_path / "notes")
    monkeypatch.setattr(BaseProcess, "join", joined)
    yield learner
    learner.close()


def wait(learner: Notebook, until: Callable[[], object]) -> list[str]:
    notes, end = [], time.monotonic() + 60
    while not until():
        assert time.monotonic() < end
        notes += learner.poll()
        time.sleep(0.01)
    return [note for note in notes if note]


def test_the_next_run_begins_when_the_one_before_has_ended_and_nobody_waits(notebook: Notebook):
    """Of two that wait the last one is meant, and so is what is asked meanwhile."""
    notebook.note("one", 0.3, "at once")
    assert wait(notebook, lambda: notebook.state is WorkerState.RUNNING) == ["at once"]
    notebook.note("two", note="never")
    notebook.note("three", note="later")
    notebook._order(Worker.pause)
    assert notebook.waiting
    assert notebook.state is WorkerState.STARTING
    assert notebook.alive
    notes = wait(notebook, lambda: notebook.state is WorkerState.PAUSED)
    assert notes == ["later"]
    assert notebook.lines == ["one begins", "one ends", "three begins"]


def test_one_that_does_not_end_is_ended_and_after_a_close_nothing_begins(
    notebook: Notebook, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("game.core.worker.STOP_SECONDS", 0.3)
    notebook.note("one", 60.0)
    wait(notebook, lambda: notebook.state is WorkerState.RUNNING)
    notebook.note("two", 0.1)
    wait(notebook, lambda: notebook.state is WorkerState.RUNNING)
    assert notebook.lines == ["one begins", "two begins"]
    notebook.note("three", 0.0)
    notebook.close()
    notebook.poll()
    assert not notebook.alive
    assert notebook.lines == ["one begins", "two begins", "two ends"]
