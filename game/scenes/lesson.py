"""Lesson scene: one learning step as a strip of frames, each beside the code that does it."""

from __future__ import annotations

from typing import Final

import pygame

from ai.explain.agent_lesson import Lesson
from ai.explain.digit_lesson import DigitLesson
from game.core import texts
from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import INK, MUTE, NIGHT0, SMALL, TEXT, TITLE
from game.input.controls import Command
from game.lesson.agent_frames import agent_frames
from game.lesson.code import CODE, CodeWalk
from game.lesson.digit_frames import digit_frames
from game.lesson.frame import PICTURE, Frame
from game.lesson.strip import STRIP, FilmStrip
from game.panels.lesson_door import ImageDoor
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FormScene
from game.ui.hints import Hint, HintRow
from game.ui.virtual_pointer import VirtualPointer

_LEFT: Final = 40.0
_SENTENCE: Final = 166.0
_REACH: Final = STRIP.unionall([PICTURE, CODE])  # of the pointer that keys move


class LessonScene(FormScene):
    """Lesson scene, of a learning step of the agent or of a digit network.

    With the door to a digit network's run, the lessons of other images of the batch can be had.

    Attributes:
        lesson: the learning step.
        parts: the frames with their code.
        current: number of the frame that is shown large.

    """

    def __init__(self, context: Context, lesson: Lesson | DigitLesson, door: ImageDoor | None = None) -> None:
        super().__init__(context)
        self._door = door
        self.current = 0
        self._take(lesson)
        self.pointer = self.form.add(VirtualPointer(self.form.manager, _REACH, self._point, hold=texts.LESSON_PRESS))

    def _take(self, lesson: Lesson | DigitLesson) -> None:
        """Take a lesson apart; the number of the frame that is shown stays."""
        self.lesson = lesson
        self.parts = agent_frames(lesson) if isinstance(lesson, Lesson) else digit_frames(lesson)
        self.strip = FilmStrip([part.frame for part in self.parts])

    @property
    def frame(self) -> Frame:
        """The frame that is shown large."""
        return self.parts[self.current].frame

    @property
    def code(self) -> CodeWalk:
        """The walk through the code beside it."""
        return self.parts[self.current].code

    def actions(self) -> Table:
        """Go from frame to frame, and from line to line; point at numbers; see another image; go back."""
        controls = self.context.controls
        another = [Action(Command.RETRY, self._another, texts.LESSON_ANOTHER_IMAGE)] if self._door else []
        return [
            Hint(controls.arrows_aside, texts.LESSON_HINT_FRAME),
            Hint(controls.arrows, texts.LESSON_HINT_LINE),
            self.form.confirms(texts.LESSON_HINT_POINT),
            *another,
            Action(Command.LEFT, lambda: self.go(-1)),
            Action(Command.RIGHT, lambda: self.go(1)),
            Action(Command.PREVIOUS, lambda: self.go(-1)),
            Action(Command.NEXT, lambda: self.go(1)),
            Action(Command.STEP, lambda: self.go(1)),
            Action(Command.UP, lambda: self.code.step(-1)),
            Action(Command.DOWN, lambda: self.code.step(1)),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def _another(self) -> None:
        """Ask for the lesson of the next image of the batch."""
        if self._door and isinstance(self.lesson, DigitLesson):
            self._door.another(self.lesson)

    def go(self, direction: int) -> None:
        """Go to the frame before or after."""
        self.show(min(max(self.current + direction, 0), len(self.parts) - 1))

    def show(self, number: int) -> None:
        """Show a frame large."""
        if number != self.current:
            self.frame.follow(None)
            self.code.follow(None)
            self.current = number
            self.context.sound.play("move")

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Follow the mouse; a click goes to a frame, or picks what it points at."""
        if event.type == pygame.MOUSEBUTTONDOWN or (event.type == pygame.MOUSEMOTION and not self.form.typing):
            self._point(event)  # a click counts also while keys move a pointer
        if event.type == pygame.MOUSEWHEEL:
            self.code.step(-event.y)
            return None
        return super().handle_event(event)

    def _point(self, event: pygame.event.Event) -> None:
        """Follow the mouse or the pointer that keys move; an event's position is in points."""
        if event.type == pygame.MOUSEMOTION:
            self.frame.follow(event.pos)
            self.code.follow(event.pos)
        elif event.type == pygame.MOUSEBUTTONDOWN and event.button == 1:
            number = self.strip.at(event.pos)
            if number is not None:
                self.show(number)
            elif self.frame.press(event.pos):
                self.frame.follow(event.pos)
                self.context.sound.play("choose")

    def update(self) -> Transition | None:
        """Let gradients flow; take apart the lesson of another image once it has come."""
        if self._door and (lesson := self._door.next_lesson()):
            self._take(lesson)
        self.frame.update(self.context.settings.reduced_motion)
        return super().update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the strip, the current frame, its code, and the explanation of what is pointed at."""
        canvas.surface.fill(NIGHT0)
        canvas.text(texts.LESSON_TITLE, (_LEFT, 40), size=TITLE)
        canvas.text(self._whose(), (STRIP.right, 40), size=SMALL, colour=MUTE, align="right", tabular=True, room=900)
        self.strip.draw(canvas, self.current)
        draw_wrapped(canvas, self.frame.sentence, (_LEFT, _SENTENCE), STRIP.width, size=TEXT, colour=INK, leading=22,
                     most=2)  # fmt: skip
        self.code.draw(canvas)
        self.frame.draw(canvas)
        self.frame.draw_explanation(canvas)
        self.code.draw_explanation(canvas)
        if self.pointer.typing:
            self.form.draw(canvas)
        self.draw_hints(canvas)

    def _whose(self) -> str:
        lesson = self.lesson
        if isinstance(lesson, DigitLesson):
            digit = int(lesson.labels[lesson.step.row])
            return texts.LESSON_DIGIT_WHEN.format(digit=digit, step=lesson.taken + 1)
        if lesson.flown is None:
            return texts.LESSON_WHEN.format(decisions=lesson.decisions)
        return texts.LESSON_WHOSE_MOMENT.format(
            slot=lesson.flown.slot + 1, moment=lesson.flown.decisions, decisions=lesson.decisions
        )

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints at the foot."""
        return [HintRow(self.hints, (_LEFT, 698), room=STRIP.width)]
