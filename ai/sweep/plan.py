"""Plan of a study: all that was asked for when it began."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Final, Self

from ai.digits.config import DigitConfig
from ai.files import Count, OneOf, Seed, Sized, Within
from ai.files.knobs import Knobs
from ai.sweep.metric import Metric
from ai.sweep.space import Dimension
from ai.training.config import ANYWHERE, LANDER, Config

AGENT, DIGITS = "agent", "digits"  # kinds of run
TPE, RANDOM, POPULATION = "tpe", "random", "population"
_MEASURED: Final = 5  # times that a run is measured, unless told otherwise


@dataclass(frozen=True)
class Plan:
    """Plan of a study."""

    kind: Annotated[str, OneOf((AGENT, DIGITS))]  # of its runs
    settings: dict[str, Any]  # of every run, but for the knobs that are searched
    space: dict[str, Dimension]  # where each knob is searched, by its name
    seeds: Annotated[tuple[Seed, ...], Sized(1000, 1)]  # of each trial's runs
    budget: Annotated[int, Within(1, 10**12)]  # decisions or epochs of a run; in a population, of all generations
    every: Annotated[int, Within(1, 10**12)]  # decisions or epochs between two measurements
    metric: str  # what trials are compared by
    search: Annotated[str, OneOf((TPE, RANDOM, POPULATION))] = TPE  # how settings are proposed
    stop_early: bool = False  # whether trials that fall behind are ended
    trials: Annotated[int, Within(1, 100_000)] = 64
    population: Count = 0  # members of a generation; 0 without a population
    seed: Seed = 0  # of the search itself
    validation: Annotated[int, Within(1, 50_000)] | None = None  # episodes of a measurement; None: as suits the task

    @classmethod
    def of(
        cls, config: Knobs, space: Mapping[str, Dimension], *, seeds: int = 3, decisions: int = 250_000,
        every: int | None = None, metric: str | None = None, search: str = TPE, trials: int = 64,
        population: int | None = None, **others: Any,
    ) -> Self:  # fmt: skip
        """Return the plan of a study of runs with these settings, with what is usual for their kind."""
        settings = json.loads(json.dumps(config.to_json()))
        if digits := isinstance(config, DigitConfig):
            budget, usual = config.epochs, "accuracy"
        else:
            budget, usual = decisions, "time_to_99" if settings["env"] in (LANDER, ANYWHERE) else "return"
        if search == POPULATION:
            population = population or 8
            every = every or budget // max(1, trials // population)
        return cls(
            kind=DIGITS if digits else AGENT, settings=settings, space=dict(space), seeds=tuple(range(seeds)),
            budget=budget, every=every or max(1, budget // _MEASURED), metric=metric or usual, search=search,
            trials=trials, population=population or 0, **others,
        )  # fmt: skip

    @property
    def config(self) -> Knobs:
        """Settings of every run; raises ValueError for what makes no sense."""
        return (DigitConfig if self.kind == DIGITS else Config).from_json(self.settings)

    def check(self) -> None:
        """Raise ValueError if it makes no sense as a whole."""
        Metric.named(self.metric)
        live, known = self.config.live_names(), self.config.names()
        if len(set(self.seeds)) < len(self.seeds):
            raise ValueError("each seed is there once")
        if not self.space:
            raise ValueError("a study searches at least one knob")
        if "env" in self.space:
            raise ValueError("a study has one environment: env cannot be searched")
        if unknown := [name for name in self.space if name not in known]:
            raise ValueError(f"there is no setting called {unknown[0]}")
        if (self.search == POPULATION) != bool(self.population):
            raise ValueError(f"a population is for --search {POPULATION}")
        if fixed := [name for name in self.space if self.population and name not in live]:
            raise ValueError(f"a population changes knobs while a run goes on; {', '.join(fixed)} cannot change then")
        if self.population and (self.population < 2 or self.trials % self.population or self.stop_early):
            raise ValueError(
                "a population has two members or more, trials are a multiple of them, and none is stopped early"
            )

    @property
    def generations(self) -> int:
        """Number of generations; 1 without a population."""
        return self.trials // self.population if self.population else 1

    def generation(self, number: int) -> int:
        """Return the generation of a trial, from 0 on."""
        return number // self.population if self.population else 0

    def span(self, number: int) -> tuple[int, int]:
        """Return where the runs of a trial begin and end, in decisions or epochs."""
        generation = self.generation(number)
        return self.budget * generation // self.generations, self.budget * (generation + 1) // self.generations

    @property
    def unit(self) -> str:
        """Word for what the budget counts."""
        return "epochs" if self.kind == DIGITS else "decisions"
