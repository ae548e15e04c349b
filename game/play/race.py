"""Flying against a recorded flight, or on from the midst of it."""

from __future__ import annotations

import time

from ai.lander.missions import MISSIONS
from game.core import texts
from game.flight.flight_file import Record
from game.flight.replay import Tape
from game.play.challenge import Flown, FlyOn, Race


def race(record: Record) -> Flown | Race:
    """Fly a recorded flight's start against its ghost; a mission's as that mission, with what it asks and earns."""
    mission = MISSIONS.get(record.recording.mission)
    return Flown(mission, record, _name(record)) if mission else Race(record, _name(record))


def fly_on(record: Record, tape: Tape) -> FlyOn:
    """Fly on from the moment that a tape shows; the recorded flight goes on as a ghost."""
    return FlyOn(tape, _name(record))


def _name(record: Record) -> str:
    return texts.RACE_RIVAL.format(when=time.strftime("%Y-%m-%d %H:%M", time.localtime(record.entry.when)))
