"""Replay of a recorded flight, which can be moved to any of its steps."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.environment import Doubles
from ai.flights.verification import Earned, earned
from ai.lander.missions import STARTS
from game.flight.choosers import Recorded
from game.flight.flight import Flight, Recording
from game.flight.flight_file import Record

_EVERY: Final = 20  # steps between the snapshots from which `go_to` starts
_EXACT: Final = 1e-6  # tolerance of the end pose in metres and radians, for rounding on other processors


def replayed(source: Recording) -> Flight[Recorded]:
    """Begin a flight that repeats a recorded one."""
    return Flight(source, Recorded(source))


class FlightReplay:
    """Replay of a record at any step, while a second flight, the scout, runs ahead and notes the path.

    Attributes:
        flight: the flight at the step that is shown.
        length: physics steps of the whole flight.
        path: positions (steps + 1, 2) up to the scout's step.

    """

    def __init__(self, record: Record) -> None:
        self.record = record
        self.length = len(record.recording.pushes)
        self.flight, self._scout = replayed(record.recording), replayed(record.recording)
        self._moments = [self._scout.env.snapshot()]
        self._places = np.empty((self.length + 1, 2))
        self._places[0] = self._scout.env.position[0]

    @property
    def at(self) -> int:
        """Physics step that is shown, counted from the start."""
        return self.flight.at

    @property
    def reached(self) -> int:
        """Last step that can be shown, which is the scout's."""
        return self._scout.at

    @property
    def path(self) -> Doubles:
        """Path of the flight up to the scout's step, (steps + 1, 2), in metres. Do not write to it."""
        return self._places[: self.reached + 1]

    @property
    def touching(self) -> bool:
        """Whether the scout touches the ground, where a step takes several times as long as in the air."""
        return bool(self._scout.env.feet_down.any())

    @property
    def complete(self) -> bool:
        """Whether the scout has reached the end."""
        return self._scout.over or self.reached >= self.length

    @property
    def earned(self) -> Earned | None:
        """What the flight really earned; None until the scout has reached the end."""
        return earned(self._scout.env, self.record.recording) if self.complete else None

    @property
    def faithful(self) -> bool:
        """Whether the replay matches the record so far; it does not if the rules have changed since."""
        if not self.complete:
            return True
        entry = self.record.entry
        away = np.abs(self._scout.poses.now[0] - self.record.end).max()
        return self.reached == self.length and self._scout.outcome.name == entry.outcome and bool(away < _EXACT)

    def scout(self, steps: int) -> None:
        """Advance the scout by some physics steps."""
        for _ in range(steps):
            if self.complete:
                return
            self._scout.step()
            self._places[self.reached] = self._scout.env.position[0]
            if self.reached % _EVERY == 0:
                self._moments.append(self._scout.env.snapshot())

    def step(self) -> None:
        """Show the next step."""
        if self.at >= self.reached:
            self.scout(1)
        if self.at < self.reached:
            self.flight.step()
        else:
            self.flight.rest()

    def go_to(self, step: int) -> None:
        """Show another step, `reached` at most."""
        step = min(max(step, 0), self.reached)
        mark = min(step // _EVERY, len(self._moments) - 1)
        if not mark * _EVERY <= self.at <= step:
            self.flight.put(self._moments[mark], self.record.recording, mark * _EVERY)
        while self.at < step:
            self.flight.step()
        self.flight.rest()


def flown_elsewhere(recording: Recording) -> bool:
    """Whether a recorded flight was flown where it is not as on the moon."""
    return recording.mission != "" and STARTS[recording.mission].elsewhere
