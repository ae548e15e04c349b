"""Places of flights: what a course in the logbook stands for, and whether a flight was really flown there.

A flight says which course it belongs to. Its recording says where it began and under which rules; the two are two
things as soon as somebody else has made the file or the code.
"""

from __future__ import annotations

from contextlib import suppress
from datetime import date
from typing import Final

from ai.flights.easing import AS_IT_IS
from ai.flights.recording import Recording
from ai.flights.shared import SharedFlight
from ai.lander.descent import LegStart, can_begin
from ai.lander.missions import MISSIONS
from ai.lander.spawns import RUNGS

DAILY: Final = "daily"
DESCENT: Final = "descent"
COURSES: Final = ("", DAILY, DESCENT, *MISSIONS)  # "" is a free flight


def day_of(seed: int) -> date | None:
    """Return the day whose start has this seed; None if no day has."""
    with suppress(ValueError, OverflowError):
        return date.fromordinal(seed)
    return None


def in_its_place(flight: SharedFlight) -> bool:
    """Whether a flight began where its course begins, under the gravity, fuel and limits of that place."""
    recording, course = flight.recording, flight.course
    start = recording.spawn, recording.pads, recording.mission, recording.leg
    if course == DAILY:
        return start == ("random", 3, "", None) and not recording.gravity and day_of(recording.seed) is not None
    if course in MISSIONS:
        return start == ("random", 1, course, None) and not recording.gravity
    if recording.leg:  # one can be raced too, as a flight of no course
        return course in ("", DESCENT) and start[:3] == ("random", 1, "") and _is_leg(recording, recording.leg)
    return course == "" and start[2:] == ("", None) and _is_free(recording.spawn, recording.pads)


def _is_leg(recording: Recording, leg: LegStart) -> bool:
    return not recording.gravity and recording.easing == AS_IT_IS and can_begin(recording.seed, leg)


def _is_free(spawn: str, pads: int) -> bool:
    """Whether the game has free flights from this kind of start: from anywhere, or from a rung of the ladder."""
    return spawn == "random" or (spawn in RUNGS and pads == 1)
