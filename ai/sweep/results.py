"""Results of a trial, as a study keeps them: `ai.files.read_as` reads them from JSON, `asdict` makes it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final, Self

from ai.files import Count, Duration, Seed, Share, Sized, read_as, read_json
from ai.sweep.metric import Point

STUDIES: Final = "studies"  # folder of all studies, in the user's
STUDY_FILE: Final = "study.json"
SUMMARY_FILE: Final = "summary.json"

_Words = Annotated[str, Sized(2000)]


@dataclass(frozen=True)
class SeedResult:
    """Result of one seed of a trial.

    Attributes:
        curve: what was measured on the way.
        value: of the metric; None if there is none.
        problem: why the run ended before its time; empty if it did not.
        seconds: of training, by the clock.
        figures: of the network that is kept, as its command tells them; empty for a run that was stopped early.

    """

    seed: Seed
    curve: Annotated[tuple[Point, ...], Sized(100_000)]
    value: float | None
    problem: _Words
    seconds: Duration
    figures: dict[str, Any]


@dataclass(frozen=True)
class FinishedTrial:
    """Result of a trial.

    Attributes:
        number: of the trial in its study.
        params: values of the knobs that were searched.
        value: of the metric, as the seeds are judged; None if the settings made no sense or a seed has no value.
        at: decisions or epochs that were trained.
        stopped: whether it was stopped early, because others were better.
        seconds: that it took, by the clock, with all measuring and saving.
        seeds: the result of each seed; none if the settings made no sense.
        parent: number of the trial whose runs it went on with; None without a population.
        problem: why there is no result; empty if there is one.
        restarts: times that it went on from its last checkpoint, as its worker had died.

    """

    number: Count
    params: dict[str, Any]
    value: float | None
    at: Count
    stopped: bool
    seconds: Duration
    seeds: Annotated[tuple[SeedResult, ...], Sized(1000)]
    parent: Count | None = None
    problem: _Words = ""
    restarts: Count = 0

    @classmethod
    def senseless(cls, number: int, params: dict[str, Any], problem: str) -> Self:
        """Return the result of a trial whose settings make no sense together."""
        return cls(number, params, None, 0, False, 0.0, (), problem=problem)

    @property
    def values(self) -> list[float]:
        """Values of the seeds that have one."""
        return [seed.value for seed in self.seeds if seed.value is not None]

    @property
    def best_seed(self) -> SeedResult | None:
        """Seed whose network is the best, by the figures of its own validation; None if none was kept."""
        return max((seed for seed in self.seeds if seed.figures), key=_rank, default=None)


def _rank(seed: SeedResult) -> tuple[float, float]:
    numbers = [seed.figures.get(name) for name in ("success", "held_out", "mean_return")]
    known = [float(number) if isinstance(number, int | float) else 0.0 for number in numbers]
    return known[0] + known[1], known[2]


@dataclass(frozen=True)
class Summary:
    """Summary of a study, for lists of many.

    Attributes:
        finished, trials: trials that are finished, and those asked for.
        metric: what they are compared by.
        env: environment of its runs; None for digits.
        best: value of the best trial, as text; None before there is one.
        run: folder of the best run, within the study's.
        importance: share that each knob has in setting the best trials apart, once that is known.

    """

    finished: Count
    trials: Count
    metric: Annotated[str, Sized(200)]
    env: str | None = None
    best: Annotated[str, Sized(200)] | None = None
    run: Annotated[str, Sized(200)] | None = None
    importance: dict[str, Share] | None = None


def summary_of(folder: Path) -> Summary | None:
    """Return the summary of a study; None without one that can be read."""
    try:
        return read_as(Summary, read_json(folder / SUMMARY_FILE))
    except (OSError, ValueError, RecursionError):
        return None
