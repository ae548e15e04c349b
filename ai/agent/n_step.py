"""N-step returns, and the collection of whole episodes that ended well."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np

from ai.agent.replay import Transition
from ai.common.environment import Bools, Floats, Ints
from ai.files import array_like, count_of

_KEPT: Final = ("_states", "_actions", "_returns", "_ages", "_open")


class NStep:
    """N-step returns: sums the rewards of up to `n` decisions into one transition (Sutton and Barto 2018, 7.1).

    From decision t on, a transition has the reward Σ γⁱ · r(t + i) over i = 0 … k - 1, and leads to state t + k. k is
    `n`, or less where the episode ended before. `discount` is γ, for each decision; it may be changed.
    """

    def __init__(self, n: int, discount: float) -> None:
        self.n, self.discount = n, discount
        self._states: Floats | None = None

    def add(
        self, state: Floats, action: Ints, reward: Floats, next_state: Floats, terminal: Bools, ended: Bools
    ) -> tuple[Transition, Ints]:
        """Take one decision of every slot; return the m transitions that are now complete, and their slots (m,).

        `state` and `next_state` are (slots, features), the others (slots,). `terminal` marks a next state without
        value, `ended` any end of an episode. A transition's `reward` is the discounted sum, its `steps` how many it
        has. Slots that have ended before and wait for a reset must not be passed on with a new decision.
        """
        if self._states is None or self._states.shape[1:] != state.shape:
            self._start(state)
        assert self._states is not None
        # The last n decisions are a ring of rows, (n, slots). The newest begins a transition in each slot, and every
        # transition that is open gets this reward, discounted by its age.
        newest = self._count % self.n
        self._states[newest], self._actions[newest] = state, action
        self._returns[newest], self._ages[newest] = 0.0, 0
        self._open[newest] = True
        self._count += 1
        self._returns += np.float32(self.discount) ** self._ages.astype(np.float32) * reward * self._open
        self._ages += 1
        # Complete are those of n rewards, all in the row that will be overwritten next, and those whose episode ended.
        oldest = self._count % self.n
        full = np.zeros_like(self._open)
        full[oldest] = self._ages[oldest] >= self.n
        complete = self._open & (full | ended)
        self._open &= ~complete
        row, slot = complete.nonzero()
        order = np.argsort(-self._ages[row, slot], kind="stable")  # oldest first: a pruned buffer loses the oldest
        row, slot = row[order], slot[order]
        transitions = Transition(
            self._states[row, slot],
            next_state[slot],
            self._actions[row, slot],
            self._returns[row, slot],
            terminal[slot],
            self._ages[row, slot],
        )
        return transitions, slot

    def state(self) -> dict[str, Any]:
        """Return copies of all that the next `add` depends on, besides the settings."""
        if self._states is None:
            return {}
        return {"count": self._count} | {name: getattr(self, name).copy() for name in _KEPT}

    def load_state(self, state: Mapping[str, Any], observation: Floats) -> None:
        """Go on from what `state` returned, for observations like this one (slots, features).

        Raises KeyError, TypeError or ValueError for anything else.
        """
        if state:
            self._start(observation)
            for name in _KEPT:
                setattr(self, name, array_like(getattr(self, name), state[name], name))
            self._count = count_of(state["count"])

    def _start(self, state: Floats) -> None:
        shape = (self.n, len(state))
        self._count = 0
        self._states = np.zeros((*shape, state.shape[1]), dtype=np.float32)
        self._actions = np.zeros(shape, dtype=np.intp)
        self._returns = np.zeros(shape, dtype=np.float32)
        self._ages = np.zeros(shape, dtype=np.intp)
        self._open = np.zeros(shape, dtype=bool)


class Episodes:
    """Collects each slot's transitions until its episode ends, and passes on those that ended well."""

    def __init__(self) -> None:
        self._parts: dict[int, list[Transition]] = {}

    def add(self, cells: Transition, slots: Ints, ended: Bools, success: Bools) -> Iterator[Transition]:
        """Take m new transitions with their slots (m,); yield every successful episode that is now whole.

        `ended` and `success` are of all slots, (slots,).
        """
        for slot in np.unique(slots).tolist():
            mine = slots == slot
            self._parts.setdefault(slot, []).append(Transition(*(part[mine] for part in cells)))
            if ended[slot]:
                parts = self._parts.pop(slot)
                if success[slot]:
                    yield joined(parts)

    def state(self) -> dict[str, Any]:
        """Return copies of all that was collected of episodes that go on: transitions by field, and their slots."""
        slots = [np.full(len(part.action), slot) for slot, parts in self._parts.items() for part in parts]
        cells = joined([part for parts in self._parts.values() for part in parts]) if slots else None
        return {"slots": np.concatenate(slots), **cells._asdict()} if cells else {}

    def load_state(self, state: Mapping[str, Any], num_features: int) -> None:
        """Go on from what `state` returned, for observations of so many features.

        Raises KeyError, TypeError or ValueError for anything else.
        """
        self._parts = {}
        if not state:
            return
        slots = state["slots"]
        kinds = (
            (num_features, np.float32),
            (num_features, np.float32),
            (0, np.intp),
            (0, np.float32),
            (0, bool),
            (0, np.intp),
        )
        like = (np.empty((len(slots), size) if size else len(slots), dtype) for size, dtype in kinds)
        names = zip(Transition._fields, like, strict=True)
        cells = Transition(*(array_like(template, state[name], name) for name, template in names))
        for slot in dict.fromkeys(slots.tolist()):
            self._parts[count_of(slot)] = [Transition(*(part[slots == slot] for part in cells))]


def joined(parts: Sequence[Transition]) -> Transition:
    """Return batches of transitions as one."""
    return Transition(*(np.concatenate(column) for column in zip(*parts, strict=True)))
