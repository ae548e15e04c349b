"""File format of a flight: its start, the push of each physics step, and its outcome.

A flight follows from its start and its pushes, bit for bit, so only these are stored, in text that a person can
read. A file can do no more than be replayed.
"""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from functools import lru_cache
from itertools import groupby
from pathlib import Path
from typing import Annotated, Any, Final, TypeVar

from ai.files.reading import brief, parse_json, read_text
from ai.files.schema import OneOf, OtherVersionError, Share, Sized, Within, check_header, read_as, read_lines
from ai.files.writing import write_text
from ai.flights.recording import LONGEST, End, LegAsList, Recording, Start, StickHolder
from ai.flights.verification import COURSES
from ai.lander.environment import Outcome
from ai.lander.push import STEPS, Push
from ai.lander.spawns import RUNGS, SPAWNS
from game.core import texts

T = TypeVar("T")
FORMAT: Final = "tranquility flight"
VERSION: Final = 8
_LARGEST: Final = 2_000_000  # bytes
LONGEST_NAME: Final = 255  # characters, as in the name of a file
_MOST: Final = 32_503_680_000 - 1  # limit of any figure; as a date the year 2999, the last on some systems

_Figure = Annotated[float, Within(0, _MOST)]
_Number = Annotated[int, Within(0, _MOST)]
_Name = Annotated[str, Sized(LONGEST_NAME)]


def _plain_name(name: str) -> None:
    if os.path.basename(name) != name or name in (".", ".."):  # noqa: PTH119 - a Path takes ten times as long
        raise ValueError(f"{brief(repr(name), 40)} is no plain name of a file")


@dataclass(frozen=True)
class Entry:
    """Line of the logbook."""

    when: _Figure  # the flight's end, in seconds since 1970
    outcome: Annotated[str, OneOf(Outcome.__members__)]
    seconds: _Figure
    fuel: _Figure  # seconds of main engine
    touchdown: _Figure  # m/s into the surface; 0 without a touch
    human: Share  # the person's of the steps
    alone: bool = False  # whether the person flew all of it without help, so that it counts for their skill
    network: _Name = ""  # that flew the rest, or could have
    pads: _Number = 1
    score: _Number = 0
    course: _Name = ""  # name of a mission; empty for a free flight
    medal: _Number = 0  # 3 for gold, 2, 1, and 0 for none
    file: Annotated[str, Sized(LONGEST_NAME), _plain_name] = ""  # for a replay
    pace: _Figure = 1.0  # slowest time scale during the flight; 1 is normal
    barred: _Name = ""  # why it does not count, a key of `texts.NOT_COUNTED`; empty if it does, or nobody noted it yet
    guarded: Share = 0.0  # assist of the guardian by futures that watched over all of it; 0 for none
    intact: bool = False  # whether it came down whole beside the pad; its outcome is CRASHED
    spawn: Annotated[str, OneOf(SPAWNS)] = "random"  # the kind of start
    leg: _Number = 0  # number of the leg in a descent; 0 for any other flight
    total: _Number = 0  # points of the descent so far

    @property
    def on_ladder(self) -> bool:
        """Whether it began on a rung of the ladder; then it does not measure the skill in flights from anywhere."""
        return self.spawn in RUNGS

    @property
    def bar(self) -> str:
        """Reason why it does not count as the person's own, a key of `texts.NOT_COUNTED`; empty if it does."""
        if self.barred in texts.NOT_COUNTED:
            return self.barred
        return "" if self.alone else "unknown"

    @property
    def landed(self) -> bool:
        """Whether the flight ended in a landing."""
        return self.outcome == Outcome.LANDED.name


def lines_of(kind: type[T], path: Path, most: int) -> tuple[list[T], str]:
    """Return the sound lines in the last `most` bytes of a file, and a sentence on what is wrong; empty if nothing.

    Invalid lines stay in the file.
    """
    try:
        found, lost = read_lines(kind, path, most)
    except FileNotFoundError:
        return [], ""
    except OSError as error:
        return [], texts.FLIGHTS_UNREADABLE.format(path=path, reason=error.strerror or error)
    return found, texts.FLIGHTS_DAMAGED.format(count=lost, path=path) if lost else ""


