"""Last chance of a lost flight: from which moment on the network, alone at the stick, would still have landed it."""

from __future__ import annotations

from collections.abc import Generator
from typing import Final

from ai.copilot.futures import KEYS, Future, Lookahead
from ai.lander.environment import LanderEnv
from ai.lander.moment import Moment
from ai.lander.pilots import COAST
from ai.lander.route import Route
from game.flight.networks import Policy

_EVERY: Final = 30  # steps between two moments that are kept


class LastChance:
    """Moments of one flight; call `note` after every step, and once it is lost, `look` until it is `known`.

    Attributes:
        known: whether all is known.
        seconds: when that moment was, in seconds of the flight; None if there was none.

    """

    def __init__(self, policy: Policy, route: Route | None = None) -> None:
        self._lookahead = Lookahead(policy, route)
        self._moments: list[tuple[float, Moment]] = []
        self._flying: Generator[Future | None, None, None] | None = None
        self.known = False
        self.seconds: float | None = None

    def note(self, env: LanderEnv) -> None:
        """Keep the present moment, now and then."""
        if int(env.steps[0]) % _EVERY == 0:
            self._moments.append((float(env.time[0]), Moment.of(env)))

    def look(self, decisions: int) -> None:
        """Fly some decisions further, from the latest moment back to the first."""
        for _ in range(decisions):
            if self.known:
                return
            if not self._moments:
                self.known = True
                return
            seconds, moment = self._moments[-1]
            self._flying = self._flying or self._lookahead.look(moment, KEYS[COAST])
            future = next(self._flying)
            if future is None:
                continue
            self._flying = None
            self._moments.pop()
            if future.plan:
                self.known, self.seconds = True, seconds
