"""Last chance of a lost flight: from which moment on the network, alone at the stick, would still have landed it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import Final

from ai.copilot.futures import KEYS, Lookahead
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
        self._search = self._find()
        self.known = False
        self.seconds: float | None = None

    def note(self, env: LanderEnv) -> None:
        """Keep the present moment, now and then."""
        if int(env.steps[0]) % _EVERY == 0:
            self._moments.append((float(env.time[0]), Moment.of(env)))

    def look(self, decisions: int) -> None:
        """Fly some decisions further, from the latest moment back to the first."""
        for _ in islice(self._search, decisions):
            pass

    def _find(self) -> Iterator[None]:
        while self._moments and self.seconds is None:
            seconds, moment = self._moments.pop()
            for future in self._lookahead.look(moment, KEYS[COAST]):
                if future and future.plan:
                    self.seconds = seconds
                yield
        self.known = True
