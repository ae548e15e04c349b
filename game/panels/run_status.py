"""Status of a training run, in words and one large figure; shared by landers and digits."""

from __future__ import annotations

from typing import Final

from game.core import texts
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas, Point
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import FIGURE, INK, MUTE, SMALL, TITLE, Colour, Palette

_LEADING: Final = 17.0


def start_label(state: WorkerState | None) -> str:
    """Return the label of the button that starts, pauses and resumes a run."""
    if state in (WorkerState.RUNNING, WorkerState.STARTING):
        return texts.TRAIN_PAUSE
    return texts.TRAIN_RESUME if state is WorkerState.PAUSED else texts.TRAIN_START


def rate_colour(palette: Palette, percent: float) -> Colour:
    """Return the colour of a success rate; the colour of success only where most attempts succeed."""
    return palette.good if percent > 50 else INK


def draw_run_status(
    canvas: Canvas, corner: Point, title: str, line: str, figure: str, words: str, *, drop: float, room: float
) -> None:
    """Draw a title with its baseline at `corner`, a line below it and, `drop` further down, a figure with words."""
    left, top = corner
    canvas.text(title, corner, size=TITLE)
    canvas.text(line, (left, top + 22), size=SMALL, colour=MUTE, tabular=True, room=room)
    if figure:
        colour = rate_colour(canvas.palette, float(figure))
        end = canvas.text(
            figure, (left - 1, top + drop), size=FIGURE, weight="light", tabular=True, colour=colour
        ).right
        canvas.text(words, (end + 8, top + drop), size=SMALL, colour=MUTE)


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


def draw_problem(canvas: Canvas, problem: str, corner: Point, width: float, most: int) -> None:
    """Draw why a run has failed, in at most so many lines."""
    left, top = corner
    canvas.marker("cross", (left + 5, top - 4), 10, canvas.palette.warn)
    draw_wrapped(canvas, problem, (left + 18, top), width - 20, colour=canvas.palette.warn, leading=_LEADING, most=most)
