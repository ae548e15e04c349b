"""Flights between friends: a record with its claim and back, and reading one from any text or file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Final

from ai.files.reading import read_text
from ai.flights.code import CodeError, code_of, codes_in, flight_of
from ai.flights.recording import Claim, ClaimedFlight, StickHolder
from ai.flights.verification import DAILY, DESCENT, Earned, day_of, in_its_place
from ai.lander.environment import Outcome
from ai.lander.rules import tenths
from ai.lander.spawns import LADDER, RUNGS
from engine import DT
from game.core import texts
from game.flight import flight_file
from game.flight.flight_file import Entry, Record

DROPPED: Final = 1_000_000  # bytes of a file that is dropped on the window, at most


def claimed(record: Record) -> ClaimedFlight:
    """Return a record as it is sent to a friend, with what it claims."""
    entry = record.entry
    claim = Claim(Outcome[entry.outcome], entry.score, record.end, entry.medal)
    course = entry.course or record.recording.mission
    return ClaimedFlight(record.recording, claim, course, entry.bar if not entry.alone else "")


def code(record: Record) -> str:
    """Return a record as a code for a message."""
    return code_of(claimed(record))


def record_of(flight: ClaimedFlight, when: float) -> Record:
    """Return the record of a flight as it is claimed."""
    recording, claim = flight.recording, flight.claim
    seconds = len(recording.pushes) * DT
    by_hand = recording.hands.count(StickHolder.HUMAN) / len(recording.hands) if recording.hands else 1.0
    entry = Entry(
        when, claim.outcome.name, seconds, 0.0, 0.0, round(by_hand, 4), pads=recording.pads, score=claim.points,
        course=flight.course, barred=flight.barred,
    )  # fmt: skip
    return Record(recording, entry, claim.end)


def flights_in(text: str) -> Iterator[ClaimedFlight | str]:
    """Yield the flights of a text, a flight's file or any text with codes; for one that is refused, the reason."""
    if text.lstrip("\ufeff \t\r\n").startswith("{"):
        try:
            yield claimed(flight_file.from_text(text.lstrip("\ufeff")))
        except ValueError as error:
            yield str(error)
        return
    found = False
    for each in codes_in(text):
        found = True
        try:
            yield flight_of(each)
        except CodeError as error:
            yield texts.CODE_REFUSED[error.kind]
    if not found:
        yield texts.CODE_REFUSED["none"]


def flight_in(text: str) -> ClaimedFlight:
    """Return the first flight of a text; raises ValueError, which says why there is none."""
    flight = next(flights_in(text))
    if isinstance(flight, str):
        raise ValueError(flight)
    return flight


def flight_in_file(path: Path) -> ClaimedFlight:
    """Return the first flight of a file of any kind; raises ValueError, which says why there is none."""
    try:
        return flight_in(read_text(path, DROPPED))
    except OSError as error:
        raise ValueError(error.strerror or str(error)) from error
    except UnicodeDecodeError as error:
        raise ValueError(texts.CODE_REFUSED["none"]) from error


def words(claim: Claim | Earned) -> str:
    """Return in words what a flight claims, or has earned."""
    said = texts.EARNED[claim.outcome.name].format(points=claim.points)
    return texts.EARNED_MEDAL.format(earned=said, medal=texts.MEDALS[claim.medal]) if claim.medal in (1, 2, 3) else said


def why_wrong(flight: ClaimedFlight, real: Earned) -> str:
    """Return what is wrong with a claim that is not true: the place, what was earned, or where the flight ended."""
    if not in_its_place(flight):
        return texts.WRONG_PLACE
    claim = flight.claim
    if (claim.outcome, claim.points) == (real.outcome, real.points) and claim.medal <= real.medal:
        return texts.WRONG_END
    return texts.WRONG_CLAIM.format(claim=words(claim))


def where(flight: ClaimedFlight) -> str:
    """Return where a flight says it was flown, with the day, the tank, and what makes it easier there."""
    recording = flight.recording
    leg, day = recording.leg, day_of(recording.seed)
    parts = [course_name(flight.course, leg.number if leg else 0, recording.spawn, recording.pads)]
    if flight.course == DAILY and day:
        parts.append(day.isoformat())
    if leg and leg.number > 1:
        parts.append(texts.PLACE_TANK.format(seconds=f"{tenths(leg.tank):.1f}"))
    return ", ".join([*parts, *(texts.ASSIST_WORDS[name] for name, on in asdict(recording.easing).items() if on)])


def course_name(course: str, leg: int, spawn: str, pads: int) -> str:
    """Return the name of a flight's course: a mission, the start of the day, a leg, or the kind of a free flight."""
    if leg:
        return texts.DESCENT_COURSE.format(number=leg)
    if course == DAILY:
        return texts.DAILY
    if course == DESCENT:  # and no leg of one
        return texts.DESCENT_TITLE
    if course in texts.MISSIONS:
        return texts.MISSIONS[course][0]
    if spawn in RUNGS:
        return texts.LADDER_FLIGHT.format(number=LADDER.stage_of(spawn) + 1)
    return texts.COURSE_FREE.get(pads, "")
