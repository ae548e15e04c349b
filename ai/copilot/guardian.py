"""Guardian: when to step in, how far, and when to hand back, given the chance to be saved after each action."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from ai.common.environment import Bools, Doubles, Floats, Ints

RISK: Final = 0.02 / 3  # chance to be lost that it accepts, at an assist of one half
SUREST: Final = 0.9995  # chance that it asks for at the most, after however many rescues
HAND_BACK: Final = 0.5  # share of the risk at which it may give the stick back
PATIENCE: Final = 0.1  # decisions for which the pilot's actions must have been safe before that: this · rescues²
_LONGEST: Final = 60  # decisions
LEEWAY: Final = 1.4  # among hills: how much oftener than after the best action a flight may be lost


def required_chance(assist: Any) -> Any:
    """Return the chance to be saved below which a guardian steps in, for assist (n,), 0 to 1."""
    with np.errstate(divide="ignore"):
        return np.maximum(0.0, 1.0 - RISK * (1.0 - np.asarray(assist)) / assist)


class Guardian:
    """Guardian of n flights, with what it remembers of each.

    Each rescue is a chance to fail, so it halves the risk it takes after every one; and the oftener it had to step
    in, the longer the pilot's actions must be safe before it hands back.

    Among hills the agent itself misses a pad now and then, so that what is asked for may be out of reach whatever the
    pilot does. There it steps in only where another action is much better, and hands back at once.

    Attributes:
        saving: whether it has the stick, (n,).
        rescues: how often it has stepped in, (n,).

    """

    def __init__(self) -> None:
        self.saving: Bools = np.zeros(0, dtype=bool)
        self.rescues: Ints = np.zeros(0, dtype=np.intp)
        self._safe_for: Ints = np.zeros(0, dtype=np.intp)  # decisions since the pilot's action was last unsafe

    def forget(self, mask: Bools | None = None) -> None:
        """Begin a new flight in the slots of `mask` (n,), or in all."""
        for memory in (self.saving, self.rescues, self._safe_for):
            if memory.size:  # it has been asked before
                memory[slice(None) if mask is None else mask] = 0

    def required(self, assist: float, slots: int) -> Doubles:
        """Return the chance below which it steps in by now, (n,), with the dial at `assist`."""
        if self.saving.shape != (slots,):
            self.saving = np.zeros(slots, dtype=bool)
            self.rescues, self._safe_for = np.zeros((2, slots), dtype=np.intp)
        required = required_chance(assist)
        halved = 1.0 - (1.0 - required) * 0.5**self.rescues
        now: Doubles = np.minimum(halved, np.maximum(required, SUREST))
        return now

    def choose(
        self, chance: Floats, candidates: Ints, required: Doubles, *, among_hills: bool = False
    ) -> tuple[Ints, Doubles]:
        """Return which candidate to fly, (n,), and the chance that was asked for, (n,).

        `chance` (n, 6) is that to be saved after each action; `candidates` (k, n) are actions, the pilot's own first
        and the least change first of the others. Where a chance is not a number, nobody can judge: the pilot flies.
        """
        offered = chance[np.arange(len(required)), candidates]
        back = 1.0 - HAND_BACK * (1.0 - required)
        patience = np.minimum(PATIENCE * self.rescues**2, _LONGEST)
        if among_hills:
            lost = 1.0 - offered.max(axis=0)
            required = np.minimum(required, 1.0 - LEEWAY * lost)
            back = np.minimum(back, 1.0 - (1.0 + HAND_BACK * (LEEWAY - 1.0)) * lost)
            patience = np.zeros_like(lost)
        asked = np.where(self.saving, back, required)
        enough = offered >= asked
        known = np.isfinite(chance).all(axis=1)
        self._safe_for = np.where(enough[0], self._safe_for + 1, 0)
        enough[0] &= ~self.saving | (self._safe_for > patience)
        none = ~enough.any(axis=0)
        enough[:, none] = (offered == offered.max(axis=0))[:, none]
        chosen = np.where(known, enough.argmax(axis=0), 0)
        saving = chosen > 0
        self.rescues += saving & ~self.saving
        self.saving = saving
        return chosen, asked
