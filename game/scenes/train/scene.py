"""Train scene: a swarm learns to land in a process of its own; its charts are live, and so are the knobs."""

from __future__ import annotations

import math
from collections.abc import Hashable
from functools import partial
from pathlib import Path

import numpy as np
import pygame

from ai.training.config import PRESETS, Config
from ai.training.experiments import differences, sabotaged
from ai.training.lander_session import CAREFUL
from game.core import texts
from game.core.scene import Pop, Transition, push
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, LINE, NIGHT0, SMALL
from game.explain.lesson_door import LessonDoor
from game.scenes.train.advice import Advice
from game.scenes.train.base import CHARTS, INSIDE, KNOBS, Pointer, TrainingScene
from game.scenes.train.charts import LANDINGS, SCORE, Beside, LandingsCaption, TrainingCharts
from game.scenes.train.inside import Inside
from game.scenes.train.knobs import KnobsPanel
from game.scenes.train.laboratory import Laboratory
from game.scenes.train.landers import HEAD, Landers
from game.scenes.train.layout import Layout, TrainingStatus
from game.scenes.train.rewind import Rewind
from game.training.library import Library
from game.training.record import take_away
from game.training.run import PACES, TrainingRun
from game.training.run_kind import LANDERS
from game.training.run_settings import RunSettings
from game.ui.charts import Scrubber
from game.ui.context import Context
from game.ui.panel import Column
from game.ui.rows import RunRow
from game.ui.virtual_pointer import VirtualPointer


