"""Study scene: the trials of a study by their results, the chosen one's learning curves, and knobs against result."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import pygame

from ai.files import brief
from ai.sweep.plan import DIGITS
from ai.sweep.study import FinishedTrial, Study, StudyError
from ai.training.config import LANDER
from game.core import texts
from game.core.scene import Transition, push
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import MARGIN, MUTE, NET, SMALL, TITLE, VIEW_SIZE
from game.flight import networks
from game.flight.study_runs import studies
from game.scenes.train.study_dots import StudyDots, knob_value
from game.training.knob_descriptions import label
from game.ui.chart import Chart, Series
from game.ui.context import Context
from game.ui.list_scene import ListLayout, ListScene
from game.ui.listing import Row
from game.ui.widget import OnPress, Widget
from game.ui.widgets import Choice

_LEFT: Final = 688
_WIDTH: Final = VIEW_SIZE[0] - MARGIN - _LEFT
_LAYOUT: Final = ListLayout(
    box=pygame.Rect(MARGIN, 188, 544, 396),
    columns=(152.0, 0.0),
    headings=lambda: texts.STUDY_COLUMNS,
    pitch=30,
    verbs=(_LEFT, 578),
    foot=608,
)
_STUDY: Final = (MARGIN, 124, 544, 24)
_CHART: Final = (_LEFT, 226, _WIDTH, 128)
_KNOB: Final = (_LEFT, 372, _WIDTH, 24)
_DOTS: Final = (_LEFT, 424, _WIDTH, 132)


class StudyScene(ListScene[FinishedTrial]):
    """Trials on the left, the best first; on the right what became of the chosen one.

    It reads plain files, and needs neither Ray nor Optuna. `folder` is the study to begin with, by default the newest.
    """

    def __init__(self, context: Context, folder: Path | None = None) -> None:
        super().__init__(context, texts.STUDY_TITLE, _LAYOUT, empty=texts.STUDY_EMPTY)
        self._folders = studies(context.user_dir)
        if folder is not None and folder not in self._folders:
            self._folders.insert(0, folder)
        self._index = self._folders.index(folder) if folder is not None else 0
        self._study: Study | None = None
        self._problem = ""
        self._knobs: list[str] = []
        self._knob = 0
        self._chart = Chart(_CHART, texts.STUDY_CURVE, read_x="{:,.0f}".format)
        self._dots = StudyDots(_DOTS)
        self._read()
        self._reload()

    def enter(self) -> None:
        """Show again what has been read: a study is read when it is chosen."""
        self._reload()

    def _read(self) -> None:
        """Read the chosen study from disk."""
        self._study, self._problem, self._knobs, self._knob = None, "", [], 0
        if not self._folders:
            self._line = texts.STUDY_NONE
            return
        folder = self._folders[self._index]
        try:
            study = Study.load(folder)
        except StudyError:
            self._line = texts.STUDY_UNREADABLE
            return
        self._shares = study.importance
        self._knobs = sorted(study.plan.space, key=lambda name: -self._shares.get(name, 0.0))
        self._study = study
        better = texts.STUDY_LESS if study.metric.sign == 1 else texts.STUDY_MORE
        self._line = texts.STUDY_LINE.format(
            finished=len(study.trials), trials=study.plan.trials, metric=_metric(study), better=better
        )

    def _reload(self) -> None:
        trials = self._study.ranked() if self._study else []
        self._show(trials, self.chosen.number if self.chosen else None)

    def _identity(self, item: FinishedTrial) -> object:
        return item.number

    def _row(self, item: FinishedTrial) -> Row:
        assert self._study is not None
        metric = self._study.metric
        worst = max(item.values, key=lambda value: value * metric.sign, default=None)
        name = texts.STUDY_TRIAL.format(number=item.number)
        return name, _shown(self._study, item.value), _shown(self._study, worst)

    def _make_verbs(self) -> list[Widget]:
        """Return the knob whose dots are shown, and what can be done with the chosen trial."""
        self._show_curves()
        widgets: list[Widget] = []
        if self.chosen and self._knobs:
            widgets.append(Choice(self.form.manager, _KNOB, texts.STUDY_KNOB, [*map(label, self._knobs)], self._knob,
                                        self._choose_knob, label_width=96, size=SMALL))  # fmt: skip
        rows: list[tuple[str, OnPress]] = []
        if self._run and self._flies:
            rows = [(texts.STUDY_WATCH, self._watch), (texts.STUDY_RACE, self._race)]
        return [*widgets, *self._buttons(rows)]

    def _below_list(self) -> list[Widget]:
        foot = super()._below_list()
        if len(self._folders) > 1:
            names = [brief(folder.name, 40) for folder in self._folders]
            foot.append(Choice(self.form.manager, _STUDY, texts.STUDY_WHICH, names, self._index,
                                     self._choose_study, label_width=96, size=SMALL))  # fmt: skip
        return foot

    @property
    def _flies(self) -> bool:
        return self._study is not None and self._study.plan.settings.get("env") == LANDER

    @property
    def _run(self) -> Path | None:
        """Folder of the chosen trial's best run; None if none was kept."""
        return self._study.best_run(self.chosen) if self._study and self.chosen else None

    def _show_curves(self) -> None:
        """Show the learning curves of the chosen trial's seeds."""
        trial = self.chosen
        if trial is None:
            self._chart.set([], (0.0, 1.0))
            return
        shares = all(point.success is not None for seed in trial.seeds for point in seed.curve)
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
            for seed in trial.seeds
        ]
        self._chart.set(series, (0.0, max((point.at for seed in trial.seeds for point in seed.curve), default=1.0)))

    # What can be done

    def _choose_study(self, index: int) -> None:
        self._index = index
        self._read()
        self._reload()

    def _choose_knob(self, index: int) -> None:
        self._knob = index

    def _press_row(self) -> Transition | None:
        return self._watch() if self._run and self._flies else None

    def _named(self) -> str:
        assert self._study is not None
        assert self.chosen is not None
        return f"{brief(self._study.folder.name, 20)} {self.chosen.number}"

    def _watch(self) -> Transition | None:
        return push("watch", guest=(self._named(), self._run)) if self._run else None

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

    def _draw_chosen(self, canvas: Canvas) -> None:
        """Draw the chosen trial: its settings, its curves and where its knobs lie."""
        study, trial = self._study, self.chosen
        if study is None or trial is None:
            return
        title = f"{texts.STUDY_TRIAL.format(number=trial.number)}   {_shown(study, trial.value)}"
        end = canvas.text(title, (_LEFT, 146), size=TITLE + 6, weight="light", room=_WIDTH).right + 14
        canvas.text(_metric(study), (end, 146), size=SMALL, colour=MUTE, room=_LEFT + _WIDTH - end)
        settings = " · ".join(f"{label(name)} {knob_value(value)}" for name, value in trial.params.items())
        draw_wrapped(canvas, brief(settings, 190), (_LEFT, 174), _WIDTH, size=SMALL, colour=MUTE, leading=19)
        self._chart.draw(canvas)
        if self._knobs:
            knob = self._knobs[self._knob]
            share = self._shares.get(knob)
            told = texts.STUDY_SHARE.format(share=round(100 * share)) if share is not None else texts.STUDY_DOTS
            canvas.text(told, (_LEFT, 414), size=SMALL, colour=MUTE, room=_WIDTH)
            self._dots.draw(canvas, study, self.items, knob, trial)
        if trial.stopped or self._run is None or not self._flies:
            why = texts.STUDY_ELSEWHERE if not self._flies else texts.STUDY_UNKEPT
            canvas.text(
                texts.STUDY_STOPPED if trial.stopped else why, (_LEFT, 596), size=SMALL, colour=MUTE, room=_WIDTH
            )


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
