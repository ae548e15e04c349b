"""Split view of Train: the swarm of a healthy run, and beside it that of an experiment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import pygame

from ai.training.experiments import Flown
from game.core import texts
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import LINE, NET, NIGHT0, SMALL, TEXT
from game.scenes.train.charts import Beside
from game.training.beside import EarlierRun
from game.training.run import TrainingRun
from game.ui.curves import RUN_STYLES
from game.world.swarm import LearningSwarm

_SAID: Final = 66.0  # height of the words below each half
_MARGIN: Final = 28.0
_STYLE: Final = 1  # of the experiment's curves: see RUN_STYLES


class SplitView:
    """Two swarms side by side, each with its name, and the flights it lands."""

    def __init__(self, run: TrainingRun) -> None:
        self._run = run
        self.swarms = tuple(LearningSwarm() for _ in range(2))
        self._box = pygame.FRect(0, 0, 836, 434)
        self._pictures: list[Canvas] = []  # of both halves, each drawn anew in every second frame
        self._names = ("", "")
        self._frame = 0
        self._moment: int | None = None

    def place(self, box: pygame.FRect) -> None:
        """Move to another box, below the words of the screen."""
        self._box, self._pictures = box, []
        for swarm in self.swarms:
            swarm.place(pygame.FRect(0, 0, box.width / 2, max(box.height - _SAID, 1.0)))

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
        """Empty both halves, for other runs."""
        self._pictures = []
        for swarm in self.swarms:
            swarm.clear()

    def update(self, still: bool, moment: int | None = None) -> None:
        """Take the latest snapshots, or those of a moment, in decisions, and advance by 1/60 s."""
        for run, swarm in zip(self._runs, self.swarms, strict=False):
            state = run.swarm_state if moment is None else run.swarms.nearest(moment)
            if state is not None and state is not swarm.swarm_state:
                if moment != self._moment:
                    swarm.clear()
                swarm.take(state)
            swarm.update(still)
        self._moment = moment
        self._frame += 1

    def draw(self, canvas: Canvas, alpha: float, landed: Sequence[str]) -> None:
        """Draw both halves; `landed` are the shares that land as the chart of both was painted."""
        box, paused = self._box, self._run.state is WorkerState.PAUSED
        canvas.fill(canvas.rect(*box), NIGHT0)
        fresh = not self._pictures or self._pictures[0].scale != canvas.scale
        if fresh:
            self._pictures = [canvas.picture(*swarm.box.size) for swarm in self.swarms]
        for number, (run, swarm, picture) in enumerate(zip(self._runs, self.swarms, self._pictures, strict=True)):
            if fresh or self._frame % 2 == number:
                swarm.draw(picture, alpha, paused=paused)
            left = box.left + number * swarm.box.width
            canvas.surface.blit(picture.surface, canvas.rect(left, box.top, *swarm.box.size))
            share = landed[number] if number < len(landed) else ""
            if self._moment is not None:
                row = run.history.row_at(self._moment)
                share = f"{100 * Flown(run.history, run.config).landed_at(row):.0f}"
            self._write(canvas, left, number, run, share)
        canvas.line((box.centerx, box.top), (box.centerx, box.bottom), LINE)

    def _write(self, canvas: Canvas, left: float, number: int, run: TrainingRun, share: str) -> None:
        """Write a run's name and the share that lands below its swarm."""
        width, top = self._box.width / 2 - 2 * _MARGIN, self._box.bottom - _SAID + 6
        colour = (NET, RUN_STYLES[_STYLE][0])[number]
        cursor = Cursor(left + _MARGIN, top, width, canvas.scale, canvas, size=TEXT, colour=colour)
        cursor.pair(self._names[number], texts.SPLIT_LANDED.format(percent=share) if share else "")
        if run.state in (WorkerState.FAILED, WorkerState.ENDED):
            cursor.in_style(SMALL, canvas.palette.warn).text(texts.SPLIT_ENDED)
