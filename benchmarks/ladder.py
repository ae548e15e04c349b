"""How a slow-handed pilot lands from every rung of the ladder of starts, and climbs it.

    python -m benchmarks.ladder [--flights 200] [--climbs 200]

The pilot is the scripted one with a person's hands: five decisions a second, each from what was to be seen a fifth of a
second ago. A second one waits twice as long, and is mistaken in every tenth decision: it stands for a beginner.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse

import numpy as np

from ai.lander.environment import LIMITS, NUM_ACTIONS, LanderEnv
from ai.lander.pilots import ScriptedPilot
from ai.lander.spawns import LADDER
from tests.support.slow_hands import fly_slowly

MOST = 60  # flights of a climb
PILOTS = {"a fifth of a second late": (12, 0.0), "two fifths late, a tenth mistaken": (24, 0.1)}


def share(spawn: str, count: int, seed: int, late: int, mistaken: float) -> float:
    """Share of `count` flights from that kind of start that land, flown `late` steps behind."""
    env = LanderEnv(count, seed, spawn, frame_skip=1, limits=LIMITS.roomy())
    env.reset()
    rng = np.random.default_rng(seed)

    def slips() -> tuple[np.ndarray, np.ndarray]:
        return rng.random(count) < mistaken, rng.integers(NUM_ACTIONS, size=count)

    return float(fly_slowly(env, ScriptedPilot(), late, slips).mean())


def climb(rates: list[float], rng: np.random.Generator) -> int:
    """Return how many flights a player who lands with these `rates` from each rung takes to its top."""
    rung, flights = 0, 0
    while rung < len(rates) - 1 and flights < MOST:
        rung = rung + 1 if rng.random() < rates[rung] else max(0, rung - 1)
        flights += 1
    return flights


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--flights", type=int, default=200)
    parser.add_argument("--climbs", type=int, default=200)
    arguments = parser.parse_args()
    rates: dict[str, list[float]] = {name: [] for name in PILOTS}
    print(f"| rung | {' | '.join(PILOTS)} |\n|---|{'---|' * len(PILOTS)}")
    for rung, (_, spawn) in enumerate(LADDER.stages):
        for name, hands in PILOTS.items():
            rates[name].append(share(spawn, arguments.flights, 7 + rung, *hands))
        cells = " | ".join(f"{100 * rates[name][-1]:.0f} %" for name in PILOTS)
        print(f"| {rung + 1 if spawn != 'random' else 'anywhere'} | {cells} |", flush=True)
    rng = np.random.default_rng(0)
    for name in PILOTS:
        taken = np.array([climb(rates[name], rng) for _ in range(arguments.climbs)])
        half, most = np.quantile(taken, (0.5, 0.9))
        print(f"{name}: at the top after {half:.0f} flights in the median, {most:.0f} in nine of ten")


if __name__ == "__main__":
    main()
