"""Captions under the charts of a training run: what each curve means now."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from ai.training.captions import CHARTS, Caption, captions
from ai.training.config import Config
from ai.training.hints import RecentCurves
from ai.training.history import History
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import LABEL, MUTE
from game.ui.chart import Chart

STAY: Final = 3.0  # seconds of training for which a caption stays at least, unless a hint speaks against it
UNKNOWN: Final = "unknown"  # the caption of a curve that has not begun, which stays no longer than that
_SIZE: Final = LABEL - 1.0
_LEADING: Final = 12.0
_DROP: Final = 12.0  # from the bottom of a chart to the first baseline
_WIDE: Final = 300.0  # points of a chart that needs one line


class ChartCaptions:
    """One caption for each chart, which changes only now and then, so that it can be read.

    Attributes:
        shown: caption of each chart, by its name; empty before there is anything to say.

    """

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Reset for another run."""
        self.shown: dict[str, Caption] = {}
        self._since: dict[str, float] = {}
        self._hint = ""

    def follow(self, history: History, config: Config, hint: str) -> None:
        """Judge the curves anew, beside the hint that is shown, by its name; call it when there is news."""
        if not len(history):
            return
        now = float(history["seconds"][-1])
        for chart, caption in captions(RecentCurves(history, config), hint).items():
            before = self.shown.get(chart)
            changes = before is not None and before.name not in (caption.name, UNKNOWN)
            if changes and now - self._since[chart] < STAY and hint == self._hint:
                continue
            if before is None or before.name != caption.name:
                self._since[chart] = now
            self.shown[chart] = caption
        self._hint = hint

    def text(self, chart: str) -> str:
        """Return the words of a chart's caption; empty if there is none."""
        caption = self.shown.get(chart)
        return texts.CHART_CAPTIONS[chart][caption.name].format(**caption.values) if caption else ""

    def draw(self, canvas: Canvas, charts: Sequence[Chart]) -> None:
        """Write the captions under their charts."""
        for name, chart in zip(CHARTS, charts, strict=True):
            box = chart.box
            lines = 1 if box.width > _WIDE else 2
            draw_wrapped(canvas, self.text(name), (box.x, box.bottom + _DROP), box.width - 8, size=_SIZE,
                         colour=MUTE, leading=_LEADING, most=lines)  # fmt: skip
