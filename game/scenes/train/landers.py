"""Landers as Train shows them: a swarm or two, the network inside, any moment of the run, experiments and lessons."""

from __future__ import annotations

import math
from collections.abc import Hashable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.training.config import Config
from ai.training.curves import caption
from ai.training.experiments import differences, sabotaged
from ai.training.lander_session import CAREFUL
from game.core import texts
from game.core.scene import Pop, Transition, push
from game.drawing.canvas import Canvas
from game.drawing.tokens import NIGHT0, SMALL
from game.explain.lesson_door import LessonDoor
from game.scenes.train.advice import Advice
from game.scenes.train.charts import LANDER_CHARTS, Beside
from game.scenes.train.inside import Inside
from game.scenes.train.laboratory import Laboratory
from game.scenes.train.layout import Layout, Status
from game.scenes.train.rewind import Rewind
from game.scenes.train.swarms import HEAD, Swarms
from game.scenes.train.view import Pointer, View
from game.training.library import Library
from game.training.record import take_away
from game.training.run_kind import LANDERS
from game.ui.charts import Scrubber
from game.ui.panel import Column
from game.ui.rows import RunRow
from game.ui.virtual_pointer import VirtualPointer

if TYPE_CHECKING:
    from game.scenes.train.scene import TrainScene

INSIDE: Final = "inside"  # what a player can open: the network


