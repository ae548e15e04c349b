"""Futures for guarded flights, without a process of their own."""

from ai.copilot.futures import Lookahead
from ai.lander.push import KEYS, Push


class AtOnce:
    """Flies futures at once, in this process; nothing is known of what is `late`, nor of anything if that is None."""

    def __init__(self):
        self.problem = ""
        self.late: set[Push] | None = set()

    def ask(self, moment, before, asked, decisions, policy, route):
        self._lookahead = Lookahead(policy, route)
        self._moment, self._before, self.decisions, self._wished = moment, before, decisions, {asked}

    def hint(self, asked):
        self._wished.add(asked)

    def known(self):
        if self.late is None:
            return {}
        pushes = [push for push in {*self._wished, KEYS[0]} if push not in self.late]
        found = self._lookahead.futures(self._moment, [(0, push) for push in pushes], self.decisions, self._before)
        return dict(zip(pushes, found, strict=True))
