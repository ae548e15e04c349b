"""How late a key is felt while the guardian looks ahead, in flights in real time.

    python -m benchmarks.guardian [--flights 4] [--dials 0.04 0.27 1]

With the dial at 0.04, 0.27 and 1, there must be a landing after 1, 4 and 12 decisions of an action. Flights take as
long as in the game, with futures from a process of their own, and a machine that does nothing else is needed for
figures that say something. Of the decisions, those are *late* in which the plan was flown on only because what was
asked for was not flown ahead in time, and those *wait* in which a new wish was not, so that the one before counted once
more. *Known* is how many of the six actions were flown ahead. The *delay* is from a change of the stick to the decision
that goes by it, *first* and *all* how old answers are when they are there. The window looks 60
times a second.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.copilot.futures import DECISION_STEPS, Future
from ai.copilot.guardian import decisions_of
from ai.flights.recording import Recording
from ai.lander.push import KEYS, STEPS, Push
from engine import DT
from game.flight.choosers import Crew
from game.flight.flight import Flight, begin
from game.flight.futures import FuturesProcess
from game.flight.guard import Guard

MODEL = Path(__file__).parent.parent / "models" / "lander" / "modern"
LIVE_STEPS = 480  # of a flight in real time at most: hands that crash are kept in the air for long


class Watched(FuturesProcess):
    """Futures' process that notes how old its answers are when they are there."""

    def __init__(self) -> None:
        super().__init__()
        self.ages: list[list[float]] = []  # of the answers to each request, in seconds
        self._asked_at = 0.0

    def ask(self, *asked: Any) -> None:
        """Ask for the futures of a moment."""
        self._asked_at = time.perf_counter()
        self.ages.append([])
        super().ask(*asked)

    def hint(self, asked: Push) -> None:
        """Say what the stick asks for now."""
        super().hint(asked)
        self.known()

    def known(self) -> Mapping[Push, Future]:
        """Return what is known by now."""
        known = super().known()
        if self.ages:
            self.ages[-1] += [time.perf_counter() - self._asked_at] * (len(known) - len(self.ages[-1]))
        return known


@dataclass
class Live:
    """What came of the decisions of flights in real time."""

    decisions: int = 0
    late: int = 0
    waited: int = 0
    known: list[int] = field(default_factory=list)  # futures of each decision
    delays: list[float] = field(default_factory=list)  # seconds from a change of the stick to its decision

    def fly(
        self, flight: Flight[Crew], guard: Guard, rng: np.random.Generator, hands: str, period: int, ready: int
    ) -> None:
        """Fly with random keys, or a random stick, changed every `period` steps, once it has hung for `ready` steps."""
        asked = Push()
        changed: int | None = None
        due = time.perf_counter()
        for step in range(-ready, LIVE_STEPS):
            due += DT
            time.sleep(max(0.0, due - time.perf_counter()))
            if step < 0:
                guard.hang(flight, asked)
                continue
            if step % period == 0:
                asked, changed = _stick(rng, hands), step
            flight.step(asked)
            if flight.over:
                break
            if step % DECISION_STEPS == 0 and (decision := flight.choice.together) and decision.known:
                self.known.append(len(decision.known[0]))
                if changed is not None and not guard.waits:
                    self.delays.append((step - changed) * DT)
                    changed = None
        self.decisions += guard.decisions
        self.late += guard.late
        self.waited += guard.waited


def _stick(rng: np.random.Generator, hands: str) -> Push:
    """Return a random key, or a random position of the stick."""
    if hands == "keys":
        return KEYS[int(rng.integers(6))]
    return Push(int(rng.integers(STEPS + 1)), int(rng.integers(-STEPS, STEPS + 1)))


def live(agent: DeepQAgent, dials: list[float], flights: int, seed: int) -> None:
    """Print how the decisions of flights in real time fare, by random keys and by a random stick."""
    print("| hands, changed each | ahead | decisions | late | wait | known | delay, 99% | first, 99% | all, 99% |")
    print("|---|---|---|---|---|---|---|---|---|")
    for (hands, period), dial in product((("keys", 61), ("keys", 13), ("stick", 61), ("stick", 13)), dials):
        rng, ahead, found = np.random.default_rng(seed), Watched(), Live()
        for number in range(flights):
            flight = begin(Recording(int(rng.integers(1 << 30)), "random"), agent)
            guard = flight.chooser.guard = Guard(flight.chooser, ahead)
            flight.chooser.help(dial)
            found.fly(flight, guard, rng, hands, period, ready=30 if number else 120)
        ahead.close()
        first, every = [ages[0] for ages in ahead.ages if ages], [age for ages in ahead.ages for age in ages]
        times = [f"{1e3 * np.median(each):.0f}, {1e3 * np.quantile(each, 0.99):.0f} ms"
                 for each in (found.delays, first, every)]  # fmt: skip
        shares = [f"{each / found.decisions:.1%}" for each in (found.late, found.waited)]
        cells = [f"{hands}, {period * DT:.1f} s", decisions_of(dial), found.decisions, *shares,
                f"{np.mean(found.known):.1f}", *times]  # fmt: skip
        print("| " + " | ".join(map(str, cells)) + " |", flush=True)


def main() -> None:
    """Measure what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flights", type=int, default=4, help="of each kind of hands with each dial (default: 4)")
    parser.add_argument("--dials", type=float, nargs="*", default=[0.04, 0.27, 1.0])
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    live(DeepQAgent.load(MODEL), arguments.dials, arguments.flights, arguments.seed)


if __name__ == "__main__":
    main()
