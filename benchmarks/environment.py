"""How many physics steps a second our lander flies, beside Gymnasium's lunar lander and EnvPool's.

    python -m benchmarks.environment [--rounds 15]

All get uniformly random actions, drawn beforehand, and begin anew when they end, which counts as time but not
as steps. All are measured twice: with one physics step to a decision, as is the others' habit, and with four, as ours
are trained; the others have no setting for that, and are given each action four times. Gymnasium's landers are
stepped one after another, without its checks. All take turns, round after round, and processor time is counted, that
of EnvPool's one thread included; the table shows medians.

The others' simulator, Box2D, does more in a step: three bodies, two legs on joints with motors and limits, and 180
iterations for velocities and 60 for positions, of 1/50 s; EnvPool's source also adds a particle whenever an engine
fires. Ours moves one rigid body, with 5 and 2 iterations where it touches anything, by 1/60 s.

Flights of random actions seldom stand on their feet, and contacts take longer than free flight. So one lander alone
is measured once more in ten flights of the scripted pilot that land, whose actions were recorded.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
import platform
import statistics
import time
from collections.abc import Callable
from importlib.metadata import version
from importlib.util import find_spec
from itertools import product

import numpy as np

from ai.lander.environment import NUM_ACTIONS, LanderEnv, Outcome
from ai.lander.pilots import ScriptedPilot

SIZES = (1, 16, 64, 256, 1024)
SKIPS = (1, 4)  # physics steps to a decision
THEIR_ACTIONS = 4
DRAWN = 512  # rounds of actions, used again and again
RECORDED = 10  # landings, flown again and again

Steps = Callable[[int], int]


def drawn(actions: int, num_envs: int) -> np.ndarray:
    return np.random.default_rng(0).integers(0, actions, (DRAWN, num_envs))


def ours(num_envs: int, frame_skip: int) -> Steps:
    env, actions = LanderEnv(num_envs, 0, "random", frame_skip), drawn(NUM_ACTIONS, num_envs)
    env.reset()

    def steps(count: int) -> int:
        flown = -int(env.steps.sum())
        for k in range(count // (num_envs * frame_skip) + 1):
            ended = env.step(actions[k % DRAWN]).ended
            if ended.any():
                flown += int(env.steps[ended].sum())
                env.reset(ended)
        return flown + int(env.steps.sum())

    return steps


def landings(frame_skip: int) -> Steps:
    env, pilot, flights = LanderEnv(1, 0, "random", frame_skip), ScriptedPilot(), []
    while len(flights) < RECORDED:
        seen, start, actions = env.reset(), env.snapshot(), []
        while env.outcome[0] == Outcome.FLYING:
            actions.append(pilot.act(seen))
            seen = env.step(actions[-1]).observation
        if env.outcome[0] == Outcome.LANDED:
            flights.append((start, actions, int(env.steps[0])))

    def steps(count: int) -> int:
        flown = 0
        while flown < count:
            for start, actions, length in flights:
                env.restore(start)
                for action in actions:
                    env.step(action)
                flown += length
        return flown

    return steps


def gymnasiums(num_envs: int, frame_skip: int) -> Steps:
    import gymnasium

    envs = [gymnasium.make("LunarLander-v3", disable_env_checker=True) for _ in range(num_envs)]
    actions = drawn(THEIR_ACTIONS, num_envs).tolist()
    for seed, env in enumerate(envs):
        env.reset(seed=seed)

    def steps(count: int) -> int:
        flown = 0
        for k in range(count // (num_envs * frame_skip) + 1):
            for env, action in zip(envs, actions[k % DRAWN], strict=True):
                for _ in range(frame_skip):
                    _, _, terminated, truncated, _ = env.step(action)
                    flown += 1
                    if terminated or truncated:
                        env.reset()
                        break
        return flown

    return steps


def envpools(num_envs: int, frame_skip: int) -> Steps:
    import envpool

    envs = envpool.make("LunarLander-v3", env_type="gymnasium", num_envs=num_envs, num_threads=1, seed=0)
    actions = drawn(THEIR_ACTIONS, num_envs).astype(np.int32)
    envs.reset()

    def steps(count: int) -> int:
        turns = count // num_envs + 1
        for k in range(turns):
            envs.step(actions[k // frame_skip % DRAWN])  # begins ended ones anew by itself
        return turns * num_envs

    return steps


def speeds(contestants: list[Steps], rounds: int) -> list[float]:
    """Median steps a second of each; they take turns of about a fifth of a second."""
    counts = []
    for steps in contestants:
        start = time.process_time()
        warm = steps(20_000)
        counts.append(int(warm / (time.process_time() - start) * 0.2))
    records: list[list[float]] = [[] for _ in contestants]
    for _ in range(rounds):
        for steps, count, record in zip(contestants, counts, records, strict=True):
            start = time.process_time()
            done = steps(count)
            record.append(done / (time.process_time() - start))
    return [statistics.median(record) for record in records]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=15)
    arguments = parser.parse_args()
    rivals = {
        name: make
        for name, make, there in (("Gymnasium", gymnasiums, "Box2D"), ("EnvPool", envpools, "envpool"))
        if find_spec(there)
    }
    with_versions = [f"{name} {version(name.lower())}" for name in rivals]
    print(", ".join([f"Python {platform.python_version()}", f"NumPy {np.__version__}", *with_versions]), end="")
    print(f"; physics steps a second on one thread, medians of {arguments.rounds} turns\n")
    columns = ["ours", *rivals, *(f"ratio to {name}" for name in rivals)]
    print(f"| landers | steps a decision | {' | '.join(columns)} |\n|---|---|{'---|' * len(columns)}")
    for num_envs, skip in product(SIZES, SKIPS):
        contestants = [ours(num_envs, skip), *(make(num_envs, skip) for make in rivals.values())]
        mine, *theirs = speeds(contestants, arguments.rounds)
        cells = [f"{speed:,.0f}" for speed in (mine, *theirs)] + [f"{mine / each:.1f}" for each in theirs]
        print(f"| {num_envs} | {skip} | {' | '.join(cells)} |", flush=True)
    one, four = speeds([landings(skip) for skip in SKIPS], arguments.rounds)
    print(f"\nOne lander in flights that land: {one:,.0f} with one step a decision, {four:,.0f} with 4")
    if len(rivals) < 2:
        print('\nNot all rivals are installed; to compare with them: pip install -e ".[bench]"')


if __name__ == "__main__":
    main()
