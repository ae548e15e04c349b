"""Captions under the charts of a training run: what each curve means now."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from ai.training.captions import Caption, caption
from ai.training.config import Config
from ai.training.hints import RecentCurves
from ai.training.history import History
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import LABEL, MUTE
from game.ui.chart import Chart

STAY: Final = 3.0  # seconds of training for which a caption stays at least, as long as it is true
_SIZE: Final = LABEL - 1.0
_LEADING: Final = 12.0
_DROP: Final = 12.0  # from the bottom of a chart to the first baseline
_WIDE: Final = 300.0  # points of a chart that needs one line


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


def draw_captions(canvas: Canvas, charts: Sequence[Chart]) -> None:
    """Write the captions under their charts, as they were when the charts were painted."""
    for chart in charts:
        box = chart.box
        lines = 1 if box.width > _WIDE else 2
        draw_wrapped(canvas, chart.painted_caption, (box.x, box.bottom + _DROP), box.width - 8, size=_SIZE,
                     colour=MUTE, leading=_LEADING, most=lines)  # fmt: skip
