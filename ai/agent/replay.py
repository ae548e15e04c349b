"""Experience replay: transitions kept in arrays and sampled at random."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ai.agent.config import AgentConfig
from ai.environment import Doubles, Floats, Ints


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

    Drawing is uniform, with replacement (Lin 1992). Raises ValueError for a `prune` outside 1 to `capacity`.

    Attributes:
        transitions: as views, each (capacity, ...), in no particular order.
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
        self.start = 0  # where the oldest lies
        self.size = 0
        self.added = 0  # ever, dropped ones included
        self.importance = 0.0

    def __len__(self) -> int:
        return self.size

    def add(self, transitions: Transition) -> Ints:
        """Keep a batch of n transitions, oldest first, and return where they lie, (n,)."""
        self.added += len(transitions.action)
        new = np.empty(len(transitions.action), self.records.dtype)
        for name, part in zip(Transition._fields, transitions, strict=True):
            new[name] = part
        new = new[-self.capacity :]
        count = len(new)
        if self.size + count > self.capacity:
            self._drop(min(self.size, max(self.prune, self.size + count - self.capacity)))
        rows = (self.start + self.size + np.arange(count)) % self.capacity
        self.records[rows] = new
        self.size += count
        return rows

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Transition, Ints, Floats]:
        """Draw `count` transitions; return them, the rows where they lie, and their weights in the cost, (count,)."""
        rows = rng.integers(self.size, size=count)
        rows += self.start
        rows %= self.capacity
        return self.at(rows), rows, np.ones(count, dtype=np.float32)

    def at(self, rows: Ints) -> Transition:
        """Return the transitions that lie at `rows`, stacked."""
        return _fields(self.records.take(rows))

    def update_priorities(self, rows: Ints, errors: Floats) -> None:
        """Take the errors (n,) of the transitions at `rows` as their priorities; without effect in uniform replay."""

    def clear(self) -> None:
        """Forget all transitions."""
        self._drop(self.size)

    def _drop(self, count: int) -> None:
        self.start = (self.start + count) % self.capacity
        self.size -= count


def _fields(records: NDArray[np.void]) -> Transition:
    """Return the fields of records as views."""
    return Transition(*(records[name] for name in Transition._fields))


class PrioritisedReplayBuffer(ReplayBuffer):
    """Prioritised replay: sampling with probability proportional to |error|^exponent (Schaul et al. 2016).

    New ones get the `largest` priority seen, so that each is drawn soon. `importance`, which the agent raises
    towards 1, is the exponent β by which the weights undo the bias that this brings; `exponent` is the paper's α.
    """

    def __init__(
        self, capacity: int, num_features: int, prune: int = 1, exponent: float = 0.6, importance: float = 0.4
    ) -> None:
        super().__init__(capacity, num_features, prune)
        self.exponent, self.importance = exponent, importance
        self.tree = SumTree(capacity)
        self.largest = 1.0

    def add(self, transitions: Transition) -> Ints:
        """Keep a batch of n transitions, oldest first, and return where they lie, (n,)."""
        rows = super().add(transitions)
        self.tree.set(rows, np.full(len(rows), self.largest))
        return rows

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Transition, Ints, Floats]:
        """Draw `count` transitions; return them, the rows where they lie, and their weights in the cost, (count,).

        Weights are (size · probability)^-β, with β the `importance`, relative to the largest of those drawn.
        """
        # One draw from each of `count` equal parts of the total: less noise than independent draws.
        rows = self.tree.find((np.arange(count) + rng.random(count)) / count * self.tree.total)
        rng.shuffle(rows)
        chance = self.tree.leaves[rows] / self.tree.total
        weights = (chance * self.size) ** -self.importance
        return self.at(rows), rows, (weights / weights.max()).astype(np.float32)

    def update_priorities(self, rows: Ints, errors: Floats) -> None:
        """Set the priorities of the transitions at `rows` by their errors (n,): (|error| + 0.001)^α."""
        priorities = (np.abs(errors).astype(float) + 1e-3) ** self.exponent
        self.largest = max(self.largest, float(priorities.max()))
        self.tree.set(rows, priorities)

    def _drop(self, count: int) -> None:
        self.tree.set((self.start + np.arange(count)) % self.capacity, np.zeros(count))
        super()._drop(count)


class SumTree:
    """Binary tree of sums (Schaul et al. 2016, appendix B.2.1).

    Batches of priorities are set, and found by cumulative weight, in O(log capacity) operations of NumPy.
    """

    def __init__(self, capacity: int) -> None:
        self.depth = max(1, int(np.ceil(np.log2(capacity))))
        self.first_leaf = 1 << self.depth
        self.nodes: Doubles = np.zeros(2 * self.first_leaf)  # node k has children 2k and 2k + 1

    @property
    def total(self) -> float:
        """Sum of all priorities."""
        return float(self.nodes[1])

    @property
    def leaves(self) -> Doubles:
        """The priorities, as a view."""
        return self.nodes[self.first_leaf :]

    def set(self, rows: Ints, priorities: Doubles) -> None:
        """Set the priorities of some rows; of a row named twice, the last counts."""
        nodes = rows + self.first_leaf
        self.nodes[nodes] = priorities
        for _ in range(self.depth):  # up to the root; where many rows share parents, each is summed once
            nodes = np.unique(nodes >> 1) if len(nodes) > 64 else nodes >> 1
            self.nodes[nodes] = self.nodes[2 * nodes] + self.nodes[2 * nodes + 1]

    def find(self, weights: Doubles) -> Ints:
        """Rows (n,) in which the running sum of priorities passes `weights` (n,), each below the total."""
        nodes = np.ones(len(weights), dtype=np.intp)
        left_over = weights.copy()
        for _ in range(self.depth):
            nodes *= 2
            left = self.nodes[nodes]
            # Rounding may leave a hair too much: never walk into an empty branch.
            right = (left_over >= left) & (self.nodes[nodes + 1] > 0)
            left_over -= left * right
            nodes += right
        return nodes - self.first_leaf


def make_replay(config: AgentConfig, num_features: int) -> ReplayBuffer:
    """Make the empty replay buffer of a configuration, for observations of so many features."""
    if config.prioritised:
        return PrioritisedReplayBuffer(
            config.replay_size, num_features, config.replay_prune, config.priority_exponent, config.importance_exponent
        )
    return ReplayBuffer(config.replay_size, num_features, config.replay_prune)
