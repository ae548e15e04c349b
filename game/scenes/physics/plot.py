"""Plot of an exhibit's law over one quantity, and what the engine has measured: how far they are apart, and why."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from game.core import texts
from game.drawing.canvas import Point
from game.drawing.cursor import Cursor
from game.drawing.tokens import HUMAN, INK, MUTE, SMALL, Colour
from game.scenes.physics.exhibit import Exhibit
from game.ui import plotting
from game.ui.chart import Chart
from game.ui.curves import Series
from game.ui.panel import Column

_HEIGHT: Final = 190.0
_CURVE: Final = 65  # places at which the law is evaluated
_SEEN: Final = 5e-3  # share of the law's greatest value from which the reason for a difference is given
_SMOOTHING: Final = 0.3
_Run = tuple[type[Exhibit], float, tuple[tuple[str, float], ...]]  # of which exhibit, gravity, values


class Results:
    """What every run has measured; another run of the same exhibit, gravity and values replaces an earlier one."""

    def __init__(self) -> None:
        self._results: dict[_Run, float] = {}

    def add(self, exhibit: Exhibit) -> bool:
        """Keep the result of a run, if it has one; return whether that is news."""
        if exhibit.result is None or self._results.get(_run(exhibit)) == exhibit.result:
            return False
        self._results[_run(exhibit)] = exhibit.result
        return True

    def along(self, exhibit: Exhibit, name: str) -> list[tuple[float, float]]:
        """Return the values of one quantity and their results, rising, where all else is as in this exhibit."""
        kind, gravity, values = _run(exhibit)
        others = dict(values).items() - {(name, exhibit.values[name])}
        return sorted(
            (dict(run)[name], result)
            for (its_kind, its_gravity, run), result in self._results.items()
            if (its_kind, its_gravity) == (kind, gravity) and others <= set(run)
        )


def _run(exhibit: Exhibit) -> _Run:
    return type(exhibit), exhibit.gravity, tuple(sorted(exhibit.values.items()))


class LawPlot:
    """Plot over one quantity, for the gravity and the other quantities of an exhibit.

    Attributes:
        law: what the law says of the values as they are.
        points: values of the quantity, and what was measured there.
        worst: greatest difference of these points from the law.
        top: greatest value of the law over the range.

    """

    def __init__(self, exhibit: Exhibit, name: str, results: Results) -> None:
        self.exhibit, self.name, self._results = exhibit, name, results
        self._what, self.unit, self._formula, self._when, self._why = texts.LAWS[exhibit.name]
        self._quantity, figure = texts.QUANTITIES[name]
        quantity = next(each for each in exhibit.quantities if each.name == name)
        self._x = np.linspace(*quantity.limits, _CURVE)
        self._y = np.array([self._law_at(x) for x in self._x.tolist()])
        self.law, self.top = self._law_at(exhibit.values[name]), float(self._y.max())
        self._chart = Chart(
            (0, 0, 300, _HEIGHT),
            texts.LAW_AXIS.format(what=self._what, unit=self.unit),
            limits=(0.0, float(plotting.grid(0.0, self.top)[-1])),
            read=lambda value: f"{value:.2f}",
            read_x=lambda value: figure.format(value=value),
        )
        self.refresh()
        self._chart.update(at_once=True)

    def _law_at(self, x: float) -> float:
        return self.exhibit.law(self.exhibit.gravity, self.exhibit.values | {self.name: x})

    def refresh(self) -> None:
        self.points = self._results.along(self.exhibit, self.name)
        self.worst = max((abs(result - self._law_at(x)) for x, result in self.points), default=0.0)
        now = self.exhibit.values[self.name]
        here = Series([now], [self.law], texts.LAW_NOW, INK, smooth=False)
        law = Series(self._x, self._y, texts.LAW_CURVE, MUTE, smooth=False)
        # A gap between any two points, so that no line joins what has been measured one by one.
        places = np.array([x for x, _ in self.points])
        x = np.insert(places, range(1, len(places)), (places[1:] + places[:-1]) / 2)
        y = np.full(len(x), np.nan)
        y[::2] = [result for _, result in self.points]
        measured = Series(x, y, texts.LAW_MEASURED, HUMAN, smooth=False)
        self._chart.set([here, law, measured], (float(self._x[0]), float(self._x[-1])))
        self._chart.mark(now)

    def update(self) -> None:
        self._chart.update()

    def hover(self, point: Point | None) -> None:
        self._chart.hover(point)

    def describe(self, column: Column, progress: Callable[[], str]) -> None:
        """Add the formula, the chart, and what there is to say; `progress` tells of a range that is being measured."""
        column.aside(texts.LAW_FORMULA.format(formula=self._formula))
        column.add(self._write_chart)
        column.add(lambda cursor: cursor.styled(self._quantity, SMALL, MUTE, align="centre"))
        column.add(lambda cursor: self._write_sentences(cursor, progress()))

    def _write_chart(self, cursor: Cursor) -> None:
        box, canvas = cursor.take(_HEIGHT), cursor.canvas
        if canvas is None:
            self._chart.move(box)
            return
        self._chart.draw(canvas)
        for x, result in self.points:
            canvas.dot(self._chart.place(x, result), 3.2, HUMAN)

    def _write_sentences(self, cursor: Cursor, progress: str) -> None:
        for words, colour in self.sentences(progress):
            cursor.styled(words, SMALL, colour)

    def sentences(self, progress: str) -> list[tuple[str, Colour]]:
        """Return what is said under the chart, each sentence with its colour."""
        result = self.exhibit.result
        first = texts.LAW_WAITING.format(law=self.law, unit=self.unit, when=self._when)
        if result is not None:
            apart = abs(result - self.law)
            first = texts.LAW_RESULT.format(law=self.law, measured=result, apart=apart, unit=self.unit)
        lines = [(first, INK)]
        if progress:
            return [*lines, (progress, MUTE)]
        if self.points:
            share = self.worst / self.top if self.top else 0.0
            words = {"count": len(self.points), "apart": self.worst, "unit": self.unit, "percent": 100 * share}
            lines.append((texts.LAW_ALL.format(**words), MUTE))
            if share > _SEEN and self._why:
                lines.append((self._why, MUTE))
        return lines


class RangeMeasurement:
    """Measurement of an exhibit over the whole range of one quantity, each value in a world of its own.

    Attributes:
        done: number of values that have been measured, of `count`.

    """

    def __init__(self, exhibit: Exhibit, name: str, results: Results) -> None:
        quantity = next(each for each in exhibit.quantities if each.name == name)
        values = quantity.spread(exhibit.points)
        self.count, self.done = len(values), 0
        self._steps = self._measure(exhibit, [exhibit.values | {name: value} for value in values], results)
        self._usual = 0.0  # seconds that a step takes, smoothed

    def _measure(self, exhibit: Exhibit, runs: list[dict[str, float]], results: Results) -> Iterator[None]:
        for values in runs:
            run = type(exhibit)(exhibit.gravity, values)
            while run.result is None and run.steps < run.patience:
                yield
                run.step()
            results.add(run)
            self.done += 1

    def advance(self, now: Callable[[], float], seconds: float) -> bool:
        """Work for about so many seconds, one step at least; return whether all values have been measured."""
        start = last = now()
        for _ in self._steps:
            time = now()
            self._usual += _SMOOTHING * (time - last - self._usual)
            last = time
            if time - start + self._usual > seconds:
                break
        return self.done == self.count
