"""How far descents are flown: by the network that comes with the game, and by a pilot with a person's slow hands.

    python -m benchmarks.descent [--runs 40] [--pilots network slow]

The slow pilot is the scripted one with five decisions a second, each from what was to be seen a fifth of a second ago.
Both follow the legs' routes, and land on pads alone.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
from collections import Counter
from pathlib import Path

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.lander.pilots import Pilot, ScriptedPilot
from tests.support.descent import QUICK, SLOW, descend

MODEL = Path(__file__).parent.parent / "models" / "lander" / "modern"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=40)
    parser.add_argument("--pilots", nargs="*", default=["network", "slow"], choices=["network", "slow"])
    arguments = parser.parse_args()
    pilots: dict[str, tuple[Pilot, tuple[int, int]]] = {
        "network": (DeepQAgent.load(MODEL), QUICK),
        "slow": (ScriptedPilot(), SLOW),
    }
    print("| pilot | runs | legs: fewest | a tenth of runs | median | most | runs that passed leg 5 | ended by |")
    print("|---|---|---|---|---|---|---|---|")
    for name in arguments.pilots:
        runs = [descend(seed, *pilots[name]) for seed in range(arguments.runs)]
        legs = np.array([run.legs for run in runs])
        ends = ", ".join(f"{end} {count}" for end, count in Counter(run.end for run in runs).most_common())
        print(
            f"| {name} | {len(runs)} | {legs.min()} | {np.quantile(legs, 0.1):.0f} | {np.median(legs):.0f} "
            f"| {legs.max()} | {(legs >= 5).sum()} | {ends} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