class TrainScene(TrainingScene):
    """Train scene: swarm, charts and knobs. With `resume`, a saved run continues at once.

    Attributes:
        landers: what is seen of them.
        laboratory: the experiment that was chosen, and what came of it.
        inside: the network.
        rewind: the moment that is shown.

    """

    def __init__(self, context: Context, resume: Path | None = None) -> None:
        self.library = Library(context.user_dir)
        super().__init__(context, TrainingRun(LANDERS, self.library))
        if resume:
            self._start(Config(), 0, resume)

    def _build(self) -> None:
        run = self.run
        self.charts, self.caption = TrainingCharts(), LandingsCaption()
        settings = RunSettings(PRESETS["modern"], 0, partial(run.ask, "change"), self._begin, LANDERS)
        self.knobs = KnobsPanel(self.form, settings)
        self.laboratory = Laboratory(run, self.knobs, self._split, self._leave_split, lambda: self.charts.landed)
        self.rewind = Rewind(run)
        self.landers = Landers(run, self.rewind)
        self.inside = Inside(run, partial(self.opened, INSIDE))
        self.lessons = LessonDoor(run, self.context.note, self.context.rng)
        self._offers = False  # whether there is a first landing to stop at
        run.set_pace(0 if self._settings.slow_runs else len(PACES) - 1)
        self._advice = Advice(run, self.knobs.turn)
        self._frame = 0
        self._news = False  # of the network, on which there is no advice yet

    # Rows

    @property
    def _shown_page(self) -> str:
        return self.laboratory.page

    @property
    def _key(self) -> Hashable:
        earlier = tuple((each.name, each.style) for each in self.run.earlier)
        opened = self.inside.opened and len(self.run.history) > 0
        now = self.rewind.moment is None
        return self.laboratory.page, self.run.twin is None, now, self._advice.key, earlier, opened, self._offers

    @property
    def _status(self) -> TrainingStatus:
        run, row, title, landed = self.run, self.rewind.row, texts.TRAIN_TITLE, texts.TRAIN_LANDED
        if run.swarm_state is None or not len(run.history):
            return TrainingStatus(title, texts.TRAIN_BEGINS if run.alive else texts.TRAIN_LINE, "", landed)
        landers, seconds = len(run.swarm_state.outcome), run.history["seconds"][row]
        count = int(run.swarm_state.decisions) if self.rewind.moment is None else self.rewind.moment
        line = texts.TRAIN_FIGURES.format(landers=landers, seconds=seconds, count=count)
        share = 100 * run.history["success_rate"][row]
        if self.rewind.moment is None and self.charts.landed and self.charts.landed[0] is not None:
            share = self.charts.landed[0]  # one number for the title and its chart
        figure = "" if np.isnan(share) else f"{share:.0f}"
        return TrainingStatus(title, line, figure, landed)

    @property
    def _unfinished(self) -> str:
        left = self.left
        if self.run.runs or left is None or not left.resumable:
            return ""
        words = texts.TRAIN_LEFT_YOUNG if left.success is None else texts.TRAIN_LEFT_FIGURES
        return words.format(seconds=left.seconds, percent=100 * (left.success or 0.0))

    def _place(self, place: Layout) -> None:
        self.landers.place(place.swarm)
        self.inside.place(place.display)

    def _pointers(self) -> list[Pointer]:
        nowhere, charts = (0, 0, 1, 1), self.charts
        if self.inside.opened:
            view = VirtualPointer(nowhere, self.inside.follow)
            return [(view, lambda: self.inside.view.box)]
        landers = VirtualPointer(nowhere, self._choose_lander, hold=texts.LESSON_MARK)
        scrubber = Scrubber(charts, self._scrub, self._duel)
        return [
            (landers, lambda: self.landers.box),
            (VirtualPointer(nowhere, charts.follow), lambda: charts.box),
            (scrubber, lambda: charts.charts[0].box.union(charts.charts[1].box)),
        ]

    def _scrub(self, place: float | int) -> None:
        if isinstance(place, int):
            self.rewind.shift(place)
        else:
            self.rewind.go_to(self.charts.decisions_at(place))

    def _describe(self, column: Column) -> None:
        self.rewind.describe(column, timeline=self.inside.opened)
        if self.inside.opened:
            self.inside.describe(column)
            column.gap()
            column.button(texts.LESSON_WHY, self._ask_why)
            self.switch(column, INSIDE)
            return
        if self.laboratory.page:
            self.laboratory.describe(column)
            return
        super()._describe(column)
        self._describe_beside(column)

    def _describe_more(self, column: Column) -> None:
        for name in (INSIDE, CHARTS, KNOBS):
            self.switch(column, name)
        column.button(texts.TRAIN_EXPERIMENTS, self.laboratory.open).pad = 3.0
        column.button(texts.TASTE_NAME, lambda: push("taste")).pad = 3.0
        column.button(texts.TRAIN_RUNS, self._open_runs).pad = 3.0
        column.gap(8)
        column.line()
        column.words([
            (texts.LESSON_WHY, self._ask_why),
            (texts.TRAIN_DUEL, self._duel),
            (texts.TRAIN_SAVE, self._save),
        ])  # fmt: skip

    def _describe_foot(self, column: Column) -> None:
        super()._describe_foot(column)
        column.choice("", texts.TRAIN_PACES, self.run.pace, self._set_pace, SMALL)

    def _set_pace(self, index: int) -> None:
        self.run.set_pace(index)
        self._settings.slow_runs = index == 0
        self.context.apply_settings()

    def _describe_beside(self, column: Column) -> None:
        """Add the names of the runs that are shown beside this one."""
        shown = self._beside
        if not shown.runs:
            return
        column.line()
        for name, style in ((shown.name or texts.TRAIN_THIS, 0), *((each.name, each.style) for each in shown.runs)):
            press = partial(take_away, [] if self.run.twin else self.run.earlier, style)
            column.widget(RunRow(name, style, press))
        if not self.run.twin:
            column.aside(texts.COMPARE_REMOVE)

    @property
    def _beside(self) -> Beside:
        chosen = self.laboratory.chosen
        return self.landers.beside(chosen.name if chosen else texts.LAB_HEADING)

    def _describe_hint(self, column: Column) -> bool:
        if self._offers and self.run.first_landing:
            column.text(texts.LESSON_OFFER.format(slot=self.run.first_landing.slot + 1), size=SMALL, colour=HUMAN)
            column.words([(texts.LESSON_LOOK, self._look), (texts.LESSON_FLY_ON, self._fly_on)])
            return True
        if self._advice.shown:
            self._advice.describe(column)
        return self._advice.shown

    # Events and time

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Handle the network, the charts and the landers, and all that every run has."""
        if not self.inside.opened:
            self.charts.follow(event)
        self.inside.follow(event)
        outcome = super().handle_event(event)
        if not self.inside.opened and not self.form.used:
            self._choose_lander(event)
        return outcome

    def update(self) -> Transition | None:
        """Receive the worker's messages, and animate the screen."""
        run, still = self.run, self._settings.reduced_motion
        looked = self._listen_to_run()
        self._advice.silence(bool(self.knobs.settings.waiting) or run.twin is not None)
        if not run.alive:
            self._advice.clear()
        else:
            self.knobs.show_in_force(run.in_force)
        self._go_to_moment()
        if self._news and run.alive and not looked:  # in a frame of its own
            self._news, looked = False, True
            self._advice.follow()
        looked |= self.charts.look(run.history, self._beside, self._caption)
        self.landers.update(still)
        self._frame += 1
        self.laboratory.update(self._frame)
        self.inside.update()
        # Tasks that take a millisecond or two take turns, one per frame.
        self.charts.update(at_once=still, turn=not (looked or self.inside.busy))
        self._offer()
        outcome = self._finish_update()
        lesson = self.lessons.answer()
        return outcome or (push("lesson", lesson, self.lessons, self.run.swarm_state) if lesson else None)

    def _listen_to_run(self) -> bool:
        """Receive the worker's messages; return whether one was about the network."""
        run = self.run
        network_state = run.network_state
        self._listen()
        if run.network_state is None or run.network_state is network_state:
            return False
        if self.rewind.moment is None:
            self.inside.show(run.network_state)
        self._news = run.alive and len(run.history) > 0
        return True

    def _go_to_moment(self) -> None:
        """Show everything as it was at the moment that is chosen, or as it is now; call it once a frame."""
        rewind, moment = self.rewind, self.rewind.moment
        rewind.update()
        if moment != self.charts.moment:
            self.charts.go_to(moment)
            self.inside.show(self.run.network_state if moment is None else rewind.network_state, rewind.row)

    def _caption(self, chart: str) -> str:
        run = self.run
        if chart == SCORE and self._beside.paid_otherwise:
            return texts.LAB_PAID_OTHERWISE
        hinted = bool(self._advice.hint)
        return self.caption.read(run.history, run.config, hinted) if run.alive and chart == LANDINGS else ""

    # The run

    def _clear(self) -> None:
        for part in (self.landers, self.rewind, self._advice, self.charts, self.caption, self.inside):
            part.clear()

    @property
    def _worth_keeping(self) -> bool:
        if self.run.runs:
            return (self.run.alive or self.run.kept) and len(self.run.history) > 0
        return self.left is not None and bool(self.left.success)  # it has landed

    @property
    def _suggestion(self) -> str:
        return texts.TRAIN_NAME.format(preset=self.knobs.name)

    def _choose_lander(self, event: pygame.event.Event) -> None:
        """Choose the lander that is clicked, in points; a second click asks for its lesson."""
        swarm, pressed = self.landers.shown, event.type == pygame.MOUSEBUTTONDOWN and event.button == 1
        slot = swarm.slot_at(event.pos) if pressed else None
        if slot is not None and slot == swarm.chosen:
            self._ask_why()
        elif slot is not None:
            swarm.chosen = slot

    def _ask_why(self) -> None:
        """Ask for the lesson of the chosen lander, or of the one that explores least, at the moment that is shown."""
        chosen = self.landers.shown.chosen
        self.lessons.ask(CAREFUL if chosen is None else chosen, self.rewind.moment)

    def _offer(self) -> None:
        """Offer once in a player's life to stop at a first landing, and look at what is learned from it."""
        if self.run.first_landing and not self._settings.lesson_offered and self.run.state is WorkerState.RUNNING:
            self._offers = self._settings.lesson_offered = True
            self.context.apply_settings()
            self._lay()
            self.form.focus(next(each for each in self.form.widgets if each.label == texts.LESSON_LOOK))
        self._offers &= self.run.alive

    def _look(self) -> None:
        """Ask for the lesson of the first landing."""
        assert self.run.first_landing is not None
        self._offers = False
        self.lessons.ask(self.run.first_landing.slot, self.run.first_landing.decisions)

    def _fly_on(self) -> None:
        self._offers = False

    def _open_runs(self) -> Transition:
        def go_on(folder: Path) -> Transition:
            self._start(Config(), 0, folder)
            return Pop()

        return push("runs", train=go_on)

    def _duel(self) -> Transition | None:
        """Fly against the checkpoint of the moment that is shown."""
        checkpoint = self.run.history.checkpoint_at(math.inf if self.rewind.moment is None else self.rewind.moment)
        if checkpoint is None:
            self.context.note(texts.TRAIN_NO_CHECKPOINT)
            return None
        try:
            rival = checkpoint.agent(self.run.config)
        except ValueError as error:
            self.context.note(str(error))
            return None
        return push("play", rival=rival, rival_name=texts.TRAIN_CHECKPOINT.format(seconds=checkpoint.seconds))

    # An experiment

    def _split(self, sabotage: str) -> None:
        """Fly a sabotage beside a healthy twin; the run that goes on is put among the player's networks."""
        config, seed = self.knobs.config, self.knobs.seed
        changed = sabotaged(config, sabotage)
        if self.run.twin is None and not self._keep():
            return
        self._was_running = False
        if note := self.run.split(config, seed, changed, tuple(differences(config, changed)), self.knobs.name):
            self.context.note(note)
        self._clear()
        self.knobs.set_config(config, seed)
        self.laboratory.follow()
        self.laboratory.open()

    def _leave_split(self, experiment: bool) -> None:
        """End the split view; go on with the healthy run, or with the experiment."""
        if not experiment:
            self.run.leave()
        elif note := self.run.keep_twin():
            self.context.note(note)
        self._clear()
        self.laboratory.page = "result" if self.run.twin else ""

    # The picture

    @property
    def _back_hint(self) -> str:
        return texts.HINT_BACK if self.rewind.moment is None else texts.REWIND_BACK

    def _back(self) -> Transition | None:
        if self.laboratory.page:
            self.laboratory.close()
        elif self.inside.opened:
            self.open(INSIDE)
        elif self.rewind.moment is not None:
            self.rewind.clear()
        else:
            return super()._back()
        return None

    def _draw_display(self, canvas: Canvas, alpha: float) -> None:
        """Draw the swarm and the charts, or the network."""
        assert self._layout is not None
        display, box = self._layout.display, self._layout.swarm
        split = self.run.twin is not None
        if self.inside.opened:
            canvas.fill(canvas.rect(*display), NIGHT0)
            self.inside.draw(canvas)
            return
        top = display.top if split else box.bottom  # one swarm fills its box
        canvas.fill(canvas.rect(display.left, top, display.width, display.bottom - top), NIGHT0)
        self.charts.draw(canvas)  # first, as the title and both halves say what they have painted
        self.landers.draw(canvas, alpha, self.charts.landed)
        canvas.line((box.left, box.bottom), (box.right, box.bottom), LINE)
        if not split or box.height > 2 * HEAD:  # or else it would lie on both swarms, which say the same
            self.draw_title(canvas)
