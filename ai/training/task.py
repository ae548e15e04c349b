"""Task protocol: what training must know of an environment to learn, the lander or any other."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from ai.agent.symmetry import Symmetry
from ai.common.environment import Doubles, Env
from ai.files import number_of, shown
from ai.lander.pilots import Pilot
from ai.training.config import Config
from ai.training.state import State

VALIDATION_SEED = 1_000_003  # episodes that choose the best checkpoint
TEST_SEED = 2_000_003  # episodes that have no say in anything, to measure a finished network by


class Score(Protocol):
    """Score of a pilot over a number of episodes without random actions."""

    @property
    def episodes(self) -> int:
        """Number of episodes."""

    @property
    def success(self) -> float | None:
        """Share that ended well; None where the environment does not define that."""

    @property
    def mean_return(self) -> float:
        """Mean sum of rewards."""

    @property
    def figure(self) -> str:
        """Most important figure of the score, as a short text."""

    def to_json(self) -> dict[str, Any]:
        """Return the values as JSON can hold them."""

    def better_than(self, other: Any) -> bool:
        """Whether this beats another score of its kind, or None."""

    def __str__(self) -> str: ...


class Task(Protocol):
    """Environment as an agent is to learn it. Made from a Config."""

    num_features: int
    num_actions: int
    symmetry: Symmetry | None
    action_chances: Doubles | None  # (actions,) odds of random actions; None for uniform
    evaluate_every: int  # decisions
    validation_episodes: int
    test_episodes: int

    def make_env(self, rng: np.random.Generator) -> Env:
        """Make the environment to train in."""

    def apply_live(self, config: Config, env: Env) -> None:
        """Take over the live knobs of another configuration, here and in an environment that `make_env` made."""

    def update_env(self, decisions: int, env: Env) -> None:
        """Bring what changes with experience up to date in an environment that `make_env` made."""

    def env_state(self, env: Env) -> State:
        """Return all that an environment of `make_env` goes on from."""

    def restore_env(self, env: Env, state: State) -> str:
        """Let a new environment go on from what `env_state` gave; return what of it could not be restored, or "".

        Raises KeyError, TypeError, OverflowError or ValueError for what no environment can have been.
        """

    def evaluate(self, pilot: Pilot, episodes: int, seed: int) -> Score:
        """Measure a pilot over so many episodes, which follow from `seed`."""

    def read_score(self, values: dict[str, Any]) -> Score:
        """Read what a score's `to_json` gave; raises TypeError or ValueError for anything else."""


def checked_score(values: Any, may_be_none: tuple[str, ...]) -> dict[str, Any]:
    """Return the values of a score from a file; raises ValueError if they are not finite numbers by name."""
    if not isinstance(values, dict):
        raise ValueError(f"{shown(values)} is no score")
    return {
        name: value if value is None and name in may_be_none else number_of(value) for name, value in values.items()
    }
