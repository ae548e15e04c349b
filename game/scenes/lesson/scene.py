"""Lesson scene: one memory on five cards in the order of time, each with its numbers, and with its code on request."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Final

import pygame

from ai.explain.agent_lesson import Lesson
from ai.training.messages import SwarmState
from game.core import texts
from game.core.scene import Pop, Transition
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import CAPTION, INK, LINE, MUTE, NET, NIGHT0, SMALL
from game.explain.explained import Explained
from game.explain.lesson_door import LessonDoor
from game.input.controls import Command
from game.scenes.lesson.again import AgainCard
from game.scenes.lesson.card import Card, LitCode
from game.scenes.lesson.cards import parts_of
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.panel import Panel
from game.ui.panel_scene import PanelScene
from game.ui.widget import RowWidget
from game.world.swarm import LearningSwarm

_CARD: Final = 132.0  # the least width of a card, in points
_HIGH, _GAP = 54.0, 8.0
_LEAST: Final = 420.0  # width of a column, where the code stands beside the card
_DIMMED: Final = 0.86  # share by which the landers behind are dimmed


class Cards(RowWidget):
    """The cards of a lesson in a strip, each with its figure; the one that is shown is lit.

    Attributes:
        index: which one is shown.

    """

    def __init__(self, cards: Sequence[Card], index: int, choose: Callable[[int], None]) -> None:
        super().__init__((0, 0, 1, 1), texts.LESSON_TITLE)
        self._cards, self.index, self._choose = cards, index, choose
        self._boxes: list[pygame.FRect] = []

    def shift(self, direction: int) -> bool:
        """Go to the card before or after."""
        self._show(self.index + direction)
        return True

    def press(self) -> Transition | None:
        """Show the card under the mouse; without a mouse, the next one."""
        mouse = self.ui_manager.get_mouse_position()
        if self.ringed:
            self._show((self.index + 1) % len(self._cards))
        else:
            self._show(next((place for place, box in enumerate(self._boxes) if box.collidepoint(mouse)), self.index))
        return None

    def _show(self, index: int) -> None:
        index = min(max(index, 0), len(self._cards) - 1)
        if index != self.index:
            self.index = index
            self._choose(index)

    def write(self, cursor: Cursor) -> None:
        """Draw the cards, on as many lines as they need."""
        across = max(1, min(len(self._cards), int((cursor.width + _GAP) / (_CARD + _GAP))))
        across = -(-len(self._cards) // -(-len(self._cards) // across))  # lines of about as many cards
        wide, boxes = (cursor.width + _GAP) / across, []
        for place in range(len(self._cards)):
            x, y = cursor.left + place % across * wide, cursor.y + place // across * (_HIGH + _GAP)
            boxes.append(pygame.FRect(x, y, wide - _GAP, _HIGH))
        if cursor.canvas:
            for place, box in enumerate(boxes):
                self._draw_card(cursor.canvas, box, place)
        else:
            self._boxes = boxes
        cursor.y = boxes[-1].bottom

    def _draw_card(self, canvas: Canvas, box: pygame.FRect, place: int) -> None:
        card, lit = self._cards[place], place == self.index
        pointed = canvas.pointer is not None and box.collidepoint(canvas.pointer)
        if lit:
            canvas.panel(box, 0.9)
        canvas.outline(box, 8, NET if lit else MUTE if pointed else LINE)
        x, colour = box.left + 10, INK if lit else MUTE
        canvas.text(str(place + 1), (x, box.top + 22), size=CAPTION, colour=NET if lit else MUTE)
        canvas.text(card.name, (x + 15, box.top + 22), size=SMALL, colour=colour, room=box.width - 30)
        canvas.text(card.figure, (x, box.top + 43), size=SMALL, colour=colour, tabular=True, room=box.width - 20)


class LessonScene(PanelScene):
    """Lesson scene, of one memory of a run.

    Args:
        context: the shared services.
        lesson: the memory, and the step in which it was learned.
        door: where another lesson of the run is asked for; None without a run.
        landers: those of the run, which are seen behind the cards as they stood.

    Attributes:
        lesson: the lesson that is shown.
        parts: the cards with their code.
        current: number of the card that is shown.
        in_code: whether the code stands beside it.

    """

    def __init__(
        self, context: Context, lesson: Lesson, door: LessonDoor | None = None, landers: SwarmState | None = None
    ) -> None:
        super().__init__(context, self._leave)
        self.current, self.in_code = 0, False
        self.explained = Explained()
        self._door, self._landers, self._picture = door, landers, PaintCache()
        self._take(lesson)
        self.form.focus(self.cards)

    def _take(self, lesson: Lesson) -> None:
        """Take a lesson apart; the number of the card that is shown stays."""
        self.lesson, self.parts = lesson, parts_of(lesson)
        self.build()

    def reword(self) -> None:
        """Take the lesson apart anew, in the other language."""
        before = self.parts[-1].card
        self._take(self.lesson)
        now = self.parts[-1].card
        if isinstance(before, AgainCard) and isinstance(now, AgainCard):
            now.take(before.alone)  # what was tried stays

    @property
    def card(self) -> Card:
        """The card that is shown."""
        return self.parts[self.current].card

    @property
    def code(self) -> LitCode:
        return self.parts[self.current].code

    # Rows

    def describe(self, panel: Panel) -> None:
        panel.text(lambda: f"{texts.LESSON_TITLE}: {self._whose()}", colour=MUTE)
        another = [(texts.LESSON_ANOTHER, self._door.ask_another)] if self._door else []
        panel.words([*another, (texts.STEP_CODE[self.in_code], self.show_code)], SMALL)
        panel.gap(4)
        self.cards = panel.widget(Cards([part.card for part in self.parts], self.current, self.show))
        panel.gap(8)
        panel.text(lambda: self.card.sentence)
        panel.gap(8)
        left, *right = panel.beside((5, 4) if self.in_code else (1,), _LEAST, 40.0)
        self.card.describe(left)
        for column in right:
            self.code.describe(column)

    def _whose(self) -> str:
        lesson = self.lesson
        if lesson.flown is None:
            return texts.LESSON_WHEN.format(decisions=lesson.decisions)
        return texts.LESSON_WHOSE_MOMENT.format(slot=lesson.flown.slot + 1, moment=lesson.flown.decisions)

    # What can be done

    def actions(self) -> Table:
        return [
            self.form.moves,
            Action(Command.NEXT, lambda: self._turn(1), texts.LESSON_HINT_CARD),
            Action(Command.PREVIOUS, lambda: self._turn(-1)),
            Action(Command.STEP, lambda: self._turn(1)),
            self.explained.action(),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def _leave(self) -> Transition:
        if self._door:
            self._door.forget()
        return Pop()

    def _turn(self, direction: int) -> None:
        self.show(min(max(self.current + direction, 0), len(self.parts) - 1))

    def show(self, number: int) -> None:
        """Show another card."""
        if number != self.current:
            self.card.point(None)
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
            self.card.point(event.pos)
        return super().handle_event(event)

    def update(self) -> Transition | None:
        if self._door and (lesson := self._door.answer()):
            self.current = 0
            self._take(lesson)
        self.card.update(self.context.settings.reduced_motion)
        if self.card.changed:
            self.card.changed = False
            self.build()
        self.explained.update()
        return super().update()

    def draw_behind(self, canvas: Canvas, alpha: float) -> None:
        if self._landers is None:
            super().draw_behind(canvas, alpha)
        else:
            self._picture.draw(canvas, canvas.view, (), partial(self._paint_behind, self._landers))

    def _paint_behind(self, landers: SwarmState, sheet: Canvas) -> None:
        """Paint the landers as they stood, without words, and dimmed."""
        swarm = LearningSwarm(sheet.view)
        swarm.head = sheet.view.height
        swarm.take(landers)
        swarm.draw(sheet, 1.0, paused=True)
        sheet.fill(sheet.surface.get_rect(), NIGHT0, _DIMMED)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        super().draw(canvas, alpha)
        self.explained.draw(canvas)
