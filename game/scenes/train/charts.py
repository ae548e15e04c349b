"""Training charts of a run, with other runs for comparison; a marker chooses a moment of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Final

import numpy as np
import pygame

from ai.agent.decision import in_points
from ai.environment import Doubles
from ai.training.captions import Caption, caption
from ai.training.config import Config
from ai.training.edits import EDITED
from ai.training.hints import RecentCurves
from ai.training.history import REVERTED, History, SettingChange
from ai.training.lander_session import TAUGHT
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, LABEL, MUTE, NIGHT0
from game.training.beside import EarlierRun
from game.training.knob_descriptions import told
from game.ui.chart import Chart, Series, Tick
from game.ui.charts import Charts
from game.ui.series import run_style

STAY: Final = 3.0  # seconds of training for which a caption stays at least, as long as it is true
_TURNS: Final = 12  # frames in a round: in every second one, one chart reads the history, which spreads the load
_TOGETHER: Final = 0.5  # seconds within which changed knobs share one mark: a preset changes many
_FEW: Final = 3  # of them that are named
_SHORTEST: Final = (10.0, 1_000.0, 100.0)  # seconds, decisions, percent that the axis spans at least
_DIMMED: Final = 0.68  # of the other runs' lines, while one is emphasised
BY_DECISIONS: Final = 1  # of the ways to measure the horizontal axis: see texts.TRAIN_AXES
SCORE: Final = "mean_return"  # what a flight earns, and beside it what the network expects
EXPECTED: Final = "mean_q"
_EXPECTED_DASH: Final = (5.0, 4.0)
_STEPPED: Final = ("epsilon",)  # curves without noise
_CHARTS: Final = {
    "success": ((0.0, 100.0), "{:.0f}"),
    SCORE: (None, "{:.0f}"),
    "loss": (None, "{:.3g}"),
    "epsilon": ((0.0, 1.0), "{:.2f}"),
}
FEW_CHARTS: Final = 2
_WIDE: Final = 300.0  # points of a chart with room for one line in a line
_SIZE: Final = LABEL - 1.0  # of captions
_LEADING: Final = 12.0
_DROP: Final = 12.0  # from the bottom of a chart to the first baseline of its caption


class ChartCaptions:
    """One caption for each chart, read together with the chart's number and painted in the same frame as that.

    Attributes:
        shown: caption of each chart that has one, by its name.

    """

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Reset for another run."""
        self.shown: dict[str, Caption] = {}
        self._since: dict[str, float] = {}

    def read(self, chart: str, history: History, config: Config, hint: str) -> str:
        """Return a chart's caption, beside the hint that is shown, by its name; empty where no rule is sure."""
        now = float(history["seconds"][-1]) if len(history) else 0.0
        before = self.shown.pop(chart, None)
        stays = before.name if before and now - self._since[chart] < STAY else ""
        found = caption(chart, RecentCurves(history, config), hint, stays)
        if found is None:
            return ""
        if before is None or before.name != found.name:
            self._since[chart] = now
        self.shown[chart] = found
        return texts.CHART_CAPTIONS[chart][found.name].format(**found.values).replace("-", "−")


