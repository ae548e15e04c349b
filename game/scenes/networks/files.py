"""The player's own pilots, Python files: to make, edit and measure."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from threading import Thread

from ai.pilots.folder import PilotFolder
from game.core import texts
from game.core.worker import Worker, WorkerState
from game.flight import own
from game.training.library import SavedRun
from game.ui.context import Context
from game.ui.panel import Column


class OwnFiles:
    """The player's own files, and the measurement of one; what goes wrong is a note for the player.

    Attributes:
        measuring: the file that is being measured; None without one.

    """

    def __init__(self, context: Context) -> None:
        self._context, self._own = context, PilotFolder(context.user_dir)
        self.measuring: Path | None = None
        self._worker: Worker | None = None
        self._share = 0.0  # how much is measured

    def read(self) -> list[SavedRun]:
        """Return what files there are, with what each landed, unless it was saved since it was measured."""
        try:
            landed = {each.name: each for each in self._own.measured()}
            found = self._own.files()
        except OSError as error:
            reason = error.strerror or error
            self._context.note(texts.PILOTS_UNREADABLE.format(path=self._own.folder, reason=reason))
            return []
        fresh = {name: each.landed for name, each in landed.items() if name in found and not each.stale(found[name])}
        return [SavedRun(path.name, path, success=fresh.get(name), flyable=True) for name, path in found.items()]

    def new(self) -> Path | None:
        """Make a file and open it in the editor; None if it could not be written."""
        try:
            path = self._own.new()
        except OSError as error:
            reason = error.strerror or error
            self._context.note(texts.PILOTS_NOT_WRITTEN.format(path=self._own.folder, reason=reason))
            return None
        self.edit(path)
        return path

    def edit(self, path: Path) -> None:
        """Open a file in the system's editor."""
        try:
            edit(path)
        except OSError:
            self._context.note(texts.PILOTS_NO_EDITOR.format(path=path))

    def measure(self, path: Path) -> None:
        """Begin to measure a file."""
        self._share, self.measuring = 0.0, path
        self._worker = Worker(own.measure, self._context.user_dir, path)

    def cancel(self) -> None:
        """End a measurement."""
        if self._worker:
            self._worker.close()

    def update(self) -> bool:
        """Follow a measurement; return whether it is over."""
        worker = self._worker
        if worker is None:
            return False
        for share in worker.poll():
            self._share = share
        over = worker.state in (WorkerState.ENDED, WorkerState.FAILED) and worker.gone
        if over:
            self._worker = self.measuring = None
            if worker.problem:
                self._context.note(worker.problem)
        return over

    def describe(self, column: Column, path: Path) -> None:
        """Add what a file is, where it lies, and how far it is measured."""
        for words in (texts.PILOTS_WHAT, texts.PILOTS_NO_SANDBOX, str(path)):
            column.aside(words)
        if self.measuring == path:
            column.aside(texts.PILOTS_MEASURING.format(count=own.STARTS))
            column.bar(lambda: self._share)


def edit(path: Path) -> None:
    """Open a file in the system's editor; raises OSError if there is none. It never runs the file."""
    if sys.platform == "win32":
        os.startfile(path, "edit")  # "open" would run it
        return
    command = ["open", "-t"] if sys.platform == "darwin" else ["xdg-open"]
    void = subprocess.DEVNULL
    editor = subprocess.Popen([*command, str(path)], stdin=void, stdout=void, stderr=void, start_new_session=True)
    Thread(target=editor.wait, daemon=True).start()
