"""The landers of a run as they are seen: now, at an earlier moment, or beside those of an experiment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import pygame

from ai.training.experiments import Flown
from game.core import texts
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import LINE, MUTE, NET, NIGHT0, SMALL, TEXT
from game.scenes.train.charts import Beside
from game.scenes.train.rewind import Rewind
from game.training.record import EarlierRun
from game.training.run import TrainingRun
from game.ui.curves import run_style
from game.world.swarm import LearningSwarm

HEAD: Final = 130.0  # points of the box, for the title above two swarms
_SAID: Final = 66.0  # height of the words below each half
_MARGIN: Final = 28.0
_STYLE: Final = 1  # of the experiment's curves: see run_style


class Swarms:
    """The swarm of a run, at the moment that is chosen, or two side by side, each with its name and what it lands.

    Attributes:
        box: where they are, in points.
        now, past: the landers now, and those of the moment that is shown instead.
        pair: those of the run and of its experiment.

    """

    def __init__(self, run: TrainingRun, rewind: Rewind) -> None:
        self._run, self._rewind = run, rewind
        self.now, self.past = LearningSwarm(), LearningSwarm()
        self.pair = LearningSwarm(), LearningSwarm()
        self.box = self._halves = pygame.FRect(0, 0, 836, 434)
        self._pictures: list[Canvas] = []  # of both halves, each drawn anew in every second frame
        self._names = ("", "")
        self._frame = 0
        self._moment: int | None = None

    @property
    def shown(self) -> LearningSwarm:
        """The landers of the moment that is shown."""
        return self.now if self._rewind.moment is None else self.past

    def place(self, box: pygame.FRect) -> None:
        """Move to another box."""
        head = min(HEAD, 0.4 * box.height)
        for swarm in (self.now, self.past):
            swarm.place(box)
            swarm.head = head
        self.box, self._pictures = box, []
        self._halves = pygame.FRect(box.left, box.top + head, box.width, box.height - head)
        for swarm in self.pair:
            swarm.place(pygame.FRect(0, 0, box.width / 2, max(self._halves.height - _SAID, 1.0)))

    @property
    def _runs(self) -> Sequence[TrainingRun]:
        return (self._run, self._run.twin) if self._run.twin else ()

    def beside(self, experiment: str) -> Beside:
        """Return what is shown beside the run: its experiment, by that name, or else earlier runs."""
        twin, run = self._run.twin, self._run
        if twin is None:
            return Beside(run.earlier)
        self._names = (texts.SPLIT_HEALTHY, experiment)
        otherwise = twin.config.reward_weights != run.config.reward_weights
        return Beside([EarlierRun(experiment, twin.history, _STYLE)], texts.SPLIT_HEALTHY, otherwise)

    def clear(self) -> None:
        """Show none, for other runs."""
        self._pictures = []
        for swarm in (self.now, self.past, *self.pair):
            swarm.clear()

    def update(self, still: bool) -> None:
        """Take the latest snapshots, or those of the moment that is shown, and advance by 1/60 s."""
        moment = self._rewind.moment
        if moment != self._moment:
            self._moment = moment
            for swarm in (self.past, *self.pair):
                swarm.clear()
        shown = [(self.now, self._run.swarm_state), (self.past, self._rewind.swarm_state)]
        for swarm, run in zip(self.pair, self._runs, strict=False):
            shown.append((swarm, run.swarm_state if moment is None else run.swarms.nearest(moment)))
        for swarm, state in shown:
            if state is not None and state is not swarm.swarm_state:
                swarm.take(state)
        for swarm in (self.now, *self.pair):
            swarm.update(still)
        self._frame += 1

    def draw(self, canvas: Canvas, alpha: float, landed: Sequence[int | None]) -> None:
        """Draw them; `landed` are the shares that land, in percent."""
        paused = self._run.state is WorkerState.PAUSED or self._moment is not None
        if self._run.twin:
            self._draw_pair(canvas, alpha, paused, landed)
            return
        self.shown.draw(canvas, alpha, paused=paused)
        if self._moment is not None and self._rewind.swarm_state is None:
            place = self.box.centerx, self.box.bottom - 14  # below the title, in a small window, too
            canvas.text(texts.REWIND_NO_LANDERS, place, size=SMALL, colour=MUTE, align="centre")

    def _draw_pair(self, canvas: Canvas, alpha: float, paused: bool, landed: Sequence[int | None]) -> None:
        box = self._halves
        canvas.fill(canvas.rect(*self.box), NIGHT0)
        fresh = not self._pictures or self._pictures[0].scale != canvas.scale
        if fresh:
            self._pictures = [canvas.picture(*swarm.box.size) for swarm in self.pair]
        for number, (run, swarm, picture) in enumerate(zip(self._runs, self.pair, self._pictures, strict=True)):
            if fresh or self._frame % 2 == number:
                swarm.draw(picture, alpha, paused=paused)
            left = box.left + number * swarm.box.width
            canvas.surface.blit(picture.surface, canvas.rect(left, box.top, *swarm.box.size))
            share = landed[number] if number < len(landed) else None
            if self._moment is not None:
                row = run.history.row_at(self._moment)
                share = round(100 * Flown(run.history, run.config).landed(row))
            self._write(canvas, left, number, run, share)
        canvas.line((box.centerx, box.top), (box.centerx, box.bottom), LINE)

    def _write(self, canvas: Canvas, left: float, number: int, run: TrainingRun, share: int | None) -> None:
        """Write a run's name and the share that lands below its swarm."""
        width, top = self._halves.width / 2 - 2 * _MARGIN, self._halves.bottom - _SAID + 6
        colour = (NET, run_style(_STYLE)[0])[number]
        cursor = Cursor(left + _MARGIN, top, width, canvas.scale, canvas, size=TEXT, colour=colour)
        cursor.pair(self._names[number], "" if share is None else texts.SPLIT_LANDED.format(percent=share))
        if run.state in (WorkerState.FAILED, WorkerState.ENDED):
            cursor.in_style(SMALL, canvas.palette.warn).text(texts.SPLIT_ENDED)
