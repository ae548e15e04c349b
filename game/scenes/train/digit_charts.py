"""Charts of a digit run: loss and accuracy over seconds, with other runs for comparison."""

from __future__ import annotations

from typing import Final

from ai.training.history import REVERTED, History, SettingChange
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import MUTE
from game.training.beside import EarlierRun
from game.training.knob_descriptions import figure, label
from game.ui.chart import Chart, Series, Tick, draw_legend
from game.ui.charts import Charts
from game.ui.series import run_style

_BATCHES: Final = (MUTE, (2.0, 4.0))


class DigitCharts(Charts):
    """Two charts over one axis."""

    def __init__(self) -> None:
        titles, empty = texts.DIGIT_RUN_CHARTS, texts.DIGIT_RUN_CHARTS_SHOW
        forms = {"loss": "{:.3g}", "accuracy": "{:.2f}"}
        super().__init__(
            [Chart((0, 0, 300, 100), titles[name], read=forms[name].format, empty=empty[name]) for name in forms]
        )
        self._told: tuple[object, ...] = ()
        self._batches: Series | None = None  # the accuracy of the training batches

    def draw(self, canvas: Canvas) -> None:
        """Draw both charts, and which curve of accuracy is which below them."""
        super().draw(canvas)
        box = self.charts[1].box
        if self._batches is not None:
            curves = [Series((), (), texts.DIGIT_RUN_HELD_OUT), self._batches]
            draw_legend(canvas, curves, (box.left, box.bottom + 14))

    def look(self, history: History, earlier: list[EarlierRun]) -> None:
        """Show the curves of this run and of earlier ones, if they have changed."""
        shown = [(beside.name, beside.style) for beside in earlier]
        told = (_seconds(history), len(history.validations), shown, self.zoom.shown, *history.setting_changes)
        if told == self._told:
            return
        self._told = told
        runs = [EarlierRun(texts.TRAIN_THIS, history, 0), *earlier]
        self.zoom.end = max(10.0, *(_seconds(beside.run) for beside in runs))
        losses, accuracies = [], []
        for beside in runs:
            name, each, (colour, dash) = beside.name, beside.run, run_style(beside.style)
            if len(each):
                losses.append(Series(each["seconds"].tolist(), each["loss"].tolist(), name, colour, dash))
                read = each.validations
                scores = ([score.seconds for score in read], [100 * score.success for score in read])
                accuracies.append(Series(*scores, name, colour, dash, smooth=False))
        self._batches = _batches(history) if len(history) else None
        if self._batches is not None:
            accuracies.append(self._batches)
        ticks = [Tick(turn.seconds, _turn_told(turn), "knob") for turn in history.setting_changes]
        for chart, series in zip(self.charts, (losses, accuracies), strict=True):
            chart.set(series, self.zoom.shown, ticks)


def _turn_told(turn: SettingChange) -> str:
    if turn.name == REVERTED:
        return texts.DIGIT_RUN_WENT_BACK.format(part=turn.after)
    return f"{label(turn.name)} {figure(turn.after)}"


def _seconds(history: History) -> float:
    return float(history["seconds"][-1]) if len(history) else 0.0


def _batches(history: History) -> Series:
    """Return the curve of the training batches' accuracy."""
    colour, dash = _BATCHES
    accuracy = (100 * history["accuracy"]).tolist()
    return Series(history["seconds"].tolist(), accuracy, texts.DIGIT_RUN_BATCHES, colour, dash)
