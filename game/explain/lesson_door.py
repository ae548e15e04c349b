"""Door from a training run to its lessons: of which lander, and the answer when it comes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ai.explain.agent_lesson import Lesson
from game.core import texts
from game.training.run import TrainingRun


class LessonDoor:
    """Door from a run to its lessons: one is asked for, and comes once; `note` shows a message to the player."""

    def __init__(self, run: TrainingRun, note: Callable[[str], object], rng: np.random.Generator) -> None:
        self._run, self._note, self._rng = run, note, rng
        self._shown = run.lesson
        self._asked = False

    def ask(self, slot: int | None) -> None:
        """Ask for the lesson of a lander; None for one in the air."""
        if not self._run.alive:
            self._note(texts.LESSON_NO_RUN)
            return
        self._shown, self._asked = self._run.lesson, True
        self._run.ask("explain", slot)

    def ask_another(self) -> None:
        """Ask for the lesson of any lander."""
        self.ask(int(self._rng.integers(self._run.config.num_envs)))

    def forget(self) -> None:
        """Wait for a lesson no longer."""
        self._asked = False

    def answer(self) -> Lesson | None:
        """Return the lesson that was asked for, once it has come; None before and afterwards. Call it once a frame."""
        if not self._asked:
            return None
        for note in self._run.poll():
            self._note(note)
        lesson: Lesson | None = self._run.lesson
        if lesson is None or lesson is self._shown:
            return None
        self._asked = False
        return lesson
