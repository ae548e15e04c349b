"""Flights that other screens lead to, by their routes."""

from datetime import date

from game.flight.days import Days
from game.flight.flight_file import Record
from game.flight.logbook import Records, best_descent
from game.flight.replay import FlightReplay
from game.scenes.play.challenge import ContinuedFlight, against, dated
from game.scenes.play.daily import DailyStart
from game.scenes.play.descent import Descent
from game.scenes.play.scene import PlayScene
from game.scenes.play.tutorial import Tutorial
from game.ui.context import Context


def tutorial(context: Context) -> PlayScene:
    """Fly the first flight, again if need be."""
    return PlayScene(context, 0, challenge=Tutorial())


def day(context: Context) -> PlayScene:
    """Fly today's flight."""
    return PlayScene(context, challenge=DailyStart(date.today(), Days(context.user_dir)))


def descent(context: Context) -> PlayScene:
    """Fly from pad to pad."""
    return PlayScene(context, challenge=Descent(best_descent(Records(context.user_dir).entries())))


def race(context: Context, record: Record, rival: str = "") -> PlayScene:
    """Race against a recorded flight."""
    return PlayScene(context, record.recording.seed, challenge=against(record, rival))


def fly_on(context: Context, record: Record, flight_replay: FlightReplay, rival: str = "") -> PlayScene:
    """Fly on from a replay's present moment, beside the recorded flight as a ghost."""
    challenge = ContinuedFlight(flight_replay, rival or dated(record))
    return PlayScene(context, record.recording.seed, challenge=challenge)
