"""Push of the stick in one step: how much each engine gives, in sixteenths, and the action nearest to that."""

from __future__ import annotations

from functools import lru_cache
from typing import Final, NamedTuple

from ai.lander.rules import ACTION_SHARES, nearest_action

STEPS: Final = 16  # from no thrust to all: flights are recorded in them, so that they can be flown again exactly


class Push(NamedTuple):
    """Push of the stick: thrust of the main engine, 0 to 16, and of the jets, -16, left, to 16, right."""

    main: float = 0
    side: float = 0

    @classmethod
    def of(cls, main: float, side: float) -> Push:
        """Return the push of shares of thrust, `main` 0 to 1 and `side` -1 to 1, exactly."""
        return cls(STEPS * main, STEPS * side)

    @property
    def action(self) -> int:
        """The nearest action, 0 to 5."""
        return _action(self)

    @property
    def shares(self) -> tuple[float, float]:
        """Its shares of thrust, of main engine and jets."""
        return self.main / STEPS, self.side / STEPS


@lru_cache(maxsize=2048)
def _action(push: Push) -> int:
    return nearest_action(*push.shares)


KEYS: Final = tuple(Push(*(round(STEPS * share) for share in shares)) for shares in ACTION_SHARES.tolist())
