"""Checked reading of JSON values: a dataclass says what a file holds, and one message names all that is wrong.

The fields of a dataclass are those of the file. Their types are checked, and so is each rule that `Annotated` adds:
`Annotated[float, Within(0, 1)]`. A field with a default may be missing, so that files from before it was added can
still be read. Types may be bool, int, float, str, None, dict, Any, tuples, other such dataclasses, and unions of them.
The reasons for this module in place of a library are in docs/adr/0013-one-reader-for-json.md.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import suppress
from dataclasses import MISSING, dataclass, fields, is_dataclass
from functools import cache
from itertools import islice
from types import NoneType, UnionType
from typing import Annotated, Any, Final, TypeVar, Union, get_args, get_origin, get_type_hints

from ai.files.reading import MOST, brief, count_of, number_of, shown

T = TypeVar("T")
Rule = Callable[[Any], object]  # raises ValueError for a value of the right type that is not allowed
Check = Callable[[Any], Any]  # returns a value as its field holds it, or raises ValueError

LARGEST_SEED: Final = 10**40  # far above a seed of 128 bits
_NAMED: Final = 20  # problems that a message names
_SHOWN: Final = 40  # letters of a wrong value in a message


class SchemaError(ValueError):
    """Values are not what a file should hold; `problems` lists what is wrong, each with its place."""

    def __init__(self, problems: list[str]) -> None:
        self.problems = problems
        named = [*map(brief, problems[:_NAMED]), *(["and more"] if len(problems) > _NAMED else [])]
        super().__init__("; ".join(named))


@dataclass(frozen=True)
class Within:
    """Allows numbers from `low` to `high`, both included."""

    low: float
    high: float

    def __call__(self, value: float) -> None:
        """Raise ValueError for a number out of bounds."""
        if not self.low <= value <= self.high:
            raise ValueError(f"{shown(value)} does not lie between {self.low:,} and {self.high:,}")


@dataclass(frozen=True)
class Above:
    """Allows numbers above `low`."""

    low: float

    def __call__(self, value: float) -> None:
        """Raise ValueError for a number that is not above the bound."""
        if not value > self.low:
            raise ValueError(f"{shown(value)} is not above {self.low:,}")


@dataclass(frozen=True)
class Sized:
    """Allows texts and lists of some lengths."""

    most: int
    least: int = 0

    def __call__(self, value: Collection[Any]) -> None:
        """Raise ValueError for a text or a list that is too long or too short."""
        if not self.least <= len(value) <= self.most:
            raise ValueError(f"{shown(value)} has a length of {len(value):,}, not of {self.least:,} to {self.most:,}")


class OneOf:
    """Allows a few values only."""

    def __init__(self, choices: Iterable[object]) -> None:
        self.choices = tuple(choices)

    def __call__(self, value: object) -> None:
        """Raise ValueError for any other value."""
        if value not in self.choices:
            raise ValueError(f"{shown(value)} is not one of {', '.join(map(str, self.choices))}")


Count = Annotated[int, Within(0, MOST)]  # the largest number up to which floats know every whole one
Seed = Annotated[int, Within(0, LARGEST_SEED)]
Share = Annotated[float, Within(0, 1)]
Duration = Annotated[float, Within(0, MOST)]  # in seconds


def read_as(kind: type[T], values: Any, *, strict: bool = False) -> T:
    """Return a dataclass from what a JSON file has given; raises ValueError, which names all that is wrong.

    Fields that `kind` does not have are passed over; with `strict`, they are refused, here and in dataclasses within.
    """
    made: T = _made(kind, strict, values)
    return made


def sound_fields(kind: type, values: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Return those fields of a dataclass that a file has given and that are right, and what is wrong with the rest."""
    return _sort_out(kind, False, values)


def check_header(values: Any, form: str, versions: Collection[int]) -> dict[str, Any]:
    """Return the values of a file that says it is of this format, in a version that can be read; raises ValueError."""
    if not isinstance(values, dict) or values.get("format") != form:
        raise ValueError(f"does not say that this is a {form!r}")
    version = values.get("version")
    if type(version) is not int or version not in versions:
        known = " and ".join(map(str, versions))
        raise ValueError(f"format version {shown(version)}; this program reads version {known}")
    return values


