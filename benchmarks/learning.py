"""How long it takes to learn to land, beside stable-baselines3's DQN on the same lander.

    python -m benchmarks.learning [--seeds 5] [--seconds 60] [--rival-seeds 3] [--rival-seconds 300]

Ours is the modern preset. The rival has the settings its authors tuned for Gymnasium's lunar lander and flies
ours through Gymnasium, one decision at a time, from the same practice spawns. Every second of training (the
rival: every ten) the network flies 500 random spawns greedily, which is not counted. A share counts as reached
when it is first seen. Seconds are processor time on one thread, so that a busy machine does not matter.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import platform
import statistics
import time
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import version
from importlib.util import find_spec
from typing import Any

import numpy as np

from ai.config import PRESETS
from ai.env import Floats, Ints
from ai.training import TEST_SEED, Training, evaluate

FLIGHTS = 500
SHARES = (0.95, 0.99)
# rl-baselines3-zoo, hyperparams/dqn.yml, LunarLander
TUNED = {
    "learning_rate": 6.3e-4, "batch_size": 128, "buffer_size": 50_000, "learning_starts": 5000, "gamma": 0.99,
    "target_update_interval": 250, "train_freq": 4, "gradient_steps": -1, "exploration_fraction": 0.12,
    "exploration_final_eps": 0.1, "policy_kwargs": {"net_arch": [256, 256]},
}  # fmt: skip
TUNED_STEPS = 100_000


@dataclass
class Run:
    """When one seed reached each share, in seconds and decisions, and the last share seen."""

    seconds: list[float]
    decisions: list[float]
    last: float


def measure(seen: Iterator[tuple[float, int, float]], limit: float) -> Run:
    """Follow a training that tells its seconds, decisions and share landed, until all is reached or time is up."""
    run = Run([np.inf] * len(SHARES), [np.inf] * len(SHARES), 0.0)
    for seconds, decisions, landed in seen:
        run.last = landed
        for k, share in enumerate(SHARES):
            if landed >= share and np.isinf(run.seconds[k]):
                run.seconds[k], run.decisions[k] = seconds, decisions
        if seconds >= limit or landed >= SHARES[-1]:
            break
    return run


def ours(seed: int) -> Iterator[tuple[float, int, float]]:
    training = Training(PRESETS["modern"], seed, evaluate_every=0)
    spent = 0.0
    while True:
        start = time.process_time()
        while time.process_time() - start < 1.0:
            training.advance()
        spent += time.process_time() - start
        yield spent, training.agent.decisions, evaluate(training.agent, FLIGHTS, TEST_SEED).success


class Flyer:
    """Lets stable-baselines3's network fly where ours do."""

    def __init__(self, model: Any) -> None:
        self.model = model

    def act(self, observation: Floats, held: Ints | None = None) -> Ints:  # noqa: ARG002
        """Actions (n,) for observations (n, 9)."""
        actions: Ints = self.model.predict(observation, deterministic=True)[0]
        return actions


def theirs(seed: int) -> Iterator[tuple[float, int, float]]:
    import gymnasium
    import torch
    from stable_baselines3 import DQN

    torch.set_num_threads(1)
    env = gymnasium.make("ai.gym_lander:tranquility/Lander-v0", spawn="practice")
    model = DQN("MlpPolicy", env, seed=seed, device="cpu", **TUNED)
    spent = 0.0
    while True:
        start = time.process_time()
        # Its schedule of random actions spans the steps it was tuned for, and stays at its end after them.
        model.learn(
            max(1000, TUNED_STEPS - model.num_timesteps), reset_num_timesteps=model.num_timesteps == 0,
            callback=lambda *_, start=start: time.process_time() - start < 10.0,
        )  # fmt: skip
        spent += time.process_time() - start
        yield spent, model.num_timesteps, evaluate(Flyer(model), FLIGHTS, TEST_SEED).success


def row(name: str, runs: list[Run], limit: float) -> list[float]:
    """Print one line of the table, and return its medians."""
    cells = []
    for k in range(len(SHARES)):
        seconds, decisions = (statistics.median(getattr(run, kind)[k] for run in runs)
                              for kind in ("seconds", "decisions"))  # fmt: skip
        late = np.isinf(seconds)
        cells.append(f"not within {limit:g} s" if late else f"{seconds:.1f} s, {decisions / 1000:,.0f}k decisions")
    last = " ".join(f"{run.last:.1%}" for run in runs)
    print(f"| {name} | {' | '.join(cells)} | {last} |", flush=True)
    return [statistics.median(run.seconds[k] for run in runs) for k in range(len(SHARES))]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--rival-seeds", type=int, default=3)
    parser.add_argument("--rival-seconds", type=float, default=300.0)
    arguments = parser.parse_args()
    rival = find_spec("stable_baselines3") is not None
    versions = [f"Python {platform.python_version()}", f"NumPy {np.__version__}"]
    versions += [f"{name} {version(name)}" for name in ("stable-baselines3", "torch", "gymnasium") if rival]
    print(f"{', '.join(versions)}; medians of {arguments.seeds} seeds of ours", end="")
    print(f", {arguments.rival_seeds} of theirs\n" if rival else "\n")
    print(f"| | {' | '.join(f'{share:.0%} landed after' for share in SHARES)} | last seen, each seed |")
    print("|---|---|---|---|")
    runs = [measure(ours(seed), arguments.seconds) for seed in range(arguments.seeds)]
    mine = row("ours, modern", runs, arguments.seconds)
    if not rival:
        print('\nstable-baselines3 is not installed; to compare with it: pip install "tranquility[bench]"')
        return
    limit = arguments.rival_seconds
    runs = [measure(theirs(seed), limit) for seed in range(arguments.rival_seeds)]
    other = row("stable-baselines3's DQN, tuned", runs, limit)
    ratios = [f"over {limit / us:.0f}" if np.isinf(them) else f"{them / us:.0f}"
              for us, them in zip(mine, other, strict=True)]  # fmt: skip
    print(f"| times as long | {' | '.join(ratios)} | |")


if __name__ == "__main__":
    main()
