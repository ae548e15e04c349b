"""Days: the player's first attempt at each start of the day, kept beside the logbook, and their best flight of a day.

A line is written when an attempt begins and another when it ends, so that leaving an attempt does not undo it.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from datetime import date, datetime
from pathlib import Path
from typing import Annotated, Final

from ai.files.schema import Count, OneOf, Sized
from ai.files.writing import append_line
from ai.flights.verification import DAILY
from ai.lander.environment import Outcome
from game.core import texts
from game.flight.flight_file import Record, lines_of
from game.flight.logbook import Records

FILE_NAME: Final = "days.jsonl"
_LARGEST: Final = 2_000_000  # last bytes that are read: decades
_AROUND: Final = 40 * 3600.0  # seconds from a day's noon within which its flights were flown
_MOST_READ: Final = 10  # files that are read to find the best flight of a day


@dataclass(frozen=True)
class Attempt:
    """First attempt at a start of the day."""

    day: Annotated[str, Sized(10, 10), date.fromisoformat]  # as in 2026-11-22
    outcome: Annotated[str, OneOf(Outcome.__members__)] = Outcome.FLYING.name  # FLYING if it was left before its end
    score: Count = 0
    barred: Annotated[str, Sized(40)] = ""  # why it does not count, as in the logbook; empty if it does
    file: Annotated[str, Sized(255)] = ""  # name of the flight's file
    intact: bool = False  # whether it came down whole beside the pad

    @property
    def line(self) -> str:
        """The result in a line for a message, which tells nothing of the way."""
        return self.line_as("eased" if self.barred else "first")

    @property
    def result(self) -> str:
        """How it ended, with its points."""
        if self.outcome == Outcome.FLYING.name:
            return texts.DAYS_LEFT
        if self.outcome == Outcome.LANDED.name:
            return texts.DAILY_LANDED.format(points=self.score)
        return texts.BESIDE_RESULT if self.intact else texts.RIVAL_RESULTS[self.outcome]

    def line_as(self, attempt: str) -> str:
        """Return the result in a line for a message; `attempt` is a key of `texts.DAILY_ATTEMPTS`."""
        return texts.DAILY_LINE.format(day=self.day, end=self.result, attempt=texts.DAILY_ATTEMPTS[attempt])


class Days:
    """First attempts in the player's folder.

    Attributes:
        attempts: by day; do not write to it.
        problem: why the last call failed, in part or in whole; empty if it did not.

    """

    def __init__(self, user_dir: Path) -> None:
        self._path, self._records = user_dir / FILE_NAME, Records(user_dir)
        self.attempts: Mapping[str, Attempt] = self._read()

    def _read(self) -> dict[str, Attempt]:
        attempts, self.problem = lines_of(Attempt, self._path, _LARGEST)
        found: dict[str, Attempt] = {}
        for attempt in attempts:
            before = found.get(attempt.day)
            if before is None or before.outcome == Outcome.FLYING.name:  # a later attempt is practice
                found[attempt.day] = attempt
        return found

    def note(self, attempt: Attempt) -> None:
        """Note that a day's first attempt has begun, or ended."""
        self.problem, self.attempts = "", {**self.attempts, attempt.day: attempt}
        try:
            append_line(self._path, asdict(attempt))
        except OSError as error:
            self.problem = texts.DAYS_NOT_KEPT.format(reason=error.strerror or error)

    def best_flight(self, day: date) -> Record | None:
        """Return the player's best flight of a day that can be replayed; None if there is none."""
        noon = datetime(day.year, day.month, day.day, 12).timestamp()
        near = [each for each in self._records.entries() if each.course == DAILY and abs(each.when - noon) < _AROUND]
        for entry in sorted(near, key=lambda entry: (not entry.landed, -entry.score))[:_MOST_READ]:
            with suppress(ValueError):  # the logbook says what is wrong with it
                record = self._records.read(entry.file)
                if record.recording.seed == day.toordinal():
                    return record
        return None
