"""Search space of a study: some knobs of a configuration, within their own ranges and scales or narrower ones."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from ai.files import read_as, read_json
from ai.files.knobs import Knobs, field_problem

Space = dict[str, "Dimension"]


@dataclass(frozen=True)
class Dimension:
    """Dimension of a search space: the range of a knob, or the values to choose from."""

    low: float = 0.0
    high: float = 0.0  # included
    log: bool = False  # whether the range is searched by factors, not by differences
    whole: bool = False
    choices: tuple[Any, ...] = ()  # values in place of a range, as JSON holds them

    @property
    def ends(self) -> tuple[Any, Any]:
        """First and last value."""
        return (self.choices[0], self.choices[-1]) if self.choices else (self.low, self.high)

    def place(self, value: Any) -> float:
        """Return where a value lies in the range, 0 to 1; of a choice, its number over that of the last.

        Raises ValueError or TypeError for what is no such value.
        """
        if self.choices:
            return self.choices.index(value) / max(1, len(self.choices) - 1)
        low, high, at = map(math.log, (self.low, self.high, value)) if self.log else (self.low, self.high, value)
        return min(1.0, max(0.0, (at - low) / (high - low))) if high > low else 0.0

    def at(self, place: float) -> Any:
        """Return the value at a place from 0 to 1."""
        place = min(1.0, max(0.0, place))
        if self.choices:
            return self.choices[round(place * (len(self.choices) - 1))]
        reach = self.high - self.low
        value = self.low * (self.high / self.low) ** place if self.log else self.low + reach * place
        value = min(self.high, max(self.low, value))
        return round(value) if self.whole else value

    def draw(self, rng: np.random.Generator) -> Any:
        """Return a value drawn at random, by the scale of the range."""
        return self.choices[int(rng.integers(len(self.choices)))] if self.choices else self.at(float(rng.random()))


def knob_dimension(config: Knobs, name: str, asked: Any = None) -> Dimension:
    """Return the dimension of a knob; raises ValueError where there is none.

    `asked` is what a file says of it: a list of values, or {"low": …, "high": …, "log": …}, each of which may be left
    out for the knob's own.
    """
    item = next((item for item in fields(config) if item.name == name), None)
    if item is None:
        raise ValueError(f"there is no setting called {name}")
    kind, described = str(item.type), item.metadata
    choices = described["choices"] or described["offers"] or ((False, True) if kind == "bool" else ())
    if isinstance(asked, list):
        choices = asked
    elif asked:
        choices = ()
    if not choices and (described["low"] is None or kind not in ("int", "float")):
        raise ValueError(f"{name} has no range and no choices to search; give it choices in a file")
    if choices:
        dimension = Dimension(choices=tuple(list(each) if isinstance(each, tuple) else each for each in choices))
    else:
        own = {end: described[end] for end in ("low", "high", "log")}
        if asked and not (isinstance(asked, Mapping) and set(asked) <= set(own)):
            raise ValueError(f"{name}: a range is low, high and log, or a list of choices")
        dimension = read_as(Dimension, own | {"whole": kind == "int"} | (asked or {}))
        if not dimension.low < dimension.high or (dimension.log and dimension.low <= 0):
            raise ValueError(f"{name}: low lies below high, and above 0 where log is true")
    for value in dimension.choices or dimension.ends:
        if problem := field_problem(item, config.value_from_json(name, int(value) if dimension.whole else value)):
            raise ValueError(problem)
    return dimension


def knob_space(config: Knobs, names: Iterable[str]) -> Space:
    """Return the space of knobs by their own ranges; a name may also be that of a group of knobs, as "learning".

    Of a group, knobs that change nothing because another one is off are left out. Raises ValueError for other names.
    """
    space: Space = {}
    for name in map(config.name_now, names):
        group = [item.name for item in fields(config) if item.metadata["group"] == name]
        for each in [each for each in group if each not in config.unused()] or [name]:
            space[each] = knob_dimension(config, each)
    return space


def read_space(config: Knobs, file: Path) -> Space:
    """Read a space from a file of JSON, a range or a list of choices by the name of each knob.

    {"learning_rate": {"low": 1e-4, "high": 1e-2}, "n_step": {}, "optimizer": ["adam", "momentum"]}. Raises OSError, or
    ValueError for what makes no sense.
    """
    asked = read_json(file)
    if not isinstance(asked, dict) or not asked:
        raise ValueError(f"{file}: a space is a range by the name of each knob")
    return {(now := config.name_now(name)): knob_dimension(config, now, each) for name, each in asked.items()}


def shown_value(value: Any) -> str:
    """Return a knob's value as a table shows it."""
    if isinstance(value, float):
        return f"{value:.3g}"
    return value if isinstance(value, str) else json.dumps(value).replace('"', "")
