"""Charts of a run over its seconds, with other runs for comparison; a marker chooses a moment of it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
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
from game.training.record import EarlierRun
from game.training.run_settings import figure, format_changes, label
from game.ui.chart import Chart
from game.ui.charts import Charts
from game.ui.curves import Series, Tick, run_style
from game.ui.plotting import Limits

LANDINGS: Final = "success"  # the chart of the share that lands
SCORE: Final = "mean_return"  # the chart of what a flight earns
FEW_CHARTS: Final = 2
_TOGETHER: Final = 0.5  # seconds within which changed knobs share one mark: a preset changes many
_FEW: Final = 3  # of them that are named
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
        log: whether that is logarithmic.
        smooth: whether the curve has noise.
        second: a second curve, which is shown of a run that stands alone.
        words: name of the second one, and what is said of both.

    """

    curve: Callable[[History], Line]
    form: str
    limits: Limits | None = None
    log: bool = False
    smooth: bool = True
    second: Callable[[History], Line] | None = None
    words: Callable[[], tuple[str, str]] = lambda: ("", "")


def _column(name: str, times: float = 1.0) -> Callable[[History], Line]:
    return lambda history: (history["seconds"], times * history[name])


def _expected(history: History) -> Line:
    return history["seconds"], in_points(history["mean_q"], history.reward_scale)


def _held_out(history: History) -> Line:
    scores = history.validations
    return np.array([each.seconds for each in scores]), np.array([100.0 * each.success for each in scores])


LANDER_CHARTS: Final = {
    LANDINGS: ChartKind(_column("success_rate", 100.0), "{:.0f}", (0.0, 100.0)),
    SCORE: ChartKind(
        _column(SCORE), "{:z.0f}", second=_expected, words=lambda: (texts.TRAIN_EXPECTED, texts.TRAIN_SCORES)
    ),
    "loss": ChartKind(_column("loss"), "{:.3g}", log=True),
    "epsilon": ChartKind(_column("epsilon"), "{:.2f}", (0.0, 1.0), smooth=False),
}
DIGIT_CHARTS: Final = {
    "loss": ChartKind(_column("loss"), "{:.3g}"),
    "accuracy": ChartKind(
        _held_out,
        "{:.2f}",
        smooth=False,
        second=_column("accuracy", 100.0),
        words=lambda: (texts.DIGIT_RUN_BATCHES, texts.DIGIT_RUN_BOTH),
    ),
}


@dataclass(frozen=True)
class Beside:
    """What is shown beside a run.

    Attributes:
        runs: their curves.
        name: of the run itself, beside them.
        paid_otherwise: whether their pay says nothing beside that of the run; then it is not shown.

    """

    runs: Sequence[EarlierRun] = ()
    name: str = ""
    paid_otherwise: bool = False


