"""Missions: starts that teach one thing each, as data. `game.texts.MISSIONS` has their words."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from ai.conditions import CALM, Conditions
from ai.ground import Ground, Pad
from ai.lander import LIMITS, PARAMS, LanderEnv, LanderParams, Limits

_PAD: Final = Pad(0.0, PARAMS.pad_top, PARAMS.pad_width)


@dataclass(frozen=True)
class Mission:
    """One start, where and under what it is flown, and what earns a medal there.

    Attributes:
        start: x, y, vx, vy, angle, spin; metres from the middle of the world and above its zero, m/s, rad, rad/s.
        gold, silver: fuel in seconds of main engine and time in seconds that a landing may take at most; any landing
            earns bronze.
        night: whether nothing is seen but what shines.

    """

    name: str
    start: tuple[float, float, float, float, float, float]
    gold: tuple[float, float]
    silver: tuple[float, float]
    conditions: Conditions = CALM
    params: LanderParams = PARAMS
    limits: Limits = LIMITS
    pad: Pad = _PAD
    night: bool = False

    def begin(self, num_envs: int = 1, frame_skip: int = 1) -> LanderEnv:
        """Return landers that are about to begin, all from the one start."""
        env = LanderEnv(num_envs, 0, frame_skip=frame_skip, params=self.params, ground=Ground((self.pad,)),
                        limits=self.limits, conditions=self.conditions)  # fmt: skip
        env.reset()
        env.place(np.ones(num_envs, dtype=bool), np.tile(np.array(self.start), (num_envs, 1)))
        return env

    def medal(self, fuel: float, seconds: float) -> int:
        """Return what a landing earns: 3 for gold, 2 for silver, 1 for bronze."""
        for medal, (most_fuel, longest) in ((3, self.gold), (2, self.silver)):
            if fuel <= most_fuel and seconds <= longest:
                return medal
        return 1


def _on(gravity: float, thrust: float) -> LanderParams:
    """The craft on another world, with an engine that is made for it."""
    return replace(PARAMS, gravity=gravity, main_thrust=thrust)


_ROWS: Final = (
    Mission("fall", (0.0, 6.0, 0.0, 0.0, 0.0, 0.0), (1.1, 5.0), (1.5, 8.0)),
    Mission("brake", (0.0, 19.0, 0.0, -2.5, 0.0, 0.0), (3.1, 8.0), (4.2, 12.0)),
    Mission("aside", (-12.0, 12.0, 0.0, 0.0, 0.0, 0.0), (3.5, 10.0), (4.7, 14.0)),
    Mission("wind", (8.0, 14.0, 0.0, -0.5, 0.0, 0.0), (3.6, 10.0), (4.8, 14.0), Conditions(wind=0.25, gust=0.3)),
    Mission("tank", (6.0, 15.0, -0.5, -1.0, 0.0, 0.0), (2.6, 9.0), (2.8, 12.0), Conditions(tank=3.0)),
    Mission("narrow", (-9.0, 13.0, 1.0, -0.5, 0.1, 0.0), (3.3, 9.5), (4.4, 13.0), pad=Pad(3.0, 2.2, 3.2)),
    Mission("mars", (7.0, 15.0, -1.0, -1.0, 0.0, 0.0), (3.3, 8.5), (4.4, 12.0), Conditions(wind=-0.1, gust=0.2),
            params=_on(3.71, 8.0)),
    Mission("earth", (-5.0, 14.0, 0.5, 0.0, 0.0, 0.0), (5.0, 8.0), (7.0, 12.0), params=_on(9.81, 19.0)),
    Mission("night", (11.0, 14.0, -1.0, -0.5, -0.2, 0.0), (3.5, 10.5), (4.7, 15.0), night=True),
    Mission("ferry", (-8.0, 14.0, 0.0, -0.5, 0.0, 0.0), (4.2, 11.0), (5.6, 16.0),
            Conditions(swing=4.0, swing_period=18.0)),
    Mission("outage", (5.0, 18.0, 0.0, -0.5, 0.1, 0.0), (5.0, 13.0), (6.5, 18.0), Conditions(outage=(2.0, 4.0))),
)  # fmt: skip
MISSIONS: Final[dict[str, Mission]] = {mission.name: mission for mission in _ROWS}
