"""Base of the scene that trains landers, as far as its runs go: begun, taught, saved, and an experiment beside."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Final

import pygame

from ai.training.config import PRESETS, Config
from ai.training.experiments import Experiment, differences
from game.core import texts
from game.core.names import LibraryError
from game.core.scene import Push, Transition
from game.flight.demonstrations import FILE_NAME, count_demonstrations
from game.panels.lab import Laboratory
from game.panels.lab_knobs import LabKnobsPanel
from game.panels.split_view import SplitView
from game.panels.training_charts import BY_DECISIONS, TrainingCharts
from game.scenes.menus.dialogs import QuestionDialog
from game.scenes.training_scene import TrainingScene
from game.training.run import TrainingRun

_KNOBS: Final = pygame.Rect(868, 20, 384, 404)


class SplitTrainingScene(TrainingScene):
    """Training scene whose run an experiment can fly beside.

    Attributes:
        lander_run: the run, with the experiment.
        training_charts: the charts of both.
        laboratory: the experiment that was chosen, and what came of it.
        split_view: the two swarms.

    """

    knobs: LabKnobsPanel
    lander_run: TrainingRun
    training_charts: TrainingCharts

    @abstractmethod
    def _lay_again(self) -> None:
        """Add the widgets beside the panel again, for other charts."""

    def _add_knobs(self) -> None:
        """Add the panel of knobs, with its laboratory."""
        self.laboratory = Laboratory(self.lander_run, self._experiment, self._leave_split)
        self.split_view = SplitView(self.laboratory)
        self.knobs = LabKnobsPanel(
            self.form, _KNOBS, PRESETS["modern"], 0, self.lander_run.change, self._begin,
            laboratory=self.laboratory, show_all=self._settings.all_knobs, on_show=self._remember_knobs,
        )  # fmt: skip

    # The run

    @property
    def _learnt(self) -> bool:
        return len(self.lander_run.history) > 0

    def _begin(self, config: Config, seed: int) -> None:
        self._keep_left()
        self._start(config, seed)

    def _keep_left(self) -> None:
        """Put what the last visit left without a name among the others, before the first run takes its place."""
        runs = self.lander_run.collection
        left = runs.rescued() if self.lander_run.runs == 0 else None
        if left is None or not left.success:  # it has landed nothing yet
            return
        try:
            runs.keep_rescued(left.name)
        except LibraryError as error:
            self.context.note(str(error))
        else:
            self.context.note(texts.TRAIN_LEFT_KEPT.format(name=left.name))

    def _go_on(self, folder: Path) -> None:
        """Resume a saved run, with its own settings."""
        self._start(Config(), 0, folder)

    def _teach(self) -> None:
        """Add the player's landings to the run's training as demonstrations, or start a run with them."""
        folder = self.context.user_dir
        if not count_demonstrations(folder):
            self.context.note(texts.TRAIN_NO_LESSONS)
            return
        if not self.lander_run.alive:
            self._begin(self.knobs.config, self.knobs.seed)
        self.lander_run.teach(folder / FILE_NAME)

    def _save(self) -> Transition | None:
        if not (self.lander_run.alive or self.lander_run.kept):
            self.context.note(texts.TRAIN_NOTHING)
            return None
        name = texts.TRAIN_TAUGHT_NAME if self.lander_run.demonstrations else texts.TRAIN_NAME
        return self._ask_name(name.format(preset=self.knobs.name))

    # An experiment

    def _experiment(self, experiment: Experiment) -> Transition | None:
        """Fly an experiment beside a healthy twin; ask first if the player's run would end for it."""
        split = partial(self._split, experiment)
        if not (self.lander_run.alive and self._learnt) or self.split_view.shown:
            split()
            return None
        answers: list[tuple[str, Callable[[], None]]] = [
            (texts.SPLIT_START, split),
            (texts.SPLIT_SAVE, self._ask_to_save),
        ]
        return Push(QuestionDialog(self, texts.SPLIT_ASK, texts.SPLIT_ASK_MORE, answers))

    def _split(self, experiment: Experiment) -> None:
        config, seed = self.knobs.config, self.knobs.seed
        changed = experiment.applied(config)
        self._was_running = False
        self._keep_left()
        if note := self.lander_run.split(config, seed, changed, tuple(differences(config, changed)), self.knobs.name):
            self.context.note(note)
        self._clear()
        self.knobs.set_config(config, seed)
        self.laboratory.follow()
        self.training_charts.measure_by(BY_DECISIONS)
        self._lay_again()
        self.knobs.show_experiment()

    def _ask_to_save(self) -> None:
        self._question = self._save()

    def _leave_split(self, experiment: bool) -> None:
        """End the split view; go on with the healthy run, or with the experiment."""
        if experiment:
            if note := self.lander_run.keep_twin():
                self.context.note(note)
        else:
            self.lander_run.leave()
        self._clear()
        self.knobs.show_experiment()

    def _remember_knobs(self, show_all: bool) -> None:
        self._settings.all_knobs = show_all
        self.context.apply_settings()
