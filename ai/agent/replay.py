"""Experience replay: transitions kept in arrays and sampled at random."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ai.agent.config import AgentConfig
from ai.environment import Doubles, Floats, Ints
from ai.files.reading import array_like

BLOCK: Final = 16  # priorities that have one sum


class Transition(NamedTuple):
    """One transition, or a batch of them stacked field by field.

    With n-step returns, `reward` is the discounted sum over `steps` decisions and `next_state` what came after
    them. `terminal` means that nothing comes after; a flight ended by the clock is not terminal.
    """

    state: Any  # (features,) or (n, features) float32
    next_state: Any
    action: Any  # () or (n,)
    reward: Any
    terminal: Any
    steps: Any = 1


MemoryCell = Transition  # as the first description of this project calls it


class ReplayBuffer:
    """Replay buffer of the last `capacity` transitions. When it is full, the oldest `prune` are dropped at once.

    It is a ring: the `size` transitions that are kept lie at rows `start`, `start` + 1 and so on, modulo the capacity.
    Drawing is uniform, with replacement (Lin 1992). Raises ValueError for a `prune` outside 1 to `capacity`.

    Attributes:
        transitions: all rows as views, each (capacity, ...).
        added: how many were ever added, dropped ones included.
        importance: exponent of the importance-sampling weights, without effect where drawing is uniform.

    """

    def __init__(self, capacity: int, num_features: int, prune: int = 1) -> None:
        if not 1 <= prune <= capacity:
            raise ValueError(f"prune must lie between 1 and the capacity of {capacity}, not {prune}")
        self.capacity, self.prune = capacity, prune
        # One record for each transition: drawing one from a memory larger than the cache waits for it once.
        fields = [
            ("state", np.float32, num_features),
            ("next_state", np.float32, num_features),
            ("action", np.int32),
            ("reward", np.float32),
            ("terminal", bool),
            ("steps", np.int32),
        ]
        self.records = np.zeros(capacity, np.dtype(fields, align=True))
        self.transitions = _fields(self.records)
        self.start = self.size = self.added = 0
        self.importance = 0.0

    def __len__(self) -> int:
        return self.size

    def add(self, transitions: Transition) -> Ints:
        """Keep a batch of n transitions, oldest first, and return the rows where they lie, (n,)."""
        self.added += len(transitions.action)
        new = np.empty(len(transitions.action), self.records.dtype)
        for name, part in zip(Transition._fields, transitions, strict=True):
            new[name] = part
        new = new[-self.capacity :]
        over = self.size + len(new) - self.capacity
        if over > 0:
            self._drop(min(self.size, max(self.prune, over)))
        rows = (self.start + self.size + np.arange(len(new))) % self.capacity
        self.records[rows] = new
        self.size += len(new)
        return rows

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Transition, Ints, Floats]:
        """Draw `count` transitions; return them, the rows where they lie, and their weights in the cost, (count,)."""
        rows = (rng.integers(self.size, size=count) + self.start) % self.capacity
        return self.at(rows), rows, np.ones(count, dtype=np.float32)

    def at(self, rows: Ints) -> Transition:
        """Return copies of the transitions that lie at `rows`, stacked."""
        return _fields(self.records.take(rows))

    def update_priorities(self, rows: Ints, errors: Floats) -> None:
        """Take the errors (n,) of the transitions at `rows` as their priorities; without effect in uniform replay."""

    def state(self, most: int) -> dict[str, NDArray[Any]]:
        """Return copies of the newest transitions, at most so many, oldest first: each field by its name."""
        return self.at(self.newest(most))._asdict()

    def load_state(self, state: Mapping[str, NDArray[Any]], num_actions: int) -> None:
        """Fill an empty buffer with what `state` returned.

        Raises KeyError, TypeError or ValueError for what no buffer of an agent with so many actions can have had.
        """
        count, given = len(state["action"]), {}
        for name, part in self.transitions._asdict().items():
            given[name] = array_like(np.empty((count, *part.shape[1:]), part.dtype), state[name], name)
        if count > self.capacity or ((given["action"] < 0) | (given["action"] >= num_actions)).any():
            raise ValueError("the memory is of another agent")
        self.add(Transition(**given))

    def clear(self) -> None:
        """Forget all transitions."""
        self._drop(self.size)

    def newest(self, most: int) -> Ints:
        """Return the rows of the newest transitions, at most so many, oldest first."""
        return (self.start + np.arange(max(0, self.size - most), self.size)) % self.capacity

    def _drop(self, count: int) -> None:
        """Forget the oldest."""
        self.start = (self.start + count) % self.capacity
        self.size -= count


def _fields(records: NDArray[np.void]) -> Transition:
    """Return the fields of records as views."""
    return Transition(*(records[name] for name in Transition._fields))


class PrioritisedReplayBuffer(ReplayBuffer):
    """Prioritised replay (Schaul et al. 2016): transition i is drawn with the chance Pᵢ = pᵢ / Σ p.

    Its priority is pᵢ = (|error| + 0.001)^α, with α the `exponent`; a new one gets the `largest` seen, so that it is
    drawn soon. What is drawn more often than others counts less, by the weight (size · Pᵢ)^-β, with β the `importance`,
    which the agent raises towards 1.

    Where the paper has a binary tree of sums, rows lie in blocks of `BLOCK` with one sum each: a draw finds its block
    in the running sum of those, then its row in the running sum of the block. NumPy pays per call, so two levels are
    quicker than twenty.
    """

    def __init__(
        self, capacity: int, num_features: int, prune: int = 1, exponent: float = 0.6, importance: float = 0.4
    ) -> None:
        super().__init__(capacity, num_features, prune)
        self.exponent, self.importance, self.largest = exponent, importance, 1.0
        self._blocks: Doubles = np.zeros((-(-capacity // BLOCK), BLOCK))
        self._sums: Doubles = np.zeros(len(self._blocks))
        self.priorities = self._blocks.reshape(-1)[:capacity]  # a view, to read; 0 where nothing lies

    def add(self, transitions: Transition) -> Ints:
        """Keep a batch of n transitions, oldest first, and return the rows where they lie, (n,)."""
        rows = super().add(transitions)
        self._prioritise(rows, self.largest)
        return rows

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Transition, Ints, Floats]:
        """Draw `count` transitions; return them, the rows where they lie, and their weights in the cost, (count,).

        There is one draw from each of `count` equal parts of the sum of all priorities: less noise than independent
        draws. Weights are relative to the largest of them.
        """
        reached = self._sums.cumsum()
        draws = (np.arange(1, count + 1) - rng.random(count)) / count * reached[-1]  # above 0: no empty row is found
        block = reached.searchsorted(draws)
        within = self._blocks[block].cumsum(axis=1)
        rest = draws - (reached[block] - self._sums[block])
        rest = np.clip(rest, np.finfo(float).tiny, within[:, -1])  # where rounding would lead out of the block
        rows = block * BLOCK + (within < rest[:, None]).sum(axis=1)
        rng.shuffle(rows)
        weights = (self.priorities[rows] / reached[-1] * self.size) ** -self.importance
        return self.at(rows), rows, (weights / weights.max()).astype(np.float32)

    def update_priorities(self, rows: Ints, errors: Floats) -> None:
        """Set the priorities of the transitions at `rows` by their errors (n,); of a row twice, the last counts."""
        priorities = (np.abs(errors).astype(float) + 1e-3) ** self.exponent
        self.largest = max(self.largest, float(priorities.max()))
        self._prioritise(rows, priorities)

    def _prioritise(self, rows: Ints, priorities: Doubles | float) -> None:
        self.priorities[rows] = priorities
        blocks = rows // BLOCK
        self._sums[blocks] = self._blocks[blocks].sum(axis=1)

    def state(self, most: int) -> dict[str, NDArray[Any]]:
        """Return copies of the newest transitions, with their priorities."""
        return super().state(most) | {"priorities": self.priorities[self.newest(most)]}

    def load_state(self, state: Mapping[str, NDArray[Any]], num_actions: int) -> None:
        """Fill an empty buffer with what `state` returned; raises as that of every buffer."""
        super().load_state(state, num_actions)
        priorities = array_like(np.empty(self.size), state["priorities"], "priorities")
        if (priorities <= 0).any():
            raise ValueError("priorities are above 0")
        self._prioritise(self.newest(self.size), priorities)
        self.largest = max(self.largest, float(priorities.max(initial=0.0)))

    def _drop(self, count: int) -> None:
        self._prioritise((self.start + np.arange(count)) % self.capacity, 0.0)
        super()._drop(count)


def make_replay(config: AgentConfig, num_features: int) -> ReplayBuffer:
    """Make the empty replay buffer of a configuration, for observations of so many features.

    Raises ValueError for one that is larger than this machine's memory.
    """
    size = config.replay_size * (8 * num_features + 16)
    if size > _memory():  # a system may promise more than it has, and end the process when it is used
        raise ValueError(
            f"replay_size: {config.replay_size:,} memories of {num_features:,} numbers each take {size / 1e9:,.1f} GB, "
            f"and this machine has {_memory() / 1e9:,.1f}"
        )
    sizes = config.replay_size, num_features, config.replay_prune
    if config.prioritised:
        return PrioritisedReplayBuffer(*sizes, config.priority_exponent, config.importance_exponent)
    return ReplayBuffer(*sizes)


def _memory() -> float:
    """Return how many bytes of memory this machine has; endless where it does not say."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return float("inf")
