"""A pilot, or a pay, in a file of the player's: flown as it is saved.

A file that was saved is tried beside the one that flies, and takes over with its first answer. Where it fails to give
one, the last good one flies on.
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
LOADING: Final = 25.0  # seconds for a file to be loaded, and to decide: PyTorch takes its time
ALONE: Final = 5.0  # seconds for an answer where nobody watches
_PIECE: Final = 64  # landers that a file with `act` alone is asked for at once, where nobody watches
_LOOK: Final = 0.2  # seconds between two looks at the file


class _Alone:
    """A file as it is now, loaded for work that nobody watches; everything raises PilotError."""

    kind = ACT

    def __init__(self, path: Path) -> None:
        self._process = PilotProcess(path, self.kind)
        self.close = self._process.close
        if not self._process.ready(LOADING):
            raise self._process.ended(f"it was not loaded after {LOADING:.0f} seconds")

    def _asked(self, question: Any, what: str) -> Any:
        if (answer := self._process.ask(question, ALONE)) is None:
            raise self._process.ended(f"{what} took longer than {ALONE:.0f} seconds")
        return answer


class MeasuredPilot(_Alone):
    """The pilot in a file as it is now, for measuring: `act` raises PilotError, and waits for its answers."""

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:  # noqa: ARG002
        """Actions (n,) for observations (n, 9)."""
        piece = len(observation) if self._process.many else _PIECE
        pieces = [observation[start : start + piece, :NUM_FEATURES] for start in range(0, len(observation), piece)]
        return np.concatenate([self._asked(rows, f"{len(rows):,} decisions") for rows in pieces])


class OwnPay(_Alone):
    """The pay in a file as it is now, for `LanderEnv(pay=…)`; raises PilotError where the file fails."""

    kind = PAY

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

    def __init__(self, path: Path, patience: float = PATIENCE, clock: Callable[[], float] = time.monotonic) -> None:
        self.path, self.problem, self.reported = path, "", ""
        self.flies_on, self.ready, self.chosen, self.version = False, False, True, 0
        self._patience, self._clock = patience, clock
        self._flying: PilotProcess | None = None
        self._next: PilotProcess | None = None  # the file that was saved last, until its first answer
        self._until, self._late, self._looked = 0.0, 0, -_LOOK
        self._stamp: tuple[int, int] | None = None
        self.look()

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:
        """Actions (n,) for observations (n, 9): those held, or coasting, where the file gives none."""
        observation = observation[:, :NUM_FEATURES]
        self.look(observation)
        actions = self._decided(observation) if self._flying else None
        if actions is None:
            actions = held if self._flying and held is not None else np.full(len(observation), COAST, np.intp)
        return actions

    def _decided(self, observation: Floats) -> Ints | None:
        """Return what the file that flies decides; None if it fails or is late, for which its process may be ended."""
        assert self._flying
        try:
            actions: Ints | None = self._flying.ask(observation, self._patience)
            self._late = 0 if actions is not None else self._late + 1
            if self._late == LATE:
                raise self._flying.ended(f"{LATE} decisions in a row took longer than {1000 * self._patience:.0f} ms")
            return actions
        except PilotError as error:
            self.problem, self.flies_on = str(error), False
            if self._flying.gone:  # else it may raise only now and then
                self._flying = None
                self.version += 1
            return None

    def look(self, observation: Floats | None = None) -> None:
        """Look whether the file was saved anew, and load it then; see whether a file that is loading fails.

        Asked for an observation, it flies from its first answer on.
        """
        now = self._clock()
        try:
            if now - self._looked >= _LOOK:
                self._looked = now
                if (stamp := _stamp(self.path)) != self._stamp:
                    self._stamp = stamp
                    self._leave_next()
                    self._next, self._until = PilotProcess(self.path), now + LOADING
            if self._next:
                if observation is not None and self._next.ask(observation, self._patience) is not None:
                    self._take_over()
                elif self._next.ready():
                    self.ready, self._until = True, now + LOADING
                elif now > self._until:
                    raise self._next.ended(f"it gave no answer within {LOADING:.0f} seconds")
        except PilotError as error:
            self.problem, self.flies_on = str(error), self._flying is not None
            self._leave_next()

    def close(self) -> None:
        """End its processes."""
        self._leave_next()
        if self._flying:
            self._flying.close()
        self._flying = None

    def _take_over(self) -> None:
        """Let the file that was saved last fly."""
        if self._flying:
            self._flying.close()
        self._flying, self._next = self._next, None
        self.ready, self.problem, self._late = True, "", 0
        self.version += 1

    def _leave_next(self) -> None:
        if self._next:
            self._next.close()
        self._next = None


def _stamp(path: Path) -> tuple[int, int]:
    """Return what changes when a file is saved."""
    try:
        status = path.stat()
    except OSError:
        return 0, 0
    return status.st_mtime_ns, status.st_size
