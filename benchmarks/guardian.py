"""What the guardian promises, and how late a key is felt.

    python -m benchmarks.guardian [--flights 300] [--dials 0.04 0.27 1] [--into FILE]   hands of all families
    python -m benchmarks.guardian --live [--flights 4]                     decisions of flights in real time

With the dial at 0.04, 0.27 and 1, there must be a landing after 1, 4 and 12 decisions of an action. Starts are fresh:
no network was trained with them. All hands fly from the same; "good" among them is the network alone. Flights are flown
in rounds, all of some families at once, and noted in the file, so that they can be broken off.

Live flights take as long as in the game, with futures from a process of their own, and a machine that does nothing
else is needed for figures that say something. Of the decisions, those are *late* in which the plan was flown on only
because what was asked for was not flown ahead in time, and those *wait* in which a new wish was not, so that the one
before counted once more. *Known* is how many of the six actions were flown ahead. The *delay* is from a change of the
stick to the decision that goes by it, *first* and *all* how old answers are when they are there. The window looks 60
times a second.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
import json
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.copilot.copilot import Mode
from ai.copilot.futures import DECISION_STEPS, Future, Push
from ai.copilot.guardian import decisions_of
from ai.copilot.hands import HANDS
from ai.copilot.measurement import ALONE, rows
from ai.flights.recording import STEPS, Shares
from engine import DT
from game.flight.flight import Flight
from game.flight.futures import FuturesProcess
from game.flight.guard import Guard

MODEL = Path(__file__).parent.parent / "models" / "lander" / "modern"
# Hands that are flown at once: futures of many take hardly longer.
HOSTILE = "adversary, random", "adversary, least"
KINDS = [name for name in HANDS if name not in HOSTILE], HOSTILE
ROUND = 100  # flights of each family in a round: few at once cost several times as much each
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

    def fly(self, flight: Flight, guard: Guard, rng: np.random.Generator, hands: str, period: int, ready: int) -> None:
        """Fly with random keys, or a random stick, changed every `period` steps, once it has hung for `ready` steps."""
        asked: tuple[int, Shares | None] = 0, None
        changed: int | None = None
        due = time.perf_counter()
        for step in range(-ready, LIVE_STEPS):
            due += DT
            time.sleep(max(0.0, due - time.perf_counter()))
            if step < 0:
                guard.hang(0)
                continue
            if step % period == 0:
                asked, changed = _stick(rng, hands), step
            flight.step(*asked)
            if flight.over:
                break
            if step % DECISION_STEPS == 0 and flight.decision and flight.decision.known:
                self.known.append(len(flight.decision.known[0]))
                if changed is not None and not guard.waits:
                    self.delays.append((step - changed) * DT)
                    changed = None
        self.decisions += guard.decisions
        self.late += guard.late
        self.waited += guard.waited


def _stick(rng: np.random.Generator, hands: str) -> tuple[int, Shares | None]:
    """Return a random key, or a random position of the stick."""
    if hands == "keys":
        return int(rng.integers(6)), None
    main, side = int(rng.integers(STEPS + 1)), int(rng.integers(-STEPS, STEPS + 1))
    return Push.of(main / STEPS, side / STEPS).action, (main, side)


def live(agent: DeepQAgent, dials: list[float], flights: int, seed: int) -> None:
    """Print how the decisions of flights in real time fare, by random keys and by a random stick."""
    print("| hands, changed each | ahead | decisions | late | wait | known | delay, 99% | first, 99% | all, 99% |")
    print("|---|---|---|---|---|---|---|---|---|")
    for (hands, period), dial in product((("keys", 61), ("keys", 13), ("stick", 61), ("stick", 13)), dials):
        rng, ahead, found = np.random.default_rng(seed), Watched(), Live()
        for number in range(flights):
            flight = Flight(int(rng.integers(1 << 30)), agent)
            flight.guard = Guard(flight, ahead)
            flight.help(dial)
            found.fly(flight, flight.guard, rng, hands, period, ready=30 if number else 120)
        ahead.close()
        first, every = [ages[0] for ages in ahead.ages if ages], [age for ages in ahead.ages for age in ages]
        times = [f"{1e3 * np.median(each):.0f}, {1e3 * np.quantile(each, 0.99):.0f} ms"
                 for each in (found.delays, first, every)]  # fmt: skip
        shares = [f"{each / found.decisions:.1%}" for each in (found.late, found.waited)]
        cells = [f"{hands}, {period * DT:.1f} s", decisions_of(dial), found.decisions, *shares,
                f"{np.mean(found.known):.1f}", *times]  # fmt: skip
        print("| " + " | ".join(map(str, cells)) + " |", flush=True)


def promises(agent: DeepQAgent, names: list[str], dials: list[float], flights: int, seed: int, into: Path) -> None:
    """Fly each family alone and guarded, in rounds of other starts, add each round to a file, and print all in it.

    A round that is in the file already is left out, so one that was broken off goes on.
    """
    done = [json.loads(line) for line in into.read_text().splitlines()] if into.exists() else []
    for number in range(-(-flights // ROUND)):
        for kind in KINDS:
            mine = [name for name in kind if name in names]
            for dial in (None, *dials):
                help_ = (ALONE, 0.0) if dial is None else (str(Mode.GUARDIAN), dial)
                made = {row["pilot"] for row in done if (row["seed"], row["assist"]) == (seed + number, help_[1])}
                if missing := [name for name in mine if name not in made]:
                    begun = time.process_time()
                    flown = rows(agent, agent, "one_pad", missing, [help_], ROUND, seed + number)
                    took = (time.process_time() - begun) / len(missing)
                    new = [asdict(row) | {"seed": seed + number, "seconds": took} for row in flown]
                    with into.open("a") as file:
                        file.writelines(json.dumps(row) + "\n" for row in new)
                    done += new
    table(done, names)


def table(done: list[dict[str, Any]], names: list[str]) -> None:
    """Print what came of all rounds: of each family and each dial, the flights of all rounds together."""
    print("| hands | decisions | flights | landed | crashed | overridden | held | lost though held |")
    print("|---|---|---|---|---|---|---|---|")
    for name in names:
        for dial in sorted({row["assist"] for row in done if row["pilot"] == name}):
            same = [row for row in done if (row["pilot"], row["assist"]) == (name, dial)]
            flights = sum(row["episodes"] for row in same)
            shares = [
                sum(row[part] * row["episodes"] for row in same) / flights
                for part in ("success", "crash", "overridden", "held", "lost_held")
            ]
            cells = [name, decisions_of(dial) if dial else "alone", flights, *(f"{share:.1%}" for share in shares)]
            print("| " + " | ".join(map(str, cells)) + " |")


def main() -> None:
    """Measure what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--live", action="store_true", help="fly in real time, with futures from another process")
    parser.add_argument(
        "--flights",
        type=int,
        default=300,
        help=f"of each family with each dial, in whole rounds of {ROUND}; live, at most 4",
    )
    parser.add_argument("--into", type=Path, default=Path("guardian.jsonl"), help="file of the rounds that were flown")
    parser.add_argument("--hands", nargs="*", default=list(HANDS), choices=list(HANDS), metavar="NAME")
    parser.add_argument("--dials", type=float, nargs="*", default=[0.04, 0.27, 1.0])
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    agent = DeepQAgent.load(MODEL)
    if arguments.live:
        live(agent, arguments.dials, min(4, arguments.flights), arguments.seed)
    else:
        promises(agent, arguments.hands, arguments.dials, arguments.flights, arguments.seed, arguments.into)


if __name__ == "__main__":
    main()
