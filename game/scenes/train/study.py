"""Study scene: the trials of a study by their results, and the chosen one's learning curves."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

import pygame

from ai.files import brief
from ai.sweep.plan import DIGITS
from ai.sweep.study import FinishedTrial, Study, StudyError
from ai.training.config import LANDER
from game.core import texts
from game.core.scene import Transition, push
from game.drawing.tokens import NET, SMALL, TITLE
from game.flight import networks
from game.flight.study_runs import studies
from game.scenes.train.networks import write_headings
from game.training.knob_descriptions import figure, label
from game.ui.chart import Chart, Series
from game.ui.listing import Row
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.ui.context import Context
    from game.ui.panel import Column, Panel

_LEAST: Final = 300.0  # points of a column
_CELLS: Final = (152.0, 0.0)  # from the right end of the list: where result and worst seed end
_PITCH, _AROUND = 30.0, 190.0  # points of a row of the list, and of all around the list
_CHART: Final = 200.0  # points of height
_NAMED: Final = 4  # knobs whose share of the difference is said


class StudyScene(PanelScene):
    """Trials in a list, the best first; beside it, or below, what became of the chosen one.

    It reads plain files, and needs neither Ray nor Optuna. `folder` is the study to begin with, by default the newest.

    Attributes:
        items: the trials.
        chosen: the chosen trial; None if there is none.

    """

    def __init__(self, context: Context, folder: Path | None = None) -> None:
        super().__init__(context)
        self._folders = studies(context.user_dir)
        if folder is not None and folder not in self._folders:
            self._folders.insert(0, folder)
        self._index = self._folders.index(folder) if folder is not None else 0
        self._chart = Chart((0, 0, 300, _CHART), texts.STUDY_CURVE, read_x="{:,.0f}".format)
        self._read()
        self.build()

    def _read(self) -> None:
        """Read the chosen study from disk."""
        self._study: Study | None = None
        self.items: list[FinishedTrial] = []
        self.chosen: FinishedTrial | None = None
        self._line = texts.STUDY_UNREADABLE if self._folders else texts.STUDY_NONE
        try:
            study = Study.load(self._folders[self._index]) if self._folders else None
        except StudyError:
            return
        if study is None:
            return
        self._study, self.items = study, study.ranked()
        better = texts.STUDY_LESS if study.metric.sign == 1 else texts.STUDY_MORE
        self._line = texts.STUDY_LINE.format(
            finished=len(study.trials), trials=study.plan.trials, metric=_metric(study), better=better
        )
        self._choose(0)

    # Rows

    def describe(self, panel: Panel) -> None:
        """Add the trials, and the chosen one."""
        panel.title(texts.STUDY_TITLE)
        panel.aside(self._line)
        if len(self._folders) > 1:
            names = [brief(folder.name, 40) for folder in self._folders]
            panel.choice(texts.STUDY_WHICH, names, self._index, self._choose_study, SMALL)
        panel.gap(4)
        left, self._beside = panel.beside((2, 3), _LEAST, 48.0)
        left.add(partial(write_headings, texts.STUDY_COLUMNS, _CELLS))
        trials = left.listing(
            [self._row(item) for item in self.items], lambda _: self._watch(), texts.STUDY_EMPTY, around=_AROUND,
            columns=_CELLS, pitch=_PITCH, on_choose=self._choose,
            index=self.items.index(self.chosen) if self.chosen else 0,
        )  # fmt: skip
        self.form.focus(trials)
        self._describe_chosen(self._beside)

    def _row(self, item: FinishedTrial) -> Row:
        study = self._study
        assert study is not None
        worst = max(item.values, key=lambda value: value * study.metric.sign, default=None)
        return texts.STUDY_TRIAL.format(number=item.number), _shown(study, item.value), _shown(study, worst)

    def _describe_chosen(self, column: Column) -> None:
        """Add the chosen trial: its settings, its curves and where its knobs lie, and what can be done with it."""
        study, trial = self._study, self.chosen
        if study is None or trial is None:
            return
        name = texts.STUDY_TRIAL.format(number=trial.number)
        column.text(f"{name} · {_shown(study, trial.value)}", size=TITLE + 6, weight="light")
        column.aside(_metric(study))
        settings = " · ".join(f"{label(name)} {knob_value(value)}" for name, value in trial.params.items())
        column.aside(brief(settings, 190))
        column.picture(_CHART, self._draw_chart)
        if study.importance:
            most = sorted(study.importance.items(), key=lambda item: -item[1])[:_NAMED]
            shares = ", ".join(f"{label(name)} {round(100 * share)} %" for name, share in most)
            column.aside(texts.STUDY_SHARES.format(shares=shares))
        if self._run and self._flies:
            column.words([(texts.STUDY_WATCH, self._watch), (texts.STUDY_RACE, self._race)])
        else:
            why = texts.STUDY_UNKEPT if self._flies else texts.STUDY_ELSEWHERE
            column.aside(texts.STUDY_STOPPED if trial.stopped else why)

    # What can be done

    def _choose_study(self, index: int) -> None:
        self._index = index
        self._read()
        self.build()

    def _choose(self, number: int) -> None:
        self.chosen = self.items[number] if self.items else None
        self._show_curves()
        if hasattr(self, "_beside"):
            self._beside.clear()
            self._describe_chosen(self._beside)

    @property
    def _flies(self) -> bool:
        return self._study is not None and self._study.plan.settings.get("env") == LANDER

    @property
    def _run(self) -> Path | None:
        """Folder of the chosen trial's best run; None if none was kept."""
        return self._study.best_run(self.chosen) if self._study and self.chosen else None

    def _named(self) -> str:
        assert self._study is not None
        assert self.chosen is not None
        return f"{brief(self._study.folder.name, 20)} {self.chosen.number}"

    def _watch(self) -> Transition | None:
        return push("watch", guest=(self._named(), self._run)) if self._run and self._flies else None

    def _race(self) -> Transition | None:
        """Fly against the chosen trial's network; say so if it cannot be read."""
        if self._run is None:
            return None
        network = networks.load(self._named(), self._run)
        if network.policy is None:
            self.context.note(network.problem)
            return None
        return push("play", rival=network.policy, rival_name=network.name)

    # Time and picture

    def update(self) -> Transition | None:
        """Let the chart follow."""
        self._chart.update()
        return super().update()

    def _show_curves(self) -> None:
        """Show the learning curves of the chosen trial's seeds."""
        seeds = self.chosen.seeds if self.chosen else ()
        shares = all(point.success is not None for seed in seeds for point in seed.curve)
        self._chart.label = texts.STUDY_CURVE if shares else texts.STUDY_RETURN
        self._chart.fixed = (0.0, 1.0) if shares else None
        series = [
            Series(
                [point.at for point in seed.curve],
                [(point.success or 0.0) if shares else point.mean_return for point in seed.curve],
                texts.STUDY_SEED.format(seed=seed.seed),
                NET,
                smooth=False,
            )
            for seed in seeds
        ]
        self._chart.set(series, (0.0, max((point.at for seed in seeds for point in seed.curve), default=1.0)))

    def _draw_chart(self, canvas: Canvas, box: pygame.FRect) -> None:
        self._chart.move(box)
        self._chart.draw(canvas)


def knob_value(value: object) -> str:
    """Return a knob's value, as a study holds it, for the player."""
    if isinstance(value, list):
        return figure(tuple(value))
    return figure(float(f"{value:.3g}") if isinstance(value, float) else value)


def _metric(study: Study) -> str:
    """Return in words what trials are compared by."""
    kind = study.metric.kind
    if study.plan.kind == DIGITS:
        kind = {"time": "epochs", "success": "accuracy"}.get(kind, kind)
    return texts.STUDY_METRICS[kind].format(percent=round(100 * study.metric.share))


def _shown(study: Study, value: float | None) -> str:
    """Return a result as the player reads it."""
    if value is not None and study.metric.kind == "time" and value > study.plan.budget:
        return texts.STUDY_NOT_REACHED
    return study.shown(value)
