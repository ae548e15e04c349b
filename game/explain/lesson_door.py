"""Doors from a training run to one of its lessons: of which lander or image, and the answer when it comes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

from ai.explain.agent_lesson import Lesson
from ai.explain.digit_lesson import DigitLesson
from ai.training.lander_session import CAREFUL
from game.core import texts
from game.core.scene import Transition, push
from game.training.run import TrainingRun
from game.world.swarm import LearningSwarm

_PATIENCE: Final = 30  # frames without an answer, after which the player is told that it is being made


class Door:
    """Door from a run to its lessons: one is asked for, and comes once; `note` shows a message to the player."""

    def __init__(self, run: TrainingRun, note: Callable[[str], object]) -> None:
        self._run, self._note = run, note
        self._shown = run.lesson
        self._asked, self._waited = False, 0  # whether one was asked for, and how many frames ago

    def ask(self, slot: int, moment: int | None = None) -> None:
        """Ask for the lesson of a lander, at a moment of the run, or of an image; say so if the run is over."""
        if not self._run.alive:
            self._note(texts.LESSON_NO_RUN)
            return
        self._shown, self._asked, self._waited = self._run.lesson, True, 0
        self._run.explain(slot, moment)

    def answer(self) -> Lesson | DigitLesson | None:
        """Return the lesson that was asked for, once it has come; None before and afterwards. Call it once a frame."""
        lesson: Lesson | DigitLesson | None = self._run.lesson
        if not self._asked:
            return None
        if lesson is None or lesson is self._shown:
            self._waited += 1
            if self._waited == _PATIENCE:
                self._note(texts.LESSON_ASKED)
            return None
        self._asked = False
        return lesson


class LessonDoor(Door):
    """Door to a lander's lessons. A click on a lander chooses it, a second one opens its lesson.

    `swarm` returns the landers that are shown, and `moment` when that is, in decisions, or None for now.
    """

    def __init__(
        self,
        run: TrainingRun,
        swarm: Callable[[], LearningSwarm],
        moment: Callable[[], int | None],
        note: Callable[[str], object],
    ) -> None:
        super().__init__(run, note)
        self._swarm, self._moment = swarm, moment

    def follow(self, event: pygame.event.Event) -> bool:
        """Take a click on the swarm, in points; return whether there was a lander."""
        if event.type != pygame.MOUSEBUTTONDOWN or event.button != 1:
            return False
        swarm = self._swarm()
        slot = swarm.slot_at(event.pos)
        if slot is None:
            return False
        again, swarm.chosen = slot == swarm.chosen, slot
        if again:
            self.open()
        return True

    def open(self) -> None:
        """Ask for the lesson of the chosen lander, or of the one that explores least, at the moment that is shown."""
        chosen = self._swarm().chosen
        self.ask(CAREFUL if chosen is None else chosen, self._moment())

    def update(self) -> Transition | None:
        """Open the lesson once it has come."""
        lesson = self.answer()
        return push("lesson", lesson) if lesson else None


class ImageDoor(Door):
    """Door to the lessons of a digit run: the first image of its next batch, and from a lesson to the next image."""

    def open(self) -> None:
        """Ask for the lesson of the first image."""
        self.ask(0)

    def another(self, lesson: DigitLesson) -> None:
        """Ask for the lesson of the image after that of a lesson, or of the first one, in the batch that comes next."""
        self.ask((lesson.step.row + 1) % len(lesson.labels))

    def update(self) -> Transition | None:
        """Open the lesson once it has come; the door goes with it."""
        lesson = self.answer()
        return push("lesson", lesson, self) if lesson else None

    def next_lesson(self) -> DigitLesson | None:
        """Return the lesson of another image once it has come; only while no other scene listens to the run."""
        for note in self._run.poll():
            self._note(note)
        lesson = self.answer()
        return lesson if isinstance(lesson, DigitLesson) else None
