"""Panel of an exhibit's law: its curve over one quantity, what the engine has measured, and how far they are apart."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Final

import numpy as np
import pygame

from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.paint_cache import PaintCache
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, INK, LABEL, MUTE, SMALL, VIEW_SIZE, Colour
from game.scenes.physics.exhibit import Exhibit
from game.ui import plotting
from game.ui.chart import Chart
from game.ui.series import Series

_SIZE: Final = (404, 372)
_TOP, _EDGE = 168, 40  # points from the view's edges
_PADDING: Final = 28
_CHART: Final = (40, 186)  # top in the panel, and height
_WORDS: Final = 246  # first baseline under the chart, from the panel's top
_FOOT: Final = 32  # height of the row of widgets
_CURVE: Final = 65  # places at which the law is evaluated
_ALPHA: Final = 0.97
_LEADING: Final = 17.0
_SEEN: Final = 5e-3  # share of the law's greatest value from which the reason for a difference is told
_SMOOTHING: Final = 0.3
_Run = tuple[type[Exhibit], float, tuple[tuple[str, float], ...]]  # of which exhibit, gravity, values


class LawPanel:
    """Plot of law and measurement of one exhibit, over the quantity that was changed last.

    Attributes:
        box: the panel's box, in points.
        name: that quantity.
        law: what the law says of the values as they are.
        points: values of that quantity, and what was measured there.
        worst: greatest difference of these points from the law.
        top: greatest value of the law over the range.

    """

    def __init__(self, exhibit: Exhibit, name: str, results: Results) -> None:
        self.exhibit, self.name, self._results = exhibit, name, results
        left = _EDGE if exhibit.plot_side == "left" else VIEW_SIZE[0] - _EDGE - _SIZE[0]
        self.box = pygame.Rect((left, _TOP), _SIZE)
        self._what, self.unit, self._formula, self._when, self._why = texts.LAWS[exhibit.name]
        quantity = next(each for each in exhibit.quantities if each.name == name)
        self._x = np.linspace(*quantity.limits, _CURVE)
        self._y = np.array([self._law_at(x) for x in self._x.tolist()])
        self.law, self.top = self._law_at(exhibit.values[name]), float(self._y.max())
        label, figure = texts.QUANTITIES[name]
        self._quantity = label
        self._chart = Chart(
            (left + _PADDING, _TOP + _CHART[0], _SIZE[0] - 2 * _PADDING + 14, _CHART[1]),
            texts.LAW_AXIS.format(what=self._what, unit=self.unit),
            limits=(0.0, float(plotting.grid(0.0, self.top)[-1])),
            read=lambda value: f"{value:.2f}",
            read_x=lambda value: figure.format(value=value),
        )
        self._words = PaintCache()
        self.points: list[tuple[float, float]] = []
        self.worst = 0.0
        self.refresh()
        self._chart.update(at_once=True)

    @property
    def foot(self) -> pygame.Rect:
        """Room for widgets, in points."""
        return pygame.Rect(self.box.left + _PADDING, self.box.bottom - _FOOT, _SIZE[0] - 2 * _PADDING, 20)

    def _law_at(self, x: float) -> float:
        return self.exhibit.law(self.exhibit.gravity, self.exhibit.values | {self.name: x})

    def refresh(self) -> None:
        """Take in new results."""
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
        """Advance by 1/60 s."""
        self._chart.update()

    def hover(self, point: Point | None) -> None:
        """Show the values under the mouse, a point of the canvas."""
        self._chart.hover(point)

    def draw(self, canvas: Canvas, progress: str) -> None:
        """Draw the panel; `progress` tells of a range that is being measured, if one is."""
        canvas.panel(self.box, _ALPHA)
        left, top = self.box.left + _PADDING, self.box.top
        room = self.box.width - 2 * _PADDING
        self._chart.draw(canvas)
        for x, result in self.points:
            canvas.dot(self._chart.place(x, result), 3.2, HUMAN)
        foot = self._chart.plot.bottom + 15
        where = (self._chart.plot.centerx, foot)
        canvas.text(self._quantity, where, size=LABEL - 1, colour=MUTE, align="centre", room=room / 2)
        told = tuple(self.sentences(progress))
        self._words.draw(canvas, (left, top, room, _SIZE[1] - _FOOT), told, partial(self._paint_words, told))

    def _paint_words(self, told: Sequence[tuple[str, Colour]], sheet: Canvas) -> None:
        """Paint what is said above and under the chart; breaking it into lines in each frame would take long."""
        room = _SIZE[0] - 2 * _PADDING
        sheet.text(texts.LAW_FORMULA.format(formula=self._formula), (0, 26), size=SMALL, room=room)
        y = float(_WORDS)
        for sentence, colour in told:
            y = draw_wrapped(sheet, sentence, (0, y), room, colour=colour, leading=_LEADING) + 2

    def sentences(self, progress: str) -> list[tuple[str, Colour]]:
        """Return what is said under the chart, each sentence with its colour."""
        result = self.exhibit.result
        if result is None:
            first = texts.LAW_WAITING.format(law=self.law, unit=self.unit, when=self._when)
        else:
            apart = abs(result - self.law)
            first = texts.LAW_RESULT.format(law=self.law, measured=result, apart=apart, unit=self.unit)
        told = [(first, INK)]
        if progress:
            return [*told, (progress, MUTE)]
        if self.points:
            share = self.worst / self.top if self.top else 0.0
            words = {"count": len(self.points), "apart": self.worst, "unit": self.unit, "percent": 100 * share}
            told.append((texts.LAW_ALL.format(**words), MUTE))
            if share > _SEEN and self._why:
                told.append((self._why, MUTE))
        return told


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
        self._usual = 0.0  # seconds that a step takes, smoothed

    def advance(self, now: Callable[[], float], seconds: float) -> bool:
        """Work for about so many seconds, one step at least; return whether all values have been measured."""
        start = last = now()
        while self.done < self.count:
            self._step()
            time = now()
            self._usual += _SMOOTHING * (time - last - self._usual)
            last = time
            if time - start + self._usual > seconds:
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
