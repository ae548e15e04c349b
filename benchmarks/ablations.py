"""What each part of the modern recipe is worth: the same training with one thing changed at a time.

    python -m benchmarks.ablations [--seeds 3] [--decisions 250000] [--only NAME ...]

Every variant trains on the same seeds for the same number of decisions, so that a busy machine changes
nothing but the seconds. Each is flown greedily from 300 random spawns every 25,000 decisions; the table gives the
decisions until 95 % and 99 % of them first landed, the share at the end, and what it took in CPU time, each the
median over the seeds.
"""

from __future__ import annotations

import argparse
import os
import platform
import statistics
import time
from dataclasses import replace
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import numpy as np

from ai.environment import finished
from ai.lander.rewards import RewardWeights
from ai.training.config import PRESETS, Config
from ai.training.loop import Training
from ai.training.tasks import VALIDATION_SEED, flights

EVERY = 25_000
FLIGHTS = 300
WITHOUT_SHAPING = RewardWeights(distance=0.0, speed=0.0, alignment=0.0, tilt=0.0, feet=0.0)

VARIANTS: dict[str, dict[str, Any]] = {
    "modern": {},
    "momentum for Adam": {"optimizer": "momentum", "learning_rate": 1e-2, "final_learning_rate": 1e-3},
    "plain steps for Adam": {"optimizer": "sgd", "learning_rate": 5e-2, "final_learning_rate": 1e-2},
    "ReLU": {"activation": "relu"},
    "tanh": {"activation": "tanh"},
    "tanh, no normalisation": {"activation": "tanh", "layer_normalisation": False},
    "no normalisation": {"layer_normalisation": False},
    "the target judges": {"target_judges": True},
    "the target judges, double Q": {"target_judges": True, "double": True},
    "dueling": {"dueling": True},
    "prioritised replay": {"prioritised": True},
    "1-step returns": {"n_step": 1},
    "5-step returns": {"n_step": 5},
    "hard target, every 200": {"target_judges": True, "target_update_interval": 200, "tau": 1.0},
    "squared error": {"cost": "mse"},
    "no mirror": {"mirror": False},
    "same ε for all": {"epsilon_spread": 0.0},
    "uniform random actions": {"random_main": 0.5},
    "no practice spawns": {"spawn": "random"},
    "real limits, no care": {"final_touchdown_limits": 1.0},
    "8 learning steps a decision": {"gradient_steps": 8},
    "no steadiness": {"steadiness": 0.0},
    "no shaping": {"reward_weights": WITHOUT_SHAPING},
    "replay of 10,000": {"replay_size": 10_000},
    "second pass over successes": {"success_pass": True, "success_batch_size": 64},
}


def curve(config: Config, seed: int, decisions: int) -> tuple[list[float], float]:
    """Shares of greedy flights landed after every 25,000 decisions, and CPU seconds of the training alone."""
    training = Training(config, seed, evaluate_every=0)
    landed, spent, started = [], 0.0, time.process_time()
    while training.agent.decisions < decisions:
        training.advance()
        if training.agent.decisions // EVERY > len(landed):
            spent += time.process_time() - started
            landed.append(finished(flights(training.agent, FLIGHTS, VALIDATION_SEED)).success)
            started = time.process_time()
    return landed, spent


def trained(name: str, seed: int, decisions: int) -> tuple[list[float], float]:
    """The curve of a variant, a seed and a number of decisions."""
    return curve(replace(PRESETS["modern"], **VARIANTS[name]), seed, decisions)


def first(landed: list[float], share: float) -> float:
    """Thousands of decisions until `share` first landed; infinite if never."""
    reached = [index for index, value in enumerate(landed) if value >= share]
    return (reached[0] + 1) * EVERY / 1000 if reached else float("inf")


def shown(values: list[float]) -> str:
    middle = statistics.median(values)
    return "never" if np.isinf(middle) else f"{middle:.0f}k"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--decisions", type=int, default=250_000)
    parser.add_argument("--only", nargs="+", choices=VARIANTS, default=list(VARIANTS))
    arguments = parser.parse_args()
    print(
        f"Python {platform.python_version()}, NumPy {np.__version__}; {arguments.seeds} seeds,"
        f" {arguments.decisions:,} decisions each, one thread\n"
    )
    print("| | 95 % after | 99 % after | mean of the curve | at the end | worst seed | CPU s |")
    print("|---|---|---|---|---|---|---|")
    for name in arguments.only:
        runs = [trained(name, seed, arguments.decisions) for seed in range(arguments.seeds)]
        curves = [landed for landed, _ in runs]
        final = [landed[-1] for landed in curves]
        print(
            f"| {name} | {shown([first(c, 0.95) for c in curves])} | {shown([first(c, 0.99) for c in curves])}"
            f" | {np.mean(curves):.2f} | {statistics.median(final):.1%} | {min(final):.1%}"
            f" | {statistics.median(spent for _, spent in runs):.1f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
