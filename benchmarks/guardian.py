"""What the guardian promises, and what it costs.

    python -m benchmarks.guardian [--flights 20] [--dials 0.04 0.27 1]     hands of all families, alone and guarded
    python -m benchmarks.guardian --costs [--rounds 100]                   how long futures take

With the dial at 0.04, 0.27 and 1, there must be a landing after 1, 4 and 12 decisions of an action. Starts are fresh:
no network was trained with them. The costs are of moments of flights by random keys, with the network that comes with
the game; processor time is that of this process alone, so that others lengthen it little.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
import platform
import time
from pathlib import Path

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.copilot import futures
from ai.copilot.copilot import Mode
from ai.copilot.futures import KEYS, Lookahead
from ai.copilot.guardian import decisions_of
from ai.copilot.measurement import ALONE, PILOTS, rows
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.moment import Moment

MODEL = Path(__file__).parent.parent / "models" / "lander" / "modern"
BATCHES = (1, 6, 12, 18, 42)


def moments(rounds: int) -> list[Moment]:
    """Return moments of flights in which another random key is held each second."""
    rng = np.random.default_rng(11)
    env = LanderEnv(1, rng)
    env.reset()
    found = []
    for _ in range(rounds):
        found.append(Moment.of(env))
        for action in rng.integers(6, size=2):
            for _ in range(15):
                env.fly(np.array([action]))
        if env.outcome[0] != Outcome.FLYING:
            env.reset()
    return found


def costs(agent: DeepQAgent, rounds: int) -> None:
    """Print how long batches of futures take, in plain floats one after another, and in arrays."""
    print(f"{platform.processor() or platform.machine()}, Python {platform.python_version()}, NumPy {np.__version__}")
    print("| | median | 99% within | processor, median | 99% within |\n|---|---|---|---|---|")
    found = moments(rounds)
    found = moments(rounds)
    usual = futures._size
    for name, size_of, together in (
        ("arrays alone", lambda count: max(2, usual(count)), True),
        ("arrays, the last one in plain floats", usual, True),
        ("plain floats, one after another", usual, False),
    ):
        futures._size = size_of
        for size in BATCHES:
            # One opening after another, so that as many different futures are flown as are asked for.
            asked = [(0, (KEYS[number % 6],) * (1 + number // 6)) for number in range(size)]
            batches = [asked] if together else [[each] for each in asked]
            lookahead = Lookahead(agent)
            took, worked = [], []
            for moment in [found[0], *found]:
                begun, busy = time.perf_counter(), time.process_time()
                for batch in batches:
                    lookahead.plans(moment, batch)
                took.append(time.perf_counter() - begun)
                worked.append(time.process_time() - busy)
            figures = [1e3 * float(np.quantile(times[1:], share)) for times in (took, worked) for share in (0.5, 0.99)]
            print(f"| {name}, {size} | " + " | ".join(f"{figure:.1f} ms" for figure in figures) + " |", flush=True)
    futures._size = usual


def promises(agent: DeepQAgent, names: list[str], dials: list[float], flights: int, seed: int) -> None:
    """Print how many flights of each family land, alone and guarded, and what that takes."""
    helps = [(ALONE, 0.0), *((str(Mode.GUARDIAN), dial) for dial in dials)]
    print(
        "| hands | decisions | landed | crashed | overridden | held | lost though held |\n|---|---|---|---|---|---|---|"
    )
    (network,) = rows(agent, agent, "one_pad", ["good"], helps[:1], flights, seed)
    print(f"| the network alone | | {network.success:.1%} | {network.crash:.1%} | | | |")
    for name in names:
        for row in rows(agent, agent, "one_pad", [name], helps, flights, seed):
            dial = "" if row.mode == ALONE else decisions_of(row.assist)
            print(f"| {name} | {dial} | {row.success:.1%} | {row.crash:.1%} | {row.overridden:.1%} | {row.held:.1%} |"
                  f" {row.lost_held:.1%} |", flush=True)  # fmt: skip


def main() -> None:
    """Measure what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--costs", action="store_true", help="measure how long futures take")
    parser.add_argument("--rounds", type=int, default=100, help="moments from which futures are flown")
    parser.add_argument("--flights", type=int, default=20, help="of each family with each dial")
    parser.add_argument("--hands", nargs="*", default=list(PILOTS), choices=list(PILOTS), metavar="NAME")
    parser.add_argument("--dials", type=float, nargs="*", default=[0.04, 0.27, 1.0])
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    agent = DeepQAgent.load(MODEL)
    if arguments.costs:
        costs(agent, arguments.rounds)
    else:
        promises(agent, arguments.hands, arguments.dials, arguments.flights, arguments.seed)


if __name__ == "__main__":
    main()
