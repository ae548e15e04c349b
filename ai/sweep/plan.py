"""Plan of a study: all that was asked for when it began."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Final

from ai.files import Count, OneOf, Seed, Sized, Within
from ai.sweep.metric import JUDGES, Metric
from ai.sweep.runs import AGENT, DIGITS, read_config
from ai.sweep.space import Space, read_dimension

FORMAT: Final = "tranquility study"
VERSION: Final = 2
TPE, RANDOM, POPULATION = "tpe", "random", "population"
SEARCHES: Final = (TPE, RANDOM, POPULATION)
MOST_TRIALS: Final = 100_000


@dataclass(frozen=True)
class Plan:
    """Plan of a study.

    Attributes:
        kind: of its runs, "agent" or "digits".
        settings: of every run, but for the knobs that are searched.
        space: a dimension by the name of each knob searched, as JSON.
        seeds: of each trial's runs.
        budget: decisions or epochs of each run; in a population, those of all generations together.
        every: decisions or epochs between two measurements.
        metric: what trials are compared by.
        judge: how a trial's seeds are judged, by their median or by the worst.
        search: how settings are proposed.
        stop_early: whether trials that fall behind are ended (ASHA).
        trials: number of trials.
        population: members of a generation; 0 without a population.
        seed: of the search itself.
        validation: episodes of a measurement of an agent; None for as many as suit its task.

    """

    kind: Annotated[str, OneOf((AGENT, DIGITS))]
    settings: dict[str, Any]
    space: dict[str, dict[str, Any]]
    seeds: Annotated[tuple[Seed, ...], Sized(1000, 1)]
    budget: Annotated[int, Within(1, 10**12)]
    every: Annotated[int, Within(1, 10**12)]
    metric: str
    judge: Annotated[str, OneOf(JUDGES)]
    search: Annotated[str, OneOf(SEARCHES)]
    stop_early: bool
    trials: Annotated[int, Within(1, MOST_TRIALS)]
    population: Count = 0
    seed: Seed = 0
    validation: Annotated[int, Within(1, 50_000)] | None = None

    def check(self) -> None:
        """Raise ValueError if it makes no sense as a whole."""
        Metric.named(self.metric)
        config = read_config(self.kind, self.settings)
        if len(set(self.seeds)) < len(self.seeds):
            raise ValueError("each seed is there once")
        if not self.space:
            raise ValueError("a study searches at least one knob")
        if "env" in self.space:
            raise ValueError("a study has one environment: env cannot be searched")
        for name in self.dimensions():
            if name not in self.settings:
                raise ValueError(f"there is no setting called {name}")
        if self.search == POPULATION:
            if fixed := [name for name in self.space if name not in config.live_names()]:
                raise ValueError(
                    f"a population changes knobs while a run goes on; {', '.join(fixed)} cannot change then"
                )
            if self.population < 2 or self.trials % self.population or self.stop_early:
                raise ValueError(
                    "a population has two members or more, trials are a multiple of them, and none is stopped early"
                )
        elif self.population:
            raise ValueError(f"a population is for --search {POPULATION}")

    def dimensions(self) -> Space:
        """Return the space that is searched; raises ValueError for one that makes no sense."""
        try:
            return {name: read_dimension(each) for name, each in self.space.items()}
        except (KeyError, TypeError) as error:
            raise ValueError(f"the search space cannot be read: {error}") from error

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
        return tuple(self.budget * each // self.generations for each in (generation, generation + 1))  # type: ignore[return-value]

    @property
    def unit(self) -> str:
        """Word for what the budget counts."""
        return "epochs" if self.kind == DIGITS else "decisions"
