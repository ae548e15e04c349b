"""Easing of a flight: changes of its rules, set at its start and recorded with it, that give the pilot more room."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from ai.lander.missions import STARTS, Mission
from ai.lander.rules import Limits

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

    @property
    def pads(self) -> float:
        """Width of the pads, in shares of their own."""
        return WIDER if self.wider_pads else 1.0

    def limits(self, limits: Limits) -> Limits:
        """Return a flight's limits, eased."""
        return replace(limits, time=UNHURRIED) if self.untimed else limits

    def mission(self, name: str) -> Mission:
        """Return a mission, eased."""
        mission = STARTS[name]
        pad = replace(mission.pad, width=self.pads * mission.pad.width)
        return replace(mission, pad=pad, limits=self.limits(mission.limits))


AS_IT_IS: Final = Easing()
