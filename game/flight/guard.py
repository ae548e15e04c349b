"""Guard of one flight by futures: it decides at every fourth step, by what was flown ahead in the meantime."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ai.agent.decision import Decision
from ai.copilot.copilot import CoPilot, SharedDecision
from ai.copilot.futures import DECISION_STEPS, Future, Here, Opening
from ai.copilot.guardian import decisions_of
from ai.environment import Doubles
from ai.flights.recording import StickHolder
from ai.lander.moment import Moment
from ai.lander.push import KEYS, STEPS, Push
from ai.lander.route import Route
from game.flight.choosers import Choice, seen_by
from game.flight.networks import Policy

if TYPE_CHECKING:
    from game.flight.choosers import Crew
    from game.flight.flight import Flight
    from game.flight.futures import FuturesProcess

_PATIENCE: Final = 180  # steps for which a craft hangs on until a plan is found
_NEAR: Final = STEPS / 4  # between a position of the stick and one that is flown in its place
_NOTHING: Final = Push()


class Taps:
    """What was pressed since the last decision: an engine that was tapped between two decisions counts in the next."""

    def __init__(self) -> None:
        self._now = self._tapped = _NOTHING

    def follow(self, push: Push) -> None:
        """Follow one step's stick."""
        main, side = self._tapped
        before, self._now = self._now, push
        self._tapped = Push(main if before.main else push.main or main, side if before.side else push.side or side)

    @property
    def asked(self) -> Push:
        """What the stick asks for in the decision that begins."""
        return Push(self._now.main or self._tapped.main, self._now.side or self._tapped.side)

    def forget(self) -> None:
        """Forget the taps: they are flown."""
        self._tapped = _NOTHING


