"""What the path's chapters on the target network, the memory and daring claim, over several seeds.

python -m benchmarks.small_runs [--seeds 10]      # some ten minutes of one core
"""

from __future__ import annotations

import argparse

from ai.agent.config import Config
from ai.training.small_run import SMALL_RUN, Plan, SmallRun, SmallState
from game.learn.daring import DARING, PAY
from game.learn.memory import LATEST, TODAY, YESTERDAY, MemoryChapter
from game.learn.target import BOUND, EVERY

DECISIONS = 600


def run(config: Config, seed: int, plan: Plan | None = None, decisions: int = DECISIONS) -> list[SmallState]:
    """Return the states of a run after each decision."""
    small = SmallRun(config, seed, plan)
    return [small.advance() for _ in range(decisions)]


def main() -> None:
    """Print a line for each chapter and choice."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=10)
    seeds = range(parser.parse_args().seeds)
    for every in EVERY:
        states = [run(SMALL_RUN.changed(target_update_interval=every), seed) for seed in seeds]
        beyond = sum(max(state.value for state in each) > BOUND for each in states)
        print(f"target copied every {every}: values beyond {BOUND:g} in {beyond}, {_landed(states)}", flush=True)
    for share in DARING:
        config = SMALL_RUN.changed(n_step=5, reward_weights=PAY, epsilon_start=share, epsilon_end=share)
        states = [run(config, seed, Plan((5.0, 8.0))) for seed in seeds]
        print(f"{share:.0%} at random: {_landed(states)}", flush=True)
    for kind, prioritised, keep in (("even", False, None), ("surprising", True, None), ("latest", False, LATEST)):
        plan, config = MemoryChapter.PLAN._replace(keep=keep), SMALL_RUN.changed(prioritised=prioritised)
        least = [
            min(state.passed or 0.0 for state in run(config, seed, plan, YESTERDAY + TODAY)[YESTERDAY:])
            for seed in seeds
        ]
        print(f"memory {kind}: least share of tests today {[round(share, 2) for share in least]}", flush=True)


def _landed(runs: list[list[SmallState]]) -> str:
    return f"at least half landed in {sum((states[-1].landed or 0.0) >= 0.5 for states in runs)} of {len(runs)}"


if __name__ == "__main__":
    main()
