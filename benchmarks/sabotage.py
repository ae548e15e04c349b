"""What the cards of the sabotage lab say was measured: shares of training flights that landed, over several seeds.

    python -m benchmarks.sabotage [--seeds 6] [--only NAME ...]    # ten seconds of one core for each run

Each part is taken away from the modern preset, and each run is trained for 150,000 decisions. A share is of the latest
hundred training flights, with their chance moves; a line gives its mean over the seeds, and the 95 % interval of that
mean (Student's t), then the least and the most. Another processor learns otherwise from the same seed, so single seeds
tell nothing.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
from typing import Final

from ai.training.config import PRESETS
from ai.training.experiments import MEASURED, SABOTAGES, sabotaged
from ai.training.loop import Training
from ai.training.statistics import mean_of_shares

AFTER: Final = (50_000, 100_000, 150_000)


def shares(name: str, seed: int) -> list[float]:
    """Return the share that landed after each of `AFTER`; with one lander, after as many turns as 6,000 decisions."""
    config = PRESETS[MEASURED]
    training = Training(config if name == MEASURED else sabotaged(config, name), seed=seed, evaluate_every=0)
    found = []
    for decisions in (6_000,) if training.env.num_envs == 1 else AFTER:
        while training.agent.decisions < decisions:
            progress = training.advance()
        found.append(progress.success_rate)
    return found


def main() -> None:
    """Print a line for each part that is taken away."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--only", nargs="+", choices=(MEASURED, *SABOTAGES), default=(MEASURED, *SABOTAGES))
    options = parser.parse_args()
    for name in options.only:
        runs = [shares(name, seed) for seed in range(options.seeds)]
        told = []
        for each in zip(*runs, strict=True):
            mean, low, high = mean_of_shares(each)
            told.append(f"{mean:4.0%} ({low:.0%} to {high:.0%}; {min(each):.0%} to {max(each):.0%})")
        print(f"{name:18} {'  '.join(told)}", flush=True)


if __name__ == "__main__":
    main()
