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

import numpy as np

from ai.environment import Doubles, Floats, Ints
from ai.files import CONTROLS
from ai.lander.rewards import Situation
from ai.pilots.child import ACT, ANSWER, AT, PROBLEM, READY, serve

_TURN: Final = 0.1  # seconds after which a wait looks whether the process is still there


class PilotError(ValueError):
    """What is wrong with a player's file, in words; `line` of it is 0 where no line is to blame."""

    def __init__(self, words: str, line: int = 0) -> None:
        super().__init__(f"line {line}: {words}" if line else words)
        self.line = line


class PilotProcess:
    """A process that runs a file's source, and answers with its `act` or its `pay`.

    Every method but `close` returns at once, or within the seconds that it is given; they raise PilotError for what is
    wrong with the file, and once the process has ended. `many` says whether the file has `act_many`, once it is ready.
    """

    many = False

    def __init__(self, path: Path, source: str, kind: str = ACT) -> None:
        context = get_context("spawn")
        self._link, theirs = context.Pipe()
        self._asked, self._answered = 0, -1  # numbers of questions: that of loading the file is 0
        self._answer: Any = None
        self._line: int | None = None
        # No daemon, as such a process may have no children of its own: closed when this is collected, or at the end.
        self._process = context.Process(target=serve, args=(theirs, str(path), source, kind))
        try:
            with _uninterrupted():
                self._process.start()
        except OSError as error:
            self._link.close()
            raise PilotError(f"its process could not be started: {error.strerror or error}") from error
        finally:
            theirs.close()
        self.close = Finalize(self, _end, (self._process, self._link), exitpriority=1)

    def ready(self, seconds: float = 0.0) -> bool:
        """Whether nothing is under way: the file is loaded, and the last question answered."""
        until = time.monotonic() + seconds
        while self._answered < self._asked:
            if not self._receive(until):
                return False
        return True

    def act(self, observation: Floats, seconds: float) -> Ints | None:
        """Return actions (n,) for observations (n, 9); None if they took too long, and will never be used."""
        actions: Ints | None = self._ask(np.array(observation, np.float32), seconds)
        return actions

    def pay(self, before: Situation, after: Situation, seconds: float) -> Doubles | None:
        """Return the pay (n,) of a decision; None if that took too long."""
        pay: Doubles | None = self._ask(np.array([*vars(before).values(), *vars(after).values()], float), seconds)
        return pay

    def late(self, words: str, seconds: float = 0.1) -> PilotError:
        """End the process, which took too long; return that in words, with the line at which the file was."""
        until, self._line = time.monotonic() + seconds, None
        with suppress(PilotError, OSError):
            self._link.send(None)
            while self._line is None and self._receive(until):
                pass
        self.close()
        return PilotError(f"{words}: its process was ended", self._line or 0)

    @property
    def gone(self) -> bool:
        """Whether the process has ended, or was closed."""
        return self._process.exitcode is not None

    def _ask(self, question: Any, seconds: float) -> Any:
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
        while self._answered < self._asked:
            if not self._receive(until):
                return None
        return self._answer

    def _receive(self, until: float) -> bool:
        """Take in what the process says next, and return whether it said something in time; raises PilotError."""
        try:
            while not self._link.poll(min(_TURN, max(0.0, until - time.monotonic()))):
                if self.gone and not self._link.poll():  # a child of its own may keep the pipe open
                    raise self._ended()
                if time.monotonic() >= until:
                    return False
            kind, number, *said = self._link.recv()
        except (EOFError, OSError) as error:
            raise self._ended() from error
        if kind == AT:
            self._line = number
            return True
        self._answered = number
        if kind == PROBLEM:
            line, words = said
            raise PilotError(CONTROLS.sub(" ", words), line)
        if kind == READY:
            (self.many,) = said
        elif kind == ANSWER:
            (self._answer,) = said
        return True

    def _ended(self) -> PilotError:
        self.close()
        return PilotError("its process has ended")


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


def _end(process: BaseProcess, link: Connection) -> None:
    """End a process, and where the system has groups of processes, what it has started."""
    with suppress(OSError):
        process.kill()
        if process.pid and hasattr(os, "killpg"):
            os.killpg(process.pid, signal.SIGKILL)
    process.join()
    link.close()
