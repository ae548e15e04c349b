"""Flight: one lander in its environment, what chooses its pushes, and poses for drawing between steps."""

from __future__ import annotations

from typing import Any, Final, Generic, TypeVar

import numpy as np

from ai.environment import Bools, Doubles
from ai.flights.recording import Recording, StickHolder
from ai.flights.verification import begun
from ai.lander.descent import leg_of
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.pilots import Pilot
from ai.lander.push import Push
from ai.lander.route import Route
from game.flight.choosers import Choice, Chooser, Crew

__all__ = ["Flight", "Recording", "StickHolder", "begin"]

C = TypeVar("C", bound=Chooser)
_NOTHING: Final = Push()


def begin(start: Recording, network: Pilot | None = None, *, shares: bool = True) -> Flight[Crew]:
    """Begin a flight that a person flies, with a `network` that can take the stick, or also share it if it `shares`."""
    return Flight(start, Crew(network, shares=shares, route=_route_of(start)))


def _route_of(start: Recording) -> Route | None:
    return Route(leg_of(start.seed, start.leg).route) if start.leg else None


class Poses:
    """Last two poses x, y, angle of every lander, for interpolation when drawing."""

    def __init__(self, env: LanderEnv) -> None:
        self._env = env
        self.now = self._read()
        self.before = self.now

    def take(self, jumped: Bools | None = None) -> None:
        """Store the poses after a step; the slots of `jumped` were reset, and are not interpolated."""
        self.before, self.now = self.now, self._read()
        if jumped is not None and jumped.any():
            self.before = np.where(jumped[:, None], self.now, self.before)

    def at(self, alpha: float) -> Doubles:
        """Return poses (n, 3), interpolated between the last two steps by `alpha`, 0 to 1."""
        poses: Doubles = self.before + alpha * (self.now - self.before)
        return poses

    def _read(self) -> Doubles:
        return np.concatenate([self._env.position, self._env.angle[:, None]], axis=1)


class Flight(Generic[C]):
    """Flight of one lander: a recording of what is pushed in each step, and what chooses that.

    Args:
        start: the recording of a flight from the same start; what it has flown is not looked at.

    Attributes:
        chooser: what chooses the push of each step; free to be changed.
        choice: what it chose last.
        asked: what the stick asks for.
        route: how a network is led around rock on a leg of a descent; None in any other flight.

    """

    def __init__(self, start: Recording, chooser: C) -> None:
        self.recording, self.chooser = start.again(), chooser
        self.env = begun(self.recording)
        self.route = _route_of(start)
        self.poses = Poses(self.env)
        self.choice, self.asked = Choice(_NOTHING, StickHolder.HUMAN), _NOTHING
        self._yours = 0
        self._aim(0.0)

    @property
    def at(self) -> int:
        """Steps flown."""
        return len(self.recording.pushes)

    @property
    def outcome(self) -> Outcome:
        """Outcome of the flight so far; it is `over` unless it is still flying."""
        return Outcome(int(self.env.outcome[0]))

    @property
    def over(self) -> bool:
        """Whether it has ended."""
        return self.outcome is not Outcome.FLYING

    @property
    def intact(self) -> bool:
        """Whether it has ended beside the pad with nothing broken."""
        return bool(self.env.intact[0])

    @property
    def wrecked(self) -> bool:
        """Whether it has ended in a wreck."""
        return self.outcome is Outcome.CRASHED and not self.intact

    @property
    def flown_by(self) -> StickHolder:
        """Who chose the push of the last step."""
        return self.recording.hands[-1] if self.recording.hands else self.chooser.hand

    @property
    def share(self) -> float:
        """Person's share of the steps flown, 0 to 1."""
        return self._yours / self.at if self.at else 1.0

    def put(self, moment: dict[str, Any], source: Recording, step: int) -> None:
        """Restore a snapshot `moment` of the environment after `step` steps of a flight from the same start."""
        self.env.restore(moment)
        self.recording.pushes[:] = source.pushes[:step]
        self.recording.hands[:] = source.hands[:step]
        self._yours = self.recording.hands.count(StickHolder.HUMAN)
        self.rest()

    def rest(self) -> None:
        """Stop interpolation, so that the lander is drawn at its present pose."""
        self.poses.take()
        self.poses.take()

    def step(self, asked: Push = _NOTHING) -> None:
        """Advance by 1/60 s; `asked` is what the stick asks for, which the chooser may heed."""
        self.asked = asked
        if self.over:
            self.poses.take()
            return
        self.choice = choice = self.chooser.choose(self)
        push, by = choice.push, choice.by
        if choice.likely is not None:
            self._aim(choice.likely)
        self.env.fly(np.array([push.action]), np.array([push.shares]))
        self.recording.pushes.append(push)
        self.recording.hands.append(by)
        self._yours += by is StickHolder.HUMAN
        self.poses.take()
        if self.outcome is Outcome.LANDED:
            self.env.target = self.env.landed_on

    def _aim(self, likely: Doubles | float) -> None:
        self.env.target[:] = self.target_of(likely)

    def target_of(self, likely: Doubles | float) -> int:
        """Return at which pad read-outs and network aim: the most `likely` (pads,); among equals, the nearest."""
        if self.route:  # to the goal, whatever is nearer
            return 0
        away = np.abs(self.env.ground.middles[:, 0] - self.env.position[0, 0])
        return int((likely - 1e-6 * away).argmax())
