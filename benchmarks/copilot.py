"""How long one shared decision takes, with one pad and with three.

    python -m benchmarks.copilot [--rounds 2000]

A decision is all that the game does for it: observe the lander for every pad, value every action on the way to each,
read which pad is meant, and choose. The network is the one that comes with the game.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
import platform
import time
from pathlib import Path

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.copilot.copilot import CoPilot, Mode
from ai.lander.environment import NUM_ACTIONS, LanderEnv
from ai.lander.ground import Ground, hilly

MODEL = Path(__file__).parent.parent / "models" / "lander" / "modern"


def decisions(copilot: CoPilot, ground: Ground, rounds: int) -> list[float]:
    """Median and 99th percentile in milliseconds, by the clock and of processor time, which others do not lengthen."""
    env = LanderEnv(1, 0, frame_skip=1, ground=ground)
    env.reset()
    rng = np.random.default_rng(0)
    took, worked = [], []
    for _ in range(rounds):
        pilot = rng.integers(0, NUM_ACTIONS, 1)
        start, work = time.perf_counter(), time.process_time()
        action, _ = copilot.share(env.observe_pads(), pilot, env.around_pads())
        took.append(time.perf_counter() - start)
        worked.append(time.process_time() - work)
        if env.step(action).ended[0]:
            env.reset()
            copilot.forget()
    return [1e3 * float(np.quantile(times, share)) for times in (took, worked) for share in (0.5, 0.99)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=2000)
    rounds = parser.parse_args().rounds
    agent = DeepQAgent.load(MODEL)
    print(f"{platform.processor() or platform.machine()}, Python {platform.python_version()}, NumPy {np.__version__}")
    print("| | median | 99% within | processor, median | 99% within |\n|---|---|---|---|---|")
    for name, ground in (("one pad", Ground.flat()), ("three pads", hilly(np.random.default_rng(0)))):
        for mode in Mode:
            figures = decisions(CoPilot(agent, 0.5, mode), ground, rounds)
            print(f"| {name}, {mode} | " + " | ".join(f"{figure:.3f} ms" for figure in figures) + " |")


if __name__ == "__main__":
    main()
