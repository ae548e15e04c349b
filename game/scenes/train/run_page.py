"""Description of a saved run: its row in a list, and its page of details."""

from __future__ import annotations

import time

from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import LABEL, MUTE, NET, SMALL, TITLE
from game.training.library import Library, SavedRun
from game.ui.listing import shortened


def row(run: SavedRun, own: bool) -> tuple[str, str, str, str]:
    """Return the row of a run: name, landing rate, decisions learnt from, and date saved."""
    saved = time.strftime("%Y-%m-%d", time.localtime(run.saved)) if own else texts.RUNS_SHIPPED
    if run.problem:
        return run.name, "–", "–", saved
    return run.name, " ".join(_percent(run)), " ".join(_count(run.decisions)), saved


def suggestion(library: Library, run: SavedRun) -> str:
    """Suggest a name from a run's figures, for players without a keyboard."""
    if run.problem:
        return library.free_name(run.name)
    count = "".join(_count(run.decisions))
    name = texts.RUN_SUGGESTION.format(preset=run.preset, decisions=count, percent=_percent(run)[0])
    return library.free_name(name)


def draw_run(canvas: Canvas, run: SavedRun, left: float, width: float, *, own: bool, named: bool, flies: bool) -> None:
    """Draw the details of a run; its name only if `named`, as an entry to rename it may stand there."""
    if named:
        canvas.text(shortened(canvas, run.name, TITLE, width), (left, 165), size=TITLE, room=width)
    y = 222 if run.problem else 294
    if run.problem:
        canvas.marker("cross", (left + 5, 190), 10, canvas.palette.warn)
        problem = shortened(canvas, run.problem, SMALL, width - 20)
        canvas.text(problem, (left + 18, 194), size=SMALL, colour=canvas.palette.warn)
    else:
        canvas.text(_made(run), (left, 194), size=SMALL, colour=MUTE)
        _draw_figures(canvas, run, left)
    when = time.strftime("%Y-%m-%d %H:%M", time.localtime(run.saved))
    saved = texts.RUN_SAVED.format(when=when) if own else texts.RUN_SHIPPED
    canvas.text(saved, (left, y), size=SMALL, colour=MUTE)
    if flies:
        canvas.dot((left + 4, y + 20), 4, NET)
        canvas.text(texts.RUN_FLIES, (left + 16, y + 24), size=SMALL, colour=NET)


def _draw_figures(canvas: Canvas, run: SavedRun, left: float) -> None:
    figures = (_percent(run), _count(run.decisions), _duration(run.seconds))
    for number, (label, (figure, unit)) in enumerate(zip(texts.RUN_FIGURES, figures, strict=True)):
        x = left + number * 132
        canvas.text(label, (x, 230), size=LABEL, weight="medium", colour=MUTE)
        box = canvas.text(figure, (x - 1, 262), size=28, weight="light", tabular=True)
        canvas.text(unit, (box.right + 5, 262), size=SMALL, colour=MUTE)


def _made(run: SavedRun) -> str:
    settings = texts.RUN_SETTINGS if run.changes else texts.RUN_AS_IS
    return texts.RUN_SEED.format(settings=settings.format(preset=run.preset, count=run.changes), seed=run.seed)


def _percent(run: SavedRun) -> tuple[str, str]:
    return ("–", "") if run.success is None else (f"{100 * run.success:.1f}", "%")


def _count(number: int) -> tuple[str, str]:
    if number >= 1_000_000:
        return f"{number / 1e6:.1f}", "M"
    return (f"{number / 1e3:.0f}", "k") if number >= 1000 else (str(number), "")


def _duration(seconds: float) -> tuple[str, str]:
    return (f"{seconds:.0f}", "s") if seconds < 120 else (f"{seconds / 60:.0f}", "min")
