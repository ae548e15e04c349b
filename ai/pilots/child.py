"""The process of a player's file: it loads the file, and answers one question after another.

Both ways go blocks of bytes behind their length in four bytes. In come the file's path and source once, then arrays of
numbers, or nothing at all, which asks at which line the file is. Out come `READY` with what the file has, `ANSWER` with
the numbers, or `PROBLEM` with a line's number and words. Nothing is pickled.
"""

from __future__ import annotations

import os
import signal
import sys
import traceback
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from queue import SimpleQueue
from threading import Thread, main_thread
from typing import Any, BinaryIO, Final

import numpy as np

from ai.lander.rewards import Situation
from ai.lander.rules import NUM_ACTIONS, NUM_FEATURES

READY, ANSWER, PROBLEM = b"r", b"a", b"p"
MANY: Final = b"m"  # after `READY`: the file has `act_many`, and gets all its landers at once
LONGEST: Final = 1 << 22  # bytes of a block
WORDS: Final = 300  # characters of a problem
ACT, PAY = "act", "pay"  # what a file is asked for
_PARTS: Final = fields(Situation)

Answer = Callable[[bytes], bytes]  # numbers to numbers, as bytes


def main() -> None:
    """Serve until the other end is closed."""
    requests, replies = _own_ends()
    kind, path, source = ((read_block(requests) or b"").decode() for _ in range(3))
    questions: SimpleQueue[bytes] = SimpleQueue()
    Thread(target=_listen, args=(requests, replies, path, questions), daemon=True).start()
    try:
        answer, many = load(kind, path, source)
        write_block(replies, READY + MANY * many)
        while True:
            question = questions.get()
            try:
                block = ANSWER + answer(question)
            except BaseException as error:  # the file may raise whatever it likes, SystemExit too
                block = PROBLEM + problem(error, path).encode()
            write_block(replies, block)
    except BaseException as error:
        write_block(replies, PROBLEM + problem(error, path).encode())


def _own_ends() -> tuple[BinaryIO, BinaryIO]:
    """Return the ends that were given as standard input and output; the file's own input is empty, its print is stderr.

    Ctrl-C in a terminal reaches this process too, and is left to the one that started it.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    ends = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    void = os.open(os.devnull, os.O_RDWR)
    os.dup2(void, 0)
    try:
        os.dup2(2, 1)
    except OSError:  # an app without a terminal
        os.dup2(void, 1)
    return ends


def _listen(requests: BinaryIO, replies: BinaryIO, path: str, questions: SimpleQueue[bytes]) -> None:
    """Receive in a thread: an endless loop can say where it is, and ends too once nobody asks any more."""
    while (question := read_block(requests)) is not None:
        if question:
            questions.put(question)
            continue
        stack = traceback.walk_stack(sys._current_frames()[main_thread().ident or 0])
        line = next((line for frame, line in stack if frame.f_code.co_filename == path), 0)
        write_block(replies, PROBLEM + f"{line} ".encode())
    os._exit(0)


def read_block(stream: BinaryIO) -> bytes | None:
    """Return the next block; None at the end, or before one of more than LONGEST bytes."""
    head = stream.read(4)
    length = int.from_bytes(head, "little")
    if len(head) < 4 or length > LONGEST:
        return None
    block = stream.read(length)
    return block if len(block) == length else None


def write_block(stream: BinaryIO, block: bytes) -> None:
    """Write a block; raises OSError if nobody reads."""
    stream.write(len(block).to_bytes(4, "little") + block)
    stream.flush()


def problem(error: BaseException, path: str) -> str:
    """Return a line's number in the file, 0 if it is none of it, and after a space what went wrong there."""
    lines = [frame.lineno or 0 for frame in traceback.extract_tb(error.__traceback__) if frame.filename == path]
    line = lines[-1] if lines else 0
    if isinstance(error, SyntaxError) and error.filename == path:
        line, words = error.lineno or 0, f"{type(error).__name__}: {error.msg}"
    else:
        words = str(error) if isinstance(error, AnswerError) else f"{type(error).__name__}: {error}".removesuffix(": ")
    return f"{line} {' '.join(words[:WORDS].split())}"


class AnswerError(ValueError):
    """An answer of the file that cannot be used, in words."""


def load(kind: str, path: str, source: str) -> tuple[Answer, bool]:
    """Run a file; return what answers with its function, and whether that takes many at once.

    Raises what the file raises, or AnswerError.
    """
    sys.path.insert(0, str(Path(path).parent))
    names: dict[str, Any] = {"__name__": "pilot", "__file__": path}
    exec(compile(source, path, "exec"), names)
    if kind == PAY:
        return _paying(_function(names, "pay")), True
    if callable(many := names.get("act_many")):
        return lambda question: actions(many(_rows(question)), len(_rows(question)), "act_many").tobytes(), True
    one = _function(names, "act")
    return lambda question: b"".join(actions(one(row), 1, "act").tobytes() for row in _rows(question)), False


def _function(names: dict[str, Any], name: str) -> Callable[..., Any]:
    if not callable(function := names.get(name)):
        raise AnswerError(f"there is no function {name} in it")
    return function  # type: ignore[no-any-return]


def _rows(question: bytes) -> Any:
    """Return observations (n, 9) as an array of their own, which the file may change."""
    return np.frombuffer(question, np.float32).reshape(-1, NUM_FEATURES).copy()


def actions(given: Any, count: int, name: str) -> Any:
    """Return `count` actions as an array of bytes; raises AnswerError for anything but whole numbers from 0 to 5."""
    try:
        found = np.asarray(given)
    except ValueError:  # rows of several lengths
        found = np.empty(0, object)
    if found.dtype.kind not in "iu" or found.size != count or not ((found >= 0) & (found < NUM_ACTIONS)).all():
        one = "a whole number" if count == 1 else f"{count} whole numbers"
        raise AnswerError(f"{name} must return {one} from 0 to {NUM_ACTIONS - 1}, and returned {_shown(given)}")
    return found.astype(np.uint8).ravel()


def _paying(pay: Callable[..., Any]) -> Answer:
    def answer(question: bytes) -> bytes:
        rows = np.frombuffer(question, float).reshape(2, len(_PARTS), -1).copy()
        before, after = (
            Situation(
                *(row.astype(np.intp) if part.type == "Ints" else row for part, row in zip(_PARTS, half, strict=True))
            )
            for half in rows
        )
        given = pay(before, after.actions, after)
        try:
            found = np.asarray(given, float)
        except (TypeError, ValueError):
            found = np.empty(0)
        if found.shape != (count := rows.shape[2],) or not np.isfinite(found).all():
            raise AnswerError(f"pay must return {count} finite numbers, and returned {_shown(given)}")
        return found.tobytes()

    return answer


def _shown(value: Any) -> str:
    """Return a value in a few characters; its own `repr` may fail."""
    try:
        return repr(value)[:60]
    except Exception:
        return type(value).__name__
