"""By your taste: which of two flights is liked better, how the network flies now, and what it believes one likes."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.training.preferences import FIRST, NEITHER, SECOND, SUMS
from ai.training.upbringing import UPBRINGING
from game.core import texts
from game.core.scene import Push, Transition, push
from game.drawing.cursor import Cursor
from game.drawing.tokens import FAINT, INK, MUTE, NET, SMALL, TITLE
from game.input.controls import Command
from game.scenes.menus.dialogs import NameDialog
from game.scenes.taste.flights import Pair, PairRow, Small
from game.scenes.taste.run import Nursery, TasteRun
from game.ui.actions import Action, Table
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from game.drawing.canvas import Align
    from game.ui.context import Context
    from game.ui.panel import Column, Panel

_MORE: Final = "taste"  # what a player can open
_CHAPTER: Final = "pay"  # says more of what a network is paid for
_LEAST: Final = 300.0  # points of a column
_HIGH, _PAIR, _NOW = 0.5, 0.38, 0.26  # height of a picture, of its width; of the pair and the landers, of the view
_MIDDLE, _BAR = 0.72, 0.27  # of a column's width: where bars begin, and how long they are at most, each way
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
        self.run = TasteRun(Nursery(context.user_dir))
        self.pair, self.now = Pair(), Small()
        try:
            self.run.keeps = self.run.collection.hold()
            left = self.run.unfinished
            self._begin(resume=left)
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
        panel.text(lambda: self._sentence, size=TITLE)
        panel.gap(6)
        self._row = panel.widget(PairRow(self.pair, self.answer, self._height, lambda: self._waits))
        again, back = (texts.TASTE_AGAIN, self.pair.again), (texts.TASTE_BACK, self._take_back)
        panel.words([again, back, self.unfolding(_MORE)])
        panel.gap(6)
        if self.context.settings.is_open(_MORE):
            self._describe_more(panel)
        left, right = panel.beside((1, 1), _LEAST)
        left.add(lambda cursor: cursor.caption(texts.TASTE_NOW.format(count=self._answers)))
        left.add(self._write_now)
        right.caption(texts.TASTE_BELIEVED)
        right.add(self._write_sides)
        for number, name in enumerate(SUMS):
            right.add(partial(self._write_liking, number, texts.TASTE_SUMS[name]))

    def _describe_more(self, column: Column) -> None:
        words = [
            (texts.TASTE_KEEP, self._keep),
            (texts.TASTE_ANEW, self._start_anew),
            (texts.TRAIN_RUNS, self._networks),
        ]
        column.words(words)
        column.gap(6)
        column.aside(texts.TASTE_ASSISTANTS)
        column.button(texts.LEARN[_CHAPTER]["title"], lambda: push("chapter", _CHAPTER))
        column.gap(6)

    @property
    def _answers(self) -> int:
        return self.run.asked.answers if self.run.asked else 0

    @property
    def _sentence(self) -> str:
        return self.run.problem or texts.TASTE_ASK

    @property
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

    def _write_sides(self, cursor: Cursor) -> None:
        """Write which side of the bars means what."""
        box = cursor.take(1.4 * SMALL)
        if cursor.canvas:
            for side, word in zip((-1, 1), texts.TASTE_SIDES, strict=True):
                place = cursor.left + (_MIDDLE + side * _BAR) * cursor.width, box.top + SMALL
                align: Align = "left" if side < 0 else "right"
                cursor.canvas.text(word, place, size=SMALL, colour=MUTE, align=align)

    def _write_liking(self, number: int, word: str, cursor: Cursor) -> None:
        """Draw how much of a sum is liked, to the right, or disliked, to the left, and how sure that is."""
        cursor.gap(1)
        label = cursor.column(cursor.left, (_MIDDLE - _BAR) * cursor.width - 8)
        label.styled(word, SMALL, INK)
        if (canvas := cursor.canvas) is not None:
            asked = self.run.asked
            middle, half = cursor.left + _MIDDLE * cursor.width, _BAR * cursor.width
            y = cursor.y + 0.62 * SMALL * 1.4
            canvas.line((middle, y - 7), (middle, y + 7), FAINT)
            if asked is not None and asked.answers:
                most = max(float(np.abs(asked.liking).max()), 2.0)
                liking, unsure = asked.liking[number] / most, asked.unsure[number] / most
                ends = np.clip([liking - unsure, liking + unsure], -1, 1) * half + middle
                canvas.line((ends[0], y), (ends[1], y), MUTE)
                left, right = sorted((middle, middle + half * float(liking)))
                canvas.fill(canvas.rect(left, y - 3, max(right - left, 1), 6), NET)
        cursor.y = label.y

    # Keys

    def actions(self) -> Table:
        """Answer by the arrows, unless they move from word to word."""
        answers = [
            Action(pygame.K_LEFT, partial(self.answer, FIRST), texts.TASTE_THIS, Command.LEFT),
            Action(pygame.K_DOWN, partial(self.answer, NEITHER), texts.TASTE_NEITHER, Command.DOWN),
            Action(pygame.K_RIGHT, partial(self.answer, SECOND), texts.TASTE_THAT, Command.RIGHT),
        ]
        focused, controls = self.form.focused, self.context.controls
        words = focused is not None and focused is not self._row and focused.ringed
        return [
            *((each.hint_for(controls) for each in answers) if words else answers),
            Action(pygame.K_BACKSPACE, self._take_back, gamepad=Command.HANDOVER),
            Action(Command.RETRY, self.pair.again),
            self.form.goes_back(texts.HINT_BACK),
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
        self.run.ask("take_back")

    # Events and time

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

    # The network

    def _keep(self) -> Transition:
        name = self.run.collection.free_name(texts.TASTE_NAME)
        return Push(NameDialog(self, texts.NAMING, name, self.run.save))

    def _start_anew(self) -> None:
        """Bring up another; this one is put among the player's networks, if it has learned anything."""
        problem = self.run.save(self.run.collection.free_name(texts.TASTE_NAME)) if self._answers else ""
        if problem:
            self.context.note(problem)
        else:
            self._begin()

    def _networks(self) -> Transition:
        return push("runs")
