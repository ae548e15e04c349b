"""Shows that every mission can be won: finds a flight there that earns gold, and writes it down for the game.

    python -m benchmarks.missions_won [--missions outage earth] [--generations 8] [--hardest] [--slow] [--write]

A hand-written pilot with ten numbers flies each mission a few hundred times at once, with other numbers in every
slot; the numbers of the best tenth make those of the next generation (the cross-entropy method, Rubinstein 1999). It
knows what the network does not: gravity, wind, and when an engine fails. Sought is a flight that stays a tenth below
gold's limits and touches down softly, one to be raced; `--hardest` asks for the least fuel and time instead.
`--slow` flies with a person's hands: five decisions a second, each from what was to be seen a fifth of a second ago.
`--write` keeps the flights in assets/flights, where the game finds them.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
from dataclasses import dataclass

import numpy as np

from ai.lander.environment import OBSERVATION_SCALE, LanderEnv, Outcome
from ai.lander.missions import MISSIONS, Mission
from ai.lander.push import KEYS
from game.core.assets import ASSETS_DIR
from game.flight.flight import Recording, StickHolder
from game.flight.flight_file import Record, write
from game.flight.logbook import describe
from game.flight.networks import DECISION_STEPS
from game.flight.replay import replayed

SLOTS = 320
BEST = 32
ENOUGH = 0.9  # of gold's limits
SLOW = 12  # physics steps of a decision
#         drift   most   lean   most   turn   spin   brake  touch  aside  climb
LOW = np.array([0.15, 1.0, 0.15, 0.20, 1.5, 0.8, 0.55, 0.3, 0.0, -4.0])
HIGH = np.array([1.20, 6.0, 1.20, 0.90, 8.0, 4.5, 1.00, 1.6, 0.8, 4.0])


@dataclass
class Found:
    """The best flight so far: what it burnt, how long it took, and its actions, one for each decision."""

    cost: float
    fuel: float
    seconds: float
    actions: list[int]


def act(numbers: np.ndarray, env: LanderEnv, observation: np.ndarray) -> np.ndarray:
    """Actions (n,) of pilots with `numbers` (n, 10): lean towards the pad, fall as fast as can be braked in time."""
    drift, most, firm, farthest, turn, spin_share, brake, touch, aside, climb = numbers.T
    x, y, vx, vy, sin, cos, spin, *_ = (observation / OBSERVATION_SCALE).T
    params, conditions, time = env.params, env.conditions, env.time
    angle = np.arctan2(sin, cos)
    most_push = params.main_thrust / params.mass
    against = np.arcsin(np.clip(conditions.push(time) / params.main_thrust, -0.5, 0.5))
    low = (y < 1.2) & (np.abs(x) < 2.0)
    lean = np.clip(firm * (vx - np.clip(-drift * x, -most, most)), -farthest, farthest) + against
    lean = np.where(low, np.clip(lean, -0.12, 0.12), lean)
    push = turn * (lean - angle) - spin_share * spin
    steer = np.where(push > 0.25, 1, np.where(push < -0.25, 2, 0))
    height = np.maximum(y - aside * np.clip(np.abs(x) - 1.6, 0.0, 6.0), 0.0)
    fastest = -np.sqrt(touch**2 + 2 * brake * (most_push - params.gravity) * height)
    ahead = (time < conditions.outage[0]) & np.isfinite(conditions.outage[0])
    fastest = np.where(ahead, climb, fastest)  # what can't be braked later is braked now
    main = (vy < fastest) & (np.abs(angle) < 1.1)
    rest = (y < 0.1) & (np.abs(x) < 2.0) & (np.abs(angle) < 0.15)
    return np.where(rest, 0, 3 * main + steer).astype(np.intp)


def fly(mission: Mission, numbers: np.ndarray, enough: float, steps: int) -> tuple[np.ndarray, LanderEnv, np.ndarray]:
    """Cost (n,) of flights with `numbers` (n, 10), how they ended, and their actions (decisions, n)."""
    env = mission.begin(len(numbers), frame_skip=steps)
    seen = [env.observe()]
    actions: list[np.ndarray] = []
    while (env.outcome == Outcome.FLYING).any():
        actions.append(act(numbers, env, seen[-2 if steps == SLOW else -1] if actions else seen[0]))
        seen = [seen[-1], env.step(actions[-1]).observation]
    away = np.linalg.norm(env.position - env.pad, axis=1) + np.linalg.norm(env.velocity, axis=1)
    share = np.maximum(env.fuel / mission.gold[0], env.time / mission.gold[1])
    landed = np.abs(share - enough) + 0.05 * env.impact[:, 0]
    cost = np.where(env.outcome == Outcome.LANDED, landed, 10 + away)
    return cost, env, np.array(actions)


def search(mission: Mission, generations: int, enough: float, steps: int, rng: np.random.Generator) -> Found | None:
    """Return the best flight found, which takes `enough` of gold's limits; None if none has landed."""
    middle, spread = (LOW + HIGH) / 2, (HIGH - LOW) / 2
    found = None
    for _ in range(generations):
        numbers = np.clip(middle + spread * rng.standard_normal((SLOTS, len(LOW))), LOW, HIGH)
        cost, env, actions = fly(mission, numbers, enough, steps)
        order = np.argsort(cost)
        best = int(order[0])
        if env.outcome[best] == Outcome.LANDED and (found is None or cost[best] < found.cost):
            decisions = -(-int(env.steps[best]) // steps)
            found = Found(
                float(cost[best]), float(env.fuel[best]), float(env.time[best]), actions[:decisions, best].tolist()
            )
        few = numbers[order[:BEST]]
        middle, spread = few.mean(axis=0), few.std(axis=0) + 0.02 * (HIGH - LOW)
    return found


def keep(name: str, found: Found, steps: int) -> None:
    """Write a flight down as the game does, a decision being so many steps."""
    pushes = [KEYS[action] for action in found.actions for _ in range(steps)]
    hands = [StickHolder.NETWORK] * len(pushes)
    flight = replayed(Recording(0, "random", mission=name, pushes=pushes, hands=hands))
    while not flight.over:
        flight.step()
    x, y, angle = flight.poses.now[0].tolist()
    folder = ASSETS_DIR / "flights"
    folder.mkdir(exist_ok=True)
    medal = MISSIONS[name].medal(float(flight.env.fuel[0]), float(flight.env.time[0]))
    entry = describe(flight, 0.0, course=name, medal=medal)
    (folder / f"{name}.json").unlink(missing_ok=True)
    write(folder / f"{name}.json", Record(flight.recording, entry, (x, y, angle)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--missions", nargs="*", default=list(MISSIONS), choices=MISSIONS)
    parser.add_argument("--generations", type=int, default=8)
    parser.add_argument("--hardest", action="store_true")
    parser.add_argument("--slow", action="store_true")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    steps = SLOW if arguments.slow else DECISION_STEPS
    print("| mission | fuel | time | gold asks | silver asks | medal |")
    print("|---|---|---|---|---|---|")
    for name in arguments.missions:
        mission = MISSIONS[name]
        enough = 0.0 if arguments.hardest else ENOUGH
        found = search(mission, arguments.generations, enough, steps, np.random.default_rng(0))
        if found is None:
            print(f"| {name} | not landed | | | | |", flush=True)
            continue
        if arguments.write:
            keep(name, found, steps)
        limits = (f"{fuel:.1f} s, {seconds:.1f} s" for fuel, seconds in (mission.gold, mission.silver))
        medal = mission.medal(found.fuel, found.seconds)
        print(f"| {name} | {found.fuel:.2f} s | {found.seconds:.1f} s | {' | '.join(limits)} | {medal} |", flush=True)


if __name__ == "__main__":
    main()
