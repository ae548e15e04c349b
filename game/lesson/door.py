"""Door from a training run to one of its lessons: which lander and which moment, and the answer when it comes."""

from __future__ import annotations

from collections.abc import Callable

import pygame

from ai.training.history import Checkpoint
from ai.training.session import CAREFUL
from game.core import texts
from game.core.scene import Transition, push
from game.core.worker import WorkerState
from game.training.lander_run import LanderRun
from game.world.swarm import LearningSwarm


class LessonDoor:
    """Door from a run to its lessons. A click on a lander chooses it, a second one opens its lesson.

    `note` shows a message to the player; `checkpoint` returns the one that is marked on the charts, if any.
    """

    def __init__(
        self,
        run: LanderRun,
        swarm: LearningSwarm,
        note: Callable[[str], object],
        checkpoint: Callable[[], Checkpoint | None],
    ) -> None:
        self._run, self._swarm, self._note, self._checkpoint = run, swarm, note, checkpoint
        self._set_aside: Checkpoint | None = None  # a mark that was there before the player turned to the swarm
        self._stepped = 0  # decisions of the run when it was last seen standing still
        self._shown = run.lesson
        self._asked = False

    def follow(self, event: pygame.event.Event) -> bool:
        """Take a click on the swarm, in points; return whether there was a lander."""
        if event.type != pygame.MOUSEBUTTONDOWN or event.button != 1:
            return False
        slot = self._swarm.slot_at(event.pos)
        if slot is None:
            return False
        again, self._swarm.chosen = slot == self._swarm.chosen, slot
        self._set_aside = self._checkpoint()
        if again:
            self.open()
        return True

    def open(self) -> None:
        """Ask for the lesson of the chosen lander, or of the one that explores least.

        The moment is that of the checkpoint that is marked, or of the swarm that is shown, or now.
        """
        if not self._run.alive:
            self._note(texts.LESSON_NO_RUN)
            return
        self._shown, self._asked = self._run.lesson, True
        self._note(texts.LESSON_ASKED)
        self._run.explain(CAREFUL if self._swarm.chosen is None else self._swarm.chosen, self._moment)

    @property
    def _moment(self) -> int | None:
        """The moment that is meant, by the decisions of the run; None for now."""
        checkpoint, state, shown = self._checkpoint(), self._run.swarm_state, self._swarm.swarm_state
        if checkpoint is not None and checkpoint is not self._set_aside:
            return checkpoint.decisions
        past = state is not None and shown is not None and shown.decisions < state.decisions
        return shown.decisions if past and shown is not None else None

    def update(self) -> Transition | None:
        """Open the lesson once it has come."""
        state = self._run.swarm_state
        if state is not None and self._run.state is WorkerState.PAUSED and state.decisions != self._stepped:
            self._stepped, self._set_aside = state.decisions, self._checkpoint()  # a step was taken: now is meant
        lesson = self._run.lesson
        if not self._asked or lesson is None or lesson is self._shown:
            return None
        self._asked = False
        return push("lesson", lesson)
