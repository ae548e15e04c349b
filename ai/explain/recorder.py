"""Recorder of running code: the lines of chosen functions as they run, with the local variables that each one sets.

What a screen shows of a computation is then that computation, and the code beside it cannot disagree. Python calls a
trace function for each line, so a recorded call is slow, and one that is not recorded costs nothing.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import chain
from types import CodeType, FrameType, TracebackType
from typing import Any, Final, Self

import numpy as np

RETURN: Final = "return"  # name under which a function's result is recorded, with its last line
LARGE: Final = 1 << 16  # numbers of an array, from which on one row of it is recorded instead
Function = Callable[..., Any]


@dataclass(frozen=True, eq=False)
class Row:
    """Row of an array that is too large to be copied whole, and the shape of that array."""

    shape: tuple[int, ...]
    values: np.ndarray[Any, Any]


@dataclass(frozen=True, eq=False)
class Event:
    """Event of a recording: one line that ran.

    Attributes:
        function: qualified name of the function.
        number: number of the line in its file.
        values: variables that the line set or changed, by name: local numbers, and copies of arrays, or of a Row of
            a large one. The parts of a tuple are `name.part`, arrays that the function's object keeps `self.name`.
            The first event of a call has its arguments, the last one its result.
        owner: the `self` of the function, if it has one.

    """

    function: str
    number: int
    values: dict[str, Any]
    owner: Any = None


class Recorder:
    """Recorder of some functions; a context manager that records the thread that enters it.

    Of arrays with more than LARGE numbers, only row `row` is recorded.

    Attributes:
        functions: the functions by their qualified names.
        events: what was recorded, in the order in which it ran.

    """

    def __init__(self, functions: Iterable[Function], row: int = 0) -> None:
        self._row = row
        self.functions: dict[str, Function] = {}
        self.events: list[Event] = []
        self._codes: dict[CodeType, str] = {}
        for function in map(inspect.unwrap, functions):
            self.functions[function.__qualname__] = function
            self._codes[function.__code__] = function.__qualname__

    def __enter__(self) -> Self:
        self._before = sys.gettrace()
        sys.settrace(self._enter_function)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        sys.settrace(self._before)

    def of(self, function: str) -> list[Event]:
        """Return the events of one function."""
        return [event for event in self.events if event.function == function]

    def last(self, function: str, name: str) -> Any:
        """Return the last value of a local variable; raises KeyError if the function has never set it."""
        for event in reversed(self.events):
            if event.function == function and name in event.values:
                return event.values[name]
        raise KeyError(f"{function} has not set {name}")

    def _enter_function(self, frame: FrameType, event: str, _: Any) -> Any:
        name = self._codes.get(frame.f_code)
        return _Call(name, self.events, self._row, frame).follow if name is not None and event == "call" else None


class _Call:
    """One call of a recorded function."""

    def __init__(self, function: str, events: list[Event], row: int, frame: FrameType) -> None:
        self._function, self._events, self._row = function, events, row
        self._seen: dict[str, Any] = {}  # the latest values; at first of the object's arrays, which are no news
        self._seen = dict(self._attributes(frame))
        self._number = 0  # of the line that runs; 0 before the first

    def follow(self, frame: FrameType, event: str, result: Any) -> Any:
        """Record the line before, once the next one begins or the function returns: what it set is known only then."""
        if event in ("line", "return"):
            values = self._changed(frame)
            if event == "return":
                values |= dict(_parts(RETURN, result, self._row))
            number = self._number or frame.f_code.co_firstlineno
            self._events.append(Event(self._function, number, values, frame.f_locals.get("self")))
            self._number = frame.f_lineno
        return self.follow

    def _changed(self, frame: FrameType) -> dict[str, Any]:
        """Return copies of the variables that are new, or are not what they were."""
        changed = {}
        held = (part for name, value in frame.f_locals.items() for part in _parts(name, value, self._row))
        for name, value in chain(held, self._attributes(frame)):
            if name not in self._seen or not _same(self._seen[name], value):
                changed[name] = self._seen[name] = value
        return changed

    def _attributes(self, frame: FrameType) -> Iterator[tuple[str, Any]]:
        """Yield the arrays that the function's object keeps."""
        for name, value in getattr(frame.f_locals.get("self"), "__dict__", {}).items():
            if isinstance(value, np.ndarray):
                yield from _parts(f"self.{name}", value, self._row)


def _parts(name: str, value: Any, row: int) -> Iterator[tuple[str, Any]]:
    """Yield what can be recorded of a variable: a number, an array, or those in a tuple."""
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiub":
        large = value.size > LARGE and value.ndim > 1 and len(value) > row
        yield name, Row(value.shape, value[row].copy()) if large else value.copy()
    elif isinstance(value, np.generic):
        yield name, value.item()
    elif isinstance(value, bool | int | float):
        yield name, value
    elif isinstance(value, tuple):
        names = getattr(value, "_fields", range(len(value)))
        for part, each in zip(names, value, strict=True):
            yield from _parts(f"{name}.{part}", each, row)


def _same(before: Any, now: Any) -> bool:
    """Whether two recorded values are equal, NaN to NaN."""
    if isinstance(before, Row) and isinstance(now, Row):
        return before.shape == now.shape and _same(before.values, now.values)
    if isinstance(before, np.ndarray) and isinstance(now, np.ndarray):
        return before.shape == now.shape and before.dtype == now.dtype and before.tobytes() == now.tobytes()
    return type(before) is type(now) and repr(before) == repr(now)
