"""How long it takes to learn Gymnasium's LunarLander-v3, beside stable-baselines3's DQN.

    python -m benchmarks.lunar_lander [--seeds 3] [--decisions 300000] [--rival-seeds 3] [--rival-seconds 300]

Ours has the settings `ai.training.config.LUNAR_LANDER`; the rival those its authors tuned for this. Every 20,000
decisions (the rival: every ten seconds) the network flies 100 validation episodes without random actions and with a
decision at every step, as the rival's, and the best so far is kept; in the end that one flies 100 others, which had no
say in the choice. No clock chooses ours: the same seed and decisions give the same figures. Seconds are processor time
on one thread, of training alone.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import platform
import statistics
import sys
import time
from collections.abc import Iterator
from importlib.metadata import version
from importlib.util import find_spec

import numpy as np

from ai.environment import finished
from ai.training.config import gym_config
from ai.training.gym_task import GymTask
from ai.training.loop import Training
from ai.training.tasks import TEST_SEED, VALIDATION_SEED
from benchmarks.learning import Checkpoint, followed, sb3_dqn

ENV = "LunarLander-v3"
PAUSE = 20_000  # decisions
VALIDATION_EPISODES, TEST_EPISODES = 100, 100
RETURNS = (200.0, 250.0, 270.0)


def ours(seed: int, decisions: int) -> Iterator[Checkpoint]:
    """Train one of ours, pausing every 20,000 decisions."""
    training = Training(gym_config(ENV), seed, evaluate_every=0)
    spent = 0.0
    for pause in range(PAUSE, decisions + PAUSE, PAUSE):
        start = time.process_time()
        while training.agent.decisions < min(pause, decisions):
            training.advance()
        spent += time.process_time() - start
        yield spent, training.agent.decisions, training.agent, training.best_agent


def measured(training: Iterator[Checkpoint], limit: float = np.inf) -> tuple[list[float], float, int, float]:
    """Return the seconds to each mean return, all seconds and decisions, and what the best network earns at last."""
    task = GymTask(gym_config(ENV))
    seconds = [np.inf] * len(RETURNS)
    scored = followed(training, lambda pilot: finished(task.trial(pilot, VALIDATION_EPISODES, VALIDATION_SEED, 1)))
    for spent, decisions, pilot, best in scored:  # noqa: B007
        seconds = [
            min(old, spent) if best.mean_return >= goal else old for old, goal in zip(seconds, RETURNS, strict=True)
        ]
        if spent >= limit:
            break
    return seconds, spent, decisions, finished(task.trial(pilot, TEST_EPISODES, TEST_SEED, 1)).mean_return


def row(name: str, runs: list[tuple[list[float], float, int, float]]) -> None:
    """Print one line of the table: medians, and each seed's end."""
    cells = []
    for k in range(len(RETURNS)):
        middle = statistics.median(seconds[k] for seconds, *_ in runs)
        cells.append("never" if np.isinf(middle) else f"{middle:.0f} s")
    cells.append(f"{statistics.median(spent for _, spent, _, _ in runs):.0f} s")
    cells.append(f"{statistics.median(decisions for _, _, decisions, _ in runs) / 1000:,.0f}k")
    print(f"| {name} | {' | '.join(cells)} | {', '.join(f'{earned:.0f}' for *_, earned in runs)} |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--decisions", type=int, default=300_000)
    parser.add_argument("--rival-seeds", type=int, default=3)
    parser.add_argument("--rival-seconds", type=float, default=300.0)
    arguments = parser.parse_args()
    if not (find_spec("gymnasium") and find_spec("Box2D")):
        sys.exit('this needs Gymnasium and Box2D: pip install -e ".[bench]"')
    rivals = [name for name in ("stable-baselines3", "torch") if find_spec(name.replace("-", "_"))]
    names = ", ".join(f"{name} {version(name)}" for name in ("numpy", "gymnasium", *rivals))
    print(f"Python {platform.python_version()}, {names}\n")
    heads = " | ".join(f"validation mean {goal:.0f} after" for goal in RETURNS)
    print(f"| | {heads} | trained for | decisions | mean return of {TEST_EPISODES} unseen episodes, each seed |")
    print("|---|---|---|---|---|---|")
    row("ours", [measured(ours(seed, arguments.decisions)) for seed in range(arguments.seeds)])
    if "stable-baselines3" not in rivals:
        print('\nto compare with stable-baselines3: pip install -e ".[bench]"')
    elif arguments.rival_seeds > 0:
        limit = arguments.rival_seconds
        row(
            "stable-baselines3's DQN, tuned",
            [measured(sb3_dqn(ENV, seed), limit) for seed in range(arguments.rival_seeds)],
        )


if __name__ == "__main__":
    main()