class Guard:
    """Guard of one flight by futures, whoever has the stick.

    Attributes:
        ahead: what flies the futures.
        push: what is pushed in the decision that is flown now; None while nothing is guarded.
        saves: whether something else is flown now because what was asked for was seen not to land.
        decisions: decisions so far.
        late: those in which something else was flown only because what was asked for was not flown ahead in time.
        waits: whether what is asked for now was not flown ahead in time, so that what was asked for before counts.
        waited: decisions in which that was so.
        bare: since when, in seconds of the flight, it guards without a plan; None while it holds one.

    """

    def __init__(self, crew: Crew, ahead: FuturesProcess) -> None:
        self._crew, self.ahead = crew, ahead
        self._taps = Taps()
        self.push: Push | None = None
        self.saves = False
        self.waits = False
        self.decisions = self.late = self.waited = 0
        self.bare: float | None = None
        self._wish = _NOTHING  # what was asked for in the decision that is flown now
        self._decision: SharedDecision | None = None
        self._alone: Decision | None = None  # what the network would do
        self._hung = 0  # steps for which the craft has hung although something was asked for
        self._moment = -1  # steps flown when the futures asked for last begin
        self._flown_by: tuple[object, ...] = ()  # and what they are flown by

    def acts(self, flight: Flight[Any]) -> bool:
        """Return whether a guardian goes by futures now; it begins with a decision, every fourth step."""
        copilot = self._crew.copilot
        if copilot is None or copilot.assist == 0 or self.ahead.problem:
            self.push, self._moment, self.bare = None, -1, None
            return False
        return self.push is not None or _begins(flight)

    @property
    def safe(self) -> bool:
        """Whether a plan that lands is held, so that nobody can crash the flight."""
        return self.push is not None and self._decision is not None and bool(np.all(self._decision.held))

    def ready(self, flight: Flight[Any]) -> bool:
        """Return whether a craft that hangs may go: it is known whether the network lands, or that takes too long."""
        if not (self.acts(flight) and _begins(flight)) or self.safe or self._hung >= _PATIENCE:
            return True
        known = self.ahead.known() if self._moment == flight.at else {}
        return any(future.plan for future in known.values()) or all(key in known for key in KEYS)

    def hang(self, flight: Flight[Any], asked: Push) -> None:
        """Let the futures of the present moment be flown while the craft hangs, and the stick asks for that."""
        if not self.acts(flight) or not _begins(flight) or flight.over:
            return
        self._hung += asked != _NOTHING
        if self._moment != flight.at or self._flown_by != self._flyer(flight):
            self._ask(flight, (), asked)
        else:
            self.ahead.hint(asked)

    def choose(self, flight: Flight[Any]) -> Choice:
        """Return the next step's push, which is decided every fourth step."""
        by_hand, likely = self._crew.hand is StickHolder.HUMAN, None
        if by_hand:
            self._taps.follow(flight.asked)
        if _begins(flight):
            likely = self._decide(flight, by_hand)
        elif by_hand:
            self.ahead.hint(flight.asked)
        decision = self._decision
        assert self.push is not None
        assert decision is not None
        if not by_hand:
            return Choice(self.push, StickHolder.NETWORK, self._alone)
        overridden = bool(decision.overridden[0])
        by = StickHolder.NETWORK if overridden else StickHolder.HUMAN
        return Choice(self.push, by, decision, self._wish, overridden, likely)

    def _decide(self, flight: Flight[Any], by_hand: bool) -> Doubles | None:
        """Decide what is flown in the next four steps, and let the futures after them be flown meanwhile.

        Returns how likely each pad is meant by the person; None while the network has the stick.
        """
        copilot, alone = self._copilot, self._crew.alone
        assert alone is not None
        known: Mapping[Push, Future] = self.ahead.known() if self._moment == flight.at else {}
        self._alone = None if by_hand else alone.decide(flight)
        stick = KEYS[int(self._alone.action[0])] if self._alone else self._taps.asked
        held = self.safe
        self._wish = wish = self._wished(flight, nearest(stick, known), known) if by_hand else stick
        seen, around = seen_by(alone.network, flight)
        asked, shares = np.array([wish.action]), np.array([wish.shares])
        self._decision = decision = copilot.decide(seen, asked, around, shares, flight.env, [known])
        self.push = Push.of(*decision.shares[0].tolist())
        self.decisions += 1
        missing = held and bool(decision.overridden[0]) and wish not in known
        self.saves, self.late = bool(decision.overridden[0]) and not missing, self.late + missing
        self.bare = None if self.safe else float(flight.env.time[0]) if self.bare is None else self.bare
        likely: Doubles | None = decision.likely[0] if by_hand else None
        self._ask(flight, (self.push,), stick, likely)
        return likely

    def _wished(self, flight: Flight[Any], wish: Push, known: Mapping[Push, Future]) -> Push:
        """Return what is asked for in this decision.

        A new wish of which is not known yet what comes of it waits for one decision, in which the one before counts: so
        a key is felt a little later at times.
        """
        waited, self.waits = self.waits, False
        if self.safe and not waited:
            guardian, here = self._copilot.guardians[0], Here.of(flight.env)
            self.waits = guardian.knows(here, self._wish, known) and not guardian.knows(here, wish, known)
        self.waited += self.waits
        if not self.waits:
            self._taps.forget()
        return self._wish if self.waits else wish

    def _ask(self, flight: Flight[Any], before: Opening, wish: Push, likely: Doubles | None = None) -> None:
        self._moment, self._flown_by = flight.at + DECISION_STEPS * len(before), self._flyer(flight)
        moment = Moment.of(flight.env)
        if likely is not None:
            moment.target[:] = flight.target_of(likely)
        self.ahead.ask(moment, before, wish, *self._flyer(flight))

    @property
    def _copilot(self) -> CoPilot:
        assert self._crew.copilot is not None
        return self._crew.copilot

    def _flyer(self, flight: Flight[Any]) -> tuple[int, Policy, Route | None]:
        assert self._crew.network is not None
        return decisions_of(self._copilot.assist), self._crew.network, flight.route


def _begins(flight: Flight[Any]) -> bool:
    """Whether a decision is due."""
    return flight.at % DECISION_STEPS == 0


def nearest(wish: Push, known: Mapping[Push, Future]) -> Push:
    """Return a position of the stick, or the nearest that was flown ahead, if that is near; keys stay as they are."""
    if wish in known or wish in KEYS or not known:
        return wish
    away, best = min((hypot(push.main - wish.main, push.side - wish.side), push) for push in known)
    return best if away <= _NEAR else wish
