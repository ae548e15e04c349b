"""How long it takes to learn to land, beside stable-baselines3's DQN on the same lander.

    python -m benchmarks.learning [--seeds 10] [--seconds 60] [--rival-seeds 3] [--rival-seconds 300]
                                 [--preset modern] [--set NAME=VALUE ...]

Ours is the modern preset, whose settings were tuned for this lander. The rival's were not: it has those that its
authors tuned for Gymnasium's lunar lander, and flies ours through Gymnasium, one decision at a time, from the same
spawns. Every second of training (the rival: every ten) the network flies 2,000 random validation spawns greedily, one
that is taught hard spawns 1,000 of those as well, and the best so far is kept. A share counts as reached when the best
lands it of the random ones; then, and not before, it flies 2,000 test spawns, which had no say in anything, and the
table shows what it lands of those. Seconds are processor time on one thread, of training alone.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import platform
import statistics
import time
from collections.abc import Callable, Iterator
from copy import deepcopy
from dataclasses import dataclass
from importlib.metadata import version
from importlib.util import find_spec
from typing import Any

import numpy as np

from ai.cli.command_line import configured
from ai.environment import Floats, Ints, finished
from ai.lander.pilots import Pilot
from ai.lander.spawns import CURRICULA
from ai.training.config import PRESETS, Config
from ai.training.loop import Training
from ai.training.tasks import TEST_SEED, VALIDATION_SEED, Evaluation, LanderTask, flights

STOPPING_FLIGHTS = 2000  # more: of 500, a network that lands 98.5 % lands 99 % once in four looks
TEST_FLIGHTS = 2000
SHARES = (0.95, 0.99)
# rl-baselines3-zoo, hyperparams/dqn.yml, LunarLander
TUNED = {
    "learning_rate": 6.3e-4, "batch_size": 128, "buffer_size": 50_000, "learning_starts": 5000, "gamma": 0.99,
    "target_update_interval": 250, "train_freq": 4, "gradient_steps": -1, "exploration_fraction": 0.12,
    "exploration_final_eps": 0.1, "policy_kwargs": {"net_arch": [256, 256]},
}  # fmt: skip
TUNED_STEPS = 100_000
LANDER = "ai.training.gym_lander:tranquility/Lander-v0"


@dataclass
class Kept:
    """The best network after so many seconds of training, measured on spawns that did not choose it."""

    seconds: float
    decisions: int
    test: Evaluation


Checkpoint = tuple[float, int, Pilot, Callable[[], Pilot]]  # seconds, decisions, the pilot, how to keep it


def followed(
    training: Iterator[Checkpoint], validate: Callable[[Pilot], Any]
) -> Iterator[tuple[float, int, Pilot, Any]]:
    """Yield seconds, decisions, the best pilot so far by validation, and its score."""
    best, kept = None, None
    for seconds, decisions, pilot, keep in training:
        score = validate(pilot)
        if score.better_than(best):
            best, kept = score, keep()
        assert kept is not None
        yield seconds, decisions, kept, best


def race(
    training: Iterator[Checkpoint], limit: float, task: LanderTask | None = None, shares: tuple[float, ...] = SHARES
) -> tuple[list[Kept | None], float]:
    """The network kept when validation first lands each share, None for those not reached; and the last's test share.

    What lands of the test spawns decides neither when to stop nor what is kept.
    """
    reached: list[Kept | None] = [None] * len(shares)
    fly = task.trial if task else flights
    scored = followed(training, lambda pilot: finished(fly(pilot, STOPPING_FLIGHTS, VALIDATION_SEED)))
    for seconds, decisions, pilot, best in scored:
        ended = seconds >= limit or best.success >= max(shares)
        if ended or any(old is None and best.success >= share for old, share in zip(reached, shares, strict=True)):
            kept = Kept(seconds, decisions, finished(flights(pilot, TEST_FLIGHTS, TEST_SEED)))
            passed = [best.success >= share for share in shares]
            reached = [old or (kept if there else None) for old, there in zip(reached, passed, strict=True)]
        if ended:
            break
    return reached, kept.test.success


def ours(seed: int, config: Config = PRESETS["modern"]) -> Iterator[Checkpoint]:
    """Train one of ours without end, pausing every second."""
    training = Training(config, seed, evaluate_every=0)
    spent = 0.0
    while True:
        start = time.process_time()
        while time.process_time() - start < 1.0:
            training.advance()
        spent += time.process_time() - start
        yield spent, training.agent.decisions, training.agent, training.best_agent


class Flyer:
    """Lets stable-baselines3's network fly where ours do."""

    def __init__(self, model: Any) -> None:
        self.model = model

    def act(self, observation: Floats, held: Ints | None = None) -> Ints:  # noqa: ARG002
        """Actions (n,) for observations (n, 9)."""
        actions: Ints = self.model.predict(observation, deterministic=True)[0]
        return actions


