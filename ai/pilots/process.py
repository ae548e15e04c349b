"""A player's file at work in a process of its own, as the process that asks it knows it.

Whoever asks waits no longer than is said. That is no sandbox: the file may do whatever the player may.
"""

from __future__ import annotations

import os
import signal
import time
from contextlib import suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from multiprocessing.util import Finalize
from pathlib import Path
from typing import Any

from ai.files.reading import CONTROLS
from ai.pilots.child import ACT, serve


class PilotError(ValueError):
    """What is wrong with a player's file, in words, with the line of it that is to blame, if one is."""

    def __init__(self, words: str, line: int = 0) -> None:
        super().__init__(f"line {line}: {words}" if line else words)


class PilotProcess:
    """A process that runs a file as it is now, and answers with its `act` or its `pay`.

    Every method but `close` returns at once, or within the seconds that it is given; they raise PilotError for what is
    wrong with the file, and once the process has ended. `many` says whether the file has `act_many`, once it is ready.
    """

    many: bool | None = None

    def __init__(self, path: Path, kind: str = ACT) -> None:
        context = get_context("spawn")
        self._link, theirs = context.Pipe()
        self._busy = True  # with loading, then with a question
        self._given: Any = None  # the last answer
        # No daemon, as such a process may have no children of its own: closed when this is collected, or at the end.
        self._process = context.Process(target=serve, args=(theirs, str(path.absolute()), kind))
        self.close = Finalize(self, _end, (self._process, self._link), exitpriority=1)
        try:
            self._process.start()
        except OSError as error:
            raise self.ended(f"its process could not be started: {error.strerror or error}") from error
        finally:
            theirs.close()

    def ready(self, seconds: float = 0.0) -> bool:
        """Whether nothing is under way: the file is loaded, and the last question answered."""
        if not self._busy:
            return True
        try:
            if not self._link.poll(max(0.0, seconds)):
                return False
            self._given, line, words = self._link.recv()
        except (EOFError, OSError) as error:
            raise self.ended() from error
        self._busy = False
        if words:
            if self.many is None:  # it cannot be loaded
                self.close()
            raise PilotError(CONTROLS.sub(" ", words), line)
        if self.many is None:
            self.many = self._given
        return True

    def ask(self, question: Any, seconds: float) -> Any:
        """Return actions (n,) for observations (n, 9), or the pay (n,) for the situations before and after a decision.

        None if that took too long; the answer will never be used.
        """
        until = time.monotonic() + seconds
        if not self.ready(seconds):  # one that came too late before
            return None
        try:
            self._link.send(question)
        except OSError as error:
            raise self.ended() from error
        self._busy = True
        return self._given if self.ready(until - time.monotonic()) else None

    def ended(self, words: str = "its process has ended") -> PilotError:
        """End the process; return the reason as an error."""
        self.close()
        return PilotError(words)

    @property
    def gone(self) -> bool:
        """Whether the process has ended, or was closed."""
        return self._process.exitcode is not None


def _end(process: BaseProcess, link: Connection) -> None:
    """End a process, and where the system has groups of processes, what it has started."""
    if process.pid:
        with suppress(OSError):
            process.kill()
            if hasattr(os, "killpg"):
                os.killpg(process.pid, signal.SIGKILL)
        process.join()
    link.close()