class TrainingCharts:
    """Charts over one axis: seconds, decisions, or each run from its beginning to its end.

    Attributes:
        charts: those that are shown.
        moment: the moment under the marker, in decisions; None for now.
        axis: index into `texts.TRAIN_AXES`.

    """

    def __init__(self, *, more: bool = False) -> None:
        self._all = [
            Chart((0, 0, 300, 100), texts.TRAIN_CHARTS[name], limits=limits, read=partial(_written, form),
                  log=name == "loss", empty=texts.TRAIN_CHARTS_SHOW[name])
            for name, (limits, form) in _CHARTS.items()
        ]  # fmt: skip
        self._turn = self.axis = 0
        self.show(more=more)
        self.clear()

    def show(self, *, more: bool) -> None:
        """Show all charts, or few."""
        self.charts = Charts(self._all if more else self._all[:FEW_CHARTS])

    def place(self, boxes: Sequence[pygame.FRect]) -> None:
        """Move the charts to their boxes."""
        for chart, box in zip(self.charts.charts, boxes, strict=True):
            chart.move(box)

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
        for chart in self._all:
            chart.read_x = texts.TRAIN_AXIS[axis].format
        self.charts.zoom.reset()

    def look(
        self,
        history: History,
        beside: Sequence[EarlierRun],
        name: str = "",
        say: Callable[[str], str] = lambda _: "",
        *,
        paid_otherwise: bool = False,
        emphasised: int | None = None,
    ) -> None:
        """Read new points of the current run, by its name there, and of those beside it; call it once a frame.

        `say` returns the caption of a chart for the same points. Where the others are `paid_otherwise`, their pay says
        nothing beside that of this one, and is not shown. The run of the line style `emphasised` is seen before others.
        """
        self._turn = (self._turn + 1) % _TURNS
        number, odd = divmod(self._turn, 2)
        self._history = history
        self._mark()
        if odd or number >= len(self.charts.charts):
            return
        runs = [each for each in (EarlierRun(name or texts.TRAIN_THIS, history, 0), *beside) if len(each.run)]
        shown = [(each.name, each.style) for each in runs]
        told = (len(history), shown, emphasised, self.axis, self.charts.zoom.shown)
        if self._told[number] == told:
            return
        self._told[number] = told
        column = list(_CHARTS)[number]
        compared = runs[:1] if column == SCORE and paid_otherwise else runs
        series = [self._series(column, each, emphasised) for each in compared]
        said = say(column)
        if column == SCORE and len(runs) == 1 and len(history):
            expected = self._series(EXPECTED, compared[0], emphasised)
            series.append(expected)
            said = f"{_both(history)}\n{said}".strip()
        self.charts.zoom.end = max([_SHORTEST[self.axis], *(float(np.max(each.x)) for each in series)])
        ticks = [Tick(self._place(tick.x), tick.text, tick.kind) for tick in ticks_of(history)] if number == 0 else ()
        self.charts.charts[number].set(series, self.charts.zoom.shown, ticks, said)

    def _series(self, name: str, beside: EarlierRun, emphasised: int | None) -> Series:
        run, (colour, dash), label = beside.run, run_style(beside.style), beside.name
        if name == EXPECTED:
            colour, dash, label = HUMAN, _EXPECTED_DASH, texts.TRAIN_EXPECTED
        if emphasised not in (None, beside.style):
            colour = mix(colour, NIGHT0, _DIMMED)
        x = run["decisions" if self.axis == 1 else "seconds"]
        if self.axis == 2:
            x = 100.0 * x / max(float(x[-1]), 1e-9)
        return Series(x, _shown(run, name), label, colour, dash, smooth=name not in _STEPPED)

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

    @property
    def landed(self) -> str:
        """Share that lands, in percent, as its chart was last painted; a dash or nothing before any is known."""
        return self._all[0].painted_latest

    def draw(self, canvas: Canvas) -> None:
        """Draw the charts, and what is said of them as it was when they were painted."""
        self.charts.draw(canvas)
        for name, chart in zip(_CHARTS, self.charts.charts, strict=False):
            box = chart.box
            y = box.bottom + _DROP
            lines = chart.painted_caption.split("\n")
            for line in lines if box.width >= _WIDE else lines[:1]:
                y = draw_wrapped(canvas, line, (box.x, y), box.width - 8, size=_SIZE, colour=MUTE, leading=_LEADING,
                                 most=2)  # fmt: skip
            canvas.explain(chart.header, texts.EXPLAIN_CHARTS[name], partial(_latest, chart))
            canvas.explain(chart.gutter, texts.EXPLAIN_AXES[self.axis], partial(_scale, name))


def _both(history: History) -> str:
    """Say what a flight earns and what is expected, from the latest numbers of both curves."""
    earned, expected = (float(_shown(history, name)[-1]) for name in (SCORE, EXPECTED))
    said = texts.TRAIN_SCORE.format(earned=earned) if math.isfinite(earned) else ""
    if said and math.isfinite(expected):
        said = texts.TRAIN_SCORES.format(earned=earned, expected=expected)
    return said.replace("-", "−")


def _scale(name: str) -> str:
    return texts.EXPLAIN_AXIS_LOG if name == "loss" else ""


def _latest(chart: Chart) -> str:
    return texts.EXPLAIN_CHART_NOW.format(value=chart.latest)


def _shown(run: History, name: str) -> Doubles:
    """Return a column in the unit of its chart: shares in percent, values in points of reward."""
    if name == EXPECTED:
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
