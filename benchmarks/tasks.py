"""One setting, five tasks: what `ai.training.config.GYM` learns on each, and stable-baselines3's DQN on two of them.

    python -m benchmarks.tasks [NAME ...] [--seeds 5] [--share 1.0] [--rival-seeds 5]

Ours has the same setting on all five; on our own lander a decision is four physics steps, as everywhere. The rival has
the one that its authors tuned for each task (rl-baselines3-zoo, hyperparams/dqn.yml), and as many steps as that says.
Every tenth part of a run, the network flies the validation episodes without random actions, and the best so far is
kept; that one flies the test episodes, which had no say in the choice. The rival's last network does. No clock chooses:
the same seed and decisions give the same figures. `--share` trains for a share of the decisions.

The table has means over seeds with their 95 % interval (Student's t): mean returns, of our lander per cent landed.
Seconds are processor time on one thread, of training alone.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from math import sqrt
from typing import Any, Final

import numpy as np

from ai.environment import finished
from ai.training.config import GYM, LANDER, Config
from ai.training.loop import Training
from ai.training.tasks import TEST_SEED, VALIDATION_SEED, Evaluation

MOMENTS: Final = 10  # validations of a run
STUDENT: Final = {1: 12.706, 2: 4.303, 3: 3.182, 4: 2.776, 5: 2.571, 6: 2.447, 7: 2.365, 8: 2.306, 9: 2.262}


@dataclass(frozen=True)
class Aim:
    """What is to be reached on a task, after so many decisions."""

    goal: float
    decisions: int


AIMS: Final = {
    "CartPole-v1": Aim(500.0, 100_000),
    "Acrobot-v1": Aim(-80.0, 200_000),
    "MountainCar-v0": Aim(-110.0, 300_000),
    "LunarLander-v3": Aim(270.0, 600_000),
    LANDER: Aim(99.5, 200_000),
}
TUNED: Final[dict[str, tuple[int, dict[str, Any]]]] = {  # steps and settings
    "CartPole-v1": (50_000, {
        "learning_rate": 2.3e-3, "batch_size": 64, "buffer_size": 100_000, "learning_starts": 1000, "gamma": 0.99,
        "target_update_interval": 10, "train_freq": 256, "gradient_steps": 128, "exploration_fraction": 0.16,
        "exploration_final_eps": 0.04, "policy_kwargs": {"net_arch": [256, 256]},
    }),
    "MountainCar-v0": (120_000, {
        "learning_rate": 4e-3, "batch_size": 128, "buffer_size": 10_000, "learning_starts": 1000, "gamma": 0.98,
        "target_update_interval": 600, "train_freq": 16, "gradient_steps": 8, "exploration_fraction": 0.2,
        "exploration_final_eps": 0.07, "policy_kwargs": {"net_arch": [256, 256]},
    }),
}  # fmt: skip
Run = tuple[float, int, float]  # what it earns at last, decisions, seconds


def setting(env: str) -> Config:
    """Return the one setting for a task."""
    return GYM.changed(env=env, frame_skip=4) if env == LANDER else GYM.changed(env=env)


def earned(score: Any) -> float:
    """Return the figure of a score: per cent landed, or a mean return."""
    return 100 * float(score.success) if isinstance(score, Evaluation) else float(score.mean_return)


def ours(env: str, decisions: int, seed: int) -> Run:
    """Train with the setting, and measure the best network of all moments."""
    training = Training(setting(env), seed, evaluate_every=0)
    task, best, kept, spent = training.task, None, None, 0.0
    for moment in range(1, MOMENTS + 1):
        start = time.process_time()
        while training.agent.decisions < decisions * moment / MOMENTS:
            training.advance()
        spent += time.process_time() - start
        score = finished(task.trial(training.agent, task.validation_episodes, VALIDATION_SEED))
        if score.better_than(best):
            best, kept = score, training.best_agent()
    assert kept is not None
    return earned(finished(task.trial(kept, task.test_episodes, TEST_SEED))), training.agent.decisions, spent


def rivals(env: str, share: float, seed: int) -> Run:
    """Train one of stable-baselines3's as its authors do, and measure it at the end."""
    import gymnasium
    import torch
    from stable_baselines3 import DQN
    from stable_baselines3.common.evaluation import evaluate_policy

    torch.set_num_threads(1)
    steps, settings = TUNED[env]
    model = DQN("MlpPolicy", gymnasium.make(env), seed=seed, device="cpu", **settings)
    start = time.process_time()
    model.learn(round(share * steps))
    spent = time.process_time() - start
    mean, _ = evaluate_policy(model, model.get_env(), n_eval_episodes=100)
    return float(mean), model.num_timesteps, spent


def row(name: str, goal: float, seeds: int, run: Callable[[int], Run]) -> None:
    """Print one line of the table."""
    ends, decisions, seconds = zip(*(run(seed) for seed in range(seeds)), strict=True)
    middle = statistics.mean(ends)
    half = STUDENT.get(seeds - 1, 1.96) * statistics.stdev(ends) / sqrt(seeds) if seeds > 1 else float("nan")
    each = ", ".join(f"{end:.1f}" for end in ends)
    spent = f"{np.mean(decisions) / 1000:,.0f}k | {np.mean(seconds):.0f} s"
    print(f"| {name} | {goal:g} | {middle:.1f} ± {half:.1f} | {each} | {spent} |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"tasks, of {', '.join(AIMS)}; all without")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--share", type=float, default=1.0, help="train for this share of the decisions")
    parser.add_argument("--rival-seeds", type=int, default=5)
    arguments = parser.parse_args()
    names = arguments.names or list(AIMS)
    if unknown := [name for name in names if name not in AIMS]:
        parser.error(f"no task is called {unknown[0]}; there are {', '.join(AIMS)}")
    if not (find_spec("gymnasium") and find_spec("Box2D")):
        sys.exit('this needs Gymnasium and Box2D: pip install -e ".[bench]"')
    print("| task | goal | reached | each seed | decisions | seconds |")
    print("|---|---|---|---|---|---|")
    for env in names:
        aim, decisions = AIMS[env], round(arguments.share * AIMS[env].decisions)
        row(env, aim.goal, arguments.seeds, partial(ours, env, decisions))
        if env in TUNED and arguments.rival_seeds > 0 and find_spec("stable_baselines3"):
            name = f"{env}, stable-baselines3's DQN"
            row(name, aim.goal, arguments.rival_seeds, partial(rivals, env, arguments.share))
    if not find_spec("stable_baselines3"):
        print('\nto compare with stable-baselines3: pip install -e ".[bench]"')


if __name__ == "__main__":
    main()
