"""Lesson scene: one memory on five cards in the order of time, each with its numbers, and with its code on request."""

from __future__ import annotations

from functools import partial
from typing import Final

import pygame

from ai.explain.agent_lesson import Lesson
from game.core import texts
from game.core.scene import Pop, Transition
from game.drawing.canvas import Canvas
from game.drawing.tokens import MUTE, SMALL
from game.explain.explained import Explained
from game.explain.lesson_door import LessonDoor
from game.input.controls import Command
from game.scenes.lesson.cards import parts_of
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.panel import Panel
from game.ui.panel_scene import PanelScene

_LEAST: Final = 420.0  # width of a column, where the code stands beside the card


class LessonScene(PanelScene):
    """Lesson scene, of one memory of a run.

    Args:
        context: the shared services.
        lesson: the memory, and the step in which it was learned.
        door: where another lesson of the run is asked for; None without a run.

    Attributes:
        lesson: the lesson that is shown.
        parts: the cards with their code.
        current: number of the card that is shown.
        in_code: whether the code stands beside it.

    """

    def __init__(self, context: Context, lesson: Lesson, door: LessonDoor | None = None) -> None:
        super().__init__(context, self._leave)
        self.current, self.in_code = 0, False
        self.explained, self._door = Explained(), door
        self._take(lesson)
        self.form.focus(self.cards)

    def _take(self, lesson: Lesson) -> None:
        """Take a lesson apart; the number of the card that is shown stays."""
        self.lesson, self.parts = lesson, parts_of(lesson)
        self.build()

    def reword(self) -> None:
        self._take(self.lesson)

    def describe(self, panel: Panel) -> None:
        part, flown = self.parts[self.current], self.lesson.flown
        whose = texts.LESSON_WHEN.format(decisions=self.lesson.decisions)
        if flown:
            whose = texts.LESSON_WHOSE_MOMENT.format(slot=flown.slot + 1, moment=flown.decisions)
        panel.text(f"{texts.LESSON_TITLE}: {whose}", colour=MUTE)
        another = [(texts.LESSON_ANOTHER, self._door.ask_another)] if self._door else []
        panel.words([*another, (texts.STEP_CODE[self.in_code], self.show_code)], SMALL)
        panel.gap(4)
        names = [f"{number}  {each.card.name}" for number, each in enumerate(self.parts, 1)]
        self.cards = panel.choice("", names, self.current, self.show)
        panel.gap(8)
        panel.text(lambda: part.card.sentence)
        panel.gap(8)
        left, *right = panel.beside((5, 4) if self.in_code else (1,), _LEAST, 40.0)
        part.card.describe(left)
        for column in right:
            part.code.describe(column)
            column.aside(texts.LESSON_SCALE.format(scale=f"{self.lesson.config.reward_scale:g}"))

    def actions(self) -> Table:
        last = self.current == len(self.parts) - 1
        return [
            self.form.moves,
            Action(Command.NEXT, partial(self._turn, 1), "" if last else texts.LESSON_HINT_CARD),
            Action(Command.PREVIOUS, partial(self._turn, -1)),
            self.explained.action(),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def _turn(self, direction: int) -> None:
        self.cards.shift(direction)

    def _leave(self) -> Transition:
        if self._door:
            self._door.forget()
        return Pop()

    def show(self, number: int) -> None:
        """Show another card."""
        self.current = number
        self.panel.scrolled = 0.0
        self.build()

    def show_code(self) -> None:
        """Show the code beside the card, or fold it again."""
        self.in_code = not self.in_code
        self.build()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        if self.explained.handle_event(event):
            return None
        if event.type == pygame.MOUSEMOTION:
            self.parts[self.current].card.point(event.pos)
        return super().handle_event(event)

    def update(self) -> Transition | None:
        if self._door and (lesson := self._door.answer()):
            self.current = 0
            self._take(lesson)
        self.parts[self.current].card.update(self.context.settings.reduced_motion)
        self.explained.update()
        return super().update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        super().draw(canvas, alpha)
        self.explained.draw(canvas)
