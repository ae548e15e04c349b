"""Train scene: a swarm learns to land in a process of its own; its charts are live, and so are the knobs."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable
from functools import partial
from pathlib import Path
from typing import Final

import pygame

from ai.training.config import PRESETS, Config
from ai.training.experiments import Experiment, differences
from game.core import texts
from game.core.names import LibraryError
from game.core.scene import Pop, Push, Transition, push
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas
from game.drawing.tokens import LINE, NIGHT0, SMALL
from game.flight.demonstrations import FILE_NAME, count_demonstrations
from game.input.controls import Command
from game.panels.explained import Explained
from game.panels.lesson_door import LessonDoor
from game.scenes.menus.dialogs import QuestionDialog
from game.scenes.train.advice import Advice
from game.scenes.train.base import CHARTS, INSIDE, KNOBS, MORE, TrainingScene
from game.scenes.train.charts import BY_DECISIONS, FEW_CHARTS, SCORE, ChartCaptions, TrainingCharts
from game.scenes.train.dialogs import TrainDialogs
from game.scenes.train.inside import Inside
from game.scenes.train.knobs import KnobsPanel
from game.scenes.train.laboratory import ExperimentPages, Laboratory
from game.scenes.train.layout import Layout
from game.scenes.train.rewind import Rewind
from game.scenes.train.split_view import SplitView
from game.scenes.train.status import lander_status
from game.training.library import Library
from game.training.run import TrainingRun
from game.training.workers import LANDERS, PACES
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.panel import Column
from game.ui.rows import RunRow
from game.ui.scrubber import Scrubber
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widget import Widget
from game.world.swarm import LearningSwarm

_ALL_CHARTS: Final = 4
_HEAD: Final = 130.0  # of the display, for the title above two swarms
_BEHIND: Final = 0.72  # cover of the swarm behind an edited network


class TrainScene(TrainingScene):
    """Train scene: swarm, charts and knobs. With `resume`, a saved run continues at once.

    Attributes:
        lander_run: the run, with the experiment beside it.
        training_charts: the charts of both.
        laboratory: the experiment that was chosen, and what came of it.
        split_view: the two swarms.

    """

    def __init__(self, context: Context, resume: Path | None = None) -> None:
        self._resume = resume
        self.library = Library(context.user_dir)
        self.lander_run = TrainingRun(LANDERS, self.library)
        super().__init__(context, self.lander_run)

    def _build(self) -> None:
        left = self.library.claim()  # the run left unnamed by the last visit
        run = self.lander_run
        self.swarm = LearningSwarm()
        self.training_charts = TrainingCharts(more=self.opened(CHARTS))
        self.captions = ChartCaptions()
        self.explained = Explained()
        self.knobs = KnobsPanel(self.form, PRESETS["modern"], 0, run.change, self._begin)
        self.laboratory = Laboratory(run, self._experiment, self._leave_split)
        self.pages = ExperimentPages(self.laboratory, self.knobs)
        self.split_view = SplitView(self.laboratory)
        self.inside = Inside(run)
        self.inside.opened = self.opened(INSIDE)
        self._dialogs = TrainDialogs(self, run, self.library, self._ask, self._go_on)
        self.rewind = Rewind(run)
        self.lessons = LessonDoor(run, lambda: self.shown_swarm, lambda: self.moment, self.context.note)
        self._advice = Advice(self.knobs.turn, self._go_back)
        self._pace = len(PACES) - 1
        if self._resume:
            self._go_on(self._resume)
        elif left:
            self._question = self._dialogs.ask_what_becomes_of(left)

    # Rows

    @property
    def charts_shown(self) -> int:
        """Number of charts."""
        return _ALL_CHARTS if self.opened(CHARTS) else FEW_CHARTS

    @property
    def _key(self) -> Hashable:
        beside = tuple((each.name, each.style) for each in self.split_view.beside)
        return (
            self.pages.page, self.laboratory.flies, self.moment is None, self._advice.key, beside,
            self.inside.editing.key,
            self.inside.opened and bool(len(self.lander_run.history)),
        )  # fmt: skip

    def _place(self, place: Layout) -> None:
        head = min(_HEAD, 0.4 * place.swarm.height)
        for swarm in (self.swarm, self.rewind.swarm):
            swarm.place(place.swarm)
            swarm.head = head
        halves = pygame.FRect(place.swarm.left, place.swarm.top + head, place.swarm.width, place.swarm.height - head)
        self.split_view.place(halves)
        self.training_charts.place(place.charts)
        self.inside.place(place.display)
        inside, charts = pygame.Rect(self.inside.view.box), self.training_charts.charts.box
        boxes = [inside] if self.inside.opened else [pygame.Rect(place.swarm), charts]
        for widget, box in zip(self._pointers_laid, boxes, strict=True):
            widget.relative_rect = widget.rect = box
        if not self.inside.opened:
            self._scrubber.relative_rect = self._scrubber.rect = pygame.Rect(place.charts[0]).union(place.charts[1])

    def _pointers(self) -> list[Widget]:
        """Return new widgets for the swarm and the charts, or the network."""
        manager, nowhere = self.form.manager, (0, 0, 1, 1)
        if self.inside.opened:
            self._pointers_laid = [VirtualPointer(manager, nowhere, self.inside.follow, hold=texts.EDIT_PICK)]
            return [*self._pointers_laid]
        charts = self.training_charts.charts
        self._pointers_laid = [
            VirtualPointer(manager, nowhere, self.lessons.follow, hold=texts.LESSON_MARK),
            VirtualPointer(manager, nowhere, charts.follow),
        ]
        self._scrubber = Scrubber(manager, charts, self._scrub, self._duel, charts.zoom_by)
        return [*self._pointers_laid, self._scrubber]

    def _scrub(self, place: float | int) -> None:
        if isinstance(place, int):
            self.rewind.shift(place)
        else:
            self.rewind.seek(self.training_charts.decisions_at(place))

    def _describe(self, column: Column) -> None:
        self.rewind.describe(column, self.form.manager, timeline=self.inside.opened)
        if self.inside.opened:
            self.inside.describe(column)
            column.gap()
            column.button(texts.LESSON_WHY, self.lessons.open)
            self.switch(column, INSIDE, texts.TRAIN_LOOK)
            return
        self.inside.editing.describe(column, opened=False)
        if self.pages.page:
            self.pages.describe(column)
            return
        super()._describe(column)
        self._describe_beside(column)

    def _describe_more(self, column: Column) -> None:
        column.gap()
        self.switch(column, MORE, texts.TRAIN_MORE)
        if not self.opened(MORE):
            return
        self.switch(column, INSIDE, texts.TRAIN_LOOK)
        self.switch(column, CHARTS, texts.TRAIN_MORE_CHARTS)
        self.switch(column, KNOBS, texts.TRAIN_MORE_KNOBS)
        column.button(texts.TRAIN_EXPERIMENTS, self.pages.open).pad = 3.0
        column.button(texts.TRAIN_RUNS, self._open_runs).pad = 3.0
        column.gap(8)
        column.line()
        column.words([
            (texts.LESSON_WHY, self.lessons.open),
            (texts.TRAIN_DUEL, self._duel),
            (texts.TRAIN_COMPARE, self._dialogs.add),
            (texts.TRAIN_TEACH, self._teach),
            (texts.TRAIN_STEP, self.lander_run.step),
            (texts.TRAIN_SAVE, self._save),
        ])  # fmt: skip
        column.choice("", texts.TRAIN_PACES, self._pace, self._set_pace)

    def _describe_beside(self, column: Column) -> None:
        """Add the names of the runs that are shown beside this one, and by what they are measured."""
        self._legend: list[RunRow] = []
        beside = self.split_view.beside
        if not beside:
            return
        column.line()
        for name, style in ((self.split_view.name, 0), *((each.name, each.style) for each in beside)):
            press = partial(self._dialogs.choose, style)
            self._legend.append(column.widget(RunRow(self.form.manager, name, style, press)))
        charts = self.training_charts
        column.choice("", texts.TRAIN_AXES, charts.axis, charts.measure_by, SMALL)

    def _describe_hint(self, column: Column) -> bool:
        if self._advice.shown:
            self._advice.describe(column)
        return self._advice.shown

    def open(self, name: str) -> None:
        """Open a part, or close it; it stays so for this player."""
        super().open(name)
        self.inside.opened = self.opened(INSIDE)
        self.training_charts.show(more=self.opened(CHARTS))

    def _set_pace(self, pace: int) -> None:
        self._pace = pace
        self.lander_run.set_pace(pace)

    def _turn_pace(self, direction: int) -> None:
        pace = min(max(self._pace + direction, 0), len(PACES) - 1)
        self._set_pace(pace)
        self._laid = None  # the choice shows it

    # Events

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Handle explanations, start, pause, step, knobs and the network."""
        if self.explained.handle_event(event):
            return None
        if not self.inside.opened:
            self.training_charts.charts.follow(event)
        self.inside.follow(event)
        outcome = super().handle_event(event)
        if not self.inside.opened and not self.form.used:
            self.lessons.follow(event)
        return outcome

    def actions(self) -> Table:
        """Go back; step, start or pause, and change the pace, as the buttons say."""
        return [
            *super().actions(),
            Action(Command.SLOWER, lambda: self._turn_pace(-1)),
            Action(Command.FASTER, lambda: self._turn_pace(1)),
            self.explained.action(),
        ]

    def update(self) -> Transition | None:
        """Receive the worker's messages, and animate the screen."""
        run, split = self.lander_run, self.split_view
        looked = self._listen()
        self._follow_run()
        self._advice.hush(bool(self.knobs.waiting) or split.shown)
        if run.alive:
            self.knobs.show_in_force(run.in_force)
        still = self._settings.reduced_motion
        self.rewind.show_in(self.inside, self.training_charts)
        emphasised = next((each.style for each in getattr(self, "_legend", ()) if each.focused), None)
        self.training_charts.look(
            run.history, split.beside, split.name, self._caption,
            paid_otherwise=split.paid_otherwise, emphasised=emphasised,
        )  # fmt: skip
        self.swarm.update(still)
        self.explained.update()
        split.update(still, self.moment)
        self.inside.update(still)
        # Tasks that take a millisecond or two take turns, one per frame.
        self.training_charts.charts.update(at_once=still, turn=not (looked or self.inside.busy))
        return self._finish_update() or self.lessons.update()

    def _listen(self) -> bool:
        """Receive the worker's messages; return whether one was about the network."""
        run = self.lander_run
        swarm_state, network_state, points = run.swarm_state, run.network_state, len(run.history)
        for note in run.poll():
            self.context.note(note)
        if run.swarm_state is not None and run.swarm_state is not swarm_state:
            self.swarm.take(run.swarm_state)
        if len(run.history) != points and self.moment is None:
            self.inside.pay(run.history)
        if run.network_state is None or run.network_state is network_state:
            return False
        if self.moment is None:
            self.inside.take(run.network_state, run.config)
        if run.alive and len(run.history):
            health = self.inside.health
            self._advice.follow(run.history, run.config, health.dead_share, health.clipped_share)
        return True

    def _caption(self, chart: str) -> str:
        run = self.lander_run
        if chart == SCORE and self.split_view.paid_otherwise:
            return texts.LAB_PAID_OTHERWISE
        return self.captions.read(chart, run.history, run.config, self._advice.hint) if run.alive else ""

    @property
    def moment(self) -> int | None:
        """Moment of the run that is shown, in decisions; None for now."""
        return self.rewind.moment

    @property
    def shown_swarm(self) -> LearningSwarm:
        """The landers of the moment that is shown."""
        return self.swarm if self.moment is None else self.rewind.swarm

    # The run

    @property
    def _learnt(self) -> bool:
        return len(self.lander_run.history) > 0

    def _clear(self) -> None:
        for part in (self.split_view, self.swarm, self.rewind, self._advice, self.training_charts, self.captions,
                     self.inside):  # fmt: skip
            part.clear()

    def _clear_advice(self) -> None:
        self._advice.clear()

    def _begin(self, config: Config, seed: int) -> None:
        """Start a run; one that has learnt and has no name is put among the player's networks."""
        self._keep()
        self._start(config, seed)

    def _keep(self) -> None:
        """Put what has no name yet among the player's networks: the run that goes on, or what the last visit left."""
        run, runs = self.lander_run, self.lander_run.collection
        try:
            if run.alive and self._learnt:
                run.save(runs.free_name(self._suggestion))  # the note comes once it is saved
            elif run.runs == 0 and (left := runs.rescued()) is not None and left.success:  # it has landed
                runs.keep_rescued(left.name)
                self.context.note(texts.TRAIN_LEFT_KEPT.format(name=left.name))
        except LibraryError as error:
            self.context.note(str(error))

    @property
    def _suggestion(self) -> str:
        """Name for the run, after its settings."""
        name = texts.TRAIN_TAUGHT_NAME if self.lander_run.demonstrations else texts.TRAIN_NAME
        return name.format(preset=self.knobs.name)

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
        return self._ask_name(self._suggestion)

    def _open_runs(self) -> Transition:
        def go_on(folder: Path) -> Transition:
            self._go_on(folder)
            return Pop()

        return push("runs", train=go_on)

    def _ask(self, question: Transition) -> None:
        self._question = question

    def _go_back(self, decisions: int) -> None:
        """Return the run to an earlier checkpoint."""
        checkpoint = self.lander_run.history.checkpoint_at(decisions)
        if checkpoint is not None:
            self.lander_run.revert(checkpoint)

    def _duel(self) -> Transition | None:
        """Fly against the checkpoint of the moment that is shown."""
        checkpoint = self.lander_run.history.checkpoint_at(math.inf if self.moment is None else self.moment)
        if checkpoint is None:
            self.context.note(texts.TRAIN_NO_CHECKPOINT)
            return None
        try:
            rival = checkpoint.agent(self.lander_run.config)
        except ValueError as error:
            self.context.note(str(error))
            return None
        name = texts.TRAIN_CHECKPOINT.format(seconds=checkpoint.seconds)
        return push("play", rival=rival, rival_name=name)

    # An experiment

    def _experiment(self, experiment: Experiment) -> Transition | None:
        """Fly an experiment beside a healthy twin; ask first if the player's run would end for it."""
        split = partial(self._split, experiment)
        if not (self.lander_run.alive and self._learnt) or self.split_view.shown:
            split()
            return None
        answers: list[tuple[str, Callable[[], None]]] = [
            (texts.SPLIT_START, split),
            (texts.SPLIT_SAVE, lambda: setattr(self, "_question", self._save())),
        ]
        return Push(QuestionDialog(self, texts.SPLIT_ASK, texts.SPLIT_ASK_MORE, answers))

    def _split(self, experiment: Experiment) -> None:
        config, seed = self.knobs.config, self.knobs.seed
        changed = experiment.applied(config)
        self._was_running = False
        if not self.lander_run.alive:
            self._keep()
        if note := self.lander_run.split(config, seed, changed, tuple(differences(config, changed)), self.knobs.name):
            self.context.note(note)
        self._clear()
        self.knobs.set_config(config, seed)
        self.laboratory.follow()
        self.training_charts.measure_by(BY_DECISIONS)
        self.pages.open()

    def _leave_split(self, experiment: bool) -> None:
        """End the split view; go on with the healthy run, or with the experiment."""
        if experiment:
            if note := self.lander_run.keep_twin():
                self.context.note(note)
        else:
            self.lander_run.leave()
        self._clear()
        self.pages.page = "result" if self.laboratory.flies else ""

    # The picture

    @property
    def _back_hint(self) -> str:
        return texts.HINT_BACK if self.moment is None else texts.REWIND_BACK

    def _back(self) -> Transition | None:
        if self.pages.page:
            self.pages.close()
        elif self.inside.opened:
            self.open(INSIDE)
        elif self.moment is not None:
            self.rewind.clear()
        else:
            return super()._back()
        return None

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the display, the panel beside it and, over both, an explanation."""
        super().draw(canvas, alpha)
        self.explained.draw(canvas)

    def _draw_display(self, canvas: Canvas, alpha: float) -> None:
        """Draw the swarm and the charts, or the network."""
        assert self._layout is not None
        display, swarm = self._layout.display, self._layout.swarm
        paused = self.lander_run.state is WorkerState.PAUSED
        if self.inside.opened:
            edited = self.lander_run.edits.holds and self.moment is None  # then the swarm is seen behind the network
            if edited:
                self.swarm.draw(canvas, alpha, paused=paused)
            canvas.fill(canvas.rect(*display), NIGHT0, _BEHIND if edited else 1.0)
            self.inside.draw(canvas)
            return
        top = display.top if self.split_view.shown else swarm.bottom  # one swarm fills its box
        canvas.fill(canvas.rect(display.left, top, display.width, display.bottom - top), NIGHT0)
        if self.split_view.shown:
            self.split_view.draw(canvas, alpha)
        elif self.moment is not None:
            self.rewind.draw_swarm(canvas, alpha)
        else:
            self.swarm.draw(canvas, alpha, paused=paused)
        canvas.line((swarm.left, swarm.bottom), (swarm.right, swarm.bottom), LINE)
        self.training_charts.draw(canvas)
        status = lander_status(self.lander_run, self.moment, self.rewind.row)
        painted = self.training_charts.landed
        if self.moment is None and status.figure and painted.isdigit():  # one number for both
            status = status._replace(figure=painted)
        self.draw_title(canvas, texts.TRAIN_TITLE, status)
