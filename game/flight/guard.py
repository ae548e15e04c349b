"""Guard of one flight by futures: it decides at every fourth step, by what was flown ahead in the meantime."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot
from typing import TYPE_CHECKING, Final

import numpy as np

from ai.copilot.copilot import SharedDecision
from ai.copilot.futures import DECISION_STEPS, KEYS, FlownAhead, Future, Here, Opening, Push
from ai.copilot.guardian import decisions_of
from ai.flights.recording import STEPS, Shares, StickHolder, full
from ai.lander.moment import Moment
from ai.lander.pilots import COAST
from ai.lander.route import Route
from ai.lander.rules import ACTION_SHARES
from game.flight.networks import Policy

if TYPE_CHECKING:
    from game.flight.flight import Flight

_SHORT: Final = 8.0  # seconds before time is out, in which no network may be able to land
_SOON: Final = 0.5  # seconds within which it must be known that no network lands, to be why no plan is held
_PATIENCE: Final = 180  # steps for which a craft hangs on until a plan is found
_NEAR: Final = 0.25  # shares of thrust between a position of the stick and one that is flown in its place


def push_of(action: int, shares: Shares | None = None) -> Push:
    """Return what a step pushes, by its action and its shares of thrust, or all that the action asks for."""
    main, side = ACTION_SHARES[action].tolist() if shares is None else (shares[0] / STEPS, shares[1] / STEPS)
    return Push(action, main, side)


def shares_of(push: Push) -> Shares | None:
    """Return the shares of thrust of a push as a flight records them; None for all that its action asks for."""
    shares = round(STEPS * push.main), round(STEPS * push.side)
    return None if shares == full(push.action) else shares


class Taps:
    """What was pressed since the last decision: an engine that was tapped between two decisions counts in the next."""

    def __init__(self) -> None:
        self._now, self._tapped = [0.0, 0.0], [0.0, 0.0]  # shares of main engine and jets

    def follow(self, push: Push) -> None:
        """Follow one step's stick."""
        for engine, share in enumerate(push[1:]):
            if share and not self._now[engine]:
                self._tapped[engine] = share
            self._now[engine] = share

    @property
    def asked(self) -> Push:
        """What the stick asks for in the decision that begins."""
        main, side = (now or tapped for now, tapped in zip(self._now, self._tapped, strict=True))
        return Push.of(main, side)

    def forget(self) -> None:
        """Forget the taps: they are flown."""
        self._tapped = [0.0, 0.0]


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
        bare: since when, in seconds of the flight, no plan is held, and the key of why; None while one is, and before
            anything is guarded.

    """

    def __init__(self, flight: Flight, ahead: FlownAhead) -> None:
        self._flight, self.ahead = flight, ahead
        self._taps = Taps()
        self.push: Push | None = None
        self.saves = False
        self.waits = False
        self.decisions = self.late = self.waited = 0
        self.bare: tuple[float, str] | None = None
        self._wish = KEYS[COAST]  # what was asked for in the decision that is flown now
        self._decision: SharedDecision | None = None
        self._hung = 0  # steps for which the craft has hung although something was asked for
        self._moment = -1  # steps flown when the futures asked for last begin
        self._flown_by: tuple[object, ...] = ()  # and what they are flown by

    @property
    def acts(self) -> bool:
        """Whether a guardian goes by futures now; it begins with a decision, every fourth step."""
        copilot = self._flight.copilot
        if copilot is None or copilot.assist == 0 or self.ahead.problem:
            if self.push and not self._flight.over:
                self.bare = self._seconds, "process" if self.ahead.problem else "off"
            self.push, self._moment = None, -1
            return False
        return self.push is not None or self._begins

    @property
    def safe(self) -> bool:
        """Whether a plan that lands is held, so that nobody can crash the flight."""
        return self.push is not None and self._decision is not None and bool(np.all(self._decision.held))

    @property
    def _begins(self) -> bool:
        return len(self._flight.recording.actions) % DECISION_STEPS == 0

    @property
    def ready(self) -> bool:
        """Whether a craft that hangs may go: it is known whether the network lands, or that takes too long."""
        if not (self.acts and self._begins) or self.safe or self._hung >= _PATIENCE:
            return True
        known = self.ahead.known() if self._moment == self._here else {}
        return any(future.plan for future in known.values()) or all(key in known for key in KEYS)

    def hang(self, held: int) -> None:
        """Let the futures of the present moment be flown while the craft hangs, and `held` is the action asked for."""
        if not self.acts or not self._begins or self._flight.over:
            return
        self._hung += held != COAST
        if self._moment != self._here or self._flown_by != self._flyer:
            self._ask((), push_of(held))
        else:
            self.ahead.hint(push_of(held))

    def choose(self, by: StickHolder, shares: Shares | None) -> tuple[int, StickHolder, Shares | None]:
        """Return the next step's action, who chose it, and its shares of thrust, or None for all of it."""
        flight = self._flight
        if by is StickHolder.HUMAN:
            self._taps.follow(push_of(flight.asked, shares))
        if self._begins:
            self._decide(by)
        elif by is StickHolder.HUMAN:
            self.ahead.hint(push_of(flight.asked, shares))
        flight.decision = decision = self._decision
        assert self.push
        assert decision
        if by is StickHolder.NETWORK:
            flight.asked = COAST
            return self.push.action, by, shares_of(self.push)
        flight.asked, flight.overridden = int(decision.pilot[0]), bool(decision.overridden[0])
        return self.push.action, StickHolder.NETWORK if flight.overridden else by, shares_of(self.push)

    def _decide(self, by: StickHolder) -> None:
        """Decide what is flown in the next four steps, and let the futures after them be flown meanwhile."""
        flight, flight.alone = self._flight, None
        assert flight.copilot is not None
        known: Mapping[Push, Future] = self.ahead.known() if self._moment == self._here else {}
        stick = self._taps.asked if by is StickHolder.HUMAN else push_of(flight.ask_network())
        held = self.safe
        self._wish = wish = self._wished(nearest(stick, known), known) if by is StickHolder.HUMAN else stick
        seen, around = flight.seen()
        pilot, pushed = np.array([wish.action]), np.array([wish[1:]])
        self._decision = decision = flight.copilot.decide(seen, pilot, around, pushed, flight.env, [known])
        self.push = Push(int(decision.action[0]), *decision.shares[0].tolist())
        self.decisions += 1
        missing = held and bool(decision.overridden[0]) and wish not in known
        self.saves, self.late = bool(decision.overridden[0]) and not missing, self.late + missing
        self._note(known)
        if by is StickHolder.HUMAN:
            flight.aim(decision.likely[0])
        self._ask((self.push,), stick)

    def _note(self, known: Mapping[Push, Future]) -> None:
        """Note since when no plan is held, and why."""
        if self.safe:
            self.bare = None
            return
        since, why = self.bare or (self._seconds, "looking")
        if why == "looking" and self._seconds - since < _SOON and all(key in known for key in KEYS):
            left = float(np.max(self._flight.env.limits.time)) - self._seconds
            why = "none" if left > _SHORT else "time"
        self.bare = since, why

    @property
    def _seconds(self) -> float:
        return float(self._flight.env.time[0])

    def _wished(self, wish: Push, known: Mapping[Push, Future]) -> Push:
        """Return what is asked for in this decision.

        A new wish of which is not known yet what comes of it waits for one decision, in which the one before counts: so
        a key is felt a little later at times.
        """
        flight, waited = self._flight, self.waits
        assert flight.copilot is not None
        self.waits = False
        if self.safe and not waited:
            guardian, here = flight.copilot.guardians[0], Here.of(flight.env)
            self.waits = guardian.knows(here, self._wish, known) and not guardian.knows(here, wish, known)
        self.waited += self.waits
        if not self.waits:
            self._taps.forget()
        return self._wish if self.waits else wish

    def _ask(self, before: Opening, wish: Push) -> None:
        flight = self._flight
        self._moment, self._flown_by = self._here + DECISION_STEPS * len(before), self._flyer
        self.ahead.ask(Moment.of(flight.env), before, wish, *self._flyer)

    @property
    def _flyer(self) -> tuple[int, Policy, Route | None]:
        flight = self._flight
        assert flight.copilot is not None
        assert flight.network is not None
        return decisions_of(flight.copilot.assist), flight.network, flight.route

    @property
    def _here(self) -> int:
        """The steps flown, which tell one moment of the flight from another."""
        return int(self._flight.env.steps[0])


def nearest(wish: Push, known: Mapping[Push, Future]) -> Push:
    """Return a position of the stick, or the nearest that was flown ahead, if that is near; keys stay as they are."""
    if wish in known or wish in KEYS or not known:
        return wish
    away, best = min((hypot(push.main - wish.main, push.side - wish.side), push) for push in known)
    return best if away <= _NEAR else wish
