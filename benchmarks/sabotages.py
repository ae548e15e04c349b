"""What the sabotage cards say was measured: shares of training flights that landed, over several seeds.

    python -m benchmarks.sabotages [--seeds 4] [--only NAME ...]    # a run takes some ten seconds of one core

Each part is taken away from the modern preset, and each run is trained for 100,000 decisions. A share is of the latest
hundred training flights, with their chance moves; a line gives its mean over the seeds, and the 95 % interval of that
mean (Student's t), within 0 and 1. The cards read the file that this writes; with --only, the others' lines stay in it,
which must be of as many seeds. Another processor learns otherwise from
the same seed, so single seeds tell nothing.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
import json
from collections.abc import Sequence
from math import sqrt
from multiprocessing import Pool
from statistics import mean, stdev
from typing import Final

from ai.files import write_text
from ai.training.config import PRESETS
from ai.training.experiments import MEASURED, SABOTAGES, sabotaged
from ai.training.loop import Training
from game.scenes.train.laboratory import FILE, measurements

DECISIONS: Final = 100_000


# Student's t of a two-sided 95 % interval, by degrees of freedom from 1 on.
_T: Final = (12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131)


def mean_of_shares(shares: Sequence[float]) -> tuple[float, float, float]:
    """Return the mean of two or more shares, and its 95 % interval within 0 to 1 (Student's t)."""
    half = _T[min(len(shares) - 1, len(_T)) - 1] * stdev(shares) / sqrt(len(shares))
    return mean(shares), max(0.0, mean(shares) - half), min(1.0, mean(shares) + half)


def share(name: str, seed: int) -> float:
    """Return the share that landed in the end."""
    config = PRESETS[MEASURED]
    training = Training(config if name == MEASURED else sabotaged(config, name), seed=seed, evaluate_every=0)
    while training.agent.decisions < DECISIONS:
        progress = training.advance()
    return float(progress.success_rate)


def main() -> None:
    """Measure each card, print a line for it, and write the file that the cards read."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--only", nargs="*", choices=list(SABOTAGES), metavar="NAME", help="cards to measure")
    arguments = parser.parse_args()
    seeds, names = arguments.seeds, arguments.only or (MEASURED, *SABOTAGES)
    found = measurements() if arguments.only else {"seeds": seeds, "shares": {}}
    if found["seeds"] != seeds:
        parser.error(f"the other cards were measured with --seeds {found['seeds']}")
    shares = found["shares"]
    with Pool() as pool:
        landed = pool.starmap(share, [(name, seed) for name in names for seed in range(seeds)], chunksize=1)
    for number, name in enumerate(names):
        each = landed[number * seeds : (number + 1) * seeds]
        mean, low, high = mean_of_shares(each)
        shares[name] = [round(part, 3) for part in (mean, max(low, 0.0), min(high, 1.0))]
        print(f"{name:18} {mean:4.0%} ({low:.0%} to {high:.0%})  {' '.join(f'{one:.0%}' for one in each)}", flush=True)
    write_text(FILE, json.dumps({"decisions": DECISIONS, "seeds": seeds, "shares": shares}, indent=1) + "\n")


if __name__ == "__main__":
    main()
