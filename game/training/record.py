"""What is kept of a run to be shown again: messages of its landers and its networks."""

from __future__ import annotations

from bisect import bisect_left
from typing import Any, Final, Generic, Protocol, TypeVar

_OVERHEAD: Final = 1024  # bytes of a message besides its arrays, about


class Dated(Protocol):
    """Message that says at which moment of a run it was sent."""

    @property
    def decisions(self) -> int:
        """Moment of the run, in decisions of all landers."""


Message = TypeVar("Message", bound=Dated)


class Record(Generic[Message]):
    """Record of messages that come in the order of their `decisions`, within `most` bytes.

    All are kept until they take too much room; then every second one, and so on: they stay evenly spaced over the run.
    """

    def __init__(self, most: int) -> None:
        self._most, self._every, self._came = most, 1, 0
        self._kept: list[Message] = []

    @property
    def begins(self) -> int | None:
        """Decisions of the first message; None without any."""
        return self._kept[0].decisions if self._kept else None

    @property
    def moments(self) -> list[int]:
        """Decisions of the kept messages, rising."""
        return [message.decisions for message in self._kept]

    def append(self, message: Message) -> None:
        """Keep a message, if it is one of those that are kept by now."""
        if self._came % self._every == 0:
            self._kept.append(message)
        self._came += 1
        while len(self._kept) * size_of(message) > self._most and len(self._kept) > 1:
            self._kept, self._every = self._kept[::2], 2 * self._every

    def nearest(self, decisions: float) -> Message | None:
        """Return the kept message nearest to a moment, the earlier of two; None if none is kept."""
        after = bisect_left(self._kept, decisions, key=lambda message: message.decisions)
        around = self._kept[max(after - 1, 0) : after + 1]
        return min(around, key=lambda message: abs(message.decisions - decisions), default=None)


def size_of(message: Any) -> int:
    """Return about how many bytes a message takes: those of its arrays, and a little for the rest."""
    return _OVERHEAD + sum(getattr(value, "nbytes", 0) for value in vars(message).values())
