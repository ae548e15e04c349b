"""Charts of a digit run: loss and accuracy over seconds, with other runs for comparison."""

from __future__ import annotations

from typing import Final

from ai.training.digit_session import DigitSettingChanged
from ai.training.history import REVERTED
from game.charts.chart import Chart, Series, Tick, draw_legend
from game.charts.charts import Charts
from game.charts.series import run_style
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import MUTE
from game.training.digit_run import DigitCurves
from game.training.knob_descriptions import figure, label
from game.training.training_run import EarlierRun

_CHARTS: Final = {"loss": (40, 146, 372, 152), "accuracy": (440, 146, 372, 152)}
_LEGEND: Final = (440.0, 118.0)
_BATCHES: Final = (MUTE, (2.0, 4.0))


class DigitCharts(Charts):
    """Two charts over one axis."""

    def __init__(self) -> None:
        titles, empty = texts.DIGIT_RUN_CHARTS, texts.DIGIT_RUN_CHARTS_SHOW
        forms = {"loss": "{:.3g}", "accuracy": "{:.2f}"}
        super().__init__(
            [Chart(_CHARTS[name], titles[name], read=forms[name].format, empty=empty[name]) for name in forms]
        )
        self._told: tuple[object, ...] = ()

    def look(self, curves: DigitCurves, earlier: list[EarlierRun[DigitCurves]]) -> None:
        """Show the curves of this run and of earlier ones, if they have changed."""
        shown = [(beside.name, beside.style) for beside in earlier]
        told = (curves.seconds, len(curves.points), len(curves.scores), shown, self.zoom.shown, *curves.turns)
        if told == self._told:
            return
        self._told = told
        runs = [EarlierRun(texts.TRAIN_THIS, curves, 0), *earlier]
        self.zoom.end = max(10.0, *(beside.run.seconds for beside in runs))
        losses, accuracies = [], []
        for beside in runs:
            name, each, (colour, dash) = beside.name, beside.run, run_style(beside.style)
            if each.points:
                seconds = [point.seconds for point in each.points]
                losses.append(Series(seconds, [point.loss for point in each.points], name, colour, dash))
                scores = ([score.seconds for score in each.scores], [100 * score.accuracy for score in each.scores])
                accuracies.append(Series(*scores, name, colour, dash, smooth=False))
        if curves.points:
            accuracies.append(_batches(curves))
        ticks = [Tick(turn.seconds, _turn_told(turn), "knob") for turn in curves.turns]
        for chart, series in zip(self.charts, (losses, accuracies), strict=True):
            chart.set(series, self.zoom.shown, ticks)


def draw_accuracy_legend(canvas: Canvas, curves: DigitCurves) -> None:
    """Draw which curve of accuracy is which."""
    draw_legend(canvas, [Series((), (), texts.DIGIT_RUN_HELD_OUT), _batches(curves)], _LEGEND)


def _turn_told(turn: DigitSettingChanged) -> str:
    if turn.name == REVERTED:
        return texts.DIGIT_RUN_WENT_BACK.format(part=turn.after)
    return f"{label(turn.name)} {figure(turn.after)}"


def _batches(curves: DigitCurves) -> Series:
    """Return the curve of the training batches' accuracy."""
    colour, dash = _BATCHES
    return Series(
        [point.seconds for point in curves.points],
        [100 * point.accuracy for point in curves.points],
        texts.DIGIT_RUN_BATCHES,
        colour,
        dash,
    )
