"""Door from a training run to one of its lessons: which lander and which moment, and the answer when it comes."""

from __future__ import annotations

from collections.abc import Callable

import pygame

from ai.training.session import CAREFUL
from game.core import texts
from game.core.scene import Transition, push
from game.training.lander_run import LanderRun
from game.world.swarm import LearningSwarm


class LessonDoor:
    """Door from a run to its lessons. A click on a lander chooses it, a second one opens its lesson.

    `swarm` returns the landers that are shown, and `moment` when that is, in decisions, or None for now; `note` shows a
    message to the player.
    """

    def __init__(
        self,
        run: LanderRun,
        swarm: Callable[[], LearningSwarm],
        moment: Callable[[], int | None],
        note: Callable[[str], object],
    ) -> None:
        self._run, self._swarm, self._moment, self._note = run, swarm, moment, note
        self._shown = run.lesson
        self._asked = False

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
        if not self._run.alive:
            self._note(texts.LESSON_NO_RUN)
            return
        self._shown, self._asked = self._run.lesson, True
        self._note(texts.LESSON_ASKED)
        chosen = self._swarm().chosen
        self._run.explain(CAREFUL if chosen is None else chosen, self._moment())

    def update(self) -> Transition | None:
        """Open the lesson once it has come."""
        lesson = self._run.lesson
        if not self._asked or lesson is None or lesson is self._shown:
            return None
        self._asked = False
        return push("lesson", lesson)
