"""Knobs against result: a dot for each trial of a study, across by one knob and up by the result."""

from __future__ import annotations

from collections.abc import Sequence

import pygame

from ai.sweep.study import FinishedTrial, Study
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import LABEL, LINE, MUTE, NET
from game.training.knob_descriptions import figure


class StudyDots:
    """Dots of the trials in a box, in points; painted anew only for another knob, trial or window."""

    def __init__(self, box: pygame.typing.RectLike) -> None:
        self.box = pygame.FRect(box)
        self._cache = PaintCache()

    def draw(
        self, canvas: Canvas, study: Study, trials: Sequence[FinishedTrial], knob: str, chosen: FinishedTrial
    ) -> None:
        """Draw the trials by their values of a knob, and a ring around the chosen one."""
        shows = (study.folder, len(trials), knob, chosen.number)
        self._cache.draw(canvas, self.box, shows, lambda sheet: self._paint(sheet, study, trials, knob, chosen))

    def _paint(
        self, canvas: Canvas, study: Study, trials: Sequence[FinishedTrial], knob: str, chosen: FinishedTrial
    ) -> None:
        dimension = study.plan.space[knob]
        plot = pygame.FRect(0, 8, self.box.width, self.box.height - 30)
        canvas.line(plot.bottomleft, plot.bottomright, LINE)
        values = [trial.value or 0.0 for trial in trials]
        low, high = min(values), max(values)
        better_up = study.metric.sign == -1
        inner = plot.inflate(-16, -16)
        for trial, value in zip(trials, values, strict=True):
            share = (value - low) / (high - low) if high > low else 0.5
            up = share if better_up else 1 - share
            spot = (inner.left + dimension.place(trial.params[knob]) * inner.width, inner.bottom - up * inner.height)
            canvas.dot(spot, 2.5, MUTE)
            if trial.number == chosen.number:
                canvas.dot(spot, 3.5, NET)
                canvas.outline((spot[0] - 8, spot[1] - 8, 16, 16), 8, NET)
        y = self.box.height - 6
        left, right = map(knob_value, dimension.ends)
        canvas.text(left, (0, y), size=LABEL, colour=MUTE)
        canvas.text(right, (plot.right, y), size=LABEL, colour=MUTE, align="right")


def knob_value(value: object) -> str:
    """Return a knob's value, as a study holds it, for the player."""
    if isinstance(value, list):
        return figure(tuple(value))
    return figure(float(f"{value:.3g}") if isinstance(value, float) else value)
