"""Design of a study: what is trained, which knobs are searched where, and what trials are compared by.

A curve is measured without random actions on validation episodes, at fixed numbers of decisions (digits: epochs on
the images held out), so a metric is the same on a slow machine and on a fast one.
"""

from __future__ import annotations

import json
import re
import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated, Any, Final, Self

from ai.digits.config import DigitConfig
from ai.files import Count, OneOf, Seed, Share, Sized, Within, read_as, read_json
from ai.files.knobs import Knobs
from ai.training.config import ANYWHERE, LANDER, Config

AGENT, DIGITS = "agent", "digits"  # kinds of run
TPE, RANDOM = "tpe", "random"
_MEASURED: Final = 5  # times that a run is measured, unless asked otherwise


@dataclass(frozen=True)
class Measurement:
    """Measurement of a learning curve."""

    at: Count  # decisions so far, or epochs
    success: Share | None  # of episodes that ended well, or of digits read right; None where that is not defined
    mean_return: float  # sum of rewards; for digits the share again


@dataclass(frozen=True)
class Metric:
    """What is read off a curve: "success", "return", "mean" or the "time" to a `share` of success."""

    kind: str
    share: float = 0.0

    @classmethod
    def named(cls, name: str) -> Self:
        """Return the metric of that name; raises ValueError for none."""
        if (time := re.fullmatch(r"time_to_(\d{1,3})", name)) and 0 < int(time[1]) <= 100:
            return cls("time", int(time[1]) / 100)
        if name in ("success", "accuracy", "return", "mean"):
            return cls("success" if name == "accuracy" else name)
        raise ValueError(f"--metric is success, accuracy, return, mean, or time_to_99 with any percentage; not {name}")

    @property
    def sign(self) -> int:
        """1 where less is better, -1 where more is."""
        return 1 if self.kind == "time" else -1

    def of(self, curve: Sequence[Measurement], budget: int, diverged: bool = False) -> float | None:
        """Return the value of one seed's curve so far, of a run of `budget`; None before the first point.

        A share that has not been reached counts as more than the whole budget: the more, the farther it was missed.
        A run that diverged has the worst value there is, or of a return the worst that was measured.
        """
        if self.kind == "return":
            returns = [point.mean_return for point in curve]
            return (min(returns) if diverged else returns[-1]) if returns else None
        if diverged:
            return budget * (1 + self.share) if self.kind == "time" else 0.0
        if not curve:
            return None
        shares = [point.success or 0.0 for point in curve]
        if self.kind == "success":
            return shares[-1]
        if self.kind == "mean":
            return statistics.fmean(shares)
        reached = (point.at for point, share in zip(curve, shares, strict=True) if share >= self.share)
        return float(next(reached, budget * (1 + self.share - max(shares))))

    def shown(self, value: float | None, budget: int) -> str:
        """Return a value as a table shows it."""
        if value is None:
            return "–"
        if self.kind == "time" and value > budget:
            return "not reached"
        kinds = {"time": ",.0f", "return": ".1f"}
        return format(value, ".3g" if abs(value) >= 1e12 else kinds.get(self.kind, ".2%"))


@dataclass(frozen=True)
class Dimension:
    """Dimension of a search space: the range of a knob, or the values to choose from."""

    low: float = 0.0
    high: float = 0.0  # included
    log: bool = False  # whether the range is searched by factors, not by differences
    whole: bool = False
    choices: tuple[Any, ...] = ()  # values in place of a range, as JSON holds them

    def __post_init__(self) -> None:
        if not self.choices and not (self.low < self.high and (self.low > 0 or not self.log)):
            raise ValueError("low lies below high, and above 0 where log is true")

    def holds(self, value: Any) -> bool:
        """Whether a trial of the study can have that value."""
        if self.choices:
            return any(type(each) is type(value) and each == value for each in self.choices)
        number = type(value) is int or (type(value) is float and not self.whole)
        return number and self.low <= value <= self.high


Space = dict[str, Dimension]


