"""Panel of an exhibit's law: its curve over one quantity, what the engine has measured, and how far they are apart."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from game.charts import plotting
from game.charts.chart import Chart
from game.charts.series import Series
from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, INK, LABEL, MUTE, SMALL, VIEW_SIZE
from game.exhibits.exhibit import Exhibit
from game.exhibits.measuring import Results

BOX: Final = pygame.Rect(836, 168, VIEW_SIZE[0] - 836 - 40, 372)
_PADDING: Final = 28.0
_CHART: Final = (BOX.left + _PADDING, BOX.top + 40, BOX.width - 2 * _PADDING + 14, 186)
_WORDS: Final = BOX.top + 246.0  # first baseline under the chart
_FOOT: Final = BOX.bottom - 32.0  # top of the row of widgets
_CURVE: Final = 65  # places at which the law is evaluated
_LEADING: Final = 17.0
_SEEN: Final = 5e-3  # share of the law's greatest value from which the reason for a difference is told


class LawPanel:
    """Plot of law and measurement of one exhibit, over the quantity that was changed last.

    Attributes:
        name: that quantity.
        law: what the law says of the values as they are.
        points: values of that quantity, and what was measured there.
        worst: greatest difference of these points from the law.
        top: greatest value of the law over the range.

    """

    def __init__(self, exhibit: Exhibit, name: str, results: Results) -> None:
        self.exhibit, self.name, self._results = exhibit, name, results
        self._what, self.unit, self._formula, self._when, self._why = texts.LAWS[exhibit.name]
        quantity = next(each for each in exhibit.quantities if each.name == name)
        self._x = np.linspace(*quantity.limits, _CURVE)
        self._y = np.array([self._law_at(x) for x in self._x.tolist()])
        self.law, self.top = self._law_at(exhibit.values[name]), float(self._y.max())
        label, figure = texts.QUANTITIES[name]
        self._quantity = label
        self._chart = Chart(
            _CHART,
            texts.LAW_AXIS.format(what=self._what, unit=self.unit),
            limits=(0.0, float(plotting.grid(0.0, self.top)[-1])),
            read=lambda value: f"{value:.2f}",
            read_x=lambda value: figure.format(value=value),
        )
        self.points: list[tuple[float, float]] = []
        self.worst = 0.0
        self.refresh()
        self._chart.update(at_once=True)

    @property
    def foot(self) -> Point:
        """Left end and top of the room for widgets, in points."""
        return BOX.left + _PADDING, _FOOT

    def _law_at(self, x: float) -> float:
        return self.exhibit.law(self.exhibit.gravity, self.exhibit.values | {self.name: x})

    def refresh(self) -> None:
        """Take in new results."""
        self.points = self._results.along(self.exhibit, self.name)
        self.worst = max((abs(result - self._law_at(x)) for x, result in self.points), default=0.0)
        now = self.exhibit.values[self.name]
        here = Series([now], [self.law], texts.LAW_NOW, INK, smooth=False)
        law = Series(self._x, self._y, texts.LAW_CURVE, MUTE, smooth=False)
        # A gap after each point, so that no line runs through what has been measured one by one.
        x = np.repeat([x for x, _ in self.points], 2) + np.tile((0.0, 1e-6), len(self.points))
        y = np.repeat([result for _, result in self.points], 2)
        y[1::2] = np.nan
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
        canvas.panel(BOX, 0.92)
        left, room = BOX.left + _PADDING, BOX.width - 2 * _PADDING
        canvas.text(texts.LAW_FORMULA.format(formula=self._formula), (left, BOX.top + 26), size=SMALL, room=room)
        self._chart.draw(canvas)
        for x, result in self.points:
            canvas.dot(self._chart.place(x, result), 3.2, HUMAN)
        middle = self._chart.plot.centerx
        foot = self._chart.plot.bottom + 15
        canvas.text(self._quantity, (middle, foot), size=LABEL - 1, colour=MUTE, align="centre", room=room / 2)
        y = _WORDS
        for sentence, colour in self.sentences(progress):
            y = draw_wrapped(canvas, sentence, (left, y), room, colour=colour, leading=_LEADING) + 2

    def sentences(self, progress: str) -> list[tuple[str, tuple[int, int, int]]]:
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
