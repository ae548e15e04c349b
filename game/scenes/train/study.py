"""Study scene: the trials of a study by their results, the chosen one's learning curves, and knobs against result."""

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
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import LABEL, LINE, MUTE, NET, SMALL, TITLE
from game.flight import networks
from game.flight.study_runs import studies
from game.scenes.train.networks import write_headings
from game.training.run_settings import figure, label
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
_CHART, _DOTS = 128.0, 132.0  # points of height


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
        self._dots = PaintCache()
        self._read()
        self.build()

    def _read(self) -> None:
        """Read the chosen study from disk."""
        self._study: Study | None = None
        self.items: list[FinishedTrial] = []
        self.chosen: FinishedTrial | None = None
        self._knobs, self._knob = list[str](), 0
        self._line = texts.STUDY_UNREADABLE if self._folders else texts.STUDY_NONE
        try:
            study = Study.load(self._folders[self._index]) if self._folders else None
        except StudyError:
            return
        if study is None:
            return
        self._study, self.items = study, study.ranked()
        self._knobs = sorted(study.plan.space, key=lambda name: -study.importance.get(name, 0.0))
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
        if self._knobs:
            column.choice(texts.STUDY_KNOB, [*map(label, self._knobs)], self._knob, self._choose_knob, SMALL)
            column.aside(self._said_of_knob)
            column.picture(_DOTS, self._draw_dots)
        if self._run and self._flies:
            column.words([(texts.STUDY_WATCH, self._watch), (texts.STUDY_RACE, self._race)])
        else:
            why = texts.STUDY_UNKEPT if self._flies else texts.STUDY_ELSEWHERE
            column.aside(texts.STUDY_STOPPED if trial.stopped else why)

    def _said_of_knob(self) -> str:
        assert self._study is not None
        share = self._study.importance.get(self._knobs[self._knob])
        return texts.STUDY_DOTS if share is None else texts.STUDY_SHARE.format(share=round(100 * share))

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

    def _choose_knob(self, index: int) -> None:
        self._knob = index

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

    def _draw_dots(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the trials by their values of a knob, and a ring around the chosen one; kept until one is another."""
        study, trial, knob = self._study, self.chosen, self._knobs[self._knob]
        assert study is not None
        assert trial is not None
        shows = (study.folder, knob, trial.number, box.size)
        self._dots.draw(canvas, box, shows, lambda sheet: _paint_dots(sheet, box.size, study, knob, trial))


def _paint_dots(canvas: Canvas, size: tuple[float, float], study: Study, knob: str, chosen: FinishedTrial) -> None:
    """Paint a dot for each trial, across by one knob and up by the result."""
    dimension, trials = study.plan.space[knob], study.ranked()
    plot = pygame.FRect(0, 8, size[0], size[1] - 30)
    canvas.line(plot.bottomleft, plot.bottomright, LINE)
    values = [trial.value or 0.0 for trial in trials]
    low, high = min(values), max(values)
    inner = plot.inflate(-16, -16)
    for trial, value in zip(trials, values, strict=True):
        share = (value - low) / (high - low) if high > low else 0.5
        up = share if study.metric.sign == -1 else 1 - share
        spot = (inner.left + dimension.place(trial.params[knob]) * inner.width, inner.bottom - up * inner.height)
        canvas.dot(spot, 2.5, MUTE)
        if trial.number == chosen.number:
            canvas.dot(spot, 3.5, NET)
            canvas.outline((spot[0] - 8, spot[1] - 8, 16, 16), 8, NET)
    left, right = map(knob_value, dimension.ends)
    canvas.text(left, (0, size[1] - 6), size=LABEL, colour=MUTE)
    canvas.text(right, (plot.right, size[1] - 6), size=LABEL, colour=MUTE, align="right")


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
