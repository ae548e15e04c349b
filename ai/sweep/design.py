"""Design of a study: what is trained, which knobs are searched where, and what trials are compared by.

A curve is measured without random actions on validation episodes, at fixed numbers of decisions (digits: epochs on
the images held out), so a metric is the same on a slow machine and on a fast one.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Annotated, Any, Final, Self

from ai.digits.config import DigitConfig
from ai.files.knobs import Knobs
from ai.files.schema import Count, OneOf, Seed, Share, Sized, Within
from ai.training.config import ANYWHERE, LANDER, Config

AGENT, DIGITS = "agent", "digits"  # kinds of run
_MEASURED: Final = 5  # times that a run is measured, unless asked otherwise


@dataclass(frozen=True)
class Measurement:
    """Measurement of a learning curve."""

    at: Count  # decisions so far, or epochs
    success: Share | None  # of episodes that ended well, or of digits read right; None where that is not defined
    mean_return: float  # sum of rewards; for digits the share again


@dataclass(frozen=True)
class Metric:
    """What is read off a curve: "success", "return" or the "time" to a `share` of success."""

    kind: str
    share: float = 0.0

    @classmethod
    def named(cls, name: str) -> Self:
        """Return the metric of that name; raises ValueError for none."""
        if (time := re.fullmatch(r"time_to_(\d{1,3})", name)) and 0 < int(time[1]) <= 100:
            return cls("time", int(time[1]) / 100)
        if name in ("success", "accuracy", "return"):
            return cls("success" if name == "accuracy" else name)
        raise ValueError(f"--metric is success, accuracy, return, or time_to_99 with any percentage; not {name}")

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
class Design:
    """All that was asked for when a study began."""

    kind: Annotated[str, OneOf((AGENT, DIGITS))]  # of its runs
    settings: dict[str, Any]  # of every run, but for the knobs that are searched
    knobs: Annotated[tuple[str, ...], Sized(1000, 1)]  # that are searched, each in its own range
    seeds: Annotated[tuple[Seed, ...], Sized(1000, 1)]  # of each trial's runs
    budget: Annotated[int, Within(1, 10**12)]  # decisions or epochs of a run
    every: Annotated[int, Within(1, 10**12)]  # decisions or epochs between two measurements
    metric: str  # what trials are compared by
    trials: Annotated[int, Within(1, 100_000)] = 64
    seed: Seed = 0  # of the search itself
    validation: Annotated[int, Within(1, 50_000)] | None = None  # episodes of a measurement; None: as suits the task

    @classmethod
    def of(
        cls, config: Knobs, knobs: tuple[str, ...], *, seeds: int = 3, decisions: int = 250_000,
        every: int | None = None, metric: str | None = None, **others: Any,
    ) -> Self:  # fmt: skip
        """Return the design of a study of runs with these settings, with what is usual for their kind."""
        settings = json.loads(json.dumps(config.to_json()))
        if digits := isinstance(config, DigitConfig):
            budget, usual = config.epochs, "accuracy"
        else:
            budget, usual = decisions, "time_to_99" if settings["env"] in (LANDER, ANYWHERE) else "return"
        return cls(
            kind=DIGITS if digits else AGENT, settings=settings, knobs=knobs, seeds=tuple(range(seeds)), budget=budget,
            every=every or max(1, budget // _MEASURED), metric=metric or usual, **others,
        )  # fmt: skip

    @property
    def config(self) -> Knobs:
        """Settings of every run; raises ValueError for what makes no sense."""
        return (DigitConfig if self.kind == DIGITS else Config).from_json(self.settings)

    def check(self) -> None:
        """Raise ValueError if it makes no sense as a whole."""
        Metric.named(self.metric)
        config = self.config
        if len(set(self.seeds)) < len(self.seeds):
            raise ValueError("each seed is there once")
        if self.settings.get("held_out") == 0 or "held_out" in self.knobs:
            raise ValueError("a study of digits needs as many images held out in every run: held_out was 0 or searched")
        for name in self.knobs:
            choices_of(config, name)

    def check_params(self, params: Mapping[str, Any]) -> None:
        """Raise ValueError for settings that no trial of this study can have."""
        config = self.config
        if set(params) != set(self.knobs):
            raise ValueError("settings of another study")
        for name, value in params.items():
            if problem := config.problem_of(name, config.value_from_json(name, value)):
                raise ValueError(problem)


def choices_of(config: Knobs, name: str) -> tuple[Any, ...]:
    """Return the values that a search of a knob chooses from, as JSON holds them; empty if its own range is searched.

    Raises ValueError where there is neither.
    """
    item = next((item for item in fields(config) if item.name == name), None)
    if item is None:
        raise ValueError(f"there is no setting called {name}")
    described, kind = item.metadata, str(item.type)
    choices = described["choices"] or described["offers"] or ((False, True) if kind == "bool" else ())
    if not choices and (described["low"] is None or kind not in ("int", "float")):
        raise ValueError(f"{name} has no range and no choices to search")
    return tuple(list(each) if isinstance(each, tuple) else each for each in choices)


def searched(config: Knobs, names: Iterable[str]) -> tuple[str, ...]:
    """Return the knobs of these names; a name may also be that of a group of knobs, as "learning".

    Of a group, knobs that change nothing because another one is off are left out. Raises ValueError for other names.
    """
    found: dict[str, None] = {}
    for name in names:
        # The name of the preset is no setting to search.
        group = [item.name for item in fields(config) if item.metadata["group"] == name and item.compare]
        found |= dict.fromkeys([each for each in group if each not in config.unused()] or [name])
    for name in found:
        choices_of(config, name)
    return tuple(found)
