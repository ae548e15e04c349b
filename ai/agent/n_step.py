"""N-step returns, and the collection of whole episodes that ended well."""

from __future__ import annotations

import numpy as np

from ai.agent.replay import Transition
from ai.environment import Bools, Floats, Ints


class NStep:
    """N-step returns: sums the rewards of up to `n` decisions into one transition (Sutton and Barto 2018, 7.1).

    From decision t on, a transition has the reward Σ γⁱ · r(t + i) over i = 0 … k - 1, and leads to state t + k. k is
    `n`, or less where the episode ended before. `discount` is γ, for each decision; it may be changed.

    The last n decisions are rows, (n, slots), oldest first. Each begins a transition, which is open until complete:

        row 0      begun n - 1 decisions ago    reward so far  r₀ + γ·r₁ + … + γⁿ⁻¹·rₙ₋₁   complete
        …
        row n - 1  begun now                                   r₀                          complete if the episode ended
    """

    def __init__(self, n: int, discount: float) -> None:
        self.n, self.discount = n, discount
        self._start(0, 0, ())

    def _start(self, slots: int, num_features: int, paid: tuple[int, ...]) -> None:
        self._states: Floats = np.zeros((self.n, slots, num_features), dtype=np.float32)
        self._actions: Ints = np.zeros((self.n, slots), dtype=np.intp)
        self._returns: Floats = np.zeros((self.n, slots, *paid), dtype=np.float32)
        self._open: Bools = np.zeros((self.n, slots), dtype=bool)

    def add(
        self, state: Floats, action: Ints, reward: Floats, next_state: Floats, terminal: Bools, ended: Bools
    ) -> tuple[Transition, Ints]:
        """Take one decision of every slot; return the m transitions that are now complete, and their slots (m,).

        `state` and `next_state` are (slots, features), the others (slots,); rewards of k kinds are (slots, k).
        `terminal` marks a next state without value, `ended` any end of an episode. Slots that have ended and wait for a
        reset must not be passed on with a new decision.
        """
        if self._states.shape[1:] != state.shape:
            self._start(len(state), state.shape[1], reward.shape[1:])
        # Each row moves up by one, to make room for this decision in the last.
        for rows, newest in ((self._states, state), (self._actions, action), (self._returns, 0.0), (self._open, True)):
            rows[:-1], rows[-1] = rows[1:], newest
        powers = np.float32(self.discount) ** np.arange(self.n - 1, -1, -1, dtype=np.float32)  # γⁿ⁻¹ … γ, 1
        worth = powers[:, None] * self._open  # of this decision's reward, to each row
        self._returns += worth.reshape(worth.shape + (1,) * (reward.ndim - 1)) * reward
        complete = self._open & ended
        complete[0] = self._open[0]  # n rewards long
        self._open &= ~complete
        row, slot = complete.nonzero()  # oldest first: a pruned buffer loses the oldest
        transitions = Transition(
            self._states[row, slot],
            next_state[slot],
            self._actions[row, slot],
            self._returns[row, slot],
            terminal[slot],
            self.n - row,
        )
        return transitions, slot


class Episodes:
    """Transitions of episodes that go on, with the slot of each, until those that end well are passed on whole."""

    def __init__(self, num_features: int) -> None:
        states, numbers = np.zeros((0, num_features), dtype=np.float32), np.zeros(0, dtype=np.intp)
        rewards, terminal = np.zeros(0, dtype=np.float32), np.zeros(0, dtype=bool)
        self._transitions, self._slots = Transition(states, states, numbers, rewards, terminal, numbers), numbers

    def add(self, transitions: Transition, slots: Ints, ended: Bools, success: Bools) -> list[Transition]:
        """Take m new transitions with their slots (m,); return every successful episode that is now whole.

        `ended` and `success` are of all slots, (slots,).
        """
        columns = zip(self._transitions, transitions, strict=True)
        self._transitions = Transition(*(np.concatenate(column) for column in columns))
        self._slots = np.concatenate([self._slots, slots])
        whole = [_taken(self._transitions, self._slots == slot) for slot in np.flatnonzero(ended & success)]
        if ended.any():
            goes_on = ~ended[self._slots]
            self._transitions, self._slots = _taken(self._transitions, goes_on), self._slots[goes_on]
        return whole


def _taken(transitions: Transition, rows: Bools) -> Transition:
    return Transition(*(part[rows] for part in transitions))
