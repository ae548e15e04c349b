"""What the path's chapters on the target network, the memory and daring claim, over several seeds, with 95 % intervals.

python -m benchmarks.small_runs [--seeds 12] [--chapters memory]    # some ten minutes of one core
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from math import sqrt
from statistics import mean, stdev

from ai.training.config import Config
from ai.training.small_run import SMALL_RUN, Plan, SmallRun, SmallState
from ai.training.statistics import wilson
from game.scenes.learn.memory import KEPT, TODAY, YESTERDAY, MemoryChapter
from game.scenes.learn.runs import BOUND, DARING, PAY, RIGHT

DECISIONS = 600
# Student's t of a two-sided 95 % interval, by degrees of freedom from 1 on.
_T = (12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131)


def mean_of_shares(shares: Sequence[float]) -> tuple[float, float, float]:
    """Return the mean of two or more shares, and its 95 % interval within 0 to 1 (Student's t)."""
    half = _T[min(len(shares) - 1, len(_T)) - 1] * stdev(shares) / sqrt(len(shares))
    return mean(shares), max(0.0, mean(shares) - half), min(1.0, mean(shares) + half)


def run(config: Config, seed: int, plan: Plan | None = None, decisions: int = DECISIONS) -> list[SmallState]:
    """Return the states of a run after each decision."""
    small = SmallRun(config, seed, plan)
    return [small.advance() for _ in range(decisions)]


def target(seeds: Sequence[int]) -> None:
    """Print how often values ran away, and how often landing was learned, with a target network and without."""
    for config in (SMALL_RUN, *RIGHT):
        states = [run(config, seed) for seed in seeds]
        beyond = sum(max(state.value for state in each) > BOUND for each in states)
        every, layers = config.target_update_interval, ", layers normalised" if config.layer_normalisation else ""
        print(
            f"target copied every {every}{layers}: values beyond {BOUND:g} in {beyond}, {_landed(states)}", flush=True
        )


def memory(seeds: Sequence[int]) -> None:
    """Print for each memory and seed the share of tests that landed at yesterday's end, and the least of today."""
    for keep in KEPT:
        plan = MemoryChapter.PLAN._replace(keep=keep)
        ranges, least = [], []
        for seed in seeds:
            shares = [state.passed or 0.0 for state in run(SMALL_RUN, seed, plan, YESTERDAY + TODAY)[YESTERDAY - 1 :]]
            least.append(min(shares[1:]))
            ranges.append(f"{shares[0]:.2f} to {least[-1]:.2f}")
        middle, low, high = mean_of_shares(least)
        print(
            f"memory of {keep or 'all'}: {', '.join(ranges)}; least {middle:.0%} ({low:.0%} to {high:.0%})", flush=True
        )


def daring(seeds: Sequence[int]) -> None:
    """Print how often landing was learned, for each share of random actions."""
    for share in DARING:
        config = SMALL_RUN.changed(n_step=5, reward_weights=PAY, epsilon_start=share, epsilon_end=share)
        states = [run(config, seed, Plan((5.0, 8.0))) for seed in seeds]
        print(f"{share:.0%} at random: {_landed(states)}", flush=True)


CHAPTERS = {"target": target, "memory": memory, "daring": daring}


def main() -> None:
    """Print a line for each chapter and choice."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=12)
    parser.add_argument("--chapters", nargs="+", choices=CHAPTERS, default=list(CHAPTERS))
    options = parser.parse_args()
    for chapter in options.chapters:
        CHAPTERS[chapter](range(options.seeds))


def _landed(runs: list[list[SmallState]]) -> str:
    landed = sum((states[-1].landed or 0.0) >= 0.5 for states in runs)
    low, high = wilson(landed / len(runs), len(runs))
    return f"at least half landed in {landed} of {len(runs)} ({low:.0%} to {high:.0%} of such runs)"


if __name__ == "__main__":
    main()
