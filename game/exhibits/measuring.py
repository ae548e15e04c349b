"""Measurements of the exhibits: the results of all runs, and whole ranges measured in small pieces."""

from __future__ import annotations

from collections.abc import Callable

from game.exhibits.exhibit import Exhibit

_Run = tuple[type[Exhibit], float, tuple[tuple[str, float], ...]]  # of which exhibit, gravity, values


class Results:
    """What every run has measured; another run of the same exhibit, gravity and values replaces an earlier one."""

    def __init__(self) -> None:
        self._results: dict[_Run, float] = {}

    def add(self, exhibit: Exhibit) -> None:
        """Keep the result of a run, if it has one."""
        if exhibit.result is not None:
            self._results[_run(exhibit)] = exhibit.result

    def along(self, exhibit: Exhibit, name: str) -> list[tuple[float, float]]:
        """Return the values of one quantity and their results, rising, where all else is as in this exhibit."""
        kind, gravity, values = _run(exhibit)
        others = dict(values).items() - {(name, exhibit.values[name])}
        return sorted(
            (dict(run)[name], result)
            for (its_kind, its_gravity, run), result in self._results.items()
            if (its_kind, its_gravity) == (kind, gravity) and others <= set(run)
        )


class RangeMeasurement:
    """Measurement of an exhibit over the whole range of one quantity, each value in a world of its own.

    Attributes:
        done: number of values that have been measured, of `count`.

    """

    def __init__(self, exhibit: Exhibit, name: str, results: Results) -> None:
        self._results = results
        quantity = next(quantity for quantity in exhibit.quantities if quantity.name == name)
        kind, gravity, values = type(exhibit), exhibit.gravity, exhibit.values
        self._waiting = [(kind, gravity, values | {name: x}) for x in reversed(quantity.spread(kind.points))]
        self.count, self.done = len(self._waiting), 0
        self._exhibit: Exhibit | None = None
        self._longest = 0.0  # seconds that a step or the making of a world has taken

    def advance(self, now: Callable[[], float], seconds: float) -> bool:
        """Work for about so many seconds, one step at least; return whether all values have been measured."""
        start = last = now()
        while self.done < self.count:
            self._step()
            time = now()
            self._longest = max(0.9 * self._longest, time - last)
            last = time
            if time - start + self._longest > seconds:
                break
        return self.done == self.count

    def _step(self) -> None:
        exhibit = self._exhibit
        if exhibit is None:
            kind, gravity, values = self._waiting.pop()
            self._exhibit = kind(gravity, values, lean=True)
            return
        exhibit.step()
        if exhibit.result is not None or exhibit.steps >= exhibit.patience:
            self._results.add(exhibit)
            self._exhibit = None
            self.done += 1


def _run(exhibit: Exhibit) -> _Run:
    return type(exhibit), exhibit.gravity, tuple(sorted(exhibit.values.items()))
