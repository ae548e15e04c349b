"""Messages of a session, and commands to it; entries of the history are messages too. All of them can be pickled.

A command is a tuple of its name and what it takes; the session of a kind has a method for each in `Session.commands`.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Final, Self

import numpy as np
from numpy.typing import NDArray

from ai.environment import Floats
from ai.explain.agent_lesson import Lesson
from ai.lander.environment import LanderEnv

Command = tuple[Any, ...]
DIVERGED: Final = "not finite"  # what a run says of its network that ended so


@dataclass(frozen=True)
class RunStarted:
    """First message of a run: its settings; of a resumed run, those it was begun with."""

    config: Any
    seed: int
    decisions: int  # so far, or learning steps of digits; 0 for a new run
    lost: str = ""  # what could not be restored of a run that goes on, in words
    steps: int | None = None  # there will be in all; None for a run without end


@dataclass(frozen=True, eq=False)
class SwarmState:
    """Poses and outcomes of all landers after one decision, before ended flights begin anew."""

    newest_only: ClassVar = True

    position: NDArray[np.float32]  # (n, 2) metres, centre of mass
    angle: NDArray[np.float32]  # (n,) radians
    action: NDArray[np.int8]  # (n,) as flown in this decision
    outcome: NDArray[np.int8]  # (n,) of ai.lander.environment.Outcome
    decisions: int

    @classmethod
    def of(cls, env: LanderEnv, decisions: int) -> Self:
        """Return the landers of an environment as they are."""
        position, angle = env.position.astype(np.float32), env.angle.astype(np.float32)
        return cls(position, angle, env.actions.astype(np.int8), env.outcome.astype(np.int8), decisions)


@dataclass(frozen=True, eq=False)
class NetworkState:
    """Parameters and gradients of the network that learns, sent a few times a second."""

    newest_only: ClassVar = True

    values: Floats  # (parameters,) float32 of the online network
    gradients: Floats  # (parameters,) of its last learning step
    observation: Floats  # (9,) what the lander in slot CAREFUL senses now
    decisions: int


@dataclass(frozen=True)
class FirstLanding:
    """The lesson of the first landing of a new run from which its network can learn."""

    lesson: Lesson


@dataclass(frozen=True)
class Saved:
    """Result of a save; no problem means that it is on the disk, whole."""

    folder: Path
    problem: str = ""
    test: float | None = None  # accuracy on the test images, of digits that have been measured
    epoch: int | None = None  # after which their network that is kept was best; None if it is the last one


@dataclass(frozen=True)
class Refused:
    """Refusal of a command that could not be carried out, and why. Nothing has changed."""

    command: Command
    problem: str
