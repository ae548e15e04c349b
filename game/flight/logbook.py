"""Logbook: a line for every flight flown, and a file for each that can be replayed.

Only `read` raises for a bad disk or a damaged file; otherwise `problem` says what went wrong.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import asdict, replace
from datetime import date, datetime
from itertools import groupby
from pathlib import Path
from typing import Any, Final

from ai.files.reading import brief
from ai.files.writing import append_line, free_path
from ai.flights.verification import DESCENT, landing_score
from game.core import texts
from game.core.settings import TOP_RUNG, Settings
from game.flight import flight_file
from game.flight.flight import Flight
from game.flight.flight_file import Entry, Record

FOLDER: Final = "flights"
LOGBOOK: Final = "logbook.jsonl"
RECENT: Final = 100  # latest flights, whose files are kept whatever their outcome
BEST: Final = 5  # best landings of each mission, whose files are kept too, as are those of the longest descent
_LARGEST: Final = 16_000_000  # last bytes of the logbook that are read: 50,000 flights
SLACK: Final = 25  # surplus files before they are cleared
# A figure of a landing's line in the logbook, and what it is to reach: points at least, engine and time at most.
GOALS: Final = (
    ("score", 80.0), ("fuel", 4.5), ("seconds", 12.0), ("score", 90.0), ("fuel", 3.5), ("seconds", 10.0),
    ("score", 95.0), ("fuel", 3.0), ("seconds", 9.0), ("score", 98.0),
)  # fmt: skip


def describe(flight: Flight[Any], when: float, **more: Any) -> Entry:
    """Return the logbook's line for a flight that has ended; `more` are the fields that the flight does not know."""
    env = flight.env
    more["network"] = brief(more.get("network", ""), flight_file.LONGEST_NAME)  # a folder's name, and maybe words on it
    return Entry(
        when=round(when, 3),
        outcome=flight.outcome.name,
        intact=flight.intact,
        spawn=flight.recording.spawn,
        seconds=round(float(env.time[0]), 3),
        fuel=round(float(env.fuel[0]), 3),
        touchdown=round(float(env.impact[0, 0]), 3),
        human=round(flight.share, 4),
        pads=len(env.ground.pads),
        score=landing_score(env),
        leg=flight.recording.leg.number if flight.recording.leg else 0,
        **more,
    )


class Records:
    """Flight records in a player's folder.

    Attributes:
        problem: why the last call failed, in part or in whole; empty if it did not.

    """

    def __init__(self, user_dir: Path) -> None:
        self.folder = user_dir / FOLDER
        self.logbook = user_dir / LOGBOOK
        self.problem = ""

    def keep(self, flight: Flight[Any], when: float, **more: Any) -> Entry:
        """Record a flight that has ended; return its line of the logbook, even if it could not be written.

        `more` are fields of Entry: alone, network, course, medal.
        """
        self.problem = ""
        entry = describe(flight, when, **more)
        try:
            x, y, angle = flight.poses.now[0].tolist()
            entry = self._write(Record(flight.recording, entry, (x, y, angle)))
            append_line(self.logbook, asdict(entry))
            self._make_room()
        except OSError as error:
            self.problem = texts.FLIGHT_NOT_KEPT.format(reason=error.strerror or error)
        return entry

    def entries(self) -> list[Entry]:
        """Return the lines of the logbook in the order of the flights, whatever the clock said.

        Invalid lines are counted in `problem` and left in the file.
        """
        found, self.problem = flight_file.lines_of(Entry, self.logbook, _LARGEST)
        return found

    def kept(self) -> set[str]:
        """Return the names of the existing flight files."""
        with suppress(OSError):
            return {path.name for path in self.folder.glob("*.json")}
        return set()

    def read(self, name: str) -> Record:
        """Read a flight. Raises ValueError, which names the file and the problem."""
        return flight_file.read(self.folder / name)

    def _write(self, record: Record) -> Entry:
        """Write a flight's file under an unused name; return its line."""
        moment = f"{datetime.fromtimestamp(record.entry.when):%Y-%m-%d %H.%M.%S.%f}"[:-3]
        path = free_path(self.folder, moment, ".json")
        entry = replace(record.entry, file=path.name)
        flight_file.write(path, replace(record, entry=entry))
        return entry

    def _make_room(self) -> None:
        """Delete the files of flights that are neither recent nor among the best."""
        files = self.kept()
        if len(files) <= RECENT + SLACK:
            return
        entries = self.entries()
        self.problem = ""
        spared = {entry.file for entry in [*best(entries), *longest_descent(entries)]}
        flown = [entry.file for entry in entries if entry.file in files]  # not by date: a clock can be set back
        spared |= set(flown[-RECENT:])
        for name in set(flown) - spared:  # a file that the logbook does not list is not deleted
            with suppress(OSError):
                (self.folder / name).unlink()