def sb3_dqn(env: str, seed: int, **options: Any) -> Iterator[Checkpoint]:
    """Train one of stable-baselines3's without end, pausing every ten seconds."""
    import gymnasium
    import torch
    from stable_baselines3 import DQN

    torch.set_num_threads(1)
    model = DQN("MlpPolicy", gymnasium.make(env, **options), seed=seed, device="cpu", **TUNED)
    spent = 0.0
    while True:
        start = time.process_time()
        # Its schedule of random actions spans the steps it was tuned for, and stays at its end after them.
        model.learn(
            max(1000, TUNED_STEPS - model.num_timesteps),
            reset_num_timesteps=model.num_timesteps == 0,
            callback=lambda *_, start=start: time.process_time() - start < 10.0,
        )
        spent += time.process_time() - start
        yield spent, model.num_timesteps, Flyer(model), lambda: Flyer(deepcopy(model.policy))


def row(name: str, runs: list[tuple[list[Kept | None], float]], limit: float) -> list[float]:
    """Print one line of the table, and return its medians."""
    cells, medians = [], []
    for k in range(len(SHARES)):
        seconds = [np.inf if kept is None else kept.seconds for kept in (reached[k] for reached, _ in runs)]
        decisions = [np.inf if kept is None else kept.decisions for kept in (reached[k] for reached, _ in runs)]
        medians.append(statistics.median(seconds))
        if np.isinf(medians[-1]):
            cells.append(f"not within {limit:g} s")
            continue
        slowest = f"{max(seconds):.1f} s" if np.isfinite(max(seconds)) else f"not within {limit:g} s"
        tests = [kept.test.success for reached, _ in runs if (kept := reached[k])]
        cells.append(
            f"{medians[-1]:.1f} s, {statistics.median(decisions) / 1000:,.0f}k decisions"
            f" ({min(seconds):.1f} s; {slowest}); {statistics.median(tests):.1%} ({min(tests):.1%})"
        )
    print(f"| {name} | {' | '.join(cells)} | {' '.join(f'{last:.1%}' for _, last in runs)} |", flush=True)
    return medians


def compare(arguments: argparse.Namespace, config: Config) -> None:
    """Print how long each needs to land each share."""
    rival = find_spec("stable_baselines3") is not None and arguments.rival_seeds > 0
    heads = " | ".join(
        f"{share:.0%} of validation after: median (fastest; slowest); of test then: median (least)" for share in SHARES
    )
    print(f"| | {heads} | of test at the end, each seed |\n|---|---|---|---|")
    task = LanderTask(config)
    runs = [race(ours(seed, config), arguments.seconds, task) for seed in range(arguments.seeds)]
    mine = row(f"ours, {arguments.preset}", runs, arguments.seconds)
    if not rival:
        print('\nto compare with stable-baselines3: pip install -e ".[bench]"')
        return
    limit = arguments.rival_seconds
    spawn = CURRICULA.get(config.spawn, config.spawn)
    runs = [race(sb3_dqn(LANDER, seed, spawn=spawn), limit) for seed in range(arguments.rival_seeds)]
    other = row("stable-baselines3's DQN, tuned for Gymnasium's lander", runs, limit)
    ratios = [
        f"over {limit / us:.0f}" if np.isinf(them) else f"{them / us:.0f}" for us, them in zip(mine, other, strict=True)
    ]
    print(f"| times as long | {' | '.join(ratios)} | |")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--rival-seeds", type=int, default=3)
    parser.add_argument("--rival-seconds", type=float, default=300.0)
    parser.add_argument("--preset", default="modern", choices=PRESETS)
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", dest="changes")
    arguments = parser.parse_args()
    config = configured(PRESETS[arguments.preset], arguments.changes)
    versions = [f"Python {platform.python_version()}", f"NumPy {np.__version__}"]
    rivals = ("stable-baselines3", "torch", "gymnasium")
    versions += [f"{name} {version(name)}" for name in rivals if find_spec(name.replace("-", "_"))]
    print(f"{', '.join(versions)}; {arguments.seeds} seeds of ours\n")
    compare(arguments, config)


if __name__ == "__main__":
    main()
