"""A pilot, or a pay, in a file of the player's: flown as it is saved.

A file that was saved is tried beside the one that flies, and takes over with its first answer. Where it fails, now or
later, the last good one flies on.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.environment import Floats, Ints, StepResult
from ai.files import read_text
from ai.lander.environment import LanderEnv
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
LARGEST: Final = 1_000_000  # bytes of a file
_LOOK: Final = 0.2  # seconds between two looks at the file


def begin(path: Path, kind: str = ACT) -> PilotProcess:
    """Return a process for the file as it is now; raises PilotError for a file that cannot be read."""
    try:
        return PilotProcess(path.absolute(), read_text(path, LARGEST), kind)
    except OSError as error:
        raise PilotError(f"the file cannot be read: {error.strerror or error}") from error
    except ValueError as error:
        raise PilotError("the file is no text in UTF-8") from error


def loaded(path: Path, kind: str = ACT) -> PilotProcess:
    """Return a process that has loaded the file, for work that nobody watches; raises PilotError."""
    process = begin(path, kind)
    try:
        if process.ready(LOADING):
            return process
        raise process.late(f"it was not loaded after {LOADING:.0f} seconds", 1.0)
    except PilotError:
        process.close()
        raise


class MeasuredPilot:
    """The pilot in a file as it is now, for measuring: `act` raises PilotError, and waits for its answers."""

    def __init__(self, path: Path) -> None:
        self._process = loaded(path)
        self.close = self._process.close

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:  # noqa: ARG002
        """Actions (n,) for observations (n, 9)."""
        count = len(observation)
        piece = count if self._process.many else _PIECE
        actions = np.empty(count, np.intp)
        for start in range(0, count, piece):
            rows = observation[start : start + piece, :NUM_FEATURES]
            if (answer := self._process.act(rows, ALONE)) is None:
                raise self._process.late(f"{len(rows):,} decisions took longer than {ALONE:.0f} seconds", 1.0)
            actions[start : start + piece] = answer
        return actions


class OwnPilot:
    """The pilot in a file, for flights that somebody watches: never raises, and never waits for long.

    Attributes:
        path: the file.
        problem: what is wrong with the file as it was saved last; empty while there is nothing.
        flies_on: whether the last good one flies then.
        chosen: whether it is to fly, and not another that the player chose since.
        reported: the words on it that were reported last, for whoever reports each once.
        ready: whether a process has answered yet; until then it coasts.
        version: how often another version of the file has taken over.

    """

    work = 100_000  # multiplications that a decision may well take the time of, for those who ask for many

    def __init__(self, path: Path, patience: float = PATIENCE, clock: Callable[[], float] = time.monotonic) -> None:
        self.path, self.problem, self.reported = path, "", ""
        self.flies_on, self.ready, self.chosen, self.version = False, False, True, 0
        self._patience, self._clock = patience, clock
        self._flying: PilotProcess | None = None
        self._before: PilotProcess | None = None  # flew well, and waits in case that the one that flies does not
        self._next: PilotProcess | None = None  # loads the file that was saved last
        self._asked, self._slow, self._until = False, "", 0.0  # of the next one: whether, and until when, it may decide
        self._late, self._looked = 0, -_LOOK
        self._stamp: tuple[int, int] | None = None
        self.look()

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:
        """Actions (n,) for observations (n, 9): those held, or coasting, where the file gives none."""
        observation = observation[:, :NUM_FEATURES]
        self.look()
        self._take_over(observation)
        while self._flying:
            try:
                actions = self._flying.act(observation, self._patience)
                self._late = 0 if actions is not None else self._late + 1
                if self._late == LATE:
                    longest = f"{1000 * self._patience:.0f} ms"
                    raise self._flying.late(f"{LATE} decisions in a row took longer than {longest}")
            except PilotError as error:
                self.problem, self.flies_on = str(error), self._fall_back()
                if not self.flies_on:
                    break
            else:
                if actions is not None:
                    return actions
                break
        return np.full(len(observation), COAST, np.intp) if held is None or not self._flying else held

    def look(self) -> None:
        """Look whether the file was saved anew, and load it then; see whether a file that is loading fails."""
        now = self._clock()
        if now - self._looked >= _LOOK:
            self._looked = now
            if (stamp := _stamp(self.path)) != self._stamp:
                self._stamp = stamp
                self._load(now)
        if self._next:
            try:
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

    def _load(self, now: float) -> None:
        if self._next:
            self._next.close()
        self._next = None
        try:
            self._next, self._asked, self._until = begin(self.path), False, now + LOADING
            self._slow = f"it was not loaded after {LOADING:.0f} seconds"
        except PilotError as error:
            self._refuse(error)

    def _take_over(self, observation: Floats) -> None:
        """Let the file that was saved last fly from its first answer on."""
        try:
            if self._next is None or not self._next.ready():
                return
            if self._next.act(observation, self._patience) is None:
                if not self._asked:
                    self._asked, self._until = True, self._clock() + FIRST
                    self._slow = f"its first decision took longer than {FIRST:.0f} seconds"
                elif self._clock() > self._until:
                    raise self._next.late(self._slow)
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
        if self._next:
            self._next.close()
            self._next = None

    def _fall_back(self) -> bool:
        """Return whether another flies now in place of the one that failed; one that only raised stays otherwise."""
        assert self._flying
        if self._before or self._late == LATE or self._flying.gone:
            self._flying.close()
            self._flying, self._before, self._late = self._before, None, 0
            self.version += 1
        else:
            return False
        return self._flying is not None


def _stamp(path: Path) -> tuple[int, int]:
    """Return what changes when a file is saved."""
    try:
        status = path.stat()
    except OSError:
        return 0, 0
    return status.st_mtime_ns, status.st_size


def pay_by(env: LanderEnv, path: Path) -> Callable[[], None]:
    """Let landers be paid by a file's `pay`, as it is now; return what ends its process. Raises PilotError.

    `step` raises it too, where the file fails. The parts of the usual pay go on being reported beside it.
    """
    process, usual = loaded(path, PAY), env.step

    def step(actions: Any) -> StepResult:
        before = Situation.of(env)
        result = usual(actions)
        pay = process.pay(before, Situation.of(env), ALONE)
        if pay is None:
            raise process.late(f"pay took longer than {ALONE:.0f} seconds", 1.0)
        return replace(result, reward=pay.astype(np.float32))

    env.step = step  # type: ignore[method-assign]
    return process.close
