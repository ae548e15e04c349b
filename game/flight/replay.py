"""A flight that is flown again from its record, and can be wound to any moment of it."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.common.environment import Doubles
from ai.lander.pilots import COAST
from game.flight.flight import DECISION_STEPS, Flight, Hand, Recording
from game.flight.flight_file import Record

_EVERY: Final = 20  # steps between moments that can be gone back to at once
_EXACT: Final = 1e-6  # metres and radians by which a flight may end elsewhere on another processor


class Rerun(Flight):
    """Flies what was recorded, whatever keys are held; after its end, or the recording's, it stays as it is."""

    def __init__(self, source: Recording) -> None:
        super().__init__(source.seed, spawn=source.spawn, pads=source.pads, mission=source.mission)
        self._source = source

    @property
    def at(self) -> int:
        """Steps flown."""
        return len(self.recording.actions)

    @property
    def flown_by(self) -> Hand:
        """Whose action the last step was; before the first, whose that will be."""
        hands = self._source.hands
        return hands[min(max(self.at - 1, 0), len(hands) - 1)] if hands else self.hand

    def _choose(self, held: int) -> tuple[int, Hand]:  # noqa: ARG002
        """Return what the next step was flown with, and whose action that was."""
        if self.at >= len(self._source.actions):
            return COAST, self.flown_by
        self.hand = self._source.hands[self.at]
        self.set_gravity(self._source.gravity_at(self.at))
        if self.hand is Hand.HUMAN and self.at % DECISION_STEPS == 0:  # as read-outs were turned then
            self._aim()
        return self._source.actions[self.at], self.hand


class Tape:
    """The flight of a record, shown at some moment, while a scout flies ahead and notes the way.

    Attributes:
        flight: as it stands at the moment that is shown.
        length: physics steps of the whole flight.
        path: positions (steps + 1, 2) as far as the scout has come.

    """

    def __init__(self, record: Record) -> None:
        self.record = record
        self.length = len(record.recording.actions)
        self.flight, self._scout = Rerun(record.recording), Rerun(record.recording)
        self._moments = [self._scout.env.snapshot()]
        self._places = np.empty((self.length + 1, 2))
        self._places[0] = self._scout.env.position[0]

    @property
    def at(self) -> int:
        """The moment that is shown, in physics steps from the start."""
        return self.flight.at

    @property
    def reached(self) -> int:
        """How far it can be wound: so far the scout has come."""
        return self._scout.at

    @property
    def path(self) -> Doubles:
        """Where the flight went, as far as it is known: (steps, 2). It is kept; do not write."""
        return self._places[: self.reached + 1]

    @property
    def touching(self) -> bool:
        """Whether the scout is on the ground, where a step takes several times as long as in the air."""
        return bool(self._scout.env.contacts.any())

    @property
    def complete(self) -> bool:
        """Whether the scout has seen all of it."""
        return self._scout.over or self.reached >= self.length

    @property
    def faithful(self) -> bool:
        """Whether the flight, as far as it is known, goes as it went: not if the rules have changed since."""
        if not self.complete:
            return True
        entry = self.record.entry
        away = np.abs(self._scout.poses.now[0] - self.record.end).max()
        return self.reached == self.length and self._scout.outcome.name == entry.outcome and bool(away < _EXACT)

    def scout(self, steps: int) -> None:
        """Look so many steps further ahead."""
        for _ in range(steps):
            if self.complete:
                return
            self._scout.step(COAST)
            self._places[self.reached] = self._scout.env.position[0]
            if self.reached % _EVERY == 0:
                self._moments.append(self._scout.env.snapshot())

    def step(self) -> None:
        """Show the next moment."""
        if self.at >= self.reached:
            self.scout(1)
        if self.at < self.reached:
            self.flight.step(COAST)
        else:
            self.flight.rest()

    def seek(self, step: int) -> None:
        """Show another moment, as far as it can be wound."""
        step = min(max(step, 0), self.reached)
        mark = min(step // _EVERY, len(self._moments) - 1)
        if not mark * _EVERY <= self.at <= step:
            self.flight.put(self._moments[mark], self.record.recording, mark * _EVERY)
        while self.at < step:
            self.flight.step(COAST)
        self.flight.rest()
