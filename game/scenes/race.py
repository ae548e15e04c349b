"""Flying against a recorded flight, or on from the midst of it."""

from __future__ import annotations

import time

from ai.lander.missions import MISSIONS
from game.core import texts
from game.flight.flight_file import Record
from game.flight.replay import Tape
from game.play.challenge import Flown, FlyOn, Race
from game.scenes.play import Play


def race(record: Record) -> Play:
    """Fly a recorded flight's start against its ghost; a mission's as that mission, with what it asks and earns."""
    mission = MISSIONS.get(record.recording.mission)
    course = Flown(mission, record, _name(record)) if mission else Race(record, _name(record))
    return Play(record.recording.seed, course=course)


def fly_on(record: Record, tape: Tape) -> Play:
    """Fly on from the moment that a tape shows; the recorded flight goes on as a ghost."""
    return Play(record.recording.seed, course=FlyOn(tape, _name(record)))


def _name(record: Record) -> str:
    return texts.RACE_RIVAL.format(when=time.strftime("%Y-%m-%d %H:%M", time.localtime(record.entry.when)))
