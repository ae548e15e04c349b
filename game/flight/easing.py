"""Easing of a flight: changes of its rules, set at its start and recorded with it, that give the pilot more room."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from ai.lander.environment import LanderEnv
from ai.lander.missions import STARTS
from ai.lander.rules import LIMITS, Limits
from game.core.settings import Settings
from game.flight.surface import ground_of

WIDER: Final = 1.5  # width of wider pads, in shares of their own
UNHURRIED: Final = 1200.0  # seconds that a flight may take without its time limit


@dataclass(frozen=True)
class Easing:
    """Easing of one flight; by default, none.

    Attributes:
        wider_pads: whether all pads are half as wide again.
        untimed: whether the flight may take `UNHURRIED` seconds.

    """

    wider_pads: bool = False
    untimed: bool = False

    @classmethod
    def chosen(cls, settings: Settings) -> Easing:
        """Return the easing that the player has chosen for the next flight."""
        return cls(settings.wider_pads, settings.untimed)

    @property
    def pads(self) -> float:
        """Width of the pads, in shares of their own."""
        return WIDER if self.wider_pads else 1.0

    def limits(self, limits: Limits) -> Limits:
        """Return a flight's limits, eased."""
        return replace(limits, time=UNHURRIED) if self.untimed else limits

    def begin(self, seed: int, spawn: str, pads: int) -> LanderEnv:
        """Return the environment of a free flight, at its start."""
        ground = ground_of(seed, pads, self.pads)
        env = LanderEnv(1, seed, spawn, frame_skip=1, ground=ground, limits=self.limits(LIMITS))
        env.reset()
        return env

    def begin_mission(self, name: str) -> LanderEnv:
        """Return the environment of a mission, at its start."""
        mission = STARTS[name]
        pad = replace(mission.pad, width=self.pads * mission.pad.width)
        return replace(mission, pad=pad, limits=self.limits(mission.limits)).begin()


AS_IT_IS: Final = Easing()