@dataclass(frozen=True)
class Design:
    """All that was asked for when a study began."""

    kind: Annotated[str, OneOf((AGENT, DIGITS))]  # of its runs
    settings: dict[str, Any]  # of every run, but for the knobs that are searched
    space: Space  # where each knob is searched, by its name
    seeds: Annotated[tuple[Seed, ...], Sized(1000, 1)]  # of each trial's runs
    budget: Annotated[int, Within(1, 10**12)]  # decisions or epochs of a run
    every: Annotated[int, Within(1, 10**12)]  # decisions or epochs between two measurements
    metric: str  # what trials are compared by
    search: Annotated[str, OneOf((TPE, RANDOM))] = TPE  # how settings are proposed
    trials: Annotated[int, Within(1, 100_000)] = 64
    seed: Seed = 0  # of the search itself
    validation: Annotated[int, Within(1, 50_000)] | None = None  # episodes of a measurement; None: as suits the task

    @classmethod
    def of(
        cls, config: Knobs, space: Space, *, seeds: int = 3, decisions: int = 250_000, every: int | None = None,
        metric: str | None = None, **others: Any,
    ) -> Self:  # fmt: skip
        """Return the design of a study of runs with these settings, with what is usual for their kind."""
        settings = json.loads(json.dumps(config.to_json()))
        if digits := isinstance(config, DigitConfig):
            budget, usual = config.epochs, "accuracy"
        else:
            budget, usual = decisions, "time_to_99" if settings["env"] in (LANDER, ANYWHERE) else "return"
        return cls(
            kind=DIGITS if digits else AGENT, settings=settings, space=space, seeds=tuple(range(seeds)), budget=budget,
            every=every or max(1, budget // _MEASURED), metric=metric or usual, **others,
        )  # fmt: skip

    @property
    def config(self) -> Knobs:
        """Settings of every run; raises ValueError for what makes no sense."""
        return (DigitConfig if self.kind == DIGITS else Config).from_json(self.settings)

    def check(self) -> None:
        """Raise ValueError if it makes no sense as a whole."""
        Metric.named(self.metric)
        known = self.config.names()
        if len(set(self.seeds)) < len(self.seeds):
            raise ValueError("each seed is there once")
        if not self.space:
            raise ValueError("a study searches at least one knob")
        if "env" in self.space:
            raise ValueError("a study has one environment: env cannot be searched")
        if self.settings.get("held_out") == 0 and "held_out" not in self.space:
            raise ValueError("a study of digits needs images held out: held_out was 0")
        if unknown := [name for name in self.space if name not in known]:
            raise ValueError(f"there is no setting called {unknown[0]}")

    def check_params(self, params: Mapping[str, Any]) -> None:
        """Raise ValueError for settings that are not of this study's space."""
        if set(params) != set(self.space) or not all(self.space[name].holds(each) for name, each in params.items()):
            raise ValueError("settings of another study")


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
    if asked not in (None, {}):
        choices = asked if isinstance(asked, list) else ()
    if not choices and (described["low"] is None or kind not in ("int", "float")):
        raise ValueError(f"{name} has no range and no choices to search; give it choices in a file")
    if choices:
        dimension = Dimension(choices=tuple(list(each) if isinstance(each, tuple) else each for each in choices))
    else:
        own = {end: described[end] for end in ("low", "high", "log")}
        if asked is not None and not (isinstance(asked, Mapping) and set(asked) <= set(own)):
            raise ValueError(f"{name}: a range is low, high and log, or a list of choices")
        try:
            dimension = read_as(Dimension, own | {"whole": kind == "int"} | dict(asked or {}))
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from error
    if dimension.whole and (dimension.low % 1 or dimension.high % 1):
        raise ValueError(f"{name} takes whole numbers: its range begins and ends with one")
    for value in dimension.choices or (dimension.low, dimension.high):
        if problem := config.problem_of(name, config.value_from_json(name, int(value) if dimension.whole else value)):
            raise ValueError(problem)
    return dimension


def knob_space(config: Knobs, names: Iterable[str]) -> Space:
    """Return the space of knobs by their own ranges; a name may also be that of a group of knobs, as "learning".

    Of a group, knobs that change nothing because another one is off are left out. Raises ValueError for other names.
    """
    space: Space = {}
    for name in names:
        # The name of the preset is no setting to search.
        group = [item.name for item in fields(config) if item.metadata["group"] == name and item.compare]
        for each in [each for each in group if each not in config.unused()] or [name]:
            space[each] = knob_dimension(config, each)
    return space


def read_space(config: Knobs, file: Path) -> Space:
    """Read a space from a file of JSON, a range or a list of choices by the name of each knob.

    {"learning_rate": {"low": 1e-4, "high": 1e-2}, "n_step": {}, "optimizer": ["adam", "momentum"]}. Raises OSError, or
    ValueError for what makes no sense.
    """
    try:
        asked = read_json(file)
    except ValueError as error:
        raise ValueError(f"{file}: {error}") from error
    if not isinstance(asked, dict) or not asked:
        raise ValueError(f"{file}: a space is a range by the name of each knob")
    return {name: knob_dimension(config, name, each) for name, each in asked.items()}
