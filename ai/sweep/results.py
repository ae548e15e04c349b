"""Results of a trial, as a study keeps them."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Annotated, Any, Self

from ai.files import Count, Duration, Seed, Share, Sized, read_as
from ai.sweep.metric import Point

_Words = Annotated[str, Sized(2000)]


@dataclass(frozen=True)
class SeedResult:
    """Result of one seed of a trial.

    Attributes:
        seed: of the run.
        curve: what was measured on the way.
        value: of the metric; None if there is none.
        problem: why the run ended before its time; empty if it did not.
        seconds: of training, by the clock.
        figures: of the network that is kept, as its command tells them; empty for a run that was stopped early.

    """

    seed: Seed
    curve: tuple[Point, ...]
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
        restarts: times that it went on from its last checkpoint, with an empty memory, as its worker had died.

    """

    number: Count
    params: dict[str, Any]
    value: float | None
    at: Count
    stopped: bool
    seconds: Duration
    seeds: tuple[SeedResult, ...]
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
        kept = [seed for seed in self.seeds if seed.figures]
        return max(kept, key=_rank, default=None)

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON can hold it."""
        told = asdict(self)
        for seed in told["seeds"]:
            seed["curve"] = [[point["at"], point["success"], point["mean_return"]] for point in seed["curve"]]
        return told

    @classmethod
    def from_json(cls, values: Any) -> Self:
        """Read what `to_json` gave; raises ValueError, which names all that is wrong."""
        told = read_as(_TrialFile, values)
        seeds = tuple(
            SeedResult(**vars(seed) | {"curve": tuple(Point(*point) for point in seed.curve)}) for seed in told.seeds
        )
        return cls(**vars(told) | {"seeds": seeds})


def _rank(seed: SeedResult) -> tuple[float, float]:
    figures = seed.figures
    numbers = [figures.get(name) for name in ("success", "held_out", "mean_return")]
    known = [float(number) if isinstance(number, int | float) else 0.0 for number in numbers]
    return known[0] + known[1], known[2]


# As a file has them: points as lists, and no field left out.


@dataclass(frozen=True)
class _SeedFile(SeedResult):
    curve: Annotated[tuple[tuple[Count, Share | None, float], ...], Sized(100_000)]  # type: ignore[assignment]


@dataclass(frozen=True)
class _TrialFile(FinishedTrial):
    seeds: Annotated[tuple[_SeedFile, ...], Sized(1000)]
    parent: Count | None = field()
    problem: _Words = field()
