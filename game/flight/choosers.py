"""Choosers of a flight's pushes: the stick, a network, both together, and a recording."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol

import numpy as np

from ai.agent.decision import Decision
from ai.environment import Doubles, Floats
from ai.flights.recording import Recording, StickHolder
from ai.lander.pilots import COAST, ScriptedPilot
from ai.lander.push import KEYS, Push
from ai.lander.route import Route
from game.flight.networks import DECISION_STEPS, Policy, QPolicy, decide, decision_steps

if TYPE_CHECKING:
    from ai.copilot.copilot import CoPilot, SharedDecision
    from game.flight.flight import Flight
    from game.flight.guard import Guard

_NOTHING: Final = KEYS[COAST]
_STEERING: Final = ScriptedPilot()


class Choice(NamedTuple):
    """What is pushed in one step."""

    push: Push
    by: StickHolder  # who chose it: the person, if it is what they asked for
    decision: Decision | SharedDecision | None = None  # the network's own, or the one it shares with the person
    asked: Push = _NOTHING  # what the person asked for
    overridden: bool = False  # whether something else is flown than that
    likely: Doubles | float | None = None  # how likely each pad is meant, (pads,), to aim anew; None to aim as before

    @property
    def together(self) -> SharedDecision | None:
        """The decision that person and network share; None without one."""
        return None if isinstance(self.decision, Decision) else self.decision

    @property
    def guarded(self) -> bool:
        """Whether it was a guardian's by futures: coasting is then an action like others."""
        return self.together is not None and self.together.held is not None


class Chooser(Protocol):
    """Protocol of what chooses the pushes of a flight; it writes nothing into the flight that it is asked for."""

    @property
    def hand(self) -> StickHolder:
        """Who holds the stick."""

    def choose(self, flight: Flight[Any]) -> Choice:
        """Return the push of a flight's next step."""


class Recorded:
    """Repeats what was recorded, and coasts beyond that."""

    def __init__(self, source: Recording) -> None:
        self._source = source

    @property
    def hand(self) -> StickHolder:
        """Who flew the first step."""
        return next(iter(self._source.hands), StickHolder.HUMAN)

    def choose(self, flight: Flight[Any]) -> Choice:
        """Return what was pushed then, and who chose it."""
        at, source = flight.at, self._source
        if at >= len(source.pushes):
            return Choice(_NOTHING, flight.flown_by)
        by = source.hands[at]
        aims = by is StickHolder.HUMAN and at % DECISION_STEPS == 0  # as the read-outs then did
        return Choice(source.pushes[at], by, likely=0.0 if aims else None)


class Alone:
    """A network flies, which decides every few steps."""

    hand = StickHolder.NETWORK

    def __init__(self, network: Policy) -> None:
        self.network, self._steps = network, decision_steps(network)
        self._decision: Decision | None = None
        self._age = 0  # steps since it decided

    def decide(self, flight: Flight[Any]) -> Decision:
        """Return what it would do now."""
        env = flight.env
        seen = flight.route.observe(env, self.network) if flight.route else env.observe_for(self.network)
        return decide(self.network, seen, env.actions)

    def choose(self, flight: Flight[Any]) -> Choice:
        """Return what it decided last."""
        if self._decision is None or self._age == self._steps:
            self._decision, self._age = self.decide(flight), 0
        self._age += 1
        return Choice(KEYS[int(self._decision.action[0])], self.hand, self._decision)


class Shared:
    """The person asks, and a co-pilot that goes by values changes what is much worse than its own."""

    hand = StickHolder.HUMAN

    def __init__(self, copilot: CoPilot, steps: int) -> None:
        self._copilot, self._steps = copilot, steps
        self._decision: SharedDecision | None = None
        self._age = 0  # steps since it decided

    def choose(self, flight: Flight[Any]) -> Choice:
        """Return what was decided last; anew every few steps, and at once on a changed request: no tap is lost."""
        asked, likely = flight.asked, None
        decision = self._decision
        if decision is None or self._age == self._steps or asked.action != decision.pilot[0]:
            seen, around = seen_by(self._copilot.agent, flight)
            decision = self._copilot.decide(seen, np.array([asked.action]), around)
            self._decision, self._age, likely = decision, 0, decision.likely[0]
        self._age += 1
        flown = int(decision.action[0])
        if flown == asked.action != COAST:
            return Choice(asked, StickHolder.HUMAN, decision, asked, likely=likely)
        # With nothing pressed, the co-pilot flies.
        return Choice(KEYS[flown], StickHolder.NETWORK, decision, asked, flown != asked.action != COAST, likely)


