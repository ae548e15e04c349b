"""How pilots fly descents: every leg along its route, from a decision to the next, until one is lost."""

from dataclasses import dataclass

import numpy as np

from ai.flights.verification import landing_score
from ai.lander.descent import LegStart, leg_of
from ai.lander.environment import Cause, LanderEnv, Outcome
from ai.lander.pilots import Pilot
from ai.lander.route import Route

QUICK = (4, 0)  # physics steps of a decision, and how many decisions old what it is made from is
SLOW = (12, 1)  # a person's hands: five decisions a second, each a fifth of a second late


@dataclass
class Run:
    """A descent to its end: how many legs were landed, what ended it, and the fuel that each landed leg burnt."""

    legs: int
    kinds: tuple[str, ...]
    end: str
    fuel: list[float]


def fly_leg(seed: int, start: LegStart, pilot: Pilot, hands: tuple[int, int] = QUICK) -> LanderEnv:
    """Fly one leg to its end."""
    steps, late = hands
    flown = leg_of(seed, start)
    env, route = flown.begin(start.tank, frame_skip=steps), Route(flown.route)
    seen = [route.observe(env, pilot)]
    while env.outcome[0] == Outcome.FLYING:
        env.fly(pilot.act(seen[max(0, len(seen) - 1 - late)], held=env.actions))
        seen.append(route.observe(env, pilot))
    return env


def descend(seed: int, pilot: Pilot, hands: tuple[int, int] = QUICK, most: int = 30) -> Run:
    """Fly a descent until a leg is lost, or so many have been landed."""
    start, fuel = LegStart(), list[float]()
    while len(fuel) < most:
        env = fly_leg(seed, start, pilot, hands)
        if env.outcome[0] != Outcome.LANDED:
            empty = env.fuel[0] >= env.conditions.tank
            end = "empty tank" if empty else Outcome(int(env.outcome[0])).name.lower()
            if env.outcome[0] == Outcome.CRASHED and not empty:
                end = Cause(int(env.cause[0])).name.lower()
            return Run(len(fuel), leg_of(seed, start).kinds, end, fuel)
        fuel.append(float(env.fuel[0]))
        spot = env.ground.pads[int(env.landed_on[0])]
        start = start.after(fuel[-1], landing_score(env), bare=spot.bare)
    return Run(len(fuel), (), "", fuel)


def stand_on(env: LanderEnv, pad: int) -> None:
    """Put a lander on its feet on a pad of its ground."""
    x, y = env.ground.middles[pad].tolist()
    env.place(np.ones(1, bool), np.array([[x, y + env.params.stand + 0.002, 0, 0, 0, 0]]))
