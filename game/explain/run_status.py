"""Share of attempts that succeed, as one large figure."""

from __future__ import annotations

from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import FIGURE, INK, MUTE, SMALL, Colour, Palette


def rate_colour(palette: Palette, percent: float) -> Colour:
    """Return the colour of a success rate; the colour of success only where most attempts succeed."""
    return palette.good if percent > 50 else INK


def draw_landings(canvas: Canvas, corner: Point, landed: int, lost: int) -> None:
    """Draw the share of flights that have landed with its baseline at `corner`, and both counts; none before any."""
    if landed + lost == 0:
        return
    (left, top), share = corner, f"{100 * landed / (landed + lost):.0f}"
    figure = canvas.text(share, (left - 1, top), size=FIGURE, weight="light", tabular=True,
                         colour=rate_colour(canvas.palette, float(share)))  # fmt: skip
    canvas.text(texts.WATCH_LANDED, (figure.right + 6, top), size=SMALL, colour=MUTE)
    counts = texts.WATCH_COUNTS.format(landed=landed, lost=lost)
    canvas.text(counts, (left, top + 22), size=SMALL, colour=MUTE, tabular=True)
    canvas.explain(
        (left - 4, top - 30, 180, 58),
        texts.EXPLAIN_LANDINGS,
        lambda: texts.EXPLAIN_LANDINGS_NOW.format(landed=landed, all=landed + lost),
    )
