"""Recorder of running code: the calls of chosen functions, line by line, with the local variables that each line sets.

What a screen shows of a computation is then that computation, and the code beside it cannot disagree. Python calls a
trace function for each line, so a recorded call is slow, and one that is not recorded costs nothing.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
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
class Line:
    """Line of code that ran.

    Attributes:
        function: qualified name of the function.
        number: number of the line in its file.
        values: variables that the line set or changed, by name: local numbers, and copies of arrays, or of a Row of
            a large one. The parts of a tuple are `name.part`, arrays that the function's object keeps `self.name`.
            The first line of a call has its arguments, the last one its result.

    """

    function: str
    number: int
    values: dict[str, Any]


@dataclass(eq=False)
class Call:
    """Call of a recorded function, with the lines that ran, in order; to be read when it is over."""

    lines: list[Line] = field(default_factory=list)

    @property
    def arguments(self) -> dict[str, Any]:
        """What it was called with, by name."""
        return self.lines[0].values

    @cached_property
    def values(self) -> dict[str, Any]:
        """The last value of each variable, by name; of its result by RETURN."""
        return {name: value for line in self.lines for name, value in line.values.items()}


class Recorder:
    """Recorder of some functions; a context manager that records the thread that enters it.

    Of arrays with more than LARGE numbers, only row `row` is recorded. A method is recorded by the class that defines
    it.

    Attributes:
        lines: the lines that ran, in order.

    """

    def __init__(self, functions: Iterable[Function], row: int = 0) -> None:
        self._row = row
        self.lines: list[Line] = []
        self._calls: dict[CodeType, list[Call]] = {inspect.unwrap(each).__code__: [] for each in functions}

    def __enter__(self) -> Self:
        self._before = sys.gettrace()
        sys.settrace(self._enter_function)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        sys.settrace(self._before)

    def calls(self, function: Function) -> list[Call]:
        """Return the calls of a function; [] for one that is not recorded."""
        return self._calls.get(inspect.unwrap(function).__code__, [])

    def call(self, function: Function) -> Call:
        """Return the last call of a function; raises LookupError if there was none."""
        calls = self.calls(function)
        if not calls:
            raise LookupError(f"{function.__qualname__} did not run")
        return calls[-1]

    def _enter_function(self, frame: FrameType, event: str, _: Any) -> Any:
        calls = self._calls.get(frame.f_code)
        if calls is None or event != "call":
            return None
        calls.append(Call())
        return _Follower(frame, calls[-1], self.lines, self._row).follow


class _Follower:
    """Follower of one call, which records each line of it."""

    def __init__(self, frame: FrameType, call: Call, lines: list[Line], row: int) -> None:
        self._call, self._lines, self._row = call, lines, row
        self._seen: dict[str, Any] = dict(self._attributes(frame))  # the latest values; these arrays are no news
        self._number = frame.f_code.co_firstlineno  # of the line that runs

    def follow(self, frame: FrameType, event: str, result: Any) -> Any:
        """Record the line before, once the next one begins or the function returns: what it set is known only then."""
        if event in ("line", "return"):
            values = self._changed(frame)
            if event == "return":
                values |= dict(_parts(RETURN, result, self._row))
            line = Line(frame.f_code.co_qualname, self._number, values)
            self._call.lines.append(line)
            self._lines.append(line)
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
        for part, each in zip(getattr(value, "_fields", range(len(value))), value, strict=True):
            yield from _parts(f"{name}.{part}", each, row)


def _same(before: Any, now: Any) -> bool:
    """Whether two recorded values are equal, NaN to NaN."""
    if isinstance(before, Row) and isinstance(now, Row):
        return before.shape == now.shape and _same(before.values, now.values)
    if isinstance(before, np.ndarray) and isinstance(now, np.ndarray):
        return before.shape == now.shape and before.dtype == now.dtype and before.tobytes() == now.tobytes()
    return type(before) is type(now) and repr(before) == repr(now)
