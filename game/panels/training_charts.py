"""Training charts of a run, with other runs for comparison; a marker chooses a moment of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Final, Protocol

import numpy as np
import pygame

from ai.agent.decision import in_points
from ai.environment import Doubles
from ai.training.edits import EDITED
from ai.training.history import REVERTED, History, SettingChange
from ai.training.lander_session import TAUGHT
from game.core import texts
from game.core.scene import Transition
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import NIGHT0, SMALL
from game.panels.chart_captions import draw_captions
from game.panels.run_legend import RunLegend
from game.training.beside import EarlierRun
from game.training.knob_descriptions import told
from game.ui.chart import Chart, Series, Tick
from game.ui.charts import Charts
from game.ui.scrubber import Scrubber
from game.ui.series import run_style
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widget import OnPress, PointsManager, Widget
from game.ui.widgets import Choice, TextButton

_TURNS: Final = 12  # frames in a round: in every second one, one chart reads the history, which spreads the load
_TOGETHER: Final = 0.5  # seconds within which changed knobs share one mark: a preset changes many
_FEW: Final = 3  # of them that are named
_SHORTEST: Final = (10.0, 1_000.0, 100.0)  # seconds, decisions, percent that the axis spans at least
_LEGEND: Final = (40, 436, 384, 20)
_DIMMED: Final = 0.68  # of the other runs' lines, while one is emphasised
_ZOOM_RIGHT: Final = 820.0
_AXES: Final = pygame.Rect(436, 436, 262, 20)  # by what the charts are measured, while runs are compared
BY_DECISIONS: Final = 1  # of the ways to measure the horizontal axis: see texts.TRAIN_AXES
PAID: Final = ("mean_return", "mean_q")  # charts in points of what a run is paid
_STEPPED: Final = ("epsilon", "stage")  # curves without noise
_CHARTS: Final = (
    ("success", (40, 456, 360, 112), (0.0, 100.0), "{:.0f}"),
    ("mean_return", (436, 456, 360, 112), None, "{:.0f}"),
    ("loss", (40, 592, 172, 92), None, "{:.3g}"),
    ("mean_q", (234, 592, 172, 92), None, "{:.0f}"),
    ("epsilon", (428, 592, 172, 92), (0.0, 1.0), "{:.2f}"),
    ("stage", (622, 592, 174, 92), (0.0, 3.0), "{:.0f}"),
)


class Seeks(Protocol):
    """Goes to a moment of a run."""

    def seek(self, decisions: float) -> None:
        """Go to the moment in decisions."""

    def shift(self, direction: int) -> None:
        """Go a step back (-1) or on (1)."""


class TrainingCharts:
    """Six charts over one axis: seconds, decisions, or each run from its beginning to its end.

    Attributes:
        moment: the moment under the marker, in decisions; None for now.
        axis: index into `texts.TRAIN_AXES`.

    """

    def __init__(self) -> None:
        self.charts = Charts([
            Chart(box, texts.TRAIN_CHARTS[name], limits=limits, read=partial(_written, form), log=name == "loss",
                  empty=texts.TRAIN_CHARTS_SHOW[name])
            for name, box, limits, form in _CHARTS
        ])  # fmt: skip
        self._turn = self.axis = 0
        self._legend: RunLegend | None = None
        self._zoom_word: TextButton | None = None
        self.clear()

    def clear(self) -> None:
        """Reset for another run, or for other runs beside it."""
        self._history = History()
        self.moment: int | None = None
        self.charts.mark(None)
        self.charts.zoom.reset()
        self._told: list[object] = [None] * len(_CHARTS)  # what is shown in each chart

    def measure_by(self, axis: int) -> None:
        """Switch the charts to another horizontal axis."""
        self.axis = axis
        for chart in self.charts.charts:
            chart.read_x = texts.TRAIN_AXIS[axis].format
        self.charts.zoom.reset()

    def look(
        self,
        history: History,
        beside: Sequence[EarlierRun],
        name: str = texts.TRAIN_THIS,
        say: Callable[[str], str] = lambda _: "",
        *,
        paid_otherwise: bool = False,
    ) -> None:
        """Read new points of the current run, by its name there, and of those beside it; call it once a frame.

        `say` returns the caption of a chart for the same points. Where the others are `paid_otherwise`, their pay says
        nothing beside that of this one, and is not shown.
        """
        self._turn = (self._turn + 1) % _TURNS
        number, odd = divmod(self._turn, 2)
        self._history = history
        self._mark()
        runs = [EarlierRun(name, history, 0), *beside]
        shown = [(each.name, each.style) for each in runs if len(each.run)]
        if self._legend is not None:
            self._legend.names = shown
        if self._zoom_word is not None:
            self._zoom_word.label = zoom_word(self.charts.zoom.factor)
        if odd or number >= len(_CHARTS):
            return
        emphasised = self._legend.emphasised if self._legend is not None else None
        told = (len(history), shown, emphasised, self.axis, self.charts.zoom.shown)
        if self._told[number] == told:
            return
        self._told[number] = told
        name = _CHARTS[number][0]
        compared = runs[:1] if name in PAID and paid_otherwise else runs
        series = [self._series(name, each, emphasised) for each in compared if len(each.run)]
        self.charts.zoom.end = max([_SHORTEST[self.axis], *(float(np.max(each.x)) for each in series)])
        ticks = [Tick(self._place(tick.x), tick.text, tick.kind) for tick in ticks_of(history)] if number == 0 else ()
        self.charts.charts[number].set(series, self.charts.zoom.shown, ticks, say(_CHARTS[number][0]))

    def _series(self, name: str, beside: EarlierRun, emphasised: int | None) -> Series:
        run, (colour, dash) = beside.run, run_style(beside.style)
        if emphasised not in (None, beside.style):
            colour = mix(colour, NIGHT0, _DIMMED)
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
        """Put the marker at the moment that is shown."""
        if self.moment is None or not len(self._history):
            self.charts.mark(None)
            return
        seconds = float(np.interp(self.moment, self._history["decisions"], self._history["seconds"]))
        place = self._place(seconds)
        if place != self.charts.charts[0].marker:
            self.charts.zoom.reach(place)
        self.charts.mark(place, texts.REWIND_MARK.format(seconds=seconds))

    def decisions_at(self, place: float) -> float:
        """Return the moment of the current run, in decisions, at a place on the axis; infinite beyond its end."""
        history = self._history
        if not len(history) or place >= self._place(float(history["seconds"][-1])):
            return math.inf
        if self.axis == 1:
            return place
        seconds = place if self.axis == 0 else place / 100.0 * float(history["seconds"][-1])
        return float(np.interp(seconds, history["seconds"], history["decisions"]))

    def widgets(
        self,
        manager: PointsManager,
        duel: OnPress,
        rewind: Seeks,
        *,
        compared: bool,
        choose: Callable[[int], Transition | None] = lambda _: None,
    ) -> list[Widget]:
        """Return a pointer for the charts, their scrubber, the zoom and, beside earlier runs, a legend and the axes.

        The scrubber rewinds the run; `duel` is called when it is pressed, and `choose` with the line style of the run
        that is pressed in the legend.
        """

        def scrub(place: float | int) -> None:
            if isinstance(place, int):
                rewind.shift(place)
            else:
                rewind.seek(self.decisions_at(place))

        found: list[Widget] = [
            VirtualPointer(manager, self.charts.box, self.charts.follow),
            Scrubber(manager, self.charts, scrub, duel, self.charts.zoom_by),
        ]
        self._legend = RunLegend(manager, _LEGEND, choose) if compared else None
        if self._legend is not None:
            found.append(self._legend)
            axes = Choice(manager, _AXES, "", texts.TRAIN_AXES, self.axis, self.measure_by, size=SMALL, gap=14)
            found.append(axes)
        width = max(typeface.width(zoom_word(factor), SMALL, "regular") for factor in (1.0, 8.0))
        box = (_ZOOM_RIGHT - width, _AXES.top, width, _AXES.height)
        self._zoom_word = TextButton(manager, box, zoom_word(self.charts.zoom.factor), self._double, size=SMALL)
        return [*found, self._zoom_word]

    def _double(self) -> None:
        self.charts.zoom.double(self.charts.charts[0].marker)

    def draw(self, canvas: Canvas) -> None:
        """Draw the charts."""
        self.charts.draw(canvas)
        draw_captions(canvas, self.charts.charts)
        for (name, *_), chart in zip(_CHARTS, self.charts.charts, strict=True):
            canvas.explain(chart.header, texts.EXPLAIN_CHARTS[name], partial(_latest, chart))
            canvas.explain(chart.gutter, texts.EXPLAIN_AXES[self.axis], partial(_scale, name))


def _scale(name: str) -> str:
    return texts.EXPLAIN_AXIS_LOG if name == "loss" else ""


def _latest(chart: Chart) -> str:
    return texts.EXPLAIN_CHART_NOW.format(value=chart.latest)


def zoom_word(factor: float) -> str:
    """Return the word of the zoom, with its factor unless the whole axis is shown."""
    return texts.COMPARE_ZOOM if factor == 1.0 else texts.COMPARE_ZOOMED.format(factor=factor)


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
    if turn.name == EDITED:
        return texts.EDIT_TICK.format(count=turn.after) if turn.after else texts.EDIT_TICK_BACK
    if turn.name == TAUGHT:
        return texts.TRAIN_TAUGHT_TICK.format(count=turn.after)
    return texts.TRAIN_REVERTED if turn.name == REVERTED else told({turn.name: turn.after})


def _written(form: str, value: float) -> str:
    return form.format(value).replace("-", "−")
