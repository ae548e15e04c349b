"""Environment protocol: all that an agent needs of an environment, whatever is simulated in it."""

from __future__ import annotations

from collections.abc import Generator, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Final, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

# Networks read and write Floats, physics computes in Doubles; the type checker keeps them apart.
Floats = NDArray[np.float32]
Doubles = NDArray[np.float64]
Bools = NDArray[np.bool_]
Ints = NDArray[np.intp]
T = TypeVar("T")
SUCCESS: Final = 1  # the outcome of an episode that ended well, in every environment; 0 is one that goes on


class ForeignEnvError(RuntimeError):
    """Environment that is not ours has failed, or returns what it cannot: a line that names it."""


@dataclass(frozen=True)
class StepResult:
    """Result of one decision in every slot. Unpacks as its first five fields.

    A slot that has ended stays ended, with the observation it ended in and no further reward, until it is
    reset. `components` are the parts of `reward` by name.
    """

    observation: Floats  # (num_envs, features)
    reward: Floats  # (num_envs,)
    terminated: Bools  # (num_envs,) ended by what happened in it
    truncated: Bools  # (num_envs,) ended by the clock: what comes next still has a value
    outcome: Ints  # (num_envs,)
    components: Mapping[str, Floats] = field(default_factory=dict)

    def __iter__(self) -> Iterator[Any]:
        return iter((self.observation, self.reward, self.terminated, self.truncated, self.outcome))

    @property
    def ended(self) -> Bools:
        """Whether the episode was terminated or truncated, (num_envs,)."""
        return self.terminated | self.truncated

    @property
    def succeeded(self) -> Bools:
        """Whether the episode ended well, (num_envs,)."""
        succeeded: Bools = self.outcome == SUCCESS
        return succeeded


class Env(Protocol):
    """Vectorised environment: many slots stepped together; ended slots wait for `reset(mask)`."""

    num_envs: int
    landings: int  # successes so far, whatever the environment calls them

    @property
    def stage(self) -> int:
        """Stage of the curriculum, 0 without one."""

    def reset(self, mask: Bools | None = None) -> Floats:
        """Begin a new episode in the slots of `mask`, or in all; return every slot's observation."""

    def step(self, actions: Ints) -> StepResult:
        """Take one action in every slot that has not ended."""


def finished(flying: Generator[None, None, T]) -> T:
    """Take what goes on bit by bit to its end; return what came of it."""
    while True:
        try:
            next(flying)
        except StopIteration as end:
            found: T = end.value
            return found
