"""The player's own pilots, Python files: to make, edit and measure."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from threading import Thread

from ai.pilots.folder import Measured, PilotFolder
from ai.pilots.own import LOADING
from game.core import texts
from game.core.worker import Worker, WorkerState
from game.drawing.tokens import HUMAN, SMALL
from game.explain.figures import percent
from game.flight import own
from game.ui.context import Context
from game.ui.panel import Column


@dataclass(frozen=True)
class OwnFile:
    """File of the player's own, and how it was measured last."""

    folder: Path  # the file itself, as other networks have a folder
    measured: Measured | None

    @property
    def name(self) -> str:
        return self.folder.name


class OwnFiles:
    """The player's own files, and the measurement of one.

    Attributes:
        said: what came of the last thing that was done; empty for nothing to say.
        measuring: the file that is being measured; None without one.

    """

    def __init__(self, context: Context) -> None:
        self._context, self._own = context, PilotFolder(context.user_dir)
        self.said = ""
        self.measuring: Path | None = None
        self._worker: Worker | None = None
        self._share = 0.0  # how much is measured

    def read(self) -> list[OwnFile]:
        """Return what files there are."""
        try:
            measured = {each.name: each for each in self._own.measured()}
            return [OwnFile(path, measured.get(name)) for name, path in self._own.files().items()]
        except OSError as error:
            self.said = texts.PILOTS_UNREADABLE.format(path=self._own.folder, reason=error.strerror or error)
            return []

    def new(self) -> Path | None:
        """Make a file and open it in the editor; None if it could not be written."""
        try:
            path = self._own.new()
        except OSError as error:
            self.said = texts.PILOTS_NOT_WRITTEN.format(path=self._own.folder, reason=error.strerror or error)
            return None
        self.edit(path)
        return path

    def edit(self, path: Path) -> None:
        """Open a file in the system's editor."""
        try:
            edit(path)
            self.said = texts.PILOTS_OPENED.format(path=path)
        except OSError:
            self.said = texts.PILOTS_NO_EDITOR.format(path=path)

    def measure(self, path: Path) -> None:
        """Begin to measure a file."""
        self._share, self.said, self.measuring = 0.0, "", path
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
            self._worker, self.measuring, self.said = None, None, worker.problem
        return over

    def describe(self, column: Column, file: OwnFile) -> None:
        """Add what is known of a file."""
        column.aside(texts.PILOTS_WHAT)
        column.aside(texts.PILOTS_NO_SANDBOX)
        column.aside(str(file.folder))
        if self.measuring == file.folder:
            words = texts.PILOTS_MEASURING
            column.aside(lambda: words[self._share > 0].format(count=own.STARTS, seconds=LOADING))
            column.bar(lambda: self._share)
        elif measured := file.measured:
            column.text(lambda: texts.PILOTS_STALE if measured.stale(file.folder) else _figures(measured), size=SMALL)
        if self.said:
            column.text(self.said, size=SMALL, colour=HUMAN)


def _figures(measured: Measured) -> str:
    """Say in one line how a pilot flew."""
    landed, seconds, fuel = percent(measured.landed, 1), f"{measured.seconds:.1f}", f"{measured.fuel:.1f}"
    return texts.PILOTS_FIGURES.format(count=own.STARTS, landed=landed, seconds=seconds, fuel=fuel)


def edit(path: Path) -> None:
    """Open a file in the system's editor; raises OSError if there is none. It never runs the file."""
    if sys.platform == "win32":
        os.startfile(path, "edit")  # "open" would run it
        return
    command = ["open", "-t"] if sys.platform == "darwin" else ["xdg-open"]
    void = subprocess.DEVNULL
    editor = subprocess.Popen([*command, str(path)], stdin=void, stdout=void, stderr=void, start_new_session=True)
    Thread(target=editor.wait, daemon=True).start()
