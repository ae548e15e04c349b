"""A player's file at work in a process of its own, as the process that asks it knows it.

The child is not trusted: what it sends is bounded, checked, and never unpickled, and whoever asks waits no longer than
is said. That is no sandbox: the file may do whatever the player may.
"""

from __future__ import annotations

import subprocess
import sys
import time
import weakref
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread
from typing import BinaryIO, Final, cast

import numpy as np

from ai.environment import Doubles, Floats, Ints
from ai.files import CONTROLS
from ai.lander.rewards import Situation
from ai.lander.rules import NUM_ACTIONS
from ai.pilots.child import ACT, ANSWER, MANY, PROBLEM, READY, WORDS, read_block, write_block

SERVE: Final = "--pilot-process"  # the argument by which the packed app becomes such a process
_ROOT: Final = str(Path(__file__).parents[2])
_CODE: Final = f"import sys; sys.path.insert(0, {_ROOT!r}); from ai.pilots.child import main; main()"
_ENDED: Final = b""


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
        command = [sys.executable, SERVE] if getattr(sys, "frozen", False) else [sys.executable, "-c", _CODE]
        self._questions: SimpleQueue[bytes | None] = SimpleQueue()
        self._answers: SimpleQueue[bytes] = SimpleQueue()
        self._waiting = 1  # answers that are due: the first says whether the file could be loaded
        try:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )
        except OSError as error:
            raise PilotError(f"its process could not be started: {error.strerror or error}") from error
        for part in (kind, str(path), source):
            self._questions.put(part.encode())
        talk = Thread(target=_talk, args=(self._process, self._questions, self._answers), daemon=True)
        self._end = weakref.finalize(self, _end, self._process, self._questions, talk)
        talk.start()

    def ready(self, seconds: float = 0.0) -> bool:
        """Whether nothing is under way: the file is loaded, and the last question answered."""
        until = time.monotonic() + seconds
        while self._waiting:
            if self._receive(until) is None:
                return False
        return True

    def act(self, observation: Floats, seconds: float) -> Ints | None:
        """Return actions (n,) for observations (n, 9); None if they took too long, and will never be used."""
        answer = self._ask(np.asarray(observation, np.float32).tobytes(), len(observation), seconds)
        if answer is None:
            return None
        actions = np.frombuffer(answer, np.uint8).astype(np.intp)
        if (actions >= NUM_ACTIONS).any():
            raise PilotError("its process gave an answer that is none")
        return actions

    def pay(self, before: Situation, after: Situation, seconds: float) -> Doubles | None:
        """Return the pay (n,) of a decision; None if that took too long."""
        question = np.array([*vars(before).values(), *vars(after).values()], float)
        answer = self._ask(question.tobytes(), 8 * question.shape[1], seconds)
        if answer is None:
            return None
        pay = np.frombuffer(answer, float)
        if not np.isfinite(pay).all():
            raise PilotError("its process gave an answer that is none")
        return pay

    def late(self, words: str, seconds: float = 0.1) -> PilotError:
        """End the process, which took too long; return that in words, with the line at which the file was."""
        Thread(target=_ask_where, args=(self._process.stdin,), daemon=True).start()
        line = 0
        try:
            self._receive(time.monotonic() + seconds)
        except PilotError as error:
            line = error.line
        self.close()
        return PilotError(f"{words}: its process was ended", line)

    def _ask(self, question: bytes, size: int, seconds: float) -> bytes | None:
        until = time.monotonic() + seconds
        while self._waiting:  # one that came too late before
            if self._receive(until) is None:
                return None
        self._waiting += 1
        self._questions.put(question)
        answer = self._receive(until)
        if answer is not None and len(answer) != size:
            raise PilotError("its process gave an answer that is none")
        return answer

    def _receive(self, until: float) -> bytes | None:
        """Return what the next block holds; None if there is none in time."""
        try:
            block = self._answers.get(timeout=max(0.0, until - time.monotonic()))
        except Empty:
            return None
        self._waiting -= 1
        kind, content = block[:1], block[1:]
        if block == _ENDED:
            self._answers.put(_ENDED)  # for whoever asks again
            self.close()
            raise PilotError("its process has ended")
        if kind == PROBLEM:
            line, _, words = content[: WORDS + 20].decode(errors="replace").partition(" ")
            raise PilotError(CONTROLS.sub(" ", words), int(line) if line.isdecimal() and len(line) < 9 else 0)
        if kind not in (READY, ANSWER):
            raise PilotError("its process gave an answer that is none")
        self.many = self.many or block == READY + MANY
        return content

    @property
    def gone(self) -> bool:
        """Whether the process has ended, or was closed."""
        return not self._end.alive or self._process.poll() is not None

    def close(self) -> None:
        """End the process."""
        self._end()


def _talk(process: subprocess.Popen[bytes], questions: SimpleQueue[bytes | None], answers: SimpleQueue[bytes]) -> None:
    """Send and receive in a thread: a process that reads or writes half of it blocks nobody else."""
    requests, replies = cast("BinaryIO", process.stdin), cast("BinaryIO", process.stdout)
    with suppress(OSError, ValueError):  # it has ended, or was closed meanwhile
        for _ in range(3):  # what the file is
            write_block(requests, questions.get() or b"")
        while block := read_block(replies):
            answers.put(block)
            if (question := questions.get()) is None:
                break
            write_block(requests, question)
    answers.put(_ENDED)


def _ask_where(stdin: BinaryIO) -> None:
    """Ask at which line a file is; a process that reads nothing any more holds up this thread alone."""
    with suppress(OSError, ValueError):
        write_block(stdin, b"")


def _end(process: subprocess.Popen[bytes], questions: SimpleQueue[bytes | None], talk: Thread) -> None:
    process.kill()
    process.wait()
    questions.put(None)
    talk.join(1.0)
    for stream in (process.stdin, process.stdout):
        with suppress(OSError):  # what was never read
            cast("BinaryIO", stream).close()
