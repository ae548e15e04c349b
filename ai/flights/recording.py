"""Recording of a flight: its start and the push of every step, from which the flight follows bit for bit."""

from __future__ import annotations

from dataclasses import asdict, astuple, dataclass, field, fields, replace
from enum import Enum
from typing import Annotated, Any, Final, Self

from ai.files.schema import OneOf, Seed, Within
from ai.lander.descent import MOST_LEGS, TANK, LegStart
from ai.lander.environment import Outcome
from ai.lander.missions import MISSIONS, STARTS, Mission
from ai.lander.push import Push
from ai.lander.rules import Limits
from ai.lander.spawns import SPAWNS

WIDER: Final = 1.5  # width of wider pads, in shares of their own
UNHURRIED: Final = 1200.0  # seconds that a flight may take without its time limit
LONGEST: Final = round(UNHURRIED) * 60  # physics steps of a recorded flight, at most

End = tuple[float, float, float]  # x, y in metres, angle in rad
LegAsList = tuple[Annotated[int, Within(1, MOST_LEGS)], Annotated[float, Within(0, TANK)], bool] | None


@dataclass(frozen=True)
class Easing:
    """Changes of a flight's rules, set at its start, that give the pilot more room; by default, none."""

    wider_pads: bool = False  # whether all pads are half as wide again
    untimed: bool = False  # whether the flight may take `UNHURRIED` seconds

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


class StickHolder(Enum):
    """Holder of the stick."""

    HUMAN = "human"
    NETWORK = "network"


@dataclass
class Start:
    """All that a flight follows from besides its inputs; `ai.files.schema.read_as` checks it as files hold it."""

    seed: Seed
    spawn: Annotated[str, OneOf(SPAWNS)]
    pads: Annotated[int, OneOf((1, 3))] = 1
    mission: Annotated[str, OneOf(("", *MISSIONS))] = ""
    easing: Easing = AS_IT_IS  # what gave the pilot more room


@dataclass
class Recording(Start):
    """Recording of a flight for an exact replay: its start, and what every step has pushed."""

    leg: LegStart | None = None  # where a flight of a descent begins
    pushes: list[Push] = field(default_factory=list)  # of whole sixteenths
    hands: list[StickHolder] = field(default_factory=list)  # the person's, if the push is the one they asked for

    @classmethod
    def begun(cls, start: Start, leg: LegAsList, pushes: list[Push], hands: list[StickHolder]) -> Self:
        """Return the recording of a start that was read, with these inputs."""
        values = {each.name: getattr(start, each.name) for each in fields(Start)}
        return cls(**values, leg=LegStart(*leg) if leg else None, pushes=pushes, hands=hands)

    def again(self) -> Self:
        """Return the recording of another flight from the same start, of which nothing is flown."""
        return replace(self, pushes=[], hands=[])

    def start(self) -> dict[str, Any]:
        """Return its start, with the leg, as JSON can hold it."""
        values = {each.name: getattr(self, each.name) for each in fields(Start)}
        return values | {"easing": asdict(self.easing), "leg": astuple(self.leg) if self.leg else None}


@dataclass(frozen=True)
class Claim:
    """What a flight is said to have ended in: its outcome, the points of its landing, its last pose, and its medal.

    A code says nothing of the medal, which is 0 then, as it is without one.
    """

    outcome: Outcome
    points: int
    end: End
    medal: int = 0


@dataclass(frozen=True)
class ClaimedFlight:
    """Flight as it is sent to a friend: its recording, and what its pilot claims to have earned."""

    recording: Recording
    claim: Claim
    course: str = ""  # name of its challenge in the logbook; empty for a free flight
    barred: str = ""  # why it is not its pilot's own, a key of the game's texts; empty if it is said to count
