"""The process of a player's file: it loads the file as a module, and answers one question after another."""

from __future__ import annotations

import importlib.util
import os
import signal
import sys
import traceback
from collections.abc import Callable
from multiprocessing import parent_process
from multiprocessing.connection import Connection
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np

from ai.files.reading import brief
from ai.lander.rewards import Situation
from ai.lander.rules import NUM_ACTIONS

ACT, PAY = "act", "pay"  # what a file is asked for

Answer = Callable[[Any], Any]  # to observations (n, 9), or to the situations before and after a decision


def serve(link: Connection, path: str, kind: str) -> None:
    """Run the file, and answer until nobody asks any more.

    What is sent back is what the file gave, and what went wrong instead: a line and words. The first, before any
    question, is whether the file takes many at once.
    """
    _stand_alone(path)
    question = answer = None
    while True:
        try:
            if answer is None:
                answer, given = load(kind, path)
            else:
                given = answer(question)
            link.send((given, 0, ""))
        except BaseException as error:  # the file may raise whatever it likes
            link.send((None, *problem(error, path)))
        question = link.recv()


def _stand_alone(path: str) -> None:
    """End with whoever started this, but not by their terminal's Ctrl-C; print to standard error."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(os, "setsid"):
        os.setsid()
    Thread(target=_end_with_parent, daemon=True).start()
    try:
        os.dup2(2, 1)
    except OSError:  # an app without a terminal
        os.dup2(os.open(os.devnull, os.O_RDWR), 1)
    sys.argv, sys.dont_write_bytecode = [path], True  # what was compiled in the same second may be another version


def _end_with_parent() -> None:
    if parent := parent_process():
        parent.join()
    os._exit(0)


def problem(error: BaseException, path: str) -> tuple[int, str]:
    """Return a line's number in the file, 0 if it is none of it, and what went wrong there."""
    lines = [line for frame, line in traceback.walk_tb(error.__traceback__) if frame.f_code.co_filename == path]
    line, words = lines[-1] if lines else 0, str(error)
    if isinstance(error, SyntaxError) and error.filename == path:
        line, words = error.lineno or 0, str(error.msg)
    if not isinstance(error, AnswerError):
        words = f"{type(error).__name__}: {words}".removesuffix(": ")
    return line, brief(" ".join(words.split()), 300)


class AnswerError(ValueError):
    """An answer of the file that cannot be used, in words."""


def load(kind: str, path: str) -> tuple[Answer, bool]:
    """Run a file; return what answers with its function, and whether that takes many at once.

    Raises what the file raises, or AnswerError.
    """
    names = vars(_module(path))
    if kind == PAY:
        return _paying(_function(names, "pay")), True
    if "act_many" in names:
        many = _function(names, "act_many")
        return lambda rows: actions(many(rows), len(rows), "act_many"), True
    one = _function(names, "act")
    return lambda rows: np.concatenate([actions(one(row), 1, "act") for row in rows]), False


def _module(path: str) -> Any:
    """Run a file as an import would, and return its module, under a name that no other has: pickles find it there."""
    name = Path(path).stem
    if name in sys.modules or name in sys.stdlib_module_names:
        name = f"own_{name}"
    sys.path.insert(0, str(Path(path).parent))
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec
    assert spec.loader
    sys.modules[name] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _function(names: dict[str, Any], name: str) -> Callable[..., Any]:
    if not callable(function := names.get(name)):
        raise AnswerError(f"there is no function {name} in it")
    return function  # type: ignore[no-any-return]


def actions(given: Any, count: int, name: str) -> Any:
    """Return `count` actions as an array; raises AnswerError for anything but whole numbers from 0 to 5."""
    found = np.asarray(given)
    whole = found.dtype.kind in "iu" and found.size == count and not np.ma.is_masked(given)
    if not whole or not ((found >= 0) & (found < NUM_ACTIONS)).all():
        one = "a whole number" if count == 1 else f"{count} whole numbers"
        raise AnswerError(
            f"{name} must return {one} from 0 to {NUM_ACTIONS - 1}, and returned {brief(repr(given), 60)}"
        )
    return found.astype(np.intp).ravel()


def _paying(pay: Callable[..., Any]) -> Answer:
    def answer(situations: tuple[Situation, Situation]) -> Any:
        before, after = situations
        given = pay(before, after.actions, after)
        found, count = np.asarray(given), len(after.steps)
        if found.dtype.kind not in "biuf" or found.shape != (count,) or not np.isfinite(found).all():
            raise AnswerError(f"pay must return {count} finite numbers, and returned {brief(repr(given), 60)}")
        return found.astype(np.float32)

    return answer
