"""First filters of a run as they form: those of the newest moment, or of the one that is chosen on the charts."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from ai.digits.filters import FilterMoment
from ai.training.history import History
from game.core import texts
from game.digits import certainty
from game.digits.pictures import mosaic, tiling
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import LABEL, MUTE, SMALL
from game.training.run import TrainingRun
from game.ui.charts import Charts

_GAP: Final = 6.0
_SAID: Final = 160.0  # width of the words beside the filters
_APART: Final = 24.0
_HEADING: Final = 16.0


class FilterFilm:
    """Filters at one moment of a run.

    Attributes:
        history: the run's history; another one belongs to another run.
        moments: all that the run has sent.
        at: number of the chosen moment; None for the newest, whichever that is.

    """

    def __init__(self, charts: Charts) -> None:
        self.history = History()
        self.moments: list[FilterMoment] = []
        self.at: int | None = None
        self._charts = charts
        self._painted = PaintCache()

    @property
    def moment(self) -> FilterMoment | None:
        """The moment that is shown; None before the first."""
        moments = self.moments
        return moments[-1 if self.at is None else min(self.at, len(moments) - 1)] if moments else None

    def choose(self, place: float | int) -> None:
        """Choose the moment nearest to a place on the charts (float), or the one before or after (int -1 or 1)."""
        moments = self.moments
        if not moments:
            return
        last = len(moments) - 1
        if isinstance(place, int):
            at = min(max((last if self.at is None else self.at) + place, 0), last)
        else:
            at = min(range(len(moments)), key=lambda number: abs(moments[number].seconds - place))
        self.at = None if at == last else at
        self._mark()

    def follow(self, run: TrainingRun) -> None:
        """Follow a run; another one begins with its newest moment."""
        if run.filters is not self.moments:
            self.history, self.moments = run.history, run.filters
            self.release()

    def release(self) -> None:
        """Show the newest moment again."""
        self.at = None
        self._mark()

    def _mark(self) -> None:
        moment = self.moment if self.at is not None else None
        if moment is None:
            self._charts.mark(None)
        else:
            self._charts.mark(moment.seconds, texts.DIGIT_RUN_MOMENT.format(seconds=moment.seconds))

    def draw(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the filters into a box: when they were so, and how well the network read then."""
        moment, (left, top) = self.moment, box.topleft
        if moment is None or not len(moment.images):
            words = texts.DIGIT_RUN_FILTERS_NONE if moment is None else texts.DIGIT_RUN_FILTERS_NO_IMAGE
            Cursor(left, top - SMALL, box.width, canvas.scale, canvas).aside(words)
            return
        words = texts.DIGIT_RUN_FILTERS_AT.format(seconds=f"{moment.seconds:.1f}", steps=moment.step)
        canvas.text(words, (left, top), size=LABEL, colour=MUTE, weight="medium", tabular=True, room=box.width)
        beside = _SAID if box.width > 2 * _SAID else 0.0
        room = (box.width - beside - (_APART if beside else 0.0), box.height - _HEADING)
        self._painted.draw(
            canvas, (left, top + _HEADING, *room), (moment, room), lambda sheet: _paint(sheet, moment, room)
        )
        if not beside:
            return
        scores = [score.success for score in self.history.validations if score.seconds <= moment.seconds]
        rows = Cursor(box.right - beside, top + _HEADING, beside, canvas.scale, canvas)
        if scores:
            rows.styled(texts.DIGIT_RUN_FILTERS_READ.format(percent=certainty(scores[-1])), SMALL)
            rows.gap(14)
        rows.aside(texts.DIGIT_RUN_FILTERS_HOW)


def _paint(sheet: Canvas, moment: FilterMoment, room: tuple[float, float]) -> None:
    images = moment.images.astype(np.float32)
    images = np.nan_to_num(images / np.abs(images).max(axis=(1, 2), keepdims=True).clip(1e-9))
    columns, room = tiling(len(images), images.shape[1:], room, _GAP)
    size = sheet.rect(0, 0, *room).size
    sheet.surface.blit(mosaic(images, columns, size, _GAP * sheet.scale), (0, 0))
