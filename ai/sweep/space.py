"""Search space of a study: some knobs of a configuration, within their own ranges and scales or narrower ones."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from ai.common.knobs import Knobs, field_problem, is_number
from ai.files import read_json, shown

Space = dict[str, "Dimension"]


@dataclass(frozen=True)
class Dimension:
    """Dimension of a search space: the range of a knob, or the values to choose from.

    Attributes:
        low, high: ends of the range, both included.
        log: whether the range is searched by factors, not by differences.
        whole: whether its values are whole numbers.
        choices: values in place of a range, as JSON holds them.

    """

    low: float = 0.0
    high: float = 0.0
    log: bool = False
    whole: bool = False
    choices: tuple[Any, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """Return it as `read_dimension` reads it."""
        if self.choices:
            return {"choices": list(self.choices)}
        return {name: value for name, value in asdict(self).items() if name != "choices"}

    def place(self, value: Any) -> float:
        """Return where a value lies in the range, from 0 to 1; of a choice, its number over that of the last."""
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

    `asked` is what a file says of it: a list of values, {"choices": list}, or {"low": …, "high": …, "log": …}, each of
    which may be left out for the knob's own.
    """
    item = next((item for item in fields(config) if item.name == name), None)
    if item is None:
        raise ValueError(f"there is no setting called {name}")
    kind, described = str(item.type), item.metadata
    asked = {"choices": asked} if isinstance(asked, list) else asked or {}
    if not isinstance(asked, Mapping) or set(asked) - {"low", "high", "log", "choices", "whole"}:
        raise ValueError(f"{name}: a range is low, high and log, or a list of choices, not {shown(asked)}")
    choices = asked.get(
        "choices", described["choices"] or described["offers"] or ((False, True) if kind == "bool" else ())
    )
    if "low" in asked or "high" in asked:
        choices = asked.get("choices", ())
    if choices:
        return _choices(config, name, choices)
    if described["low"] is None or kind not in ("int", "float"):
        raise ValueError(f"{name} has no range and no choices to search; give it choices in a file")
    low, high = asked.get("low", described["low"]), asked.get("high", described["high"])
    if not is_number(low) or not is_number(high) or not described["low"] <= low < high <= described["high"]:
        raise ValueError(
            f"{name}: low and high lie between {described['low']:g} and {described['high']:g}, low below high"
        )
    log = asked.get("log", described["log"])
    if not isinstance(log, bool) or (log and low <= 0):
        raise ValueError(f"{name}: log is true or false, and false for a range that begins at 0")
    return Dimension(low, high, log, kind == "int")


def _choices(config: Knobs, name: str, choices: Any) -> Dimension:
    """Return a dimension of values to choose from, each of which the knob must take."""
    if not isinstance(choices, Sequence) or isinstance(choices, str) or not choices:
        raise ValueError(f"{name}: choices are a list, not {shown(choices)}")
    item = next(item for item in fields(config) if item.name == name)
    plain = tuple(list(value) if isinstance(value, tuple) else value for value in choices)
    for value in plain:
        if problem := field_problem(item, config.value_from_json(name, value)):
            raise ValueError(problem)
    return Dimension(choices=plain)


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
    return {config.name_now(name): knob_dimension(config, config.name_now(name), each) for name, each in asked.items()}


def read_dimension(values: Mapping[str, Any]) -> Dimension:
    """Read what `Dimension.to_json` gave; raises ValueError, TypeError or KeyError for anything else."""
    if "choices" in values:
        return Dimension(choices=tuple(values["choices"]))
    if not is_number(values["low"]) or not is_number(values["high"]):
        raise ValueError("a range has two numbers")
    return Dimension(values["low"], values["high"], bool(values["log"]), bool(values["whole"]))


def shown_value(value: Any) -> str:
    """Return a knob's value as a table shows it."""
    if isinstance(value, float):
        return f"{value:.3g}"
    return value if isinstance(value, str) else json.dumps(value).replace('"', "")
