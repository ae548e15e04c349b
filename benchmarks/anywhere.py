"""How often pilots land from random starts in worlds of many kinds, and near the starts of the missions.

    python -m benchmarks.anywhere [--model models/lander/anywhere] [--flights 1000] [--seed N]

The pilots are the network that lands anywhere, the one that was trained on the moon alone, and the scripted pilot;
these two see nine numbers. Each world has the craft, limits and conditions of the mission of that kind, and starts are
drawn as on the moon. The seed is that of test flights: neither training nor the choice of a network has seen them.
Shares have Wilson's intervals of 95%.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.lander.anywhere import AnywhereEnv
from ai.lander.conditions import Conditions
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.ground import Ground, Pad
from ai.lander.missions import MISSIONS
from ai.lander.pilots import Pilot, ScriptedPilot
from ai.training.statistics import wilson
from ai.training.tasks import TEST_SEED
from tests.support.missions import flown, fly

LANDERS = Path(__file__).parents[1] / "models" / "lander"
SMALL_TANK = 3.6  # seconds of main engine; half of the moon's flights by the network for the moon burn 2.8 at least


def _as_in(name: str) -> Callable[[int, int], LanderEnv]:
    """Make landers with random starts where a mission is flown; its pad is in the middle, as on the moon."""
    mission = MISSIONS[name]
    pad = Pad(0.0, mission.pad.top, mission.pad.width)

    def make(count: int, seed: int) -> LanderEnv:
        return LanderEnv(count, seed, params=mission.params, limits=mission.limits, conditions=mission.conditions,
                         ground=Ground((pad,)))  # fmt: skip

    return make


WORLDS: dict[str, Callable[[int, int], LanderEnv]] = {
    "moon": LanderEnv,
    "Mars": _as_in("mars"),
    "wind": _as_in("wind"),
    "Earth": _as_in("earth"),
    "pad 3.2 m wide": _as_in("narrow"),
    "pad that moves by 4 m": _as_in("ferry"),
    f"tank of {SMALL_TANK} s": lambda count, seed: LanderEnv(count, seed, conditions=Conditions(tank=SMALL_TANK)),
    "any of these at random, and worse": lambda count, seed: AnywhereEnv(count, seed, sites=("any",)),
}


def shown(landed: np.ndarray) -> str:
    """Return the share that landed and its interval."""
    share = float(landed.mean())
    low, high = wilson(share, len(landed))
    return f"{share:.1%} ({low:.1%} to {high:.1%})"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--model", type=Path, default=LANDERS / "anywhere")
    parser.add_argument("--flights", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=TEST_SEED)
    given = parser.parse_args()
    pilots: dict[str, Pilot] = {
        given.model.name: DeepQAgent.load(given.model),
        "modern": DeepQAgent.load(LANDERS / "modern"),
        "scripted": ScriptedPilot(),
    }
    print(f"Landed, of {given.flights:,} random starts\n")
    print(f"| world | {' | '.join(pilots)} |\n|---|{'---|' * len(pilots)}")
    for world, make in WORLDS.items():
        cells = []
        for pilot in pilots.values():
            env = make(given.flights, given.seed)
            env.reset()
            cells.append(shown(flown(pilot, env) == Outcome.LANDED))
        print(f"| {world} | {' | '.join(cells)} |", flush=True)
    print("\nLanded, of 20 starts near each mission's\n")
    print(f"| mission | {' | '.join(pilots)} |\n|---|{'---|' * len(pilots)}")
    for mission in MISSIONS.values():
        cells = [str(int((fly(pilot, mission, 20)[0] == Outcome.LANDED).sum())) for pilot in pilots.values()]
        print(f"| {mission.name} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
