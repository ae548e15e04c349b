"""A flight as a file: where it began, what was done in each physics step, and what came of it.

A flight follows from its start and its actions, bit for bit, so that is all that is kept, in text that a person can
read. Nothing in it can do more than be flown again.
"""

from __future__ import annotations

import errno
import json
import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from itertools import groupby
from pathlib import Path
from typing import Any, Final

from ai.lander.environment import NUM_ACTIONS, Outcome
from ai.lander.missions import MISSIONS
from ai.lander.spawns import SPAWNS
from ai.nn.files import brief, parse_json, read_text, write_text
from game.core import texts
from game.core.settings import GRAVITY_SHARES
from game.flight.flight import Hand, Recording

FORMAT: Final = "tranquility flight"
VERSION: Final = 4
# The first knew no change of gravity, the second no rules of missions, the third not why a flight does not count.
_READS: Final = (1, 2, 3, 4)
_LONGEST: Final = 120 * 60  # physics steps of a flight
_LARGEST: Final = 1_000_000  # bytes
_LONGEST_NAME: Final = 255  # letters, as in the name of a file
_MOST: Final = 32_503_680_000  # of any figure; in seconds the year 3000, up to which every system knows dates


@dataclass(frozen=True)
class Entry:
    """A line of the logbook. Raises ValueError for what no flight can have come to.

    Attributes:
        when: the end of the flight, in seconds since 1970.
        outcome: name of an Outcome.
        seconds, fuel: how long it took; fuel in seconds of main engine.
        touchdown: m/s into the surface; 0 where nothing was touched.
        human: the person's share of it, 0 to 1.
        alone: whether it was flown by their own hands from start to end, so that it says something of their skill.
        network: who flew the rest, or might have.
        pads: how many there were.
        score: points for the landing.
        gravity: the share of what it is there that was farthest from all of it.
        pace: how fast time passed at the slowest, as the player chose it; 1 is its own pace.
        rules: the number of the rules of its mission, as `rules_of` it was then.
        barred: why it does not count as their own, a name of `texts.NOT_COUNTED`; empty if it does, or was flown
            before that was written down.
        course: name of a mission; empty for a free flight.
        medal: 3 for gold, 2, 1, and 0 for none.
        file: name of what it can be flown again from.

    """

    when: float
    outcome: str
    seconds: float
    fuel: float
    touchdown: float
    human: float
    alone: bool = False
    network: str = ""
    pads: int = 1
    score: int = 0
    course: str = ""
    medal: int = 0
    file: str = ""
    gravity: float = 1.0
    pace: float = 1.0
    rules: int = 0
    barred: str = ""

    def __post_init__(self) -> None:
        figures = (self.when, self.seconds, self.fuel, self.touchdown, self.human, self.gravity, self.pace)
        if not all(isinstance(figure, (int, float)) and 0 <= figure < _MOST for figure in figures):
            raise ValueError("a figure is no positive number")
        if self.outcome not in Outcome.__members__ or self.human > 1:
            raise ValueError(f"no flight ends as {brief(repr(self.outcome), 40)}, {self.human} of it by hand")
        words = (self.network, self.course, self.file, self.barred)
        if not all(isinstance(word, str) and len(word) <= _LONGEST_NAME for word in words):
            raise ValueError("a name is no text")
        counts = (self.alone, self.pads, self.score, self.medal, self.rules)
        if not all(isinstance(count, int) and 0 <= count < _MOST for count in counts):
            raise ValueError("a count is no whole number")
        if Path(self.file).name != self.file:
            raise ValueError("a file has no plain name")

    @property
    def practice(self) -> bool:
        """Whether it was made easier, or harder, than flights are: then it is not among the best."""
        return self.gravity != 1 or self.pace != 1

    @property
    def outdated(self) -> bool:
        """Whether its mission is flown under other rules now: then it is not among the best, and its medal is past."""
        return self.rules != rules_of(self.course)

    @property
    def bar(self) -> str:
        """Why it does not count as the person's own now, a name of `texts.NOT_COUNTED`; empty if it does."""
        if self.outdated:
            return "outdated"
        if self.barred in texts.NOT_COUNTED:
            return self.barred
        if self.practice:
            return "practice"
        return "" if self.alone else "unknown"

    @property
    def landed(self) -> bool:
        """Whether it ended well."""
        return self.outcome == Outcome.LANDED.name


def rules_of(course: str) -> int:
    """Return the number of the rules that a course is flown under now."""
    return MISSIONS[course].rules if course in MISSIONS else 0


