"""A flight as it is sent to a friend: its recording, and what its pilot claims to have earned."""

from __future__ import annotations

from dataclasses import dataclass

from ai.flights.recording import Recording
from ai.lander.environment import Outcome

End = tuple[float, float, float]  # x, y in metres, angle in rad


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
class SharedFlight:
    """Flight with its claim.

    Attributes:
        recording: its start and actions.
        claim: what it is said to have earned.
        course: name of its challenge in the logbook; empty for a free flight.
        barred: why it does not count as its pilot's own, a key of the game's texts; empty if it is said to count.

    """

    recording: Recording
    claim: Claim
    course: str = ""
    barred: str = ""
