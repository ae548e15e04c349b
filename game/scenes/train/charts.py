"""Charts of a run over its seconds, with another run for comparison; a marker chooses a moment of it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Final, NamedTuple

import numpy as np
import pygame

from ai.agent.decision import in_points
from ai.environment import Doubles
from ai.training.history import REVERTED, History, SettingChange
from game.core import texts
from game.drawing import prose
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, LABEL, MUTE
from game.training.run_settings import format_changes
from game.ui.chart import Chart
from game.ui.charts import Charts
from game.ui.curves import BESIDE, Series, Tick
from game.ui.plotting import Limits

SCORE: Final = "mean_return"  # the chart of what a flight earns
_SHORTEST: Final = 10.0  # seconds that the axis spans at least
_DASH: Final = (5.0, 4.0)  # of a second curve
_WIDE: Final = 300.0  # points of a chart with room for one line in a line
_SIZE: Final = LABEL  # of captions
_LEADING: Final = 12.0
_DROP: Final = 12.0  # from the bottom of a chart to the first baseline of its caption
Line = tuple[Doubles, Doubles]  # of a curve: seconds, and values


class ChartKind(NamedTuple):
    """One chart of a kind of run.

    Attributes:
        curve: returns the curve of a history.
        form: how a value is written.
        limits: of the vertical axis; None where it follows the numbers.
        smooth: whether the curve has noise.
        second: a second curve, which is shown of a run that stands alone, and its name.
        said: what is said of both, given the history.

    """

    curve: Callable[[History], Line]
    form: str
    limits: Limits | None = None
    smooth: bool = True
    second: tuple[Callable[[History], Line], Callable[[], str]] | None = None
    said: Callable[[History], str] = lambda _: ""


def _column(name: str, times: float = 1.0) -> Callable[[History], Line]:
    return lambda history: (history["seconds"], times * history[name])


def _expected(history: History) -> Line:
    return history["seconds"], in_points(history["mean_q"], history.reward_scale)


def _held_out(history: History) -> Line:
    scores = history.validations
    return np.array([each.seconds for each in scores]), np.array([100.0 * each.success for each in scores])


def _earned(history: History) -> str:
    """Say what a flight earns, and what the network expects."""
    earned, expected = history[SCORE][-1], _expected(history)[1][-1]
    if not np.isfinite([earned, expected]).all():
        return ""
    return texts.TRAIN_SCORES.format(earned=earned, expected=expected).replace("-", "−")


def _read(history: History) -> str:
    scores, seen = history.validations, 100 * history["accuracy"][-1]
    return texts.DIGIT_RUN_BOTH.format(100 * scores[-1].success, seen) if scores and math.isfinite(seen) else ""


LANDER_CHARTS: Final = {
    "success": ChartKind(_column("success_rate", 100.0), "{:.0f}", (0.0, 100.0)),
    SCORE: ChartKind(_column(SCORE), "{:z.0f}", second=(_expected, lambda: texts.TRAIN_EXPECTED), said=_earned),
}
DIGIT_CHARTS: Final = {
    "loss": ChartKind(_column("loss"), "{:.3g}"),
    "accuracy": ChartKind(
        _held_out,
        "{:.2f}",
        smooth=False,
        second=(_column("accuracy", 100.0), lambda: texts.DIGIT_RUN_BATCHES),
        said=_read,
    ),
}


class Beside(NamedTuple):
    """Another run, whose curves are shown beside a run's.

    Attributes:
        name: what it is called.
        run: its history.
        in_step: whether it is an experiment: what it did stands where the run took as many decisions.
        paid_otherwise: whether its pay says nothing beside that of the run; then it is not shown.

    """

    name: str
    run: History
    in_step: bool = False
    paid_otherwise: bool = False


class TrainingCharts(Charts):
    """Two charts over the seconds of a run, each with what is said of it, as they were looked at last."""

    def __init__(self, kinds: Mapping[str, ChartKind]) -> None:
        self._kinds = kinds
        super().__init__([
            Chart(texts.TRAIN_CHARTS[name], limits=kind.limits, read=partial(_written, kind.form),
                  empty=texts.TRAIN_CHARTS_SHOW[name])
            for name, kind in kinds.items()
        ])  # fmt: skip
        self._history = History()

    def place(self, boxes: Sequence[pygame.FRect]) -> None:
        """Move the charts to their boxes."""
        for chart, box in zip(self.charts, boxes, strict=True):
            chart.move(box)

    def take(self, history: History, beside: Beside | None, said: str, moment: int | None) -> None:
        """Show a run as far as it has come, and one beside it; `said` stands below the first chart."""
        self._history = history
        for (name, kind), chart in zip(self._kinds.items(), self.charts, strict=True):
            other, words = beside, said if chart is self.charts[0] else ""
            if name == SCORE and beside and beside.paid_otherwise:
                other, words = None, texts.LAB_PAID_OTHERWISE
            self._set(kind, chart, other, words, alone=beside is None)
        self.go_to(moment)

    def _set(self, kind: ChartKind, chart: Chart, beside: Beside | None, said: str, *, alone: bool) -> None:
        history, series = self._history, []
        if len(history):
            series.append(Series(*kind.curve(history), texts.TRAIN_THIS, smooth=kind.smooth))
            if kind.second and alone:
                series.append(Series(*kind.second[0](history), kind.second[1](), HUMAN, _DASH))
                said = f"{kind.said(history)}\n{said}".strip()
        if beside and len(beside.run):
            seconds, values = kind.curve(beside.run)
            if beside.in_step and len(history):
                seconds = np.interp(beside.run["decisions"], history["decisions"], history["seconds"])
            series.append(Series(seconds, values, beside.name, *BESIDE, kind.smooth))
        ends = [float(np.max(each.x)) for each in series if np.size(each.x)]
        ticks = ticks_of(history) if chart is self.charts[0] else ()
        chart.set(series, max([_SHORTEST, *ends]), ticks, said)

    def go_to(self, moment: int | None) -> None:
        """Put the marker at a moment, in decisions; None takes it away."""
        if moment is None or not len(self._history):
            self.mark(None)
            return
        seconds = float(np.interp(moment, self._history["decisions"], self._history["seconds"]))
        self.mark(seconds, texts.REWIND_MARK.format(seconds=seconds))

    def decisions_at(self, seconds: float) -> float:
        """Return a moment of the current run in decisions; infinite beyond its end."""
        history = self._history
        if not len(history) or seconds >= float(history["seconds"][-1]):
            return math.inf
        return float(np.interp(seconds, history["seconds"], history["decisions"]))

    @property
    def latest(self) -> tuple[int | None, ...]:
        """Percent that each run of the first chart has come to; None before there is a number."""
        return tuple(None if run.last is None else round(run.last) for run in self.charts[0].runs)

    def draw(self, canvas: Canvas) -> None:
        """Draw the charts, and what is said of them."""
        super().draw(canvas)
        for name, chart in zip(self._kinds, self.charts, strict=True):
            box = chart.box
            y = box.bottom + _DROP
            lines = chart.caption.split("\n")
            rows = [prose.lines(line, _SIZE, "regular", box.width - 8, canvas.scale)[:2] for line in lines]
            alone = box.width < _WIDE or len(rows[0]) > 1  # below it is the edge
            for row in rows[0] if alone else itertools.chain(*rows):
                canvas.text(row, (box.x, y), size=_SIZE, colour=MUTE)
                y += _LEADING
            canvas.explain(chart.header, texts.EXPLAIN_CHARTS[name])
            canvas.explain(chart.gutter, texts.EXPLAIN_AXIS)


def _written(form: str, value: float) -> str:
    return form.format(value).replace("-", "−")


def ticks_of(history: History) -> list[Tick]:
    """Return the marks on the axis: checkpoints and changed settings."""
    ticks = [Tick(each.seconds, texts.TRAIN_CHECKPOINT.format(seconds=each.seconds)) for each in history.checkpoints]
    return [*ticks, *(Tick(each.seconds, _change_words(each), "knob") for each in history.setting_changes)]


def _change_words(change: SettingChange) -> str:
    return texts.TRAIN_REVERTED if change.name == REVERTED else format_changes({change.name: change.after})
