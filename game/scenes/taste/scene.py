"""By your taste: which of two flights is liked better, how the network flies now, and what it believes one likes."""

from __future__ import annotations

from collections.abc import Hashable
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.training.config import Config
from ai.training.preferences import FIRST, NEITHER, SECOND, SUMS
from ai.training.upbringing import UPBRINGING, TasteSession
from game.core import texts
from game.core.scene import Push, Transition
from game.drawing.canvas import Canvas
from game.drawing.tokens import TITLE
from game.explain.explained import Explained
from game.explain.tables import Line, from_zero, table
from game.input.controls import Command
from game.scenes.menus.dialogs import NameDialog
from game.scenes.taste.flights import PACE, Pair, PairRow, Small
from game.training.library import Library
from game.training.run import TrainingRun
from game.training.run_kind import RunKind
from game.ui.actions import Action, Table
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from game.drawing.cursor import Cursor
    from game.ui.context import Context
    from game.ui.panel import Panel

RAISED: Final = RunKind(TasteSession, Config, {"taste": UPBRINGING}, lambda: texts.PRESETS, first=(), knobs={})
_MORE: Final = "taste"  # what a player can open
_FOLDER: Final = ".taste"  # among the player's networks, until it has a name: Train has its own place
_LEAST: Final = 300.0  # points of a column
_HIGH, _PAIR, _NOW = 0.5, 0.38, 0.26  # height of a picture, of its width; of the pair and the landers, of the view
_LIKING: Final = 2.0  # what fills a bar at least
_SEEDS: Final = 1_000_000


