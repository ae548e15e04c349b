"""Door from a training run to one of its lessons: of which lander or image, and the answer when it comes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from ai.explain.agent_lesson import Lesson
from ai.explain.digit_lesson import DigitLesson
from game.core import texts
from game.core.scene import Transition, push
from game.training.run import TrainingRun

_PATIENCE: Final = 30  # frames without an answer, after which a message says that it is being made


class LessonDoor:
    """Door from a run to its lessons: one is asked for, and comes once; `note` shows a message to the player."""

    def __init__(self, run: TrainingRun, note: Callable[[str], object]) -> None:
        self._run, self._note = run, note
        self._shown = run.lesson
        self._asked, self._waited = False, 0  # whether one was asked for, and how many frames ago

    def ask(self, slot: int = 0, moment: int | None = None) -> None:
        """Ask for the lesson of a lander, at a moment of the run, or of an image of the next batch."""
        if not self._run.alive:
            self._note(texts.LESSON_NO_RUN)
            return
        self._shown, self._asked, self._waited = self._run.lesson, True, 0
        self._run.ask("explain", slot, moment)

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

    def update(self) -> Transition | None:
        """Open the lesson once it has come; with one of an image goes the door, to those of other images."""
        lesson = self.answer()
        return push("lesson", lesson, self if isinstance(lesson, DigitLesson) else None) if lesson else None

    def another(self, lesson: DigitLesson) -> None:
        """Ask for the lesson of the image after that of a lesson, or of the first one, in the batch that comes next."""
        self.ask((lesson.step.row + 1) % len(lesson.labels))

    def next_lesson(self) -> DigitLesson | None:
        """Return the lesson of another image once it has come; only while no other scene listens to the run."""
        for note in self._run.poll():
            self._note(note)
        lesson = self.answer()
        return lesson if isinstance(lesson, DigitLesson) else None