@dataclass(frozen=True)
class Record:
    """A flight as its file has it: `end` is the last pose x, y, angle, to see whether it flies as it did."""

    recording: Recording
    entry: Entry
    end: tuple[float, float, float]


def read(path: Path) -> Record:
    """Read a flight. Raises ValueError, which names the file and what is wrong with it."""
    try:
        return from_text(read_text(path, _LARGEST))
    except FileNotFoundError as error:
        raise ValueError(texts.GONE.format(name=path.name)) from error
    except OSError as error:
        said = texts.FLIGHT_TOO_LARGE if error.errno == errno.EFBIG else error.strerror or error
        raise ValueError(f"{path.name}: {said}") from error
    except (ValueError, KeyError, TypeError, AttributeError, ArithmeticError) as error:
        raise ValueError(texts.FLIGHT_DAMAGED.format(name=path.name, problem=_said(error))) from error


def write(path: Path, record: Record) -> None:
    """Write a flight whole or not at all, in place of none that is there; not flushed, which would take frames.

    Raises FileExistsError if the name is taken, and OSError if the disk won't have it.
    """
    write_text(path, to_text(record), flush=False, new=True)


def to_text(record: Record) -> str:
    """Return what a flight's file holds."""
    recording = record.recording
    return json.dumps({
        "format": FORMAT, "version": VERSION, "seed": recording.seed, "spawn": recording.spawn,
        "pads": recording.pads, "mission": recording.mission, "actions": _packed(recording.actions),
        "hands": _packed(hand.value for hand in recording.hands), "gravity": recording.gravity,
        "end": record.end, "entry": asdict(record.entry),
    }, indent=1) + "\n"  # fmt: skip


def from_text(text: str) -> Record:
    """Read what `to_text` wrote; raises ValueError, KeyError or TypeError for anything else."""
    values = parse_json(text)
    if values["format"] != FORMAT or values["version"] not in _READS:
        raise ValueError(texts.FLIGHT_FORMAT.format(format=FORMAT, version=VERSION))
    seed, spawn, pads, mission = values["seed"], values["spawn"], values["pads"], values["mission"]
    if not (isinstance(seed, int) and isinstance(pads, int) and seed >= 0 and pads in (1, 3) and spawn in SPAWNS):
        raise ValueError(texts.FLIGHT_START.format(seed=seed, spawn=spawn, pads=pads))
    if mission and mission not in MISSIONS:
        raise ValueError(texts.FLIGHT_MISSION.format(name=mission))
    actions = [int(word) for word in _unpacked(values["actions"])]
    hands = [Hand(word) for word in _unpacked(values["hands"])]
    if len(actions) != len(hands) or not all(0 <= action < NUM_ACTIONS for action in actions):
        raise ValueError(texts.FLIGHT_ACTIONS)
    x, y, angle = (float(number) for number in values["end"])
    if not all(map(math.isfinite, (x, y, angle))):
        raise ValueError(texts.FLIGHT_ACTIONS)
    recording = Recording(seed, spawn, pads, actions, hands, mission, _changes(values.get("gravity", [])))
    return Record(recording, Entry(**values["entry"]), (x, y, angle))


def _changes(values: list[Any]) -> list[tuple[int, float]]:
    """Read when gravity was changed, and to what; raises ValueError or TypeError."""
    changes = [(int(step), float(share)) for step, share in values]
    low, high = GRAVITY_SHARES
    steps = [step for step, _ in changes]
    if steps != sorted(set(steps)) or not all(step >= 0 and low <= share <= high for step, share in changes):
        raise ValueError(texts.FLIGHT_GRAVITY)
    return changes


def _packed(words: Iterable[Any]) -> str:
    """Write a row with many repetitions as "word*times word*times"."""
    return " ".join(f"{word}*{len(list(same))}" for word, same in groupby(words))


def _unpacked(text: str) -> list[str]:
    """Read it; raises ValueError, before it takes much memory, for what is no such row."""
    runs = [run.split("*") for run in text.split()]
    counts = [int(count) for _, count in runs]
    if any(count < 1 for count in counts) or sum(counts) > _LONGEST:
        raise ValueError(texts.FLIGHT_ACTIONS)
    return [word for (word, _), count in zip(runs, counts, strict=True) for _ in range(count)]


def _said(error: Exception) -> str:
    return texts.FLIGHT_LACKS.format(name=brief(error.args[0], 40)) if isinstance(error, KeyError) else brief(error)
