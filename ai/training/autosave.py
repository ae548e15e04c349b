"""Saving of a live run in a thread, while training goes on."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Final

from ai.training.checkpoints import snapshot
from ai.training.history import History
from ai.training.loop import Training
from ai.training.messages import Saved, problem_of

KEEP_SECONDS: Final = 10.0  # between two saves


class Autosave:
    """Saves a run to its own folder now and then, and to any other when asked; each folder is written whole.

    Without a folder of its own (None), it saves nothing unless asked.
    """

    def __init__(self, training: Training, history: History, folder: Path | None) -> None:
        self._training, self._history, self._folder = training, history, folder
        self._saved_at = training.agent.decisions  # as on the disk
        self._due = training.clock() + KEEP_SECONDS
        self._problem = ""
        self._writer = ThreadPoolExecutor(max_workers=1)
        self._writing: Future[None] | None = None

    def move_to(self, folder: Path) -> None:
        """Save to another folder from now on, the first time as soon as possible."""
        self.wait()
        self._folder, self._saved_at, self._due = folder, -1, self._training.clock()

    def go_on(self, now: float) -> list[Saved]:
        """Start a save when it is time, by the clock; return a message when one did not succeed, once."""
        if self._folder is None:
            return []
        told = []
        if self._writing is not None and self._writing.done():
            problem, self._writing = _outcome_of(self._writing), None
            if problem and problem != self._problem:
                told.append(Saved(self._folder, problem))
            self._problem = problem
        if self._writing is None and now >= self._due:
            self._due = now + KEEP_SECONDS
            self._writing = self._write(self._folder)
        return told

    def save(self, folder: Path) -> Saved:
        """Save to a folder, and wait until it is done."""
        return Saved(folder, _outcome_of(self._write(folder)))

    def wait(self) -> None:
        """Wait until a save that is under way has ended."""
        if self._writing is not None:
            _outcome_of(self._writing)

    def end(self) -> None:
        """Save what has not been saved, and wait until it is on the disk."""
        if self._folder is not None and self._saved_at != self._training.agent.decisions:
            self.save(self._folder)
        self._writer.shutdown()

    def _write(self, folder: Path) -> Future[None]:
        if folder == self._folder:
            self._saved_at = self._training.agent.decisions
        return self._writer.submit(snapshot(self._training, self._history).save, folder)


def _outcome_of(writing: Future[None]) -> str:
    """Wait for a save, and return why it failed, if it did."""
    try:
        writing.result()
    except (OSError, ValueError) as error:
        return problem_of(error)
    return ""
