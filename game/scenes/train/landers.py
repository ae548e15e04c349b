"""Landers as Train shows them: a swarm or two, the network inside, any moment of the run, experiments and lessons."""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.training.config import Config
from ai.training.curves import caption
from ai.training.experiments import differences, sabotaged
from game.core import texts
from game.core.scene import Pop, Transition, push
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, NIGHT0, SMALL
from game.explain.lesson_door import LessonDoor
from game.scenes.train.advice import Advice
from game.scenes.train.charts import LANDER_CHARTS, Beside
from game.scenes.train.inside import Inside
from game.scenes.train.laboratory import Laboratory
from game.scenes.train.layout import Layout, Status
from game.scenes.train.rewind import Rewind
from game.scenes.train.swarms import Swarms
from game.scenes.train.view import Pointer, View
from game.training.library import Library
from game.training.run import PACES
from game.training.run_kind import LANDERS
from game.ui.charts import Scrubber
from game.ui.panel import Column
from game.ui.virtual_pointer import VirtualPointer

if TYPE_CHECKING:
    from game.scenes.train.scene import TrainScene

_SLOW: Final = 1200  # frames for which a run goes slowly from its first landing
INSIDE: Final = "inside"  # what a player can open: the network


class LanderView(View):
    """View of a run of landers.

    Attributes:
        left: the run that was left without a name by the last visit; None without one.
        swarms: what is seen of the landers.
        laboratory: the experiment that was chosen, and what came of it.
        inside: the network.
        rewind: the moment that is shown.
        offers: whether a first landing can be stopped at.

    """

    kind, charts, preset = LANDERS, LANDER_CHARTS, "modern"

    def __init__(self, scene: TrainScene) -> None:
        super().__init__(scene)
        run = self.run
        self.left = run.collection.rescued() if run.keeps else None
        self.rewind = Rewind(run)
        self.laboratory = Laboratory(run, self._split)
        self.swarms = Swarms(run, self.rewind)
        self.inside = Inside(run, self.rewind)
        self.lessons = LessonDoor(run, self.context.note, self.context.rng)
        self.advice = Advice(run, scene.knobs)
        self.offers, self._slow = False, 0

    @staticmethod
    def collection(user_dir: Path) -> Library:
        return Library(user_dir)

    # What it has come to

    @property
    def moment(self) -> int | None:  # type: ignore[override]
        return self.rewind.moment

    @property
    def fills(self) -> bool:  # type: ignore[override]
        return self.context.settings.is_open(INSIDE)

    @property
    def page(self) -> Hashable:  # type: ignore[override]
        return self.fills or self.laboratory.page

    @property
    def titled(self) -> bool:  # type: ignore[override]
        return self.swarms.titled

    @property
    def first(self) -> Sequence[str]:
        """The few knobs; once its schedule is over, the last learning rate is the one that acts."""
        run = self.run
        over = run.alive and len(run.history) and run.history["decisions"][-1] >= run.config.schedule_decisions
        return ("final_learning_rate", *self.kind.first[1:]) if over else self.kind.first

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
        halves = run.twin and not self.fills  # each says its own
        return Status(title, line, "" if np.isnan(share) or halves else f"{share:.0f}", landed)

    @property
    def beside(self) -> Beside | None:
        twin = self.run.twin
        if twin is None:
            return super().beside
        otherwise = twin.config.reward_weights != self.run.config.reward_weights
        return Beside(self.laboratory.name, twin.history, in_step=True, paid_otherwise=otherwise)

    def caption(self) -> str:
        name = caption(self.run.history) if self.run.alive else ""
        return texts.CHART_CAPTIONS[name] if name else ""

    @property
    def unfinished(self) -> str:  # type: ignore[override]
        left = self.left
        if self.run.state is not None or left is None or not left.resumable:
            return ""
        return texts.TRAIN_LEFT_YOUNG.format(seconds=left.seconds)

    @property
    def worth_keeping(self) -> bool:  # type: ignore[override]
        run = self.run
        if run.state is None:
            return self.left is not None and bool(self.left.success)  # it has landed
        return (run.alive or run.kept) and len(run.history) > 0

    # Rows

    @property
    def key(self) -> Hashable:  # type: ignore[override]
        begun, hint = len(self.run.history) > 0, self.advice.shown
        return self.laboratory.key, self.run.twin is None, self.moment is None, hint, begun, self.offers, self._slow > 0

    def describe_first(self, column: Column) -> None:
        self.rewind.describe(column)

    def describe_page(self, column: Column) -> None:
        if not self.fills:
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
        column.choice("", texts.TRAIN_PACES, PACES.index(self.run.pace), self.scene.set_pace, SMALL)

    def describe_hint(self, column: Column) -> bool:
        if self.offers:
            column.text(texts.LESSON_OFFER, size=SMALL, colour=HUMAN)
            column.words([(texts.LESSON_LOOK, self._look), (texts.LESSON_FLY_ON, self._fly_on)])
            return True
        if hint := self.advice.shown:
            self.advice.describe(column, hint)
        return hint is not None

    def pointers(self) -> list[Pointer]:
        nowhere, charts = (0, 0, 1, 1), self.scene.charts
        if self.fills:
            return [(VirtualPointer(nowhere, self.inside.follow), lambda: self.inside.view.box)]
        landers = (VirtualPointer(nowhere, self.follow_unused, hold=texts.LESSON_MARK), lambda: self.swarms.box)
        if not self.scene.charted:
            return [landers]
        return [
            landers,
            (VirtualPointer(nowhere, charts.follow), lambda: charts.box),
            (Scrubber(charts, self._scrub, self._duel), lambda: charts.box),
        ]

    def _scrub(self, place: float | int) -> None:
        if isinstance(place, int):
            self.rewind.shift(place)
        else:
            self.rewind.go_to(self.scene.charts.decisions_at(place))

    # Events and time

    def follow(self, event: pygame.event.Event) -> None:
        if self.fills:
            self.inside.follow(event)

    def follow_unused(self, event: pygame.event.Event) -> None:
        """Choose the lander that is clicked; a second click asks for its lesson."""
        swarm, pressed = self.swarms.shown, event.type == pygame.MOUSEBUTTONDOWN and event.button == 1
        slot = swarm.slot_at(event.pos) if pressed and not self.fills else None
        if slot is not None and slot == swarm.chosen:
            self._ask_why()
        elif slot is not None:
            swarm.chosen = slot

    def update(self) -> Transition | None:
        self._offer()
        self.advice.update()
        if self.fills:
            self.inside.update()
        self.swarms.update(self.context.settings.reduced_motion)
        self.laboratory.update()
        lesson = self.lessons.answer()
        return push("lesson", lesson, self.lessons) if lesson else None

    def back(self) -> bool:
        if self.laboratory.page:
            self.laboratory.close()
        elif self.fills:
            self.context.unfold(INSIDE)
        elif self.moment is not None:
            self.rewind.clear()
        else:
            return False
        return True

    def clear(self) -> None:
        for part in (self.swarms, self.rewind, self.inside):
            part.clear()
        self.advice.adviser.reset()
        if self.offers:
            self._withdraw()

    # What can be done

    def _offer(self) -> None:
        """Offer to stop at a first landing, by one key, until a player has answered once."""
        run, settings = self.run, self.context.settings
        if run.first_landing and not (self.offers or settings.lesson_offered) and run.state is WorkerState.RUNNING:
            self.offers, self._slow = True, _SLOW
            run.set_pace(PACES[0])  # or all would land before it is read
            self.scene.build()
            self.scene.form.focus(next(each for each in self.scene.form.widgets if each.label == texts.LESSON_LOOK))
        elif self.offers and not run.alive:
            self._withdraw()
        elif self._slow:
            self._slow -= 1
            if not self._slow:
                self._hurry()

    def _look(self) -> Transition:
        assert self.run.first_landing is not None
        self._fly_on()
        return push("lesson", self.run.first_landing.lesson, self.lessons)

    def _fly_on(self) -> None:
        self.context.settings.lesson_offered = True
        self._withdraw()

    def _withdraw(self) -> None:
        """Offer nothing any more."""
        self.offers = False
        self._hurry()

    def _hurry(self) -> None:
        """Go as fast as the player has chosen."""
        self._slow = 0
        self.scene.set_pace(0 if self.context.settings.slow_runs else 1)

    def _ask_why(self) -> None:
        """Ask for the lesson of the chosen lander, or of the one in the air that explores least, as the run is now."""
        chosen = self.swarms.shown.chosen
        self.rewind.clear()
        self.lessons.ask(chosen)

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

    def _split(self, sabotage: str) -> None:
        """Fly a sabotage beside a healthy twin; a run without a name that has learnt is kept first."""
        knobs, run = self.scene.knobs, self.run
        config = knobs.in_force
        changed = sabotaged(config, sabotage)
        if self.scene.keep():
            run.split(config, run.seed, changed, tuple(differences(config, changed)))
            knobs.ask(config)
            self.scene.cleared()

    # The picture

    def place(self, place: Layout) -> None:
        self.swarms.place(place.swarm)
        self._display = place.display
        self.inside.place(place.display)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the swarm, or both, or the network."""
        if self.fills:
            canvas.fill(canvas.rect(*self._display), NIGHT0)
            self.inside.draw(canvas)
        else:
            self.swarms.draw(canvas, alpha, self.scene.landed, self.laboratory.name)