class TrainingCharts(Charts):
    """Charts over the seconds of a run, each with what is said of it, as they were looked at last."""

    def __init__(self, kinds: Mapping[str, ChartKind]) -> None:
        self._kinds = kinds
        self._all = [
            Chart(
                texts.TRAIN_CHARTS[name],
                limits=kind.limits,
                read=partial(_written, kind.form),
                log=kind.log,
                empty=texts.TRAIN_CHARTS_SHOW[name],
            )
            for name, kind in kinds.items()
        ]
        super().__init__(self._all)
        self._history = History()
        self._due: list[Callable[[], None]] = []
        self.show(more=False)

    def show(self, *, more: bool) -> None:
        """Show all charts, or few."""
        self.charts = tuple(self._all if more else self._all[:FEW_CHARTS])

    def place(self, boxes: Sequence[pygame.FRect]) -> None:
        """Move the charts to their boxes."""
        for chart, box in zip(self.charts, boxes, strict=True):
            chart.move(box)

    def take(self, history: History, beside: Beside, said: str, moment: int | None) -> None:
        """Show a run as far as it has come, and those beside it; `said` stands below the first chart."""
        self._history = history
        self._due.clear()
        this = EarlierRun(beside.name or texts.TRAIN_THIS, history, 0)
        runs = [each for each in (this, *beside.runs) if len(each.run)]
        for (name, kind), chart in zip(self._kinds.items(), self._all, strict=True):
            compared = runs[:1] if name == SCORE and beside.paid_otherwise else runs
            words = said if chart is self._all[0] else ""
            if name == SCORE and beside.paid_otherwise:
                words = texts.LAB_PAID_OTHERWISE
            self._due.append(partial(self._set, kind, chart, compared, words))
        self.go_on()
        self.go_to(moment)

    def go_on(self) -> None:
        """Show the next chart as it was looked at: one a frame, which spreads the load; the first one at once."""
        if self._due:
            self._due.pop(0)()

    def _set(self, kind: ChartKind, chart: Chart, runs: Sequence[EarlierRun], said: str) -> None:
        series = []
        for each in runs:
            colour, dash = run_style(each.style)
            series.append(Series(*kind.curve(each.run), each.name, colour, dash, kind.smooth, kind.log))
        if kind.second and len(runs) == 1 and len(self._history):
            series.append(Series(*kind.second(self._history), kind.words()[0], HUMAN, _DASH))
            said = f"{self._both(kind)}\n{said}".strip()
        end = max([_SHORTEST, *(float(each.run["seconds"][-1]) for each in runs)])
        chart.set(series, end, ticks_of(self._history) if chart is self._all[0] else (), said)

    def _both(self, kind: ChartKind) -> str:
        """Say what both curves of a chart are, by their latest numbers; empty before there are any."""
        curves = (kind.curve, kind.second or kind.curve)
        latest = [float(curve(self._history)[1][-1:].sum()) for curve in curves]
        return kind.words()[1].format(*latest).replace("-", "−") if all(map(math.isfinite, latest)) else ""

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
        return tuple(None if run.last is None else round(run.last) for run in self._all[0].runs)

    def draw(self, canvas: Canvas) -> None:
        """Draw the charts, and what is said of them."""
        super().draw(canvas)
        for name, chart in zip(self._kinds, self.charts, strict=False):
            box = chart.box
            y = box.bottom + _DROP
            lines = chart.caption.split("\n")
            rows = [prose.lines(line, _SIZE, "regular", box.width - 8, canvas.scale)[:2] for line in lines]
            alone = box.width < _WIDE or len(rows[0]) > 1  # below it is the next chart
            for row in rows[0] if alone else itertools.chain(*rows):
                canvas.text(row, (box.x, y), size=_SIZE, colour=MUTE)
                y += _LEADING
            log = texts.EXPLAIN_AXIS_LOG if chart.log else ""
            canvas.explain(chart.header, texts.EXPLAIN_CHARTS[name])
            canvas.explain(chart.gutter, texts.EXPLAIN_AXIS, log.format)


def _written(form: str, value: float) -> str:
    return form.format(value).replace("-", "−")


def ticks_of(history: History) -> list[Tick]:
    """Return the marks on the axis: checkpoints and changed knobs."""
    ticks = [Tick(each.seconds, texts.TRAIN_CHECKPOINT.format(seconds=each.seconds)) for each in history.checkpoints]
    together: list[tuple[float, list[str]]] = []
    for change in history.setting_changes if len(history) else ():
        seconds = _seconds_of(change, history)
        if not together or seconds - together[-1][0] >= _TOGETHER:
            together.append((seconds, []))
        together[-1][1].append(_change_words(change))
    return [*ticks, *(Tick(seconds, _listed(words), "knob") for seconds, words in together)]


def _seconds_of(change: SettingChange, history: History) -> float:
    if change.seconds or "decisions" not in history.columns:
        return change.seconds
    return float(np.interp(change.decisions, history["decisions"], history["seconds"]))  # of an older file


def _listed(words: Sequence[str]) -> str:
    """List the knobs changed at one moment, as many as there is room for."""
    few = ", ".join(words[:_FEW])
    return few if len(words) <= _FEW else texts.TRAIN_TURNED_MORE.format(few=few, count=len(words) - _FEW)


def _change_words(change: SettingChange) -> str:
    if change.name == REVERTED:
        return texts.TRAIN_REVERTED
    part = "." in change.name
    return format_changes({change.name: change.after}) if part else f"{label(change.name)} {figure(change.after)}"
