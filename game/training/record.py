"""What is kept of runs to be shown again: any moment of this one, and the curves of earlier ones beside it."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass
from itertools import count
from typing import Any, Final, Generic, Protocol, TypeVar

import numpy as np

from ai.training.history import History

_OVERHEAD: Final = 1024  # bytes of a message besides its arrays, about


class Dated(Protocol):
    """Message that says at which moment of a run it was sent."""

    @property
    def decisions(self) -> int:
        """Moment of the run, in decisions of all landers."""


Message = TypeVar("Message", bound=Dated)


class Record(Generic[Message]):
    """Record of messages that come in the order of their `decisions`, within `most` bytes.

    The run is divided into cells of `spacing` decisions, and the first message of each cell is kept. When they take
    too much room, the cells become twice as wide: the kept messages stay evenly spaced over the whole run. One
    message is kept in any case.

    Attributes:
        spacing: decisions in a cell, a power of two.
        size: bytes that the kept messages take, about.

    """

    def __init__(self, most: int) -> None:
        self._most = most
        self.clear()

    def clear(self) -> None:
        """Forget all messages."""
        self._kept: list[Message] = []
        self.spacing, self.size = 1, 0

    def __len__(self) -> int:
        return len(self._kept)

    @property
    def begins(self) -> int | None:
        """Decisions of the first message; None without any."""
        return self._kept[0].decisions if self._kept else None

    @property
    def moments(self) -> list[int]:
        """Decisions of the kept messages, rising."""
        return [message.decisions for message in self._kept]

    def append(self, message: Message) -> None:
        """Keep a message if it is the first of its cell; one from before the latest is left out."""
        if self._kept and message.decisions // self.spacing <= self._kept[-1].decisions // self.spacing:
            return
        self._kept.append(message)
        self.size += size_of(message)
        while self.size > self._most and len(self._kept) > 1:
            self._thin()

    def _thin(self) -> None:
        self.spacing *= 2
        kept: list[Message] = []
        for message in self._kept:
            if not kept or message.decisions // self.spacing > kept[-1].decisions // self.spacing:
                kept.append(message)
        self._kept, self.size = kept, sum(map(size_of, kept))

    def nearest(self, decisions: float) -> Message | None:
        """Return the kept message nearest to a moment, the earlier of two; None if none is kept."""
        after = bisect_left(self._kept, decisions, key=lambda message: message.decisions)
        around = self._kept[max(after - 1, 0) : after + 1]
        return min(around, key=lambda message: abs(message.decisions - decisions), default=None)


def size_of(message: Any) -> int:
    """Return about how many bytes a message takes: those of its arrays, and a little for the rest."""
    return _OVERHEAD + sum(getattr(value, "nbytes", 0) for value in vars(message).values())


@dataclass(frozen=True)
class EarlierRun:
    """Earlier run shown beside the current one; its line style stays the same as others come and go."""

    name: str
    run: History
    style: int  # number for game.ui.curves.run_style; 0 is the current run's


def put_beside(runs: list[EarlierRun], name: str, run: History) -> None:
    """Add an earlier run, in place of one of its name, with the first line style that is free.

    One that has no curve yet, as no flight has ended, is left out.
    """
    if not np.isfinite(run["success_rate" if "success_rate" in run.columns else "loss"]).any():
        return
    run.checkpoints.clear()  # only its curves are shown, and there may be many such runs
    runs[:] = [each for each in runs if each.name != name]
    taken = {each.style for each in runs}
    runs.insert(0, EarlierRun(name, run, next(style for style in count(1) if style not in taken)))


def take_away(runs: list[EarlierRun], style: int) -> None:
    """Take away the earlier run of a line style; the others keep theirs."""
    runs[:] = [each for each in runs if each.style != style]
