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
from functools import cache
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Final, TypeVar, Union, get_args, get_origin, get_type_hints

from ai.files.reading import MOST, brief, number_of, parse_json, read_end, shown

T = TypeVar("T")
# What a value is not, of which the type is not exactly one of these.
_PLAIN: Final = {
    NoneType: "something",
    bool: "neither true nor false",
    int: "no whole number",
    str: "no text",
    dict: "no table of values by name",
}


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
    right, problems = sound_fields(kind, _as(dict, values))
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
    for name, (hint, needed) in _fields_of(kind).items():
        if name in values:
            try:
                right[name] = _at(name, hint, values[name])
            except ValueError as error:
                problems.append(str(error))
        elif needed:
            problems.append(f"{name} is missing")
    return right, problems


def check_field(kind: type, name: str, value: Any) -> None:
    """Raise ValueError for a value of another type than a field of a dataclass has."""
    _at(name, _fields_of(kind)[name][0], value)


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


@cache
def _fields_of(kind: type) -> dict[str, tuple[Any, bool]]:
    """Return the type of each field of a dataclass, with its rules, and whether a file must have the field."""
    hints = get_type_hints(kind, include_extras=True)
    return {
        each.name: (hints[each.name], each.default is MISSING and each.default_factory is MISSING)
        for each in fields(kind)
    }


def _at(place: object, hint: Any, value: Any) -> Any:
    """Return the value of a place as `_as` does; raises ValueError, which begins with the place."""
    try:
        return _as(hint, value)
    except ValueError as error:
        raise ValueError(f"{brief(place, 40)}: {error}") from None


def _as(hint: Any, value: Any) -> Any:
    """Return a value as a field of this type holds it; raises ValueError for one of another type, or against a rule."""
    if isinstance(hint, type):
        return _as_plain(hint, value)
    origin, inner = get_origin(hint), get_args(hint)
    if origin is Annotated:
        value = _as(inner[0], value)
        for rule in inner[1:]:
            rule(value)
        return value
    if origin in (Union, UnionType):
        *others, last = [kind for kind in inner if value is None or kind is not NoneType]
        for kind in others:
            with suppress(ValueError):
                return _as(kind, value)
        return _as(last, value)  # which says what is wrong
    if origin is tuple:
        return _as_tuple(inner, value)
    if origin is dict:
        return {name: _at(name, inner[1], each) for name, each in _as(dict, value).items()}
    raise TypeError(f"no field of a file can be {hint}")


def _as_plain(kind: Any, value: Any) -> Any:
    """Return a value as one of a class: a plain one, or a dataclass, which may be made already."""
    if kind is float:
        return float(number_of(value))
    if kind is Any:
        return value
    if kind not in _PLAIN:
        return read_as(kind, vars(value) if isinstance(value, kind) else value)
    if type(value) is not kind:
        raise ValueError(f"{shown(value)} is {_PLAIN[kind]}")
    return value


def _as_tuple(kinds: tuple[Any, ...], value: Any) -> tuple[Any, ...]:
    """Return a list as a tuple of one value for each of these types, or of any length with `...` for the second."""
    if not isinstance(value, list | tuple):
        raise ValueError(f"{shown(value)} is no list")
    if kinds[-1] is Ellipsis:
        kinds = kinds[:1] * len(value)
    if len(value) != len(kinds):
        raise ValueError(f"{shown(value)} is no list of {len(kinds)}")
    return tuple([_at(place, *each) for place, each in enumerate(zip(kinds, value, strict=True))])
