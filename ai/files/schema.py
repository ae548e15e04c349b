"""Checked reading of JSON values: a dataclass says what a file holds, and a message names the place of a fault.

The fields of a dataclass are those of the file. Their types are checked, and so is each rule that `Annotated` adds:
`Annotated[float, Within(0, 1)]`. A field with a default may be missing, and one that the dataclass does not have is
passed over. Types may be bool, int, float, str, None, dict, Any, tuples, other such dataclasses, and unions of them.
The reasons for this module in place of a library are in docs/adr/0013-one-reader-for-json.md.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import MISSING, fields
from functools import cache, partial
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Final, TypeVar, Union, get_args, get_origin, get_type_hints

from ai.files.reading import MOST, brief, number_of, parse_json, read_end, shown

T = TypeVar("T")
Check = Callable[[Any], Any]  # returns a value as its field holds it, or raises ValueError


class OtherVersionError(ValueError):
    """A file is of the right format, in a version that this program does not read."""


class Rule:
    """Rule for values of the right type: what has to hold, and the words for one of which it does not."""

    def __init__(self, holds: Callable[[Any], bool], words: str) -> None:
        self._holds, self._words = holds, words

    def __call__(self, value: Any) -> None:
        """Raise ValueError for a value that is not allowed."""
        if not self._holds(value):
            raise ValueError(f"{shown(value)} {self._words}")


class Within(Rule):
    """Allows numbers from `low` to `high`, both included."""

    def __init__(self, low: float, high: float) -> None:
        super().__init__(lambda value: low <= value <= high, f"does not lie between {low:,} and {high:,}")


class Above(Rule):
    """Allows numbers above `low`."""

    def __init__(self, low: float) -> None:
        super().__init__(lambda value: value > low, f"is not above {low:,}")


class Sized(Rule):
    """Allows texts and lists of some lengths."""

    def __init__(self, most: int, least: int = 0) -> None:
        super().__init__(lambda value: least <= len(value) <= most, f"has not a length of {least:,} to {most:,}")


class OneOf(Rule):
    """Allows a few values only."""

    def __init__(self, choices: Iterable[object]) -> None:
        known = tuple(choices)
        super().__init__(lambda value: value in known, f"is not one of {', '.join(map(str, known))}")


Count = Annotated[int, Within(0, MOST)]  # the largest number up to which floats know every whole one
Seed = Annotated[int, Within(0, 10**40)]  # far above a seed of 128 bits
Share = Annotated[float, Within(0, 1)]
Duration = Annotated[float, Within(0, MOST)]  # in seconds


def read_as(kind: type[T], values: Any) -> T:
    """Return a dataclass from what a JSON file has given; raises ValueError, which names the first fault."""
    right, problems = sound_fields(kind, _named(values))
    if problems:
        raise ValueError(problems[0])
    return kind(**right)


def read_lines(kind: type[T], path: Path, most: int) -> tuple[list[T], int]:
    """Return what the lines at the end of a file say, at most so many bytes, and how many lines make no sense.

    Raises OSError if the file cannot be read.
    """
    found, damaged = [], 0
    for line in filter(str.strip, read_end(path, most).splitlines()):
        try:
            found.append(read_as(kind, parse_json(line)))
        except ValueError:
            damaged += 1
    return found, damaged


def sound_fields(kind: type, values: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Return those fields of a dataclass that a file has given and that are right, and what is wrong with the rest."""
    right: dict[str, Any] = {}
    problems: list[str] = []
    for name, (check, needed) in _fields_of(kind).items():
        if name in values:
            try:
                right[name] = _at(name, check, values[name])
            except ValueError as error:
                problems.append(str(error))
        elif needed:
            problems.append(f"{name} is missing")
    return right, problems


def check_field(kind: type, name: str, value: Any) -> Any:
    """Return a value as a field of a dataclass holds it; raises ValueError for one of another type."""
    return _at(name, _fields_of(kind)[name][0], value)


def check_header(values: Any, form: str, version: int) -> dict[str, Any]:
    """Return the values of a file that says it is of this format and version; raises ValueError.

    Of another version, that is an OtherVersionError.
    """
    if not isinstance(values, dict) or values.get("format") != form:
        raise ValueError(f"does not say that this is a {form!r}")
    held = values.get("version")
    if type(held) is not int or held != version:
        raise OtherVersionError(f"format version {shown(held)}; this program reads version {version}")
    return values


def _at(place: object, check: Check, value: Any) -> Any:
    """Check the value of a place; raises ValueError, which begins with the place."""
    try:
        return check(value)
    except ValueError as error:
        raise ValueError(f"{brief(place, 40)}: {error}") from None


@cache
def _fields_of(kind: type) -> dict[str, tuple[Check, bool]]:
    """Return the check of each field of a dataclass, and whether a file must have the field."""
    hints = get_type_hints(kind, include_extras=True)
    return {
        each.name: (_check_of(hints[each.name]), each.default is MISSING and each.default_factory is MISSING)
        for each in fields(kind)
    }


def _check_of(hint: Any) -> Check:
    """Return the check for a type."""
    origin, inner = get_origin(hint), get_args(hint)
    if origin is Annotated:
        return partial(_ruled, _check_of(inner[0]), inner[1:])
    if origin in (Union, UnionType):
        return partial(_any_of, [_check_of(kind) for kind in inner])
    if origin is tuple:
        return partial(_tuple, [_check_of(kind) for kind in inner if kind is not Ellipsis], Ellipsis in inner)
    if origin is dict:
        return partial(_table, _check_of(inner[1]))
    return _PLAIN[hint] if hint in _PLAIN else partial(_made, hint)


def _made(kind: type, value: Any) -> Any:
    """Check for a dataclass, which may have been made already."""
    return read_as(kind, vars(value) if isinstance(value, kind) else value)


def _ruled(check: Check, rules: tuple[Check, ...], value: Any) -> Any:
    value = check(value)
    for rule in rules:
        rule(value)
    return value


def _any_of(checks: list[Check], value: Any) -> Any:
    """Check for a union: the value has to pass one of these."""
    if value is None and _none in checks:
        return None
    *others, last = (check for check in checks if check is not _none)
    for check in others:
        with suppress(ValueError):
            return check(value)
    return last(value)


def _tuple(checks: list[Check], repeated: bool, value: Any) -> tuple[Any, ...]:
    """Check for a tuple of one value for each of these checks, or of any length with one check for all."""
    if not isinstance(value, list | tuple):
        raise ValueError(f"{shown(value)} is no list")
    if repeated:
        checks = checks * len(value)
    if len(value) != len(checks):
        raise ValueError(f"{shown(value)} is no list of {len(checks)}")
    return tuple([_at(place, *each) for place, each in enumerate(zip(checks, value, strict=True))])


def _table(check: Check, value: Any) -> dict[str, Any]:
    """Check for a table, of which every value has to pass one check."""
    return {name: _at(name, check, each) for name, each in _named(value).items()}


def _of(kind: type, words: str) -> Check:
    """Return the check for values of exactly one type."""

    def check(value: Any) -> Any:
        if type(value) is not kind:
            raise ValueError(f"{shown(value)} is {words}")
        return value

    return check


_none, _named = _of(NoneType, "something"), _of(dict, "no table of values by name")
_PLAIN: Final[dict[Any, Check]] = {
    Any: lambda value: value,
    NoneType: _none,
    bool: _of(bool, "neither true nor false"),
    int: _of(int, "no whole number"),
    float: lambda value: float(number_of(value)),
    str: _of(str, "no text"),
}
