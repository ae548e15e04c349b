"""Missions: starts that teach one thing each, as data. `game.core.texts.MISSIONS` has their words."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from ai.lander.conditions import CALM, Conditions
from ai.lander.environment import LIMITS, PARAMS, LanderEnv, LanderParams, Limits
from ai.lander.ground import Ground, Pad
from ai.lander.rules import tenths

_OFTEN: Final = 15  # of 20 flights
_PAD: Final = Pad(0.0, PARAMS.pad_top, PARAMS.pad_width)


@dataclass(frozen=True)
class Mission:
    """Mission: one start, the world and conditions it is flown in, and what earns a medal there.

    Attributes:
        start: x, y, vx, vy, angle, spin; metres from the middle of the world and above its zero, m/s, rad, rad/s.
        gold, silver: fuel in seconds of main engine and time in seconds that a landing may take at most, to a tenth,
            as they are printed; any other landing by the pilot's own hands earns bronze.
        world: where it is: moon, titan, mars or earth.
        night: whether only lights are seen.
        landed: how many of 20 starts near this one the network that flies here lands, as `benchmarks.missions`
            measures it.

    """

    name: str
    start: tuple[float, float, float, float, float, float]
    gold: tuple[float, float]
    silver: tuple[float, float]
    conditions: Conditions = CALM
    params: LanderParams = PARAMS
    limits: Limits = LIMITS
    pad: Pad = _PAD
    world: str = "moon"
    night: bool = False
    landed: int = 20

    @property
    def elsewhere(self) -> bool:
        """Whether a flight here differs from one on the moon: in conditions, craft, limits of a touch or pad width."""
        return (
            (self.conditions, self.params, self.pad.width) != (CALM, PARAMS, PARAMS.pad_width)
            or replace(self.limits, time=LIMITS.time) != LIMITS
        )  # fmt: skip

    @property
    def network_lands(self) -> bool:
        """Whether the network that flies here mostly lands."""
        return self.landed > _OFTEN

    def begin(self, num_envs: int = 1, frame_skip: int = 1) -> LanderEnv:
        """Return landers ready to fly, all from the mission's start."""
        env = LanderEnv(num_envs, 0, frame_skip=frame_skip, params=self.params, ground=Ground((self.pad,)),
                        limits=self.limits, conditions=self.conditions)  # fmt: skip
        env.reset()
        env.place(np.ones(num_envs, dtype=bool), np.tile(np.array(self.start), (num_envs, 1)))
        return env

    def medal(self, fuel: float, seconds: float) -> int:
        """Return what a landing earns: 3 for gold, 2 for silver, 1 for bronze."""
        return next((medal for medal in (3, 2) if self.too_much(medal, fuel, seconds) == (0, 0)), 1)

    def too_much(self, medal: int, fuel: float, seconds: float) -> tuple[float, float]:
        """Return how much fuel and how many seconds, in tenths, were too much for gold (3) or silver (2).

        Both are rounded as they are printed before they are judged: who flew the printed limit has kept it.
        """
        most_fuel, longest = self.gold if medal == 3 else self.silver
        return tenths(max(0.0, tenths(fuel) - most_fuel)), tenths(max(0.0, tenths(seconds) - longest))


_AIR: Final = 0.06  # kg/m
_THICK_AIR: Final = 0.12
_STRONG_LEGS: Final = replace(LIMITS, touch_speed=3.0, slide_speed=3.0)


def _on(gravity: float, thrust: float) -> LanderParams:
    """Return the craft on another world, with an engine that is made for it."""
    return replace(PARAMS, gravity=gravity, main_thrust=thrust)


_ROWS: Final = (
    Mission("fall", (0.0, 6.0, 0.0, 0.0, 0.0, 0.0), (1.1, 5.0), (1.8, 8.0)),
    Mission("brake", (0.0, 19.0, 0.0, -2.5, 0.0, 0.0), (3.1, 8.0), (4.2, 12.0)),
    Mission("aside", (-12.0, 12.0, 0.0, 0.0, 0.0, 0.0), (3.5, 10.0), (4.7, 14.0)),
    Mission("wind", (8.0, 14.0, 0.0, -0.5, 0.0, 0.0), (3.2, 9.5), (4.3, 13.0), Conditions(wind=0.25, gust=0.3),
            params=replace(_on(1.35, 3.6), quadratic_drag=_THICK_AIR), world="titan"),
    Mission("tank", (6.0, 15.0, -0.5, -1.0, 0.0, 0.0), (2.6, 9.0), (2.8, 12.0), Conditions(tank=3.0)),
    Mission("narrow", (-9.0, 13.0, 1.0, -0.5, 0.1, 0.0), (3.3, 9.5), (4.4, 13.0), pad=Pad(3.0, 2.2, 3.2)),
    Mission("mars", (7.0, 15.0, -1.0, -1.0, 0.0, 0.0), (3.3, 8.5), (4.4, 12.0), Conditions(wind=-0.1, gust=0.2),
            params=_on(3.71, 8.0), world="mars"),
    Mission("earth", (-5.0, 14.0, 0.5, 0.0, 0.0, 0.0), (3.6, 7.0), (5.0, 10.0), world="earth",
            params=replace(_on(9.81, 16.0), quadratic_drag=_AIR), limits=_STRONG_LEGS),
    Mission("night", (11.0, 14.0, -1.0, -0.5, -0.2, 0.0), (3.5, 10.5), (4.7, 15.0), night=True),
    Mission("ferry", (-8.0, 14.0, 0.0, -0.5, 0.0, 0.0), (4.2, 11.0), (5.6, 16.0),
            Conditions(swing=4.0, swing_period=18.0)),
    Mission("outage", (5.0, 18.0, 0.0, -0.5, 0.1, 0.0), (3.0, 9.0), (4.5, 13.0), Conditions(outage=(2.0, 4.0))),
)  # fmt: skip
MISSIONS: Final[dict[str, Mission]] = {mission.name: mission for mission in _ROWS}
# Where a first flight is taught: on the moon as it is, with time enough.
FIRST: Final = Mission(
    "first", (0.0, 17.0, 0.0, 0.0, 0.0, 0.0), (0.0, 0.0), (0.0, 0.0), limits=replace(LIMITS, time=600.0)
)
STARTS: Final[dict[str, Mission]] = {**MISSIONS, FIRST.name: FIRST}
