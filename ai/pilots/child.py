"""The process of a player's file: it loads the file as a module, and answers one question after another.

The file has the main thread to itself, as any program has; one more thread says at which line it is, whenever asked.
"""

from __future__ import annotations

import importlib.util
import inspect
import linecache
import os
import signal
import sys
import traceback
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from threading import Thread, main_thread
from typing import Any, Final

import numpy as np

from ai.lander.rewards import Situation
from ai.lander.rules import NUM_ACTIONS

ACT, PAY = "act", "pay"  # what a file is asked for
_WORDS: Final = 300  # characters of a problem

Answer = Callable[[Any], Any]  # to observations (n, 9), or to the situations before and after a decision


def serve(link: Connection, where: Connection, path: str, source: str, kind: str) -> None:
    """Run the file, and answer until nobody asks any more.

    A question is a number and what `Answer` takes. An answer is the number of the last question, 0 before any, what
    the file gave, and what went wrong instead: a line and words. Loaded, it gives whether it takes many at once.
    """
    _stand_alone(path)
    Thread(target=_tell_where, args=(where, path), daemon=True).start()
    number, answer = 0, None
    while True:
        try:
            if answer is None:
                answer, given = load(kind, path, source)
            else:
                number, question = link.recv()
                given = answer(question)
            link.send((number, given, 0, ""))
        except BaseException as error:  # the file may raise whatever it likes and whenever: its signals come here too
            with suppress(OSError):  # nobody asks any more
                link.send((number, None, *problem(error, path)))
            if answer is None:
                return


def _stand_alone(path: str) -> None:
    """Leave the terminal's Ctrl-C to whoever started this; what the file prints goes to standard error."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # drops one that came meanwhile, too
    if hasattr(os, "setsid"):
        os.setsid()
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    try:
        os.dup2(2, 1)
    except OSError:  # an app without a terminal
        os.dup2(os.open(os.devnull, os.O_RDWR), 1)
    sys.argv = [path]


def _tell_where(where: Connection, path: str) -> None:
    """Say at which line an endless loop is; end it too once nobody asks any more."""
    try:
        while True:
            where.recv()
            stack = traceback.walk_stack(sys._current_frames()[main_thread().ident or 0])
            where.send(next((line for frame, line in stack if frame.f_code.co_filename == path), 0))
    except (EOFError, OSError):
        os._exit(0)


def problem(error: BaseException, path: str) -> tuple[int, str]:
    """Return a line's number in the file, 0 if it is none of it, and what went wrong there."""
    lines = [line for frame, line in traceback.walk_tb(error.__traceback__) if frame.f_code.co_filename == path]
    line = lines[-1] if lines else 0
    try:
        words = str(error)
    except BaseException:  # its own words may fail
        words = ""
    if isinstance(error, SyntaxError) and error.filename == path:
        line, words = error.lineno or 0, str(error.msg)
    if not isinstance(error, AnswerError):
        words = f"{type(error).__name__}: {words}".removesuffix(": ")
    return line, " ".join(str.split(words[:_WORDS]))


class AnswerError(ValueError):
    """An answer of the file that cannot be used, in words."""


def load(kind: str, path: str, source: str) -> tuple[Answer, bool]:
    """Run a file; return what answers with its function, and whether that takes many at once.

    Raises what the file raises, or AnswerError.
    """
    names = vars(_module(path, source))
    if kind == PAY:
        return _paying(_function(names, "pay")), True
    if names.get("act_many") is not None:
        many = _function(names, "act_many")
        return lambda rows: actions(many(rows), len(rows), "act_many"), True
    one = _function(names, "act")
    return lambda rows: np.concatenate([actions(one(row), 1, "act") for row in rows]), False


def _module(path: str, source: str) -> Any:
    """Run a file's source as the module that an import of the file would make, and return it.

    Dataclasses, pickles and `inspect` find it by its name: that of the file, unless another module has that already.
    """
    name = Path(path).stem
    if name in sys.modules or name in sys.stdlib_module_names:
        name = f"own_{name}"
    sys.path.insert(0, str(Path(path).parent))
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    # Not what is on the disk by the time that somebody looks.
    linecache.cache[path] = len(source), None, source.splitlines(keepends=True), path
    exec(compile(source.removeprefix("\ufeff"), path, "exec", dont_inherit=True), vars(module))  # as some editors begin
    return module


def _function(names: dict[str, Any], name: str) -> Callable[..., Any]:
    if not callable(function := names.get(name)):
        raise AnswerError(f"there is no function {name} in it")
    flags = (inspect.iscoroutinefunction, inspect.isasyncgenfunction)
    if any(is_async(each) for is_async in flags for each in (function, type(function).__call__)):
        raise AnswerError(f"{name} is async: it must be a plain function, def {name}")
    return function  # type: ignore[no-any-return]


def actions(given: Any, count: int, name: str) -> Any:
    """Return `count` actions as an array; raises AnswerError for anything but whole numbers from 0 to 5."""
    found = _array(given)
    if found.dtype.kind not in "iu" or found.size != count or not ((found >= 0) & (found < NUM_ACTIONS)).all():
        one = "a whole number" if count == 1 else f"{count} whole numbers"
        raise AnswerError(f"{name} must return {one} from 0 to {NUM_ACTIONS - 1}, and returned {_shown(given)}")
    return found.astype(np.intp).ravel()


def _paying(pay: Callable[..., Any]) -> Answer:
    def answer(situations: tuple[Situation, Situation]) -> Any:
        before, after = situations
        given = pay(before, after.actions, after)
        found, count = _array(given), len(after.steps)
        if found.dtype.kind not in "biuf" or found.shape != (count,) or not np.isfinite(found).all():
            raise AnswerError(f"pay must return {count} finite numbers, and returned {_shown(given)}")
        return found.astype(np.float32)

    return answer


def _array(given: Any) -> Any:
    """Return what a file has returned as an array; one of objects for what is none, or has places without a value."""
    try:
        found = np.asarray(given)
    except (TypeError, ValueError):  # rows of several lengths
        return np.empty(0, object)
    return np.empty(0, object) if np.ma.is_masked(given) else found


def _shown(value: Any) -> str:
    """Return a value in a few characters; its own `repr` may fail."""
    try:
        return repr(value)[:60]
    except Exception:
        return type(value).__name__
