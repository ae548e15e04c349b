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
from game.drawing.tokens import LINE, NET, NIGHT0, SMALL, TEXT, Colour
from game.scenes.train.laboratory import Laboratory
from game.training.beside import EarlierRun
from game.training.run import TrainingRun
from game.ui.series import RUN_STYLES
from game.world.swarm import LearningSwarm

_SAID: Final = 66.0  # height of the words below each half
_MARGIN: Final = 28.0
_JUDGED: Final = 20  # frames after which the runs are judged anew
_STYLE: Final = 1  # of the experiment's curves: see RUN_STYLES


class SplitView:
    """Two swarms side by side, each with its name, the flights it lands and what is different in it."""

    def __init__(self, laboratory: Laboratory) -> None:
        self._laboratory, self._split = laboratory, laboratory.split
        self.swarms = tuple(LearningSwarm() for _ in range(2))
        self._box = pygame.FRect(0, 0, 836, 434)
        self._pictures: list[Canvas] = []  # of both halves, each drawn anew in every second frame
        self._frame = 0
        self._moment: int | None = None
        self._moments: tuple[int, int] | None = None  # that moment of both, after as many decisions of each lander

    def place(self, box: pygame.FRect) -> None:
        """Move to another box, below the words of the screen."""
        self._box, self._pictures = box, []
        for swarm in self.swarms:
            swarm.place(pygame.FRect(0, 0, box.width / 2, max(box.height - _SAID, 1.0)))

    @property
    def shown(self) -> bool:
        """Whether there is an experiment to show beside the run."""
        return self._split.twin is not None

    @property
    def name(self) -> str:
        """Name of the run where it is one of several."""
        return texts.SPLIT_HEALTHY if self.shown else texts.TRAIN_THIS

    @property
    def beside(self) -> Sequence[EarlierRun]:
        """The runs whose curves are shown beside the run's: its experiment, or else earlier ones."""
        twin, chosen = self._split.twin, self._laboratory.chosen
        if twin is None:
            return self._split.earlier
        return [EarlierRun(chosen.name if chosen else texts.LAB_HEADING, twin.history, _STYLE)]

    @property
    def paid_otherwise(self) -> bool:
        """Whether the experiment is paid by other weights: then its points say nothing beside those of the run."""
        twin, run = self._split.twin, self._split
        return twin is not None and twin.config.reward_weights != run.config.reward_weights

    def clear(self) -> None:
        """Empty both halves, for other runs."""
        self._pictures = []
        for swarm in self.swarms:
            swarm.clear()

    def update(self, still: bool, moment: int | None = None) -> None:
        """Take the latest snapshots, judge the runs now and then, and advance by 1/60 s.

        `moment`, in decisions, is that which is shown instead of now.
        """
        twin = self._split.twin
        if twin is None:
            return
        share = twin.config.num_envs / self._split.config.num_envs
        self._moments = None if moment is None else (moment, int(moment * share))
        for run, swarm, then in zip((self._split, twin), self.swarms, self._moments or (None, None), strict=True):
            state = run.swarm_state if then is None else run.swarms.nearest(then)
            if state is not None and state is not swarm.swarm_state:
                if moment != self._moment:
                    swarm.clear()
                swarm.take(state)
            swarm.update(still)
        self._moment = moment
        self._frame += 1
        if self._frame % _JUDGED == 0:
            self._laboratory.follow()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw both halves."""
        twin, chosen = self._split.twin, self._laboratory.chosen
        if twin is None or chosen is None:
            return
        box = self._box
        canvas.fill(canvas.rect(*box), NIGHT0)
        paused = self._split.state is WorkerState.PAUSED
        fresh = not self._pictures or self._pictures[0].scale != canvas.scale
        if fresh:
            self._pictures = [canvas.picture(*swarm.box.size) for swarm in self.swarms]
        for number, (swarm, picture) in enumerate(zip(self.swarms, self._pictures, strict=True)):
            if fresh or self._frame % 2 == number:
                swarm.draw(picture, alpha, paused=paused)
            canvas.surface.blit(
                picture.surface, canvas.rect(box.left + number * swarm.box.width, box.top, *swarm.box.size)
            )
        canvas.line((box.centerx, box.top), (box.centerx, box.bottom), LINE)
        self._write(canvas, 0, texts.SPLIT_HEALTHY, self._split, NET)
        self._write(canvas, 1, chosen.name, twin, RUN_STYLES[_STYLE][0])

    def _write(self, canvas: Canvas, half: int, name: str, run: TrainingRun, colour: Colour) -> None:
        """Write a run's name and the share that lands below its swarm."""
        width = self._box.width / 2 - 2 * _MARGIN
        left = self._box.left + half * self._box.width / 2 + _MARGIN
        cursor = Cursor(left, self._box.bottom - _SAID + 6, width, canvas.scale, canvas, size=TEXT, colour=colour)
        figure = ""
        if len(run.history):
            row = -1 if self._moments is None else run.history.row_at(self._moments[half])
            figure = texts.SPLIT_LANDED.format(percent=100 * Flown(run.history, run.config).landed_at(row))
        cursor.pair(name, figure)
        if run.state in (WorkerState.FAILED, WorkerState.ENDED):
            cursor.in_style(SMALL, canvas.palette.warn).text(texts.SPLIT_ENDED)