def _sort_out(kind: type, strict: bool, values: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    right: dict[str, Any] = {}
    problems: list[str] = []
    known = _fields_of(kind, strict)
    for name, (check, needed) in known.items():
        if name in values:
            try:
                right[name] = check(values[name])
            except ValueError as error:
                problems += _placed(name, error)
        elif needed:
            problems.append(f"{name} is missing")
    if strict:
        strangers = (f"{brief(name, _SHOWN)} is unknown" for name in values if name not in known)
        problems += islice(strangers, _NAMED)
    return right, problems


def _placed(place: str, error: ValueError) -> list[str]:
    """Return the problems of a value with its place before each, as in "flights[2].seed: ..."."""
    if isinstance(error, SchemaError):
        return [f"{place}{'' if problem.startswith('[') else '.'}{problem}" for problem in error.problems]
    return [f"{place}: {error}"]


@cache
def _fields_of(kind: type, strict: bool) -> dict[str, tuple[Check, bool]]:
    """Return the check of each field of a dataclass, and whether a file must have the field."""
    hints = get_type_hints(kind, include_extras=True)
    return {
        each.name: (_check_of(hints[each.name], strict), each.default is MISSING and each.default_factory is MISSING)
        for each in fields(kind)
    }


def _check_of(hint: Any, strict: bool) -> Check:
    """Return the check for a type."""
    origin, inner = get_origin(hint), get_args(hint)
    if hint is Any:
        return lambda value: value
    if origin is Annotated:
        if inner[0] is int and isinstance(inner[1], Within):
            return _Whole(int(inner[1].low), int(inner[1].high))
        return _ruled(_check_of(inner[0], strict), inner[1:])
    if origin in (Union, UnionType):
        return _any_of([_check_of(kind, strict) for kind in inner if kind is not NoneType], NoneType in inner)
    if origin is tuple and inner[-1] is not Ellipsis:
        return _each([_check_of(kind, strict) for kind in inner])
    if origin is tuple:
        return _all(_check_of(inner[0], strict))
    if origin is dict:
        return _table(_check_of(inner[1], strict))
    if is_dataclass(hint):
        return lambda value: _made(hint, strict, value)
    return _PLAIN[hint]


def _ruled(check: Check, rules: tuple[Rule, ...]) -> Check:
    def both(value: Any) -> Any:
        value = check(value)
        for rule in rules:
            rule(value)
        return value

    return both


def _any_of(checks: list[Check], or_none: bool) -> Check:
    """Return the check for a union: the value has to pass one of these, or be None where that is allowed."""

    def check(value: Any) -> Any:
        if value is None and or_none:
            return None
        for each in checks[:-1]:
            with suppress(ValueError):
                return each(value)
        return checks[-1](value)

    return check


def _each(checks: list[Check]) -> Check:
    """Return the check for a tuple of one value for each of these checks."""

    def check(value: Any) -> tuple[Any, ...]:
        if not isinstance(value, list | tuple) or len(value) != len(checks):
            raise ValueError(f"{shown(value)} is no list of {len(checks)}")
        places = (f"[{place}]" for place in range(len(checks)))
        return tuple(_gathered(zip(places, checks, value, strict=True)).values())

    return check


def _all(check: Check) -> Check:
    """Return the check for a tuple of any length, of which every value has to pass one check."""

    def checked(value: Any) -> tuple[Any, ...]:
        if not isinstance(value, list | tuple):
            raise ValueError(f"{shown(value)} is no list")
        if isinstance(check, _Whole) and check.all(value):
            return tuple(value)
        try:
            return tuple(map(check, value))
        except ValueError:  # rare, so only then is each place noted
            _gathered((f"[{place}]", check, each) for place, each in enumerate(value))
            raise

    return checked


def _table(check: Check) -> Check:
    """Return the check for a table, of which every value has to pass one check."""
    return lambda value: _gathered((brief(name, _SHOWN), check, each) for name, each in _named(value).items())


def _gathered(parts: Iterable[tuple[str, Check, Any]]) -> dict[str, Any]:
    """Check values by their places, and return them so; raises SchemaError for all that are wrong."""
    found: dict[str, Any] = {}
    problems: list[str] = []
    for place, check, value in parts:
        try:
            found[place] = check(value)
        except ValueError as error:
            problems += _placed(place, error)
            if len(problems) > _NAMED:  # a long list can be wrong throughout
                break
    if problems:
        raise SchemaError(problems)
    return found


def _made(kind: Any, strict: bool, value: Any) -> Any:
    right, problems = _sort_out(kind, strict, _named(value))
    if problems:
        raise SchemaError(problems)
    return kind(**right)


def _bool(value: Any) -> bool:
    if not isinstance(value, bool):
        raise ValueError(f"{shown(value)} is neither true nor false")
    return value


@dataclass(frozen=True)
class _Whole:
    low: int
    high: int

    def __call__(self, value: Any) -> int:
        if type(value) is int and self.low <= value <= self.high:
            return value
        return count_of(value, self.low, self.high)

    def all(self, values: Collection[Any]) -> bool:
        """Whether all of many values are right, in a quarter of the time that each by itself takes."""
        return set(map(type, values)) == {int} and self.low <= min(values) and max(values) <= self.high


def _float(value: Any) -> float:
    return float(number_of(value))


def _str(value: Any) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{shown(value)} is no text")
    return value


def _named(value: Any) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise ValueError(f"{shown(value)} is no table of values by name")
    return value


_PLAIN: Final[dict[Any, Check]] = {bool: _bool, int: _Whole(-LARGEST_SEED, LARGEST_SEED), float: _float, str: _str}
