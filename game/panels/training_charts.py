"""Training charts of a run, with other runs for comparison; a marker chooses one of its checkpoints."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Final

import numpy as np
import pygame

from ai.common.decision import in_points
from ai.common.environment import Doubles
from ai.training.history import REVERTED, Checkpoint, History, SettingChange
from ai.training.session import TAUGHT
from game.charts.chart import RUN_STYLES, Chart, Series, Tick, draw_legend
from game.charts.charts import Charts
from game.charts.scrubber import Scrubber
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import SMALL
from game.training.knob_descriptions import told
from game.training.training_run import EarlierRun
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widget import OnPress, PointsManager, Widget
from game.ui.widgets import Choice

_TURNS: Final = 12  # frames in a round: in every second one, one chart reads the history, which spreads the load
_TOGETHER: Final = 0.5  # seconds within which changed knobs share one mark: a preset changes many
_FEW: Final = 3  # of them that are named
_SHORTEST: Final = (10.0, 1_000.0, 100.0)  # seconds, decisions, percent that the axis spans at least
_LEGEND: Final = (40.0, 450.0)
_AXES: Final = pygame.Rect(560, 436, 260, 20)  # by what the charts are measured, while runs are compared
BY_DECISIONS: Final = 1  # of the ways to measure the horizontal axis: see texts.TRAIN_AXES
_STEPPED: Final = ("epsilon", "stage")  # curves without noise
_CHARTS: Final = (
    ("success", (40, 456, 360, 112), (0.0, 100.0), "{:.0f}"),
    ("mean_return", (436, 456, 360, 112), None, "{:.0f}"),
    ("loss", (40, 592, 172, 92), None, "{:.3g}"),
    ("mean_q", (234, 592, 172, 92), None, "{:.1f}"),
    ("epsilon", (428, 592, 172, 92), (0.0, 1.0), "{:.2f}"),
    ("stage", (622, 592, 174, 92), (0.0, 3.0), "{:.0f}"),
)


class TrainingCharts:
    """Six charts over one axis: seconds, decisions, or each run from its beginning to its end.

    Attributes:
        chosen: the checkpoint under the marker; None without one.
        axis: index into `texts.TRAIN_AXES`.

    """

    def __init__(self) -> None:
        self.charts = Charts([
            Chart(box, texts.TRAIN_CHARTS[name], limits=limits, read=partial(_written, form), log=name == "loss",
                  empty=texts.TRAIN_CHARTS_SHOW[name])
            for name, box, limits, form in _CHARTS
        ])  # fmt: skip
        self._turn = self.axis = 0
        self.clear()

    def clear(self) -> None:
        """Reset for another run, or for other runs beside it."""
        self._history = History()
        self.chosen: Checkpoint | None = None
        self.charts.mark(None)
        self._told = [-1] * len(_CHARTS)  # points of the history shown in each chart
        self._legend: list[Series] = []

    def measure_by(self, axis: int) -> None:
        """Switch the charts to another horizontal axis."""
        self.axis = axis
        for chart in self.charts.charts:
            chart.read_x = texts.TRAIN_AXIS[axis].format
        self._told = [-1] * len(_CHARTS)
        self._mark()

    def look(self, history: History, beside: Sequence[EarlierRun[History]]) -> None:
        """Read new points of the current run and of those beside it; call it once a frame."""
        self._turn = (self._turn + 1) % _TURNS
        number, odd = divmod(self._turn, 2)
        self._history, points = history, len(history)
        if odd or number >= len(_CHARTS) or self._told[number] == points:
            return
        self._told[number] = points
        runs = [EarlierRun(texts.TRAIN_THIS, history, 0), *beside]
        series = [self._series(_CHARTS[number][0], each) for each in runs if len(each.run)]
        end = max([_SHORTEST[self.axis], *(float(np.max(each.x)) for each in series)])
        ticks = [Tick(self._place(tick.x), tick.text, tick.kind) for tick in ticks_of(history)] if number == 0 else ()
        self.charts.charts[number].set(series, (0.0, end), ticks)
        if number == 0:
            self._legend = series if len(series) > 1 else []

    def _series(self, name: str, beside: EarlierRun[History]) -> Series:
        run, (colour, dash) = beside.run, RUN_STYLES[beside.style]
        x = run["decisions" if self.axis == 1 else "seconds"]
        if self.axis == 2:
            x = 100.0 * x / max(float(x[-1]), 1e-9)
        return Series(x, _shown(run, name), beside.name, colour, dash, smooth=name not in _STEPPED)

    def _place(self, seconds: float) -> float:
        """Return the place of a moment of the current run on the axis."""
        history = self._history
        if self.axis == 0 or not len(history):
            return seconds
        if self.axis == 1:
            return float(np.interp(seconds, history["seconds"], history["decisions"]))
        return 100.0 * seconds / max(float(history["seconds"][-1]), 1e-9)

    def _mark(self) -> None:
        if self.chosen is not None:
            caption = texts.TRAIN_CHECKPOINT.format(seconds=self.chosen.seconds)
            self.charts.mark(self._place(self.chosen.seconds), caption)

    def choose(self, place: float | int, checkpoints: Sequence[Checkpoint]) -> None:
        """Choose the checkpoint at a place on the axis (float), or the one to the left or right (int -1 or 1)."""
        if not checkpoints:
            return
        if isinstance(place, int):
            places = [each.decisions for each in checkpoints]
            last = (
                places.index(self.chosen.decisions) if self.chosen and self.chosen.decisions in places else len(places)
            )
            self.chosen = checkpoints[min(max(last + place, 0), len(checkpoints) - 1)]
        else:
            self.chosen = min(checkpoints, key=lambda each: abs(self._place(each.seconds) - place))
        self._mark()

    def widgets(self, manager: PointsManager, duel: OnPress, *, compared: bool) -> list[Widget]:
        """Return a pointer for the charts, the scrubber of checkpoints and, beside earlier runs, the choice of axis.

        `duel` is called when the chosen checkpoint is pressed.
        """

        def scrub(place: float | int) -> None:
            self.choose(place, self._history.checkpoints)

        found: list[Widget] = [
            VirtualPointer(manager, self.charts.box, self.charts.follow),
            Scrubber(manager, self.charts, scrub, duel),
        ]
        if compared:
            axes = Choice(manager, _AXES, "", texts.TRAIN_AXES, self.axis, self.measure_by, size=SMALL, gap=14)
            found.append(axes)
        return found

    def draw(self, canvas: Canvas) -> None:
        """Draw the charts and their legend."""
        if self._legend:
            draw_legend(canvas, self._legend, _LEGEND)
        self.charts.draw(canvas)


def _shown(run: History, name: str) -> Doubles:
    """Return a column in the unit of its chart: shares in percent, values in points of reward."""
    if name == "mean_q":
        return in_points(run[name], run.reward_scale)
    return 100.0 * run[name] if name == "success" else run[name]


def ticks_of(history: History) -> list[Tick]:
    """Return the marks on the axis: checkpoints and changed knobs."""
    ticks = [Tick(each.seconds, texts.TRAIN_CHECKPOINT.format(seconds=each.seconds)) for each in history.checkpoints]
    if history.setting_changes and len(history):
        when = np.interp([each.decisions for each in history.setting_changes], history["decisions"], history["seconds"])
        together: list[tuple[float, list[str]]] = []
        for each, seconds in zip(history.setting_changes, when.tolist(), strict=True):
            if not together or seconds - together[-1][0] >= _TOGETHER:
                together.append((seconds, []))
            together[-1][1].append(_told(each))
        ticks += [Tick(seconds, _listed(words), "knob") for seconds, words in together]
    return ticks


def _listed(words: Sequence[str]) -> str:
    """List the knobs changed at one moment, as many as there is room for."""
    few = ", ".join(words[:_FEW])
    return few if len(words) <= _FEW else texts.TRAIN_TURNED_MORE.format(few=few, count=len(words) - _FEW)


def _told(turn: SettingChange) -> str:
    if turn.name == TAUGHT:
        return texts.TRAIN_TAUGHT_TICK.format(count=turn.after)
    return texts.TRAIN_REVERTED if turn.name == REVERTED else told({turn.name: turn.after})


def _written(form: str, value: float) -> str:
    return form.format(value).replace("-", "−")