# Summaries of the logbook


def longest_descent(entries: Iterable[Entry]) -> list[Entry]:
    """Return the legs of the longest descent by the person alone, in their order; of equal ones, most points count."""
    longest, run = list[Entry](), list[Entry]()
    for entry in entries:
        if entry.course != DESCENT or not entry.landed or entry.bar:
            continue
        run = [*run, entry] if entry.leg == len(run) + 1 else [entry][: entry.leg == 1]
        if run and (len(run), run[-1].total) > (len(longest), longest[-1].total if longest else -1):
            longest = run
    return longest


def best(entries: Iterable[Entry]) -> list[Entry]:
    """Return up to `BEST` best landings of each mission by the person alone that can be replayed.

    Landings from the ladder are ranked separately, like another mission.
    """

    def kind(entry: Entry) -> tuple[str, int, bool]:
        return entry.course, entry.pads, entry.on_ladder

    own = (entry for entry in entries if entry.landed and entry.alone and entry.file)
    return [entry for _, each in groupby(sorted(own, key=kind), kind) for entry in sorted(each, key=rank)[:BEST]]


def rank(entry: Entry) -> tuple[float, ...]:
    """Return the sort key of a landing, lower is better: fuel and time in a mission, points in a free flight."""
    return (-entry.medal, entry.fuel, entry.seconds) if entry.course else (-entry.score, entry.fuel)


def best_descent(entries: Iterable[Entry]) -> tuple[int, int]:
    """Return the most legs landed in one descent by the player alone, and its points; (0, 0) without any."""
    own = ((e.leg, e.total) for e in entries if e.course == DESCENT and e.landed and not e.bar)
    return max(own, default=(0, 0))


def ladder_rung(settings: Settings, entries: Iterable[Entry]) -> int:
    """Return the player's place on the ladder of starts, from 0; who has none yet gets one, by landings of before."""
    if settings.rung < 0:
        flown = [entry for entry in entries if entry.landed and entry.human > 0 and not entry.course]
        settings.rung = min(TOP_RUNG, len(flown))
    return settings.rung


class Goals:
    """The player's own landings in free flights from anywhere, what is to be reached next, and the best."""

    def __init__(self, entries: Iterable[Entry] = ()) -> None:
        self._landings: list[Entry] = []
        for entry in entries:
            self.add(entry)

    def add(self, entry: Entry) -> bool:
        """Count a flight; return whether it is a landing that counts here."""
        counts = entry.landed and entry.alone and not (entry.course or entry.on_ladder)
        if counts:
            self._landings.append(entry)
        return counts

    @property
    def best(self) -> int:
        """The highest score; 0 before any landing."""
        return max((entry.score for entry in self._landings), default=0)

    @property
    def next(self) -> str:
        """The first goal that no landing has reached yet, as a sentence; empty after the last."""
        for name, value in GOALS:
            figures = [getattr(each, name) for each in self._landings]
            if not any(figure >= value if name == "score" else figure <= value for figure in figures):
                return texts.GOALS[name].format(value=value)
        return ""

    def bests(self, now: float) -> dict[str, str]:
        """Return the best scores of this day and week, by their names on the card."""
        today = date.fromtimestamp(now)
        days = [(date.fromtimestamp(each.when), each.score) for each in self._landings]
        spans = {
            texts.CARD_TODAY: [score for day, score in days if day == today],
            texts.CARD_WEEK: [score for day, score in days if day.isocalendar()[:2] == today.isocalendar()[:2]],
        }
        return {name: texts.SCORE.format(count=max(scores)) for name, scores in spans.items() if scores}
