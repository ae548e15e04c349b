"""Messages of a session, and commands to it; entries of the history are messages too. All of them can be pickled."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ai.environment import Floats


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
    earned: NDArray[np.float32]  # (n,) what the flight has earned so far
    decisions: int


@dataclass(frozen=True, eq=False)
class NetworkState:
    """Parameters and gradients of the network that learns, sent a few times a second."""

    newest_only: ClassVar = True

    values: Floats  # (parameters,) float32 of the online network
    gradients: Floats  # (parameters,) of its last learning step
    observation: Floats  # (9,) what the lander in slot CAREFUL senses now
    decisions: int


@dataclass(frozen=True)
class ChangeSetting:
    """Command to turn a live knob, by its field's name in Config; "reward_weights.time" is a part of the reward."""

    name: str
    value: Any


@dataclass(frozen=True)
class Finish:
    """Command to take no more steps: keep the run, measure it, and end."""


@dataclass(frozen=True)
class Save:
    """Command to save the run, as it is now, to a folder."""

    folder: Path


@dataclass(frozen=True)
class AutosaveTo:
    """Command to save the run by itself to this folder from now on."""

    folder: Path


@dataclass(frozen=True)
class RestoreCheckpoint:
    """Command to restore the networks from a checkpoint of the history; time does not go back."""

    decisions: int


@dataclass(frozen=True)
class AddDemonstrations:
    """Command to learn from the demonstrations in a file as well, as far as this run has not done so yet."""

    path: Path


@dataclass(frozen=True)
class Explain:
    """Command to explain a learning step: the one that follows from a lander's latest memory; a Lesson is the answer.

    `decisions` of the run name a moment in the past, of which the nearest that was kept is taken; None is now. Of
    digits, the next step around the image in row `slot` of its batch; a DigitLesson is the answer.
    """

    slot: int = 0
    decisions: int | None = None


@dataclass(frozen=True)
class RestoreBest:
    """Command to restore the digit network that read the images held out best."""


@dataclass(frozen=True)
class Saved:
    """Result of a save; no problem means that it is on the disk, whole.

    Attributes:
        test: accuracy on the test images, of digits that have been measured.
        epoch: the epoch after which their network that is kept was best; None if it is the last one.

    """

    folder: Path
    problem: str = ""
    test: float | None = None
    epoch: int | None = None


@dataclass(frozen=True)
class Refused:
    """Refusal of a command that could not be carried out, and why. Nothing has changed."""

    command: Any
    problem: str


def problem_of(error: Exception) -> str:
    """Return an error in the words of a message: those of the system for a file, else its own."""
    return getattr(error, "strerror", None) or str(error)
