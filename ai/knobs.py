"""A set of choices as a dataclass whose fields say what they are: what commands, screens and files all read.

A field's metadata hold a sentence of help, its group, its range, and whether it may change while a run goes on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import Field, asdict, dataclass, field, fields, replace
from typing import Any, Self

import numpy as np


def knob(
    default: Any,
    help: str,  # noqa: A002 - what it is called wherever options are described
    group: str,
    *,
    low: float | None = None,
    high: float | None = None,
    choices: tuple[str, ...] = (),
    log: bool = False,
    live: bool = False,
    offers: tuple[Any, ...] = (),
) -> Any:
    """Describe a field: its help, group, range or choices, scale, and whether it may change during a run.

    `offers` are a few values for a screen, of a field whose range says too little.
    """
    described = {
        "help": help,
        "group": group,
        "low": low,
        "high": high,
        "choices": choices,
        "log": log,
        "live": live,
        "offers": offers,
    }
    return field(default=default, metadata=described)


@dataclass(frozen=True)
class Knobs:
    """Choices whose fields are all `knob`s; a value out of range raises ValueError, with all that is wrong."""

    def __post_init__(self) -> None:
        if problems := self.problems():
            raise ValueError("; ".join(problems))

    def problems(self) -> list[str]:
        """Say what is wrong with the values."""
        return [problem for item in fields(self) if (problem := field_problem(item, getattr(self, item.name)))]

    def to_json(self) -> dict[str, Any]:
        """Plain values, for a file."""
        return asdict(self)

    @classmethod
    def from_json(cls, values: Mapping[str, Any]) -> Self:
        """Read what `to_json` wrote; unknown names and values out of range raise ValueError."""
        unknown = sorted(set(values) - {item.name for item in fields(cls)})
        if unknown:
            raise ValueError(f"unknown settings: {', '.join(unknown)}")
        try:
            return cls(**{name: cls.value_from_json(name, value) for name, value in values.items()})
        except TypeError as error:
            raise ValueError(f"settings cannot be read: {error}") from error

    @classmethod
    def value_from_json(cls, name: str, value: Any) -> Any:  # noqa: ARG003
        """Return the value of a field from what a file holds of it; what cannot be one raises TypeError."""
        return tuple(value) if isinstance(value, list) else value

    def changed(self, **values: Any) -> Self:
        """Return a copy with some fields changed, checked like any other."""
        return replace(self, **values)

    @classmethod
    def live_names(cls) -> tuple[str, ...]:
        """Return the names of the fields that may change while a run goes on."""
        return tuple(item.name for item in fields(cls) if item.metadata["live"])

    def with_live(self, other: Self) -> Self:
        """Return these choices with the live fields of others; all the rest stay as they are."""
        return self.changed(**{name: getattr(other, name) for name in self.live_names()})

    def fixed_differences(self, other: Self) -> list[str]:
        """Return the names of the fields in which others differ, although a run cannot change them."""
        taken = self.with_live(other)
        return [item.name for item in fields(self) if getattr(taken, item.name) != getattr(other, item.name)]


def field_problem(item: Field[Any], value: Any) -> str | None:
    """Say what is wrong with a field's value, if anything."""
    described = item.metadata
    if described["choices"] and value not in described["choices"]:
        return f"{item.name} is one of {', '.join(described['choices'])}, not {value!r}"
    if isinstance(value, bool) != (item.type == "bool"):
        return f"{item.name} is {'' if item.type == 'bool' else 'not '}a yes or no, and was {value!r}"
    if item.type == "int" and not isinstance(value, int | np.integer):
        return f"{item.name} is a whole number, not {value!r}"
    several = str(item.type).startswith("tuple")
    if isinstance(value, tuple) != several:
        return f"{item.name} is {'' if several else 'not '}a list of numbers, and was {value!r}"
    if described["low"] is not None:
        numbers = value if isinstance(value, tuple) else (value,)
        if not numbers or not all(
            isinstance(n, int | float) and described["low"] <= n <= described["high"] for n in numbers
        ):
            return f"{item.name} lies between {described['low']:g} and {described['high']:g}, not {value!r}"
    return None


def nearest_preset(given: Mapping[str, Any], presets: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Name the preset with the fewest settings different, and those settings; all as `to_json` gives them."""
    changes = {
        name: {key: value for key, value in given.items() if value != preset[key]} for name, preset in presets.items()
    }
    nearest = min(changes, key=lambda name: len(changes[name]))
    return {"preset": nearest, "changes": changes[nearest]}
