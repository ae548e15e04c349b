"""A pilot, or a pay, in a file of the player's: flown as it is saved.

A file that was saved is tried beside the one that flies, and takes over with its first answer. Where it fails, now or
later, the last good one flies on.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.environment import Floats, Ints
from ai.lander.pilots import COAST
from ai.lander.rewards import Situation
from ai.lander.rules import NUM_FEATURES
from ai.pilots.child import ACT, PAY
from ai.pilots.process import PilotError, PilotProcess

PATIENCE: Final = 0.05  # seconds for a decision in a flight that somebody watches
LATE: Final = 3  # decisions in a row that may not take longer
LOADING: Final = 25.0  # seconds for a file to be loaded: PyTorch takes its time
FIRST: Final = 2.0  # seconds for the first decision of a file that was saved
ALONE: Final = 5.0  # seconds for an answer where nobody watches
_PIECE: Final = 64  # landers that a file with `act` alone is asked for at once, where nobody watches
_LOOK: Final = 0.2  # seconds between two looks at the file


class _Alone:
    """A file as it is now, loaded for work that nobody watches; everything raises PilotError."""

    def __init__(self, path: Path, kind: str) -> None:
        self._process = PilotProcess(path, kind)
        self.close = self._process.close
        try:
            if not self._process.ready(LOADING):
                raise self._process.late(f"it was not loaded after {LOADING:.0f} seconds", 1.0)
        except PilotError:
            self.close()
            raise

    def _asked(self, question: Any, what: str) -> Any:
        if (answer := self._process.ask(question, ALONE)) is None:
            raise self._process.late(f"{what} took longer than {ALONE:.0f} seconds", 1.0)
        return answer


class MeasuredPilot(_Alone):
    """The pilot in a file as it is now, for measuring: `act` raises PilotError, and waits for its answers."""

    def __init__(self, path: Path) -> None:
        super().__init__(path, ACT)

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:  # noqa: ARG002
        """Actions (n,) for observations (n, 9)."""
        piece = len(observation) if self._process.many else _PIECE
        pieces = [observation[start : start + piece, :NUM_FEATURES] for start in range(0, len(observation), piece)]
        return np.concatenate([self._asked(rows, f"{len(rows):,} decisions") for rows in pieces])


class OwnPay(_Alone):
    """The pay in a file as it is now, for `LanderEnv(pay=…)`; raises PilotError where the file fails."""

    def __init__(self, path: Path) -> None:
        super().__init__(path, PAY)

    def __call__(self, before: Situation, after: Situation) -> Floats:
        """Return what a decision earns, (n,)."""
        pay: Floats = self._asked((before, after), "pay")
        return pay


class OwnPilot:
    """The pilot in a file, for flights that somebody watches: never raises, and never waits for long.

    Attributes:
        path: the file.
        problem: what is wrong with the file as it was saved last; empty while there is nothing.
        flies_on: whether the last good one flies then.
        chosen: whether it is to fly, and not another that the player chose since.
        reported: the words on it that were reported last, for whoever reports each once.
        ready: whether a file was ever loaded; until then it coasts.
        version: how often another version of the file has taken over.

    """

    work = 100_000  # multiplications that a decision may well take the time of, for those who ask for many

    def __init__(self, path: Path, patience: float = PATIENCE, clock: Callable[[], float] = time.monotonic) -> None:
        self.path, self.problem, self.reported = path, "", ""
        self.flies_on, self.ready, self.chosen, self.version = False, False, True, 0
        self._patience, self._clock = patience, clock
        self._flying: PilotProcess | None = None
        self._before: PilotProcess | None = None  # flew well, and waits in case that the one that flies does not
        self._next: PilotProcess | None = None  # the file that was saved last, until its first answer
        self._until, self._slow = 0.0, ""  # when the next one must be loaded or have decided, and what is said if not
        self._late, self._looked = 0, -_LOOK
        self._stamp: tuple[int, int] | None = None
        self.look()

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:
        """Actions (n,) for observations (n, 9): those held, or coasting, where the file gives none."""
        observation = observation[:, :NUM_FEATURES]
        self.look()
        self._try_next(observation)
        actions: Ints | None = None
        while self._flying:
            try:
                actions = self._flying.ask(observation, self._patience)
                self._late = 0 if actions is not None else self._late + 1
                if self._late == LATE:
                    longest = f"{1000 * self._patience:.0f} ms"
                    raise self._flying.late(f"{LATE} decisions in a row took longer than {longest}")
                break
            except PilotError as error:
                self.problem = str(error)
                if not self._fall_back():
                    break
        if actions is None:
            actions = held if self._flying and held is not None else np.full(len(observation), COAST, np.intp)
        return actions

    def look(self) -> None:
        """Look whether the file was saved anew, and load it then; see whether a file that is loading fails."""
        now = self._clock()
        try:
            if now - self._looked >= _LOOK:
                self._looked = now
                if (stamp := _stamp(self.path)) != self._stamp:
                    self._stamp = stamp
                    self._leave_next()
                    self._next = PilotProcess(self.path)
                    self._until, self._slow = now + LOADING, f"it was not loaded after {LOADING:.0f} seconds"
            if self._next:
                if self._next.ready():
                    self.ready = True
                elif now > self._until:
                    raise self._next.late(self._slow)
        except PilotError as error:
            self._refuse(error)

    def close(self) -> None:
        """End its processes."""
        for process in (self._flying, self._before, self._next):
            if process:
                process.close()
        self._flying = self._before = self._next = None

    def _try_next(self, observation: Floats) -> None:
        """Let the file that was saved last fly from its first answer on."""
        try:
            if not self._next or not self._next.ready():
                return
            if self._next.ask(observation, self._patience) is None:
                first = f"its first decision took longer than {FIRST:.0f} seconds"
                if self._slow != first:
                    self._until, self._slow = self._clock() + FIRST, first
                elif self._clock() > self._until:
                    raise self._next.late(first)
                return
        except PilotError as error:
            self._refuse(error)
            return
        if self._before:
            self._before.close()
        self._before, self._flying, self._next = self._flying, self._next, None
        self.problem, self._late = "", 0
        self.version += 1

    def _refuse(self, error: PilotError) -> None:
        self.problem, self.flies_on = str(error), self._flying is not None
        self._leave_next()

    def _leave_next(self) -> None:
        if self._next:
            self._next.close()
        self._next = None

    def _fall_back(self) -> bool:
        """Let the one before fly in place of the one that failed, and return whether there is one.

        Without one, a file that only raised flies on: it may do so now and then.
        """
        assert self._flying
        if self._before or self._late == LATE or self._flying.gone:
            self._flying.close()
            self._flying, self._before, self._late = self._before, None, 0
            self.version += 1
            self.flies_on = self._flying is not None
        else:
            self.flies_on = False
        return self.flies_on


def _stamp(path: Path) -> tuple[int, int]:
    """Return what changes when a file is saved."""
    try:
        status = path.stat()
    except OSError:
        return 0, 0
    return status.st_mtime_ns, status.st_size
