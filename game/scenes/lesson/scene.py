"""Lesson scene: one learning step as a strip of frames, each with its numbers, and with its code on request."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import pygame

from ai.explain.agent_lesson import Lesson
from game.core import texts
from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import CAPTION, INK, LINE, MUTE, NET, SMALL
from game.explain.explained import Explained
from game.input.controls import Command
from game.scenes.lesson.alone import AloneFrame
from game.scenes.lesson.frame import Frame, LitCode
from game.scenes.lesson.frames import parts_of
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.panel import Panel
from game.ui.panel_scene import PanelScene
from game.ui.widget import RowWidget

_CARD: Final = 132.0  # the least width of a card, in points
_HIGH, _GAP = 54.0, 8.0
_LEAST: Final = 420.0  # width of a column, where the code stands beside the frame


class Cards(RowWidget):
    """A card for each frame of a lesson, with its figure; the one that is shown is lit.

    Attributes:
        index: which frame is shown.

    """

    def __init__(self, frames: Sequence[Frame], index: int, choose: Callable[[int], None]) -> None:
        super().__init__((0, 0, 1, 1), texts.LESSON_TITLE)
        self._frames, self.index, self._choose = frames, index, choose
        self._boxes: list[pygame.FRect] = []

    def shift(self, direction: int) -> bool:
        """Go to the frame before or after."""
        self._show(self.index + direction)
        return True

    def press(self) -> Transition | None:
        """Show the frame whose card is under the mouse; without a mouse, the next one."""
        mouse = self.ui_manager.get_mouse_position()
        if self.ringed:
            self._show((self.index + 1) % len(self._frames))
        else:
            self._show(next((place for place, box in enumerate(self._boxes) if box.collidepoint(mouse)), self.index))
        return None

    def _show(self, index: int) -> None:
        index = min(max(index, 0), len(self._frames) - 1)
        if index != self.index:
            self.index = index
            self._choose(index)

    def write(self, cursor: Cursor) -> None:
        """Draw the cards, on as many lines as they need."""
        across = max(1, min(len(self._frames), int((cursor.width + _GAP) / (_CARD + _GAP))))
        across = -(-len(self._frames) // -(-len(self._frames) // across))  # lines of about as many cards
        wide, boxes = (cursor.width + _GAP) / across, []
        for place in range(len(self._frames)):
            x, y = cursor.left + place % across * wide, cursor.y + place // across * (_HIGH + _GAP)
            boxes.append(pygame.FRect(x, y, wide - _GAP, _HIGH))
        if cursor.canvas:
            for place, box in enumerate(boxes):
                self._draw_card(cursor.canvas, box, place)
        else:
            self._boxes = boxes
        cursor.y = boxes[-1].bottom

    def _draw_card(self, canvas: Canvas, box: pygame.FRect, place: int) -> None:
        frame, lit = self._frames[place], place == self.index
        pointed = canvas.pointer is not None and box.collidepoint(canvas.pointer)
        if lit:
            canvas.panel(box, 0.9)
        canvas.outline(box, 8, NET if lit else MUTE if pointed else LINE)
        x, colour = box.left + 10, INK if lit else MUTE
        canvas.text(str(place + 1), (x, box.top + 22), size=CAPTION, colour=NET if lit else MUTE)
        canvas.text(frame.name, (x + 15, box.top + 22), size=SMALL, colour=colour, room=box.width - 30)
        canvas.text(frame.figure, (x, box.top + 43), size=SMALL, colour=colour, tabular=True, room=box.width - 20)


class LessonScene(PanelScene):
    """Lesson scene, of a learning step of the agent.

    Attributes:
        lesson: the learning step.
        parts: the frames with their code.
        current: number of the frame that is shown.
        in_code: whether the code stands beside it.

    """

    def __init__(self, context: Context, lesson: Lesson) -> None:
        super().__init__(context)
        self.current, self.in_code = 0, False
        self.explained = Explained()
        self._take(lesson)

    def _take(self, lesson: Lesson) -> None:
        """Take a lesson apart; the number of the frame that is shown stays."""
        self.lesson, self.parts = lesson, parts_of(lesson)
        self.build()

    def reword(self) -> None:
        """Take the lesson apart anew, in the other language."""
        before = self.parts[0].frame
        self._take(self.lesson)
        if isinstance(before, AloneFrame) and isinstance(now := self.parts[0].frame, AloneFrame):
            now.alone = before.alone  # what was tried stays

    @property
    def frame(self) -> Frame:
        """The frame that is shown."""
        return self.parts[self.current].frame

    @property
    def code(self) -> LitCode:
        return self.parts[self.current].code

    # Rows

    def describe(self, panel: Panel) -> None:
        panel.text(lambda: f"{texts.LESSON_TITLE}: {self._whose()}", colour=MUTE)
        frames = [part.frame for part in self.parts]
        self.cards = panel.widget(Cards(frames, self.current, self.show))
        panel.gap(8)
        panel.text(self.frame.sentence)
        panel.gap(8)
        left, *right = panel.beside((5, 4) if self.in_code else (1,), _LEAST, 40.0)
        self.frame.describe(left)
        for column in right:
            self.code.describe(column)

    def _whose(self) -> str:
        lesson = self.lesson
        if lesson.flown is None:
            return texts.LESSON_WHEN.format(decisions=lesson.decisions)
        return texts.LESSON_WHOSE_MOMENT.format(
            slot=lesson.flown.slot + 1, moment=lesson.flown.decisions, decisions=lesson.decisions
        )

    # What can be done

    def actions(self) -> Table:
        return [
            self.form.moves,
            Action(Command.NEXT, lambda: self._turn(1), texts.LESSON_HINT_FRAME),
            Action(Command.PREVIOUS, lambda: self._turn(-1)),
            Action(Command.STEP, lambda: self._turn(1)),
            Action(Command.CHOICES, self.show_code, texts.STEP_CODE[self.in_code], gamepad=Command.MODE),
            self.explained.action(),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def _turn(self, direction: int) -> None:
        self.show(min(max(self.current + direction, 0), len(self.parts) - 1))

    def show(self, number: int) -> None:
        """Show another frame."""
        if number != self.current:
            self.frame.point(None)
            self.current = number
            self.panel.scrolled = 0.0
            self.build()

    def show_code(self) -> None:
        """Show the code beside the frame, or fold it again."""
        self.in_code = not self.in_code
        self.build()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        if self.explained.handle_event(event):
            return None
        if event.type == pygame.MOUSEMOTION:
            self.frame.point(event.pos)
        return super().handle_event(event)

    def update(self) -> Transition | None:
        self.frame.update(self.context.settings.reduced_motion)
        if self.frame.changed:
            self.frame.changed = False
            self.build()
        self.explained.update()
        return super().update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        super().draw(canvas, alpha)
        self.explained.draw(canvas)
