"""Messages of a live run, and commands to it. All of them can be pickled."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ai.common.environment import Floats
from ai.explain.agent_lesson import Lesson
from ai.training.config import Config
from ai.training.edits import EditCommand, NetworkEdits
from ai.training.history import Checkpoint, Point, SettingChange, Validation
from ai.training.schedule import InForce


@dataclass(frozen=True)
class RunStarted:
    """First message of a run: its settings; of a resumed run, those it was begun with."""

    config: Config
    seed: int
    decisions: int  # so far; 0 for a new run


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
    """Command to explain the learning step that follows from a lander's latest memory; a Lesson is the answer.

    `decisions` of the run name a moment in the past, of which the nearest that was kept is taken; None is now.
    """

    slot: int
    decisions: int | None = None


@dataclass(frozen=True)
class Saved:
    """Result of a save; no problem means that it is on the disk, whole."""

    folder: Path
    problem: str = ""


@dataclass(frozen=True)
class Refused:
    """Refusal of a command that could not be carried out, and why. Nothing has changed."""

    command: Any
    problem: str


def problem_of(error: Exception) -> str:
    """Return an error in the words of a message: those of the system for a file, else its own."""
    return getattr(error, "strerror", None) or str(error)


Message = (
    RunStarted
    | SwarmState
    | NetworkState
    | InForce
    | Point
    | Checkpoint
    | Validation
    | SettingChange
    | Saved
    | Refused
    | Lesson
    | NetworkEdits
)
Command = ChangeSetting | Save | AutosaveTo | RestoreCheckpoint | AddDemonstrations | Explain | EditCommand
