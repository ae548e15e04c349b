"""The landers of a run as they are seen: now, at an earlier moment, or beside those of an experiment."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import Final

import pygame

from ai.training.curves import Curves
from game.core import texts
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import LINE, MUTE, NET, NIGHT0, SMALL, TEXT
from game.scenes.train.layout import FLIGHTS, NAMES
from game.scenes.train.rewind import Rewind
from game.training.run import TrainingRun
from game.ui.curves import BESIDE
from game.world.swarm import LearningSwarm

_HEAD: Final = 130.0  # points of the box, for the title above two swarms
_MARGIN: Final = 28.0


class Swarms:
    """The swarm of a run, at the moment that is chosen, or two side by side, each with its name and what it lands.

    Attributes:
        box: where they are, in points.
        both: those of the run, and of its experiment.

    """

    def __init__(self, run: TrainingRun, rewind: Rewind) -> None:
        self._run, self._rewind = run, rewind
        self.both = LearningSwarm(), LearningSwarm()
        self.box = self._halves = pygame.FRect(0, 0, 836, 434)
        self._pictures: list[Canvas] = []  # of both halves, each drawn anew in every second frame
        self._seen: Hashable = None
        self._frame = 0

    @property
    def shown(self) -> LearningSwarm:
        """The landers of the run."""
        return self.both[0]

    @property
    def _runs(self) -> Sequence[TrainingRun]:
        return (self._run, self._run.twin) if self._run.twin else (self._run,)

    @property
    def titled(self) -> bool:
        """Whether there is room for the title: two swarms need more of it."""
        return self._run.twin is None or self.box.height >= _HEAD + FLIGHTS + NAMES

    def place(self, box: pygame.FRect) -> None:
        """Move to another box."""
        self.box, self._pictures = box, []
        head = min(_HEAD, 0.4 * box.height) if self.titled else 0.0
        self._halves = pygame.FRect(box.left, box.top + head, box.width, box.height - head)
        half = pygame.FRect(0, 0, box.width / 2, max(self._halves.height - NAMES, 1.0))
        for swarm in self.both:
            swarm.place(half if self._run.twin else box)
            swarm.head = 0.0 if self._run.twin else head

    def clear(self) -> None:
        """Show none, for other runs."""
        for swarm in self.both:
            swarm.clear()
        self.place(self.box)

    def update(self, still: bool) -> None:
        """Take the latest snapshots, or those of the moment that is shown, and advance by 1/60 s."""
        moment = self._rewind.moment
        if (moment, self._run.twin is None) != self._seen:
            self._seen = moment, self._run.twin is None
            self.clear()
        for swarm, run in zip(self.both, self._runs, strict=False):
            state = run.swarm_state if moment is None else run.swarms.nearest(moment)
            if run is self._run and moment is not None:
                state = self._rewind.swarm_state
            if state is not None and state is not swarm.swarm_state:
                swarm.take(state)
            swarm.update(still)
        self._frame += 1

    def draw(self, canvas: Canvas, alpha: float, landed: Sequence[int | None], experiment: str) -> None:
        """Draw them; `landed` are the shares that land, in percent."""
        moment = self._rewind.moment
        paused = self._run.state is WorkerState.PAUSED or moment is not None
        if self._run.twin:
            self._draw_pair(canvas, alpha, paused, landed, (texts.SPLIT_HEALTHY, experiment))
            return
        self.shown.draw(canvas, alpha, paused=paused)
        if moment is not None and self._rewind.swarm_state is None:
            place = self.box.centerx, self.box.bottom - 14  # below the title, in a small window, too
            canvas.text(texts.REWIND_NO_LANDERS, place, size=SMALL, colour=MUTE, align="centre")

    def _draw_pair(
        self, canvas: Canvas, alpha: float, paused: bool, landed: Sequence[int | None], names: tuple[str, str]
    ) -> None:
        box, moment = self._halves, self._rewind.moment
        canvas.fill(canvas.rect(*self.box), NIGHT0)
        fresh = not self._pictures or self._pictures[0].scale != canvas.scale
        if fresh:
            self._pictures = [canvas.picture(*swarm.box.size) for swarm in self.both]
        for number, (run, swarm, picture) in enumerate(zip(self._runs, self.both, self._pictures, strict=True)):
            if fresh or self._frame % 2 == number:
                swarm.draw(picture, alpha, paused=paused)
            left = box.left + number * swarm.box.width
            canvas.surface.blit(picture.surface, canvas.rect(left, box.top, *swarm.box.size))
            share = landed[number] if number < len(landed) else None
            if moment is not None:
                share = round(100 * Curves(run.history, run.config).landed(run.history.row_at(moment)))
            self._write(canvas, left, number, run, names[number], share)
        canvas.line((box.centerx, box.top), (box.centerx, box.bottom), LINE)

    def _write(self, canvas: Canvas, left: float, number: int, run: TrainingRun, name: str, share: int | None) -> None:
        """Write a run's name and the share that lands below its swarm."""
        width, top = self._halves.width / 2 - 2 * _MARGIN, self._halves.bottom - NAMES + 6
        colour = (NET, BESIDE[0])[number]
        cursor = Cursor(left + _MARGIN, top, width, canvas.scale, canvas, size=TEXT, colour=colour)
        cursor.pair(name, "" if share is None else texts.SPLIT_LANDED.format(percent=share))
        if run.state in (WorkerState.FAILED, WorkerState.ENDED):
            cursor.in_style(SMALL, canvas.palette.warn).text(texts.SPLIT_ENDED)
