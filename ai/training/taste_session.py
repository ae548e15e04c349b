"""Session of an upbringing: what is asked, what is believed of the person's taste, and the landers meanwhile."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from ai.environment import Doubles, StepResult
from ai.training.history import COLUMNS
from ai.training.loop import Progress
from ai.training.messages import SwarmState
from ai.training.session import Session
from ai.training.upbringing import Question, Upbringing


@dataclass(frozen=True, eq=False)
class Asked:
    """A question, and the taste as it is known now; sent whenever one of them is another."""

    newest_only: ClassVar = True

    answers: int  # so far
    question: Question | None
    liking: Doubles  # (sums,) mean weight of each


class TasteSession(Session[Upbringing]):
    """Session of an upbringing. It is kept after every answer."""

    kind, columns = Upbringing, COLUMNS

    def __init__(self, training: Upbringing, keep: Path | None, source: Path | None) -> None:
        super().__init__(training, keep, source)
        self._asked: Question | None = None
        training.on_step = self._on_step

    def show(self) -> None:
        training = self.training
        self._asked = training.question
        liking = training.taste.weights.mean(axis=0)
        self.messages.append(Asked(len(training.taste.answers), self._asked, liking))

    def tell(self, progress: Progress) -> None:  # noqa: ARG002 - what is shown is no curve
        if self.training.question is not self._asked:
            self.show()

    def _on_step(self, result: StepResult) -> None:
        env, training = self.training.env, self.training
        position, angle = env.position.astype(np.float32), env.angle.astype(np.float32)
        actions, outcome = env.actions.astype(np.int8), result.outcome.astype(np.int8)
        self.messages.append(SwarmState(position, angle, actions, outcome, training.agent.decisions))

    def _choose(self, answers: int, answer: int) -> None:
        """Take the answer to the question after so many; one to another question is not meant."""
        if answers == len(self.training.taste.answers):
            self.training.answer(answer)
            self._changed()

    def _take_back(self) -> None:
        self.training.take_back()
        self._changed()

    def _changed(self) -> None:
        self.show()
        if self.keep is not None:
            self.keeper.move_to(self.keep)

    commands = Session.commands | {"choose": _choose, "take_back": _take_back}
