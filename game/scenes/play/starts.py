"""Flights that other screens lead to, by their routes: each returns the scene that flies it."""

from __future__ import annotations

import time

from ai.lander.missions import MISSIONS
from game.core import texts
from game.flight.flight_file import Record
from game.flight.replay import FlightReplay
from game.scenes.play.challenge import ContinuedFlight, FlownMission, Race
from game.scenes.play.descent import Descent
from game.scenes.play.scene import PlayScene
from game.scenes.play.tutorial import Tutorial
from game.ui.context import Context


def tutorial(context: Context) -> PlayScene:
    """Fly the first flight, again if need be."""
    return PlayScene(context, 0, challenge=Tutorial())


def descent(context: Context) -> PlayScene:
    """Fly from pad to pad."""
    return PlayScene(context, challenge=Descent())


def race(context: Context, record: Record, rival: str = "") -> PlayScene:
    """Race against a recorded flight."""
    return PlayScene(context, record.recording.seed, challenge=against(record, rival))


def fly_on(context: Context, record: Record, flight_replay: FlightReplay, rival: str = "") -> PlayScene:
    """Fly on from a replay's present moment, beside the recorded flight as a ghost."""
    challenge = ContinuedFlight(flight_replay, rival or _name(record))
    return PlayScene(context, record.recording.seed, challenge=challenge)


def against(record: Record, rival: str = "") -> FlownMission | Race:
    """Return a race against a recorded flight, named by its date or as `rival`.

    A mission's flight is raced as that mission, with its medals.
    """
    mission = MISSIONS.get(record.recording.mission)
    name = rival or _name(record)
    return FlownMission(mission, record, name) if mission else Race(record, name)


def _name(record: Record) -> str:
    return texts.RACE_RIVAL.format(when=time.strftime("%Y-%m-%d %H:%M", time.localtime(record.entry.when)))
