"""The flights that were flown: a file for each that may be flown again, and a logbook with a line for every one.

Nothing here raises for a bad disk or a damaged file but `read`; `problem` says what went wrong.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from datetime import datetime
from itertools import groupby
from pathlib import Path
from typing import Any, Final

from ai.nn.files import parse_json, read_end
from game.core import texts
from game.core.collection import Collection, LibraryError, free_path
from game.flight import flight_file
from game.flight.flight import Flight
from game.flight.flight_file import Entry, Record
from game.flight.outcomes import landing_score

FOLDER: Final = "flights"
LOGBOOK: Final = "logbook.jsonl"
RECENT: Final = 100  # flights whose files are kept whatever they came to
BEST: Final = 5  # and the best landings of each course
_LARGEST: Final = 16_000_000  # bytes of the logbook that are read, the last ones: 50,000 flights
_SLACK: Final = 25  # files too many before they are looked through
_MOST_THROWN: Final = 50  # files thrown away that can be brought back
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
        self._files = Collection(self.folder, most_thrown=_MOST_THROWN)
        self.problem = ""

    def keep(self, flight: Flight, when: float, **more: Any) -> Entry:
        """Write down a flight that has ended; return its line of the logbook, whether or not the disk took it.

        `more` are fields of Entry: alone, network, course, medal.
        """
        self.problem = ""
        entry = describe(flight, when, **more)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            x, y, angle = flight.poses.now[0].tolist()
            entry = self._write(Record(flight.recording, entry, (x, y, angle)))
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
            text = read_end(self.logbook, _LARGEST).decode(errors="replace")
        except FileNotFoundError:
            return []
        except OSError as error:
            self.problem = texts.FLIGHTS_UNREADABLE.format(path=self.logbook, reason=error.strerror or error)
            return []
        for line in text.splitlines():
            try:
                found.append(Entry(**parse_json(line)))
            except (ValueError, TypeError):
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

    def thrown(self) -> set[str]:
        """Return the names of the files that were thrown away and can be brought back."""
        return self._files.deleted

    def throw_away(self, name: str) -> bool:
        """Put a flight's file aside; the logbook keeps its line. False if that could not be done."""
        return self._attempt(lambda: self._files.throw_away(self.folder / name, name))

    def bring_back(self, name: str) -> bool:
        """Bring a file back that was thrown away. False if that could not be done."""
        return self._attempt(lambda: self._files.bring_back(name))

    def _attempt(self, deed: Callable[[], object]) -> bool:
        self.problem = ""
        try:
            deed()
        except LibraryError as error:
            self.problem = str(error)
        return not self.problem

    def why_gone(self, entry: Entry) -> str:
        """Say why a flight can't be flown again, in a sentence; empty if its file is there."""
        if entry.file in self.kept():
            return ""
        if entry.file in self.thrown():
            return texts.FLIGHT_THROWN
        if not entry.file:
            return texts.FLIGHT_NEVER_KEPT
        older = sorted(self.kept() | {entry.file})[:-RECENT]  # a name begins with its date
        return texts.FLIGHT_TOO_OLD if entry.file in older else texts.FLIGHT_MISSING

    def _write(self, record: Record) -> Entry:
        """Write a flight under a name that nothing else has, not even of another game's; return its line."""
        moment = f"{datetime.fromtimestamp(record.entry.when):%Y-%m-%d %H.%M.%S.%f}"[:-3]
        while True:
            path = free_path(self.folder, moment, ".json")
            entry = replace(record.entry, file=path.name)
            with suppress(FileExistsError):
                flight_file.write(path, replace(record, entry=entry))
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
