"""Flight: one lander in its environment, its pilots, and poses for drawing between steps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ai.agent.decision import Decision
from ai.environment import Doubles, Floats
from ai.flights.recording import AREA, AS_IT_IS, Easing, Recording, Shares, StickHolder, thrust
from ai.flights.verification import begun
from ai.lander.descent import LegStart, leg_of
from ai.lander.environment import Outcome
from ai.lander.pilots import COAST, ScriptedPilot
from ai.lander.route import Route
from game.flight.networks import DECISION_STEPS, Policy, QPolicy, decide, decision_steps
from game.flight.poses import Poses

if TYPE_CHECKING:
    from ai.copilot.copilot import CoPilot, SharedDecision
    from game.flight.guard import Guard

__all__ = ["DECISION_STEPS", "Flight", "Recording", "StickHolder", "start_of"]

_START: Final = ("spawn", "pads", "mission", "easing", "area", "leg")  # what makes a flight's start, with its seed
_STEERING: Final = ScriptedPilot()  # fires the jets for a person who flies with one switch


def start_of(recording: Recording) -> dict[str, Any]:
    """Return what a `Flight` from the same start as a recorded one is made with, besides the seed."""
    return {name: getattr(recording, name) for name in _START}


class Flight:
    """Flight of one lander, by a person, by a network, by both in turns, or by both together.

    Args:
        seed: random seed of the start and the ground.
        network: the network that can take or share the stick.
        spawn: kind of start.
        pads: 1 on a plain, or 3 among hills.
        mission: name of one of `ai.lander.missions.STARTS`, which sets the start and the conditions; empty for none.
        shares: whether the network may share the stick, and not only take it.
        easing: changes of the rules that give the pilot more room.
        area: version of the area's edges, an index of `ai.lander.rules.AREAS`.
        leg: where a flight of a descent begins, which sets the start and the conditions; None for any other.

    Attributes:
        guard: what guards the flight by futures, where there is one; without it, a guardian goes by values.
        steered: whether the jets are fired for the person, who has the main engine alone: one switch is enough.
        copilot: shares the stick while its assist is above 0; None if the network has no Q-values.
        decision: the co-pilot's latest decision; None while it does not share the stick.
        alone: latest decision of the network while it flies alone; None otherwise.
        asked: the action that the person asked for in the last step.
        overridden: whether another action was flown than the one the person asked for.
        route: how a network is led around rock on a leg of a descent; None in any other flight.

    """

    def __init__(
        self,
        seed: int,
        network: Policy | None = None,
        spawn: str = "random",
        *,
        pads: int = 1,
        mission: str = "",
        shares: bool = True,
        easing: Easing = AS_IT_IS,
        area: int = AREA,
        leg: LegStart | None = None,
    ) -> None:
        self.recording = Recording(seed, spawn, pads, mission=mission, area=area, easing=easing, leg=leg)
        self.env = begun(self.recording)
        self.route = Route(leg_of(seed, leg).route) if leg else None
        self.observation: Floats = self.env.observe()
        self.hand, self.shares = StickHolder.HUMAN, shares
        self.steered = False
        self.poses = Poses(self.env)
        self.asked, self.overridden = COAST, False
        self.decision: SharedDecision | None = None
        self.alone: Decision | None = None
        self._held_for = self._yours = 0
        self.guard: Guard | None = None
        self.copilot: CoPilot | None = None
        self.change_network(network)
        self.aim()

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
        """Who chose the action of the last step."""
        return self.recording.hands[-1] if self.recording.hands else self.hand

    @property
    def share(self) -> float:
        """Person's share of the steps flown, 0 to 1."""
        return self._yours / len(self.recording.hands) if self.recording.hands else 1.0

    @property
    def shared(self) -> bool:
        """Whether the person shares the stick with the co-pilot."""
        return self.hand is StickHolder.HUMAN and self.copilot is not None and self.copilot.assist > 0

    @property
    def guarded(self) -> bool:
        """Whether the latest decision was a guardian's by futures: coasting is then an action like others."""
        return self.decision is not None and self.decision.held is not None

    @property
    def safe(self) -> bool:
        """Whether a guardian holds a plan that lands, so that nobody can crash the flight."""
        return self.guard is not None and self.guard.safe

    def put(self, moment: dict[str, Any], source: Recording, step: int) -> None:
        """Restore a snapshot `moment` of the environment after `step` steps of a flight from the same start."""
        self.env.restore(moment)
        self.observation = self.env.observe()
        self.recording.actions[:] = source.actions[:step]
        self.recording.hands[:] = source.hands[:step]
        self._yours = self.recording.hands.count(StickHolder.HUMAN)
        self.recording.shares = {at: shares for at, shares in source.shares.items() if at < step}
        self.rest()

    def rest(self) -> None:
        """Stop interpolation, so that the lander is drawn at its present pose."""
        self.poses.take()
        self.poses.take()

    def change_network(self, network: Policy | None) -> None:
        """Set the network that can take or share the stick from now on; with None, the person has the stick."""
        self.network, self._network_steps = network, decision_steps(network)
        self._held_for, self.decision, self.alone = 0, None, None
        if network is None:
            self.hand = StickHolder.HUMAN
        before, self.copilot = self.copilot, None
        if self.shares and isinstance(network, QPolicy):
            from ai.copilot.copilot import CoPilot

            self.copilot = CoPilot(network, before.assist if before else 0.0, "guardian", route=self.route)
            if before:
                self.copilot.hold_plans_of(before)

    def help(self, assist: float) -> None:
        """Set the co-pilot's assist, 0 to 1, from the next decision on."""
        if self.copilot:
            self.copilot.assist = assist

    def hand_over(self) -> bool:
        """Hand the stick over between person and network. False without a network, or after the flight."""
        if self.over or (self.network is None and self.hand is StickHolder.HUMAN):
            return False
        self.hand = StickHolder.NETWORK if self.hand is StickHolder.HUMAN else StickHolder.HUMAN
        self._held_for, self.decision, self.alone = 0, None, None  # the new pilot decides at once
        return True

    def step(self, held: int, shares: Shares | None = None) -> None:
        """Advance by 1/60 s; `held` is the action that the stick asks for, with `shares` of thrust or all of it."""
        self.overridden = False
        if self.over:
            self.poses.take()
            return
        action, by, shares = self._choose(held, shares)
        self.env.fly(np.array([action]), thrust(shares))
        self.observation = self.env.observe()
        if shares is not None:
            self.recording.shares[len(self.recording.actions)] = shares
        self.recording.actions.append(action)
        self.recording.hands.append(by)
        self._yours += by is StickHolder.HUMAN
        self.poses.take()
        if self.outcome is Outcome.LANDED:
            self.env.target = self.env.landed_on

    def _choose(self, held: int, shares: Shares | None) -> tuple[int, StickHolder, Shares | None]:
        """Return the action of the next step, who chose it, and its shares of thrust, or None for all of it."""
        by = self.hand
        if by is StickHolder.HUMAN:
            if self.steered:
                held, shares = held - held % 3 + int(_STEERING.act(self.observation)[0]) % 3, None
            self.asked = held
        if self.guard and self.guard.acts:
            return self.guard.choose(by, shares)
        if by is StickHolder.NETWORK:
            self.asked = COAST
            return self.ask_network(), by, None
        if not self.shared:
            self.decision = None
            if self._held_for == 0:
                self.aim()
            self._held_for = (self._held_for + 1) % DECISION_STEPS
            return self.asked, by, shares
        action = self._ask_copilot()
        self.overridden = action != self.asked != COAST  # with nothing pressed the co-pilot flies
        if self.overridden or self.asked == COAST:
            return action, StickHolder.NETWORK, None
        return action, by, shares

    def seen(self) -> tuple[Floats, Floats | None]:
        """Return what a co-pilot reads of each pad, and what is around on the way there; on a leg, along its route."""
        if self.route and self.network:
            return self.route.observe(self.env, self.network), None
        return self.env.observe_pads(self.network), self.env.around_pads()

    def ask_network(self) -> int:
        """Return the network's own action, decided every few steps, as `alone` shows it."""
        if self.alone is None or self._held_for == 0:
            assert self.network is not None
            env, network = self.env, self.network
            seen = self.route.observe(env, network) if self.route else env.observe_for(network)
            self.alone = decide(network, seen, env.actions)
        self._held_for = (self._held_for + 1) % self._network_steps
        return int(self.alone.action[0])

    def _ask_copilot(self) -> int:
        """Return the co-pilot's action, decided every few steps, and at once on a changed request: no tap is lost."""
        assert self.copilot is not None
        decision = self.decision
        if decision is None or self._held_for == 0 or self.asked != decision.pilot[0]:
            seen, around = self.seen()
            self.decision = decision = self.copilot.decide(seen, np.array([self.asked]), around)
            self._held_for = 0
            self.aim(decision.likely[0])
        self._held_for = (self._held_for + 1) % self._network_steps
        return int(decision.action[0])

    def aim(self, likely: Doubles | float = 0.0) -> None:
        """Aim read-outs and network at the most `likely` (pads,) intended pad; among equals, at the nearest."""
        if self.route:  # to the goal, whatever is nearer
            self.env.target[:] = 0
            return
        away = np.abs(self.env.ground.middles[:, 0] - self.env.position[0, 0])
        self.env.target[:] = int((likely - 1e-6 * away).argmax())
