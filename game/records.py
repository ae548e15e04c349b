"""The flights that were flown: a file for each that may be flown again, and a logbook with a line for every one.

Nothing here raises for a bad disk or a damaged file but `read`; `problem` says what went wrong.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from datetime import datetime
from itertools import groupby
from pathlib import Path
from typing import Any, Final

from game import flight_file, texts
from game.flight import Flight
from game.flight_file import Entry, Record
from game.outcomes import landing_score

FOLDER: Final = "flights"
LOGBOOK: Final = "logbook.jsonl"
RECENT: Final = 100  # flights whose files are kept whatever they came to
BEST: Final = 5  # and the best landings of each course
_MOST_AT_ONCE: Final = 100  # flights of one moment
_SLACK: Final = 25  # files too many before they are looked through
RECENT_OWN: Final = 10  # flights by the person alone that their skill is told by


def describe(flight: Flight, when: float, **more: Any) -> Entry:
    """Return the logbook's line of a flight that has ended; `more` is what the flight does not know of itself."""
    env = flight.env
    return Entry(
        when=round(when, 3),
        outcome=flight.outcome.name,
        seconds=round(float(env.time[0]), 3),
        fuel=round(float(env.fuel[0]), 3),
        touchdown=round(float(env.impact[0, 0]), 3),
        human=round(flight.share, 4),
        pads=len(env.ground.pads),
        score=landing_score(env),
        gravity=max((share for _, share in flight.recording.gravity), key=lambda share: abs(share - 1), default=1.0),
        rules=flight_file.rules_of(more.get("course", "")),
        **more,
    )


class Records:
    """The flights in a player's folder.

    Attributes:
        problem: why the last call could not do all that it should; empty if it could.

    """

    def __init__(self, user_dir: Path) -> None:
        self.folder = user_dir / FOLDER
        self.logbook = user_dir / LOGBOOK
        self.problem = ""

    def keep(self, flight: Flight, when: float, **more: Any) -> Entry:
        """Write down a flight that has ended; return its line of the logbook, whether or not the disk took it.

        `more` are fields of Entry: alone, network, course, medal.
        """
        self.problem = ""
        entry = describe(flight, when, **more)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            entry = self._write(flight, entry)
            self._append(entry)
            self._make_room()
        except OSError as error:
            self.problem = texts.FLIGHT_NOT_KEPT.format(reason=error.strerror or error)
        return entry

    def entries(self) -> list[Entry]:
        """Return the logbook in the order in which flights were flown, whatever the clock said then.

        Lines that make no sense are counted in `problem` and left alone.
        """
        self.problem, found, damaged = "", [], 0
        try:
            text = self.logbook.read_text(encoding="utf-8", errors="replace")
        except FileNotFoundError:
            return []
        except OSError as error:
            self.problem = texts.FLIGHTS_UNREADABLE.format(path=self.logbook, reason=error.strerror or error)
            return []
        for line in text.splitlines():
            try:
                found.append(Entry(**json.loads(line)))
            except (ValueError, TypeError, RecursionError):
                damaged += bool(line.strip())
        if damaged:
            self.problem = texts.FLIGHTS_DAMAGED.format(count=damaged, path=self.logbook)
        return found

    def kept(self) -> set[str]:
        """Return the names of the files there are."""
        with suppress(OSError):
            return {path.name for path in self.folder.glob("*.json")}
        return set()

    def read(self, name: str) -> Record:
        """Read a flight. Raises ValueError, which names the file and what is wrong with it."""
        return flight_file.read(self.folder / name)

    def forget(self, name: str) -> bool:
        """Throw a flight's file away; the logbook keeps its line. False if that could not be done."""
        try:
            (self.folder / name).unlink(missing_ok=True)
        except OSError as error:
            self.problem = texts.NOT_DELETED.format(name=name, reason=error.strerror or error)
            return False
        return True

    def _write(self, flight: Flight, entry: Entry) -> Entry:
        """Write a flight's file, and return its line with the name of that: a number tells two of one moment apart."""
        moment = f"{datetime.fromtimestamp(entry.when):%Y-%m-%d %H.%M.%S.%f}"[:-3]
        x, y, angle = flight.poses.now[0].tolist()
        for number in range(1, _MOST_AT_ONCE + 1):
            path = self.folder / f"{moment} {number}.json".replace(" 1.json", ".json")
            entry = replace(entry, file=path.name)
            try:
                flight_file.write(path, Record(flight.recording, entry, (x, y, angle)))
            except FileExistsError:
                if number == _MOST_AT_ONCE:
                    raise
            else:
                break
        return entry

    def _append(self, entry: Entry) -> None:
        """Add a line; one that a killed game has left unfinished must not swallow it."""
        with self.logbook.open("a+b") as file:
            unfinished = False
            if file.seek(0, 2):
                file.seek(-1, 2)
                unfinished = file.read(1) != b"\n"
            file.write(b"\n" * unfinished + json.dumps(asdict(entry)).encode() + b"\n")

    def _make_room(self) -> None:
        """Throw away the files of flights that are neither recent nor among the best."""
        files = self.kept()
        if len(files) <= RECENT + _SLACK:
            return
        entries = self.entries()
        self.problem = ""
        spared = {entry.file for entry in best(entries)}
        flown = [entry.file for entry in entries if entry.file in files]  # not by date: a clock can be set back
        spared |= set(flown[-RECENT:])
        for name in set(flown) - spared:  # what is in no logbook is not ours to throw
            with suppress(OSError):
                (self.folder / name).unlink()


# What the logbook adds up to


def best(entries: Iterable[Entry], most: int = BEST) -> list[Entry]:
    """Return the best landings of each course by the person alone that can be flown again, at most so many of each.

    Those under other rules are apart, as another course.
    """

    def course(entry: Entry) -> tuple[str, int, int]:
        return entry.course, entry.pads, entry.rules

    own = (entry for entry in entries if entry.landed and entry.alone and not entry.practice)
    landings = sorted((entry for entry in own if entry.file), key=course)
    return [entry for _, group in groupby(landings, course) for entry in sorted(group, key=rank)[:most]]


def rank(entry: Entry) -> tuple[float, ...]:
    """What the better of two landings has less of: in a mission by fuel and time, in a free flight by points."""
    return (-entry.medal, entry.fuel, entry.seconds) if entry.course else (-entry.score, entry.fuel)


@dataclass(frozen=True)
class Totals:
    """What all flights come to; `streak` is the longest row of landings by the person alone."""

    flights: int = 0
    landings: int = 0
    seconds: float = 0.0
    fuel: float = 0.0
    streak: int = 0


def totals(entries: Sequence[Entry]) -> Totals:
    """Add the logbook up."""
    streak = longest = 0
    for entry in entries:
        if entry.alone:
            streak = streak + 1 if entry.landed else 0
            longest = max(longest, streak)
    return Totals(
        len(entries),
        sum(entry.landed for entry in entries),
        sum(entry.seconds for entry in entries),
        sum(entry.fuel for entry in entries),
        longest,
    )


def skill(entries: Iterable[Entry], window: int = RECENT_OWN) -> list[float]:
    """Share of landings, 0 to 1, among the last `window` flights by the person alone, after each of them."""
    return shares([entry.landed for entry in entries if entry.alone], window)


def shares(landed: Sequence[bool], window: int) -> list[float]:
    """Share of landings among the last `window` of some flights, after each of them."""
    recent = (landed[max(0, last - window) : last] for last in range(1, len(landed) + 1))
    return [sum(few) / len(few) for few in recent]