class LanderView(View):
    """View of a run of landers.

    Attributes:
        swarms: what is seen of them.
        laboratory: the experiment that was chosen, and what came of it.
        inside: the network.
        rewind: the moment that is shown.

    """

    kind, charts, preset = LANDERS, LANDER_CHARTS, "modern"

    def __init__(self, scene: TrainScene) -> None:
        super().__init__(scene)
        run = self.run
        self.rewind = Rewind(run)
        self.laboratory = Laboratory(run, scene.knobs, self._split, self._leave_split)
        self.swarms = Swarms(run, self.rewind)
        self.inside = Inside(run, partial(scene.opened, INSIDE))
        self.lessons = LessonDoor(run, self.context.note, self.context.rng)
        self.advice = Advice(run, scene.knobs.turn)
        self._advised: object = None  # the network on which there was advice last
        scene.take_pace()

    @staticmethod
    def collection(user_dir: Path) -> Library:
        return Library(user_dir)

    # What it has come to

    @property
    def moment(self) -> int | None:  # type: ignore[override]
        return self.rewind.moment

    @property
    def fills(self) -> bool:  # type: ignore[override]
        return self.inside.opened

    @property
    def page(self) -> bool:  # type: ignore[override]
        return self.inside.opened or bool(self.laboratory.page)

    def status(self) -> Status:
        run, row, title, landed = self.run, self.rewind.row, texts.TRAIN_TITLE, texts.TRAIN_LANDED
        if run.swarm_state is None or not len(run.history):
            return Status(title, texts.TRAIN_BEGINS if run.alive else texts.TRAIN_LINE, "", landed)
        count = int(run.history["decisions"][-1]) if self.moment is None else self.moment
        line = texts.TRAIN_FIGURES.format(
            landers=len(run.swarm_state.outcome), seconds=run.history["seconds"][row], count=count
        )
        share = 100 * run.history["success_rate"][row]
        if self.moment is None and self.scene.landed and self.scene.landed[0] is not None:
            share = self.scene.landed[0]
        return Status(title, line, "" if np.isnan(share) else f"{share:.0f}", landed)

    @property
    def beside(self) -> Beside:
        chosen = self.laboratory.chosen
        return self.swarms.beside(chosen.name if chosen else texts.LAB_HEADING)

    def caption(self) -> str:
        name = caption(self.run.history) if self.run.alive else ""
        return texts.CHART_CAPTIONS[name] if name else ""

    @property
    def suggestion(self) -> str:
        return texts.TRAIN_NAME.format(preset=self.scene.knobs.name)

    @property
    def unfinished(self) -> str:
        left = self.scene.left
        if self.run.runs or left is None or not left.resumable:
            return ""
        words = texts.TRAIN_LEFT_YOUNG if left.success is None else texts.TRAIN_LEFT_FIGURES
        return words.format(seconds=left.seconds, percent=100 * (left.success or 0.0))

    @property
    def worth_keeping(self) -> bool:
        if self.run.runs:
            return (self.run.alive or self.run.kept) and len(self.run.history) > 0
        return self.scene.left is not None and bool(self.scene.left.success)  # it has landed

    # Rows

    @property
    def key(self) -> Hashable:
        earlier = tuple((each.name, each.style) for each in self.run.earlier)
        opened, now = self.inside.opened and len(self.run.history) > 0, self.moment is None
        return self.laboratory.key, self.run.twin is None, now, self.advice.key, earlier, opened

    def describe_first(self, column: Column) -> None:
        self.rewind.describe(column, timeline=self.inside.opened)

    def describe_page(self, column: Column) -> None:
        if not self.inside.opened:
            self.laboratory.describe(column)
            return
        column.pair(texts.TRAIN_LANDED, lambda: self.scene.status.figure or "–")
        self.inside.describe(column)
        column.gap()
        column.button(texts.LESSON_WHY, self._ask_why)
        self.scene.switch(column, INSIDE, texts.TRAIN_LOOK)

    def describe_more(self, column: Column) -> None:
        helps = texts.TRAIN_HELP
        self.scene.switch(column, INSIDE, texts.TRAIN_LOOK, helps["inside"])
        for word, press, name in (
            (texts.TRAIN_EXPERIMENTS, self.laboratory.open, "experiments"),
            (texts.LESSON_WHY, self._ask_why, "lesson"),
            (texts.TASTE_NAME, partial(push, "taste"), "taste"),
            (texts.TRAIN_DUEL, self._duel, "duel"),
            (texts.TRAIN_RUNS, self._open_runs, "runs"),
        ):
            column.button(word, press).pad = 3.0
            column.explain(helps[name])

    def describe_foot(self, column: Column) -> None:
        column.choice("", texts.TRAIN_PACES, self.run.pace, self.scene.set_pace, SMALL)

    def describe_last(self, column: Column) -> None:
        """Add the names of the runs that are shown beside this one."""
        shown = self.beside
        if not shown.runs:
            return
        column.line()
        for name, style in ((shown.name or texts.TRAIN_THIS, 0), *((each.name, each.style) for each in shown.runs)):
            press = partial(take_away, [] if self.run.twin else self.run.earlier, style)
            column.widget(RunRow(name, style, press))
        if not self.run.twin:
            column.aside(texts.COMPARE_REMOVE)

    def describe_hint(self, column: Column) -> bool:
        if self.advice.shown:
            self.advice.describe(column)
        return self.advice.shown

    def pointers(self) -> list[Pointer]:
        nowhere, charts = (0, 0, 1, 1), self.scene.charts
        if self.inside.opened:
            view = VirtualPointer(nowhere, self.inside.follow)
            return [(view, lambda: self.inside.view.box)]
        landers = VirtualPointer(nowhere, self.follow_unused, hold=texts.LESSON_MARK)
        scrubber = Scrubber(charts, self._scrub, self._duel)
        return [
            (landers, lambda: self.swarms.box),
            (VirtualPointer(nowhere, charts.follow), lambda: charts.box),
            (scrubber, lambda: charts.box),
        ]

    def _scrub(self, place: float | int) -> None:
        if isinstance(place, int):
            self.rewind.shift(place)
        else:
            self.rewind.go_to(self.scene.charts.decisions_at(place))

    # Time

    def follow(self, event: pygame.event.Event) -> None:
        self.inside.follow(event)

    def follow_unused(self, event: pygame.event.Event) -> None:
        """Choose the lander that is clicked; a second click asks for its lesson."""
        swarm, pressed = self.swarms.shown, event.type == pygame.MOUSEBUTTONDOWN and event.button == 1
        slot = swarm.slot_at(event.pos) if pressed and not self.inside.opened else None
        if slot is not None and slot == swarm.chosen:
            self._ask_why()
        elif slot is not None:
            swarm.chosen = slot

    def update(self) -> Transition | None:
        run = self.run
        self.advice.silence(bool(self.scene.knobs.settings.waiting) or run.twin is not None)
        if not run.alive:
            self.advice.clear()
        elif run.network_state is not self._advised and len(run.history):
            self._advised = run.network_state
            self.advice.follow()
        self.rewind.update()
        self.inside.show(run.network_state if self.moment is None else self.rewind.network_state, self.rewind.row)
        self.inside.update()
        self.swarms.update(self.context.settings.reduced_motion)
        self.laboratory.update(self.scene.landed)
        lesson = self.lessons.answer()
        return push("lesson", lesson, self.lessons) if lesson else None

    def back(self) -> bool:
        if self.laboratory.page:
            self.laboratory.close()
        elif self.inside.opened:
            self.scene.open(INSIDE)
        elif self.moment is not None:
            self.rewind.clear()
        else:
            return False
        return True

    def clear(self) -> None:
        for part in (self.swarms, self.rewind, self.advice, self.inside):
            part.clear()

    # What can be done

    def _ask_why(self) -> None:
        """Ask for the lesson of the chosen lander, or of the one that explores least, as the run is now."""
        chosen = self.swarms.shown.chosen
        self.rewind.clear()
        self.lessons.ask(CAREFUL if chosen is None else chosen)

    def _open_runs(self) -> Transition:
        def go_on(folder: Path) -> Transition:
            self.scene.start(Config(), 0, folder)
            return Pop()

        return push("runs", train=go_on)

    def _duel(self) -> Transition | None:
        """Fly against the checkpoint of the moment that is shown."""
        checkpoint = self.run.history.checkpoint_at(math.inf if self.moment is None else self.moment)
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

    def _split(self, sabotage: str) -> Transition | None:
        """Fly a sabotage beside a healthy twin; a run without a name that goes on is asked about first."""
        start = partial(self._split_now, sabotage)
        if self.run.twin is None:
            return self.scene.instead(start)
        start()
        return None

    def _split_now(self, sabotage: str) -> None:
        knobs = self.scene.knobs
        config, seed, changed = knobs.config, knobs.seed, sabotaged(knobs.config, sabotage)
        if note := self.run.split(config, seed, changed, tuple(differences(config, changed)), knobs.name):
            self.context.note(note)
        self.scene.cleared()
        knobs.set_config(config, seed)
        self.laboratory.begin()

    def _leave_split(self) -> None:
        """End the split view; the healthy run goes on."""
        self.run.leave()
        self.scene.cleared()
        self.laboratory.close()

    # The picture

    def place(self, place: Layout) -> None:
        self.swarms.place(place.swarm)
        self.inside.place(place.display)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the swarm, or both, or the network."""
        if self.inside.opened:
            canvas.fill(canvas.rect(*self.inside.display), NIGHT0)
            self.inside.draw(canvas)
        else:
            self.swarms.draw(canvas, alpha, self.scene.landed)

    @property
    def titled(self) -> bool:  # type: ignore[override]
        """Whether there is room for the title: over two swarms, it would lie on what says the same."""
        return self.run.twin is None or self.swarms.box.height > 2 * HEAD
