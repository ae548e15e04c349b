"""Recording of a flight: its start and the action of every step, from which the flight follows bit for bit."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import Final

from ai.flights.easing import AS_IT_IS, UNHURRIED, Easing
from ai.flights.stick import Shares
from ai.lander.descent import LegStart
from ai.lander.rules import AREAS

AREA: Final = len(AREAS) - 1  # version of the area in which new flights are flown
LONGEST: Final = round(UNHURRIED) * 60  # physics steps of a recorded flight, at most


class StickHolder(Enum):
    """Holder of the stick."""

    HUMAN = "human"
    NETWORK = "network"


@dataclass
class Recording:
    """Recording of a flight for an exact replay: its start, and the action of every step.

    `hands` says who chose each action: with a shared stick, the person if the action is the one they asked for.
    `gravity` lists its changes: the first step, and the share of normal gravity. `shares` has the shares of thrust
    of each step, by its number, in which an engine gave less than all of it. `easing` is what gave the pilot more room,
    `area` the version of the area's edges, an index of `ai.lander.rules.AREAS`. `leg` is where a flight of a
    descent begins, None for any other.
    """

    seed: int
    spawn: str
    pads: int = 1
    actions: list[int] = field(default_factory=list)
    hands: list[StickHolder] = field(default_factory=list)
    mission: str = ""
    gravity: list[tuple[int, float]] = field(default_factory=list)
    shares: dict[int, Shares] = field(default_factory=dict)
    easing: Easing = AS_IT_IS
    area: int = AREA
    leg: LegStart | None = None

    def gravity_at(self, step: int) -> float:
        """Return the share of normal gravity during a step."""
        return next((share for begin, share in reversed(self.gravity) if begin <= step), 1.0)