class TasteScene(PanelScene):
    """Two flights, and a network that learns which is liked better.

    Attributes:
        run: what learns, in a process of its own.
        pair: the two flights.
        now: how the network flies now.

    """

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        nursery = Library(context.user_dir)
        nursery.unsaved = nursery.folder / _FOLDER
        self.run = TrainingRun(RAISED, nursery)
        self.run.pace = PACE
        self.pair, self.now, self.explained = Pair(), Small(), Explained()
        try:
            self.run.keeps = nursery.hold()
            self._begin(resume=self.run.unfinished)
            self.build()
        except BaseException:  # nobody closes a scene that could not be built
            self.close()
            raise

    def _begin(self, *, resume: bool = False) -> None:
        seed = int(self.context.rng.integers(_SEEDS))
        self.run.begin(UPBRINGING, seed, self.run.collection.unsaved if resume else None)
        self.pair.ask(None)
        self.now.swarm.clear()

    # Rows

    def describe(self, panel: Panel) -> None:
        panel.text(lambda: self.run.problem or texts.TASTE_ASK, size=TITLE)
        panel.gap(6)
        self._row = panel.widget(PairRow(self.pair, self.answer, self._height, self._waits))
        again, back = (texts.TASTE_AGAIN, self.pair.again), (texts.TASTE_BACK, self._take_back)
        panel.words([again, *([back] if self._answers else []), self.unfolding(_MORE)])
        panel.gap(6)
        if self.context.settings.is_open(_MORE):
            panel.words([(texts.TASTE_KEEP, self._keep), (texts.TASTE_ANEW, self._start_anew)])
            panel.gap(6)
            panel.aside(texts.TASTE_ASSISTANTS)
            panel.gap(6)
        left, right = panel.beside((1, 1), _LEAST)
        left.add(lambda cursor: cursor.caption(texts.TASTE_NOW.format(count=self._answers)))
        left.add(self._write_now, texts.TASTE_HELP["now"])
        right.add(table((texts.TASTE_BELIEVED, "  ←  →  ".join(texts.TASTE_SIDES)), self._likings))

    def state(self) -> Hashable:
        return super().state(), self._answers > 0

    @property
    def _answers(self) -> int:
        return self.run.asked.answers if self.run.asked else 0

    def _waits(self) -> str:
        return "" if self.run.problem else texts.TASTE_WAITS[self._answers > 0]

    def _height(self, width: float, share: float = _PAIR) -> float:
        """Return the height of pictures of that width each."""
        return min(_HIGH * width, share * self.context.reading().view.height)

    def _write_now(self, cursor: Cursor) -> None:
        box = cursor.take(self._height(cursor.width, _NOW))
        if cursor.canvas is None:
            self.now.place(box)
        else:
            self.now.draw(cursor.canvas)

    def _likings(self) -> list[Line]:
        """Return how much each sum is liked, to the right, or disliked, to the left."""
        asked = self.run.asked
        liking = asked.liking if asked and asked.answers else np.zeros(len(SUMS))
        most = max(float(np.abs(liking).max()), _LIKING)
        return [
            Line((texts.TASTE_SUMS[name], ""), texts.TASTE_HELP["liking"], lit=bool(each),
                 bars=(from_zero(float(each), -most, most),))
            for name, each in zip(SUMS, liking, strict=True)
        ]  # fmt: skip

    # Events and time

    def actions(self) -> Table:
        """Answer by the arrows, unless they move from word to word."""
        this, neither, that = (
            (texts.TASTE_THIS, texts.TASTE_NEITHER, texts.TASTE_THAT) if self.pair.question else [""] * 3
        )
        answers = [
            Action(pygame.K_LEFT, partial(self.answer, FIRST), this, Command.LEFT),
            Action(pygame.K_DOWN, partial(self.answer, NEITHER), neither, Command.DOWN),
            Action(pygame.K_RIGHT, partial(self.answer, SECOND), that, Command.RIGHT),
        ]
        focused, controls = self.form.focused, self.context.controls
        words = focused is not None and focused is not self._row and focused.ringed
        return [
            *((each.hint_for(controls) for each in answers) if words else answers),
            Action(pygame.K_BACKSPACE, self._take_back, gamepad=Command.HANDOVER),
            Action(Command.RETRY, self.pair.again),
            self.form.goes_back(texts.HINT_BACK),
            self.explained.action(),
        ]

    def answer(self, answer: int) -> None:
        """Answer what is asked."""
        asked = self.run.asked
        if asked is not None and self.pair.question is not None:
            self.run.ask("choose", asked.answers, answer)
            self.context.sound.play("choose")
            self.pair.ask(None)
            self.form.focus(self._row)

    def _take_back(self) -> None:
        if self._answers:
            self.run.ask("take_back")

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Go on explaining; everything else is the panel's."""
        return None if self.explained.handle_event(event) else super().handle_event(event)

    def update(self) -> Transition | None:
        """Receive what the worker says, and go on flying."""
        run, still, before = self.run, self.context.settings.reduced_motion, self.run.asked
        for note in run.poll():
            self.context.note(note)
        if run.asked is not before and run.asked is not None:
            self.pair.ask(run.asked.question)
        if run.swarm_state is not None and run.swarm_state is not self.now.swarm.swarm_state:
            self.now.swarm.take(run.swarm_state)
        self.pair.update(still)
        self.now.swarm.update(still)
        self.explained.update()
        return super().update()

    def enter(self) -> None:
        """Go on learning."""
        self.run.resume()

    def exit(self) -> None:
        """Rest while another scene has the window."""
        self.run.pause()

    def close(self) -> None:
        """End the run's process; what it has learned is kept, and goes on at the next visit."""
        self.run.close()
        self.run.collection.release()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        super().draw(canvas, alpha)
        self.explained.draw(canvas)

    # The network

    @property
    def _name(self) -> str:
        return self.run.collection.free_name(texts.TASTE_NAME)

    def _keep(self) -> Transition:
        return Push(NameDialog(self, texts.NAMING, self._name, self.run.save))

    def _start_anew(self) -> None:
        """Bring up another; this one is put among the player's networks, if it has learned anything."""
        if problem := self.run.save(self._name) if self._answers else "":
            self.context.note(problem)
        else:
            self._begin()
