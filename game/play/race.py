"""Races against a recorded flight, and flying on from a moment of it."""

from __future__ import annotations

import time

from ai.lander.missions import MISSIONS
from game.core import texts
from game.flight.flight_file import Record
from game.flight.replay import FlightReplay
from game.play.challenge import ContinuedFlight, FlownMission, Race


def race(record: Record, rival: str = "") -> FlownMission | Race:
    """Return a race against a recorded flight, named by its date or as `rival`.

    A mission's flight is raced as that mission, with its medals.
    """
    mission = MISSIONS.get(record.recording.mission)
    name = rival or _name(record)
    return FlownMission(mission, record, name) if mission else Race(record, name)


def fly_on(record: Record, flight_replay: FlightReplay, rival: str = "") -> ContinuedFlight:
    """Return a challenge that flies on from a replay's current moment, beside the recorded flight as a ghost."""
    return ContinuedFlight(flight_replay, rival or _name(record))


def _name(record: Record) -> str:
    return texts.RACE_RIVAL.format(when=time.strftime("%Y-%m-%d %H:%M", time.localtime(record.entry.when)))
