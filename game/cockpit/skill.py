"""The player's flights, one line each, in their own folder: for check flights, and a curve of their own skill."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from game import texts
from game.records import shares
from game.settings import write_atomically

FILE_NAME: Final = "skill.json"
DAMAGED_NAME: Final = "skill.damaged.json"
RECENT: Final = 10  # flights that skill is the mean of
CHECK_EVERY: Final = 5
_MOST: Final = 500


@dataclass(frozen=True)
class Entry:
    """One flight that has ended."""

    landed: bool
    alone: bool  # flown with one's own hands from start to end, and no help
    pads: int = 1
    score: int = 0

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> Entry:
        """Raises ValueError for what is no flight."""
        kinds = {"landed": bool, "alone": bool, "pads": int, "score": int}
        if values.keys() != kinds.keys() or any(type(values[name]) is not kind for name, kind in kinds.items()):
            raise ValueError("no flight")
        return cls(**values)


class Skill:
    """Never raises: `problem` says what went wrong with the file, and flights are counted all the same."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / FILE_NAME
        self.problem = ""
        self.entries: list[Entry] = []
        self._keeps = True  # not over a file that is there and could not be read
        try:
            rows = json.loads(self._path.read_text(encoding="utf-8"))
            self.entries = [Entry.from_dict(row) for row in rows]
        except FileNotFoundError:
            pass
        except (ValueError, TypeError, AttributeError, RecursionError):
            self._set_aside()
        except OSError as error:
            self._give_up(error)

    def add(self, entry: Entry) -> None:
        """Write a flight down."""
        self.entries = [*self.entries, entry][-_MOST:]
        if not self._keeps:
            return
        self.problem = ""
        try:
            write_atomically(self._path, json.dumps([asdict(each) for each in self.entries]) + "\n")
        except OSError as error:
            self.problem = texts.SKILL_NOT_SAVED.format(reason=error.strerror)

    @property
    def check_due(self) -> bool:
        """Whether the flights before the next one were all helped, as many as may be."""
        last = self.entries[1 - CHECK_EVERY :]
        return len(last) == CHECK_EVERY - 1 and not any(entry.alone for entry in last)

    @property
    def best(self) -> int:
        """The highest score so far, 0 before any landing."""
        return max((entry.score for entry in self.entries), default=0)

    @property
    def own(self) -> list[bool]:
        """Whether each flight without help landed, oldest first."""
        return [entry.landed for entry in self.entries if entry.alone]

    @property
    def curve(self) -> list[float]:
        """Share of landings among the last ten flights without help, after each of them."""
        return shares(self.own, RECENT)

    def _set_aside(self) -> None:
        self.problem = texts.SKILL_DAMAGED.format(name=DAMAGED_NAME)
        try:
            self._path.replace(self._path.with_name(DAMAGED_NAME))
        except OSError as error:
            self._give_up(error)

    def _give_up(self, error: OSError) -> None:
        self.problem, self._keeps = texts.SKILL_UNREADABLE.format(reason=error.strerror), False
