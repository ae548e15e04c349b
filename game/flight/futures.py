"""Futures of the flight on the screen, flown ahead in a process of their own while the present decision is flown.

A guardian needs to know what comes of a push at the moment at which it decides, and a future takes 20 to 30
milliseconds. So while one decision is flown, the futures after it are: first of what the stick asks for now, then of
the keys. Each moment is a request with a number; what comes late is of an older number and is left out.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Generator, Iterable, Mapping
from itertools import islice
from typing import Final, NamedTuple

from ai.agent.agent import DeepQAgent
from ai.agent.config import AgentConfig
from ai.agent.normalizer import Normalizer
from ai.copilot.futures import Future, Lookahead, Opening
from ai.environment import Floats
from ai.lander.moment import Moment
from ai.lander.pilots import Pilot
from ai.lander.push import KEYS, Push
from ai.lander.route import Route
from game.core import texts
from game.core.worker import Worker, WorkerState

_CORES: Final = 2  # with fewer, the futures would take the time that the window needs
_AT_A_TIME: Final = 8  # decisions, of less than a millisecond together, between two looks for requests
_SWITCH: Final = 5e-4  # seconds after which the thread that receives requests gets its turn


# All that a network flies by: what makes an agent, its parameters, and what normalises its inputs; and its route.
Flyer = tuple[tuple[int, int, AgentConfig], Floats, Normalizer | None, Route | None]


class Request(NamedTuple):
    """Request for the futures of the `moment` of one lander, after what is pushed `before`.

    `asked` is what the stick asks for now. After so many `decisions` of a push there must be a landing as well. `flyer`
    is None if the network and its route are those of the request before.
    """

    number: int
    moment: Moment
    before: Opening
    asked: Push
    decisions: int
    flyer: Flyer | None


class Found(NamedTuple):
    """What comes of a push at the moment of a request."""

    number: int
    push: Push
    future: Future


class _Ahead(Worker):
    niceness = 0  # what it finds is needed within four steps


class FuturesProcess:
    """A process that flies futures ahead; it begins with the first request, and is kept from flight to flight."""

    def __init__(self, cores: int | None = None) -> None:
        self.problem = texts.FUTURES_ONE_CORE if (cores or os.cpu_count() or 1) < _CORES else ""
        self._worker: Worker | None = None
        self._number = 0
        self._known: dict[Push, Future] = {}
        self._asked: Push | None = None
        self._flies: tuple[Pilot, Route | None] | None = None  # the network and the route that the process has

    def ask(
        self, moment: Moment, before: Opening, asked: Push, decisions: int, pilot: Pilot, route: Route | None
    ) -> None:
        """Ask for the futures of a moment of one lander, after what is pushed `before`, and forget the older ones."""
        if self.problem or not isinstance(pilot, DeepQAgent):
            return
        if self._worker is None:
            self._worker = _Ahead(fly_ahead)
        self._number += 1
        self._known, self._asked = {}, asked
        flyer: Flyer | None = None
        if self._flies is None or self._flies[0] is not pilot or self._flies[1] is not route:
            made = pilot.num_features, pilot.num_actions, pilot.config
            flyer = made, pilot.network.values, pilot.normalizer, route
        self._flies = pilot, route
        self._worker.send(Request(self._number, moment, before, asked, decisions, flyer))
        self._poll()

    def hint(self, asked: Push) -> None:
        """Say what the stick asks for now; call it in every step, so that answers are fetched as they come."""
        self._poll()
        if self._worker and asked != self._asked and asked not in self._known:
            self._asked = asked
            self._worker.send(asked)

    def known(self) -> Mapping[Push, Future]:
        """Return what is known by now of the moment asked for; never waits."""
        self._poll()
        return self._known

    def close(self) -> None:
        """End the process; another begins with the next request."""
        if self._worker:
            self._worker.close(grace=0.0)
            self._worker = self._flies = None

    def _poll(self) -> None:
        worker = self._worker
        if worker is None:
            return
        for found in worker.poll():
            if found.number == self._number:
                self._known[found.push] = found.future
        if worker.state is WorkerState.FAILED:
            self.problem = worker.problem
            self.close()


class _Order:
    """Order in which the futures of one request are flown.

    What the stick asks for comes first. Then, for the panel that shows them all, the keys, those first that were
    `found` longest ago, by the numbers of their requests.

    Attributes:
        flown: what was found, in turn, and None after each decision that was flown.

    """

    def __init__(self, request: Request, lookahead: Lookahead, found: dict[Push, int]) -> None:
        self._request, self._lookahead, self._found = request, lookahead, found
        self._asked: Push | None = request.asked
        self._left = sorted(KEYS, key=lambda key: found.get(key, 0))
        self._guesses = False  # whether what is flown now was not asked for
        self.flown = self._fly()

    def hint(self, asked: Push) -> None:
        """Fly another position of the stick next, and in place of a future that was not asked for."""
        self._asked = asked
        if self._guesses:
            self.flown = self._fly()

    def _fly(self) -> Generator[Found | None, None, None]:
        number, moment, before, _, decisions, _ = self._request
        while self._asked or self._left:
            push, self._guesses, self._asked = self._asked or self._left[0], self._asked is None, None
            for future in self._lookahead.look(moment, push, decisions, before):
                yield Found(number, push, future) if future else None
                if future and self._guesses:
                    break
            self._left = [key for key in self._left if key != push]
            self._found[push] = number


def fly_ahead() -> Generator[Iterable[Found] | None, object, None]:
    """Fly the futures of the latest request; for a `Worker`."""
    sys.setswitchinterval(_SWITCH)
    lookahead = Lookahead(DeepQAgent())
    found: dict[Push, int] = {}
    order: _Order | None = None
    answer: Iterable[Found] | None = None
    while True:
        command = yield answer
        answer = ()
        if isinstance(command, Request):
            if command.flyer:
                made, values, normalizer, route = command.flyer
                lookahead = Lookahead(agent := DeepQAgent(*made), route)
                agent.restore(values, normalizer)
            order = _Order(command, lookahead, found)
        elif isinstance(command, Push):
            if order:
                order.hint(command)
        else:
            turn = list(islice(order.flown, _AT_A_TIME)) if order else []
            answer = [each for each in turn if each] if turn else None
