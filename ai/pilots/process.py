"""A player's file at work in a process of its own, as the process that asks it knows it.

Whoever asks waits no longer than is said. That is no sandbox: the file may do whatever the player may.
"""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from multiprocessing.util import Finalize
from pathlib import Path
from typing import Any, Final

from ai.files import CONTROLS, read_text
from ai.pilots.child import ACT, serve

LARGEST: Final = 1_000_000  # bytes of a file
_TURN: Final = 0.1  # seconds after which a wait looks whether the process is still there


class PilotError(ValueError):
    """What is wrong with a player's file, in words, with the line of it that is to blame, if one is."""

    def __init__(self, words: str, line: int = 0) -> None:
        super().__init__(f"line {line}: {words}" if line else words)


class PilotProcess:
    """A process that runs a file as it is now, and answers with its `act` or its `pay`.

    Every method but `close` returns at once, or within the seconds that it is given; they raise PilotError for what is
    wrong with the file, and once the process has ended. `many` says whether the file has `act_many`, once it is ready.
    """

    many = False

    def __init__(self, path: Path, kind: str = ACT) -> None:
        path, source = path.absolute(), source_of(path)
        context = get_context("spawn")
        (self._link, theirs), (self._where, there) = context.Pipe(), context.Pipe()
        self._asked, self._answered = 0, -1  # numbers of questions: that of loading the file is 0
        # No daemon, as such a process may have no children of its own: closed when this is collected, or at the end.
        self._process = context.Process(target=serve, args=(theirs, there, str(path), source, kind))
        self.close = Finalize(self, _end, (self._process, self._link, self._where), exitpriority=1)
        try:
            with _uninterrupted():
                self._process.start()
        except OSError as error:
            raise self._ended(f"its process could not be started: {error.strerror or error}") from error
        finally:
            theirs.close()
            there.close()

    def ready(self, seconds: float = 0.0) -> bool:
        """Whether nothing is under way: the file is loaded, and the last question answered."""
        until = time.monotonic() + seconds
        while self._answered < self._asked:
            if not self._receive(until):
                return False
        return True

    def ask(self, question: Any, seconds: float) -> Any:
        """Return actions (n,) for observations (n, 9), or the pay (n,) for the situations before and after a decision.

        None if that took too long; the answer will never be used.
        """
        until = time.monotonic() + seconds
        if not self.ready(seconds):  # one that came too late before
            return None
        while self._receive(0.0):  # what the file raised since
            pass
        self._asked += 1
        try:
            self._link.send((self._asked, question))
        except OSError as error:
            raise self._ended() from error
        return self._given if self.ready(until - time.monotonic()) else None

    def late(self, words: str, seconds: float = 0.1) -> PilotError:
        """End the process, which took too long; return that in words, with the line at which the file was."""
        line = 0
        with suppress(EOFError, OSError):
            self._where.send(None)
            if self._where.poll(seconds):
                line = self._where.recv()
        self.close()
        return PilotError(f"{words}: its process was ended", line)

    @property
    def gone(self) -> bool:
        """Whether the process has ended, or was closed."""
        return self._process.exitcode is not None

    def _receive(self, until: float) -> bool:
        """Take in what the process says next, and return whether it said something in time; raises PilotError."""
        try:
            while not self._link.poll(min(_TURN, max(0.0, until - time.monotonic()))):
                if self.gone and not self._link.poll():  # a child of its own may keep the pipe open
                    raise self._ended()
                if time.monotonic() >= until:
                    return False
            self._answered, self._given, line, words = self._link.recv()
        except (EOFError, OSError) as error:
            raise self._ended() from error
        if words:
            raise PilotError(CONTROLS.sub(" ", words), line)
        if not self._answered:
            self.many = self._given
        return True

    def _ended(self, words: str = "its process has ended") -> PilotError:
        self.close()
        return PilotError(words)


def source_of(path: Path) -> str:
    """Return what stands in a file; raises PilotError for one that cannot be read."""
    try:
        return read_text(path, LARGEST)
    except OSError as error:
        raise PilotError(f"the file cannot be read: {error.strerror or error}") from error
    except ValueError as error:
        raise PilotError("the file is no text in UTF-8") from error


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Hold back Ctrl-C: a process that begins in a block is not hit by it before it has said that it ignores it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    from multiprocessing import resource_tracker

    resource_tracker.ensure_running()  # which begins with the first process, and would let Ctrl-C through again
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


def _end(process: BaseProcess, *links: Connection) -> None:
    """End a process, and where the system has groups of processes, what it has started."""
    if process.pid:
        with suppress(OSError):
            process.kill()
            if hasattr(os, "killpg"):
                os.killpg(process.pid, signal.SIGKILL)
        process.join()
    for link in links:
        link.close()