class Crew:
    """A person at the stick, who can hand it over to a network, and share it with one.

    Attributes:
        network: the network that can take or share the stick; None for a person alone.
        shares: whether it may share it, and not only take it.
        hand: who holds the stick.
        copilot: shares the stick while its assist is above 0; None if the network has no Q-values.
        guard: what guards the flight by futures, where there is one; without it, a guardian goes by values.

    """

    def __init__(self, network: Policy | None, *, shares: bool = True, route: Route | None = None) -> None:
        self.hand, self.shares, self._route = StickHolder.HUMAN, shares, route
        self.guard: Guard | None = None
        self.copilot: CoPilot | None = None
        self.change_network(network)

    @property
    def shared(self) -> bool:
        """Whether the person shares the stick with the co-pilot."""
        return self.hand is StickHolder.HUMAN and self.copilot is not None and self.copilot.assist > 0

    @property
    def safe(self) -> bool:
        """Whether a guardian holds a plan that lands, so that nobody can crash the flight."""
        return self.guard is not None and self.guard.safe

    def change_network(self, network: Policy | None) -> None:
        """Set the network that can take or share the stick from now on; with None, the person has the stick."""
        self.network = network
        if network is None:
            self.hand = StickHolder.HUMAN
        before, self.copilot = self.copilot, None
        if self.shares and isinstance(network, QPolicy):
            from ai.copilot.copilot import CoPilot

            self.copilot = CoPilot(network, before.assist if before else 0.0, "guardian", route=self._route)
            if before:
                self.copilot.hold_plans_of(before)
        self._anew()

    def help(self, assist: float) -> None:
        """Set the co-pilot's assist, 0 to 1, from the next decision on."""
        if self.copilot:
            self.copilot.assist = assist

    def hand_over(self) -> bool:
        """Hand the stick over between person and network; return False without a network."""
        if self.network is None and self.hand is StickHolder.HUMAN:
            return False
        self.hand = StickHolder.NETWORK if self.hand is StickHolder.HUMAN else StickHolder.HUMAN
        self._anew()
        return True

    def _anew(self) -> None:
        """Let whoever has the stick now decide at once."""
        self.alone = Alone(self.network) if self.network else None
        self._together = Shared(self.copilot, decision_steps(self.network)) if self.copilot else None

    def choose(self, flight: Flight[Any]) -> Choice:
        """Return what the guard, the network, both together or the person has chosen."""
        if self.guard and self.guard.acts(flight):
            return self.guard.choose(flight)
        if self.hand is StickHolder.NETWORK and self.alone:
            return self.alone.choose(flight)
        if self.shared and self._together:
            return self._together.choose(flight)
        aims = flight.at % DECISION_STEPS == 0
        return Choice(flight.asked, self.hand, asked=flight.asked, likely=0.0 if aims else None)


def seen_by(network: Any, flight: Flight[Any]) -> tuple[Floats, Floats | None]:
    """Return what a co-pilot reads of each pad, and what is around on the way there; on a leg, along its route."""
    if flight.route:
        return flight.route.observe(flight.env, network), None
    env = flight.env
    return env.observe_pads(network), np.stack([env.around(pad) for pad in range(len(env.ground.pads))], axis=1)


def steered(push: Push, observation: Floats) -> Push:
    """Return a push whose jets a scripted pilot fires, for who has the main engine alone: one switch will do."""
    return KEYS[3 * (push.main > 0) + int(_STEERING.act(observation)[0]) % 3]