@dataclass(frozen=True)
class Record:
    """Contents of a flight's file; `end` is the last pose x, y, angle, to check a replay against."""

    recording: Recording
    entry: Entry
    end: End


@dataclass(kw_only=True)
class _FlightFile(Start):
    format: str
    version: int
    pushes: str
    hands: str
    end: End
    entry: Entry
    leg: LegAsList = None


def read(path: Path) -> Record:
    """Read a flight's file. Raises ValueError, which names the file and the problem."""
    try:
        return from_text(read_text(path, _LARGEST))
    except FileNotFoundError as error:
        raise ValueError(texts.GONE.format(name=path.name)) from error
    except OSError as error:
        said = texts.FLIGHT_TOO_LARGE if error.errno == errno.EFBIG else error.strerror or error
        raise ValueError(f"{path.name}: {said}") from error
    except OtherVersionError as error:
        raise ValueError(f"{path.name}: {error}") from error
    except ValueError as error:
        raise ValueError(texts.FLIGHT_DAMAGED.format(name=path.name, problem=brief(error))) from error


def write(path: Path, record: Record) -> None:
    """Write a flight file whole or not at all, without a flush to disk, which would drop frames; raises OSError."""
    write_text(path, to_text(record), flush=False)


def to_text(record: Record) -> str:
    """Return a record as the text of a flight's file."""
    recording = record.recording
    saved = {"format": FORMAT, "version": VERSION} | recording.start() | {
        "pushes": _packed(f"{push.main:.0f},{push.side:.0f}" for push in recording.pushes),
        "hands": _packed(hand.value for hand in recording.hands),
        "end": record.end, "entry": asdict(record.entry),
    }  # fmt: skip
    return json.dumps(saved, indent=1) + "\n"


def from_text(text: str) -> Record:
    """Parse the output of `to_text`; raises ValueError for anything else, which names all that is wrong."""
    values = parse_json(text)
    try:
        check_header(values, FORMAT, VERSION)
    except OtherVersionError as error:
        held = brief(values.get("version"), 20)
        raise OtherVersionError(texts.FLIGHT_OTHER_VERSION.format(found=held, version=VERSION)) from error
    except ValueError as error:
        raise ValueError(texts.FLIGHT_FORMAT.format(format=FORMAT)) from error
    file = read_as(_FlightFile, values)
    if file.entry.course not in COURSES:
        raise ValueError(texts.FLIGHT_MISSION.format(name=brief(file.entry.course, 40)))
    pushes = [_push(word) for word in _unpacked(file.pushes)]
    hands = [StickHolder(word) for word in _unpacked(file.hands)]
    if len(pushes) != len(hands):
        raise ValueError(texts.FLIGHT_ACTIONS)
    return Record(Recording.begun(file, file.leg, pushes, hands), file.entry, file.end)


def _packed(words: Iterable[Any]) -> str:
    """Run-length encode words as "word*times word*times"."""
    return " ".join(f"{word}*{len(list(same))}" for word, same in groupby(words))


def _unpacked(text: str) -> list[str]:
    """Decode the output of `_packed`; raises ValueError for bad input, before that takes much memory."""
    runs = [run.split("*") for run in text.split()]
    counts = [int(count) for _, count in runs]
    if any(count < 1 for count in counts) or sum(counts) > LONGEST:
        raise ValueError(texts.FLIGHT_ACTIONS)
    return [word for (word, _), count in zip(runs, counts, strict=True) for _ in range(count)]


@lru_cache(maxsize=256)
def _push(word: str) -> Push:
    main, side = (int(part) for part in word.split(","))
    if not (0 <= main <= STEPS and -STEPS <= side <= STEPS):
        raise ValueError(texts.FLIGHT_ACTIONS)
    return Push(main, side)
