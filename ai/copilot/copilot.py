"""Co-pilot (shared autonomy): a person flies, and a network that values every action corrects bad ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.config import AgentConfig
from ai.copilot.futures import DECISION_STEPS, Future, Futures, Here, Known, Lookahead
from ai.copilot.guardian import ActionSource, Choice, Guardian, decisions_of
from ai.copilot.intent import DOUBT, Intent
from ai.environment import Bools, Doubles, Floats, Ints
from ai.lander.environment import NUM_ACTIONS, NUM_FEATURES, LanderEnv, Outcome
from ai.lander.moment import Moment
from ai.lander.pilots import COAST
from ai.lander.push import KEYS, Push
from ai.lander.route import Route
from ai.lander.rules import ACTION_SHARES

# Points of reward by which the guardian's action must be better than the pilot's, at an assist of one half.
GUARDIAN_MARGIN: Final = 3.0
_STEERS: Final = 3  # action = 3 * main + steer


class Mode(StrEnum):
    """Condition on which the co-pilot steps in."""

    TOLERANCE = "tolerance"  # where the pilot's action is not nearly as good as the best
    GUARDIAN = "guardian"  # only where the network would no longer land


@dataclass(frozen=True, eq=False)
class SharedDecision:
    """Joint decision of a pilot and a co-pilot, with all that explains it."""

    pilot: Ints  # (n,) what the pilot asked for
    likely: Doubles  # (n, pads) how likely it is that each pad is meant
    assist: float  # how much the co-pilot helped, 0 to 1
    action: Ints  # (n,) what is flown
    source: Ints  # (n,) of ActionSource
    shares: Doubles  # (n, 2) of thrust that are flown, of main engine and jets
    overridden: Bools  # (n,) whether anything else is flown than the pilot asked for
    # A guardian's that goes by futures; None of any other.
    asked: tuple[Push, ...] = ()  # (n) what the pilot pushes
    known: tuple[Known, ...] | None = None  # (n) what comes of each push that was looked at
    held: Bools | None = None  # (n,) whether a plan is held now, so that nobody can crash the flight


class CoPilot:
    """Shared control between a pilot and an agent (Reddy, Dragan and Levine 2018).

    `assist` runs from 0, where every action of the pilot's is flown, to 1, where only the best are good enough.

    In tolerance mode an action is feasible if its value above the worst is at least `assist` times that of the
    best. A pilot who asks for nothing has their hands off the stick: then the co-pilot flies, whatever the assist.

    In guardian mode the co-pilot goes by futures of the `LanderEnv` that is flown, if that is handed over: an action
    passes if a flight that begins with it and goes on as the network flies was seen to land, and nothing else is then
    flown than such plans (`Guardian`). The dial says how far ahead: the network must land after one decision of the
    action, and after `decisions_of(assist)` of it; at 0 nothing is ever changed. Asking for nothing is an action as any
    other here. Where not a single action lands, the pilot flies.

    Without an environment, a guardian goes by values (after McMahan et al. 2024): every action passes unless the
    co-pilot's own is worth more on the way to every pad by a margin, which falls from infinity at assist 0 to 0 at
    assist 1; hands off are as in tolerance mode.

    Of several pads, only those count that may still be meant, by what the pilot has done so far (`ai.copilot.intent`).
    Hands off, the co-pilot flies to the likeliest. So it remembers from one decision to the next, which should be some
    1/15 s; `forget` makes it ready for another flight.

    `agent` has `q_values`, (n, 6) for observations (n, 9), as a DeepQAgent does, and for futures is a pilot as well;
    `route` is how it is led around rock on a leg of a descent.

    Attributes:
        guardians: what it remembers of each flight, one for each slot: the plans.
        reward_scale: what a point of reward is in the agent's values; at first, what it was trained with.

    """

    def __init__(
        self, agent: Any, assist: float = 0.5, mode: Mode | str = Mode.TOLERANCE, *, route: Route | None = None
    ) -> None:
        self.agent, self.assist, self.mode = agent, assist, Mode(mode)
        self.reward_scale = (agent.config if isinstance(agent, DeepQAgent) else AgentConfig()).reward_scale
        self._intent = Intent(self.reward_scale)
        self.lookahead = Lookahead(agent, route)
        self.guardians: list[Guardian] = []
        self._rules: tuple[object, ...] = ()  # of the environment that the plans are for

    @property
    def assist(self) -> float:
        """Strength of the co-pilot's help, 0 to 1; setting anything else raises ValueError."""
        return self._assist

    @assist.setter
    def assist(self, assist: float) -> None:
        if not 0.0 <= assist <= 1.0:
            raise ValueError(f"assist runs from 0 to 1, not {assist}")
        self._assist = assist

    def forget(self, mask: Bools | None = None) -> None:
        """Begin a new flight in the slots of `mask` (n,), or in all, with no idea which pad is meant."""
        self._intent.forget(mask)
        for slot, guardian in enumerate(self.guardians):
            if mask is None or mask[slot]:
                guardian.plan = None

    def hold_plans_of(self, other: CoPilot) -> None:
        """Go on with the plans of another: one that lands does so whichever network it was found with."""
        self.guardians, self._rules = other.guardians, other._rules

    # Decisions

    def share(
        self,
        observation: Floats,
        pilot_action: Any,
        surroundings: Floats | None = None,
        shares: Doubles | None = None,
        env: LanderEnv | None = None,
    ) -> tuple[Ints, Bools]:
        """Return the actions to fly (n,), and where they are not the pilot's, (n,).

        `observation` is (n, 9), or (n, pads, 9) relative to each pad that may be meant; `pilot_action` is (n,)
        of 0 to 5. `surroundings` (n, k), or (n, pads, k), are those of `LanderEnv.around`, for a network that reads
        them. `shares` (n, 2) are the thrusts of main engine and jets that the pilot really pushes, full if left out.
        Where nothing is overridden, they are flown; what is overridden is flown with all thrust. With `env`, guardian
        mode goes by futures: ask every four physics steps, at the same time as `env` flies what was
        returned. Raises ValueError for others.
        """
        decision = self.decide(observation, pilot_action, surroundings, shares, env, whole=True)
        return decision.action, decision.overridden

    def decide(
        self,
        observation: Floats,
        pilot_action: Any,
        surroundings: Floats | None = None,
        shares: Doubles | None = None,
        env: LanderEnv | None = None,
        known: Sequence[Known] | None = None,
        *,
        whole: bool = False,
    ) -> SharedDecision:
        """Decide as `share` does, and return all that explains it; raises as `share` does.

        Here, what is corrected keeps the pilot's share of thrust, unless it is to be `whole`, so fly
        `SharedDecision.shares`. What is `known` (n) was flown beforehand: then no future is flown now, and what is
        missing counts as lost.
        """
        observation, pilot, pushed = _checked(observation, pilot_action, shares)
        slots, pads, _ = observation.shape
        seen = self._seen(observation, surroundings)
        values = self.agent.q_values(seen.reshape(slots * pads, -1)).reshape(slots, pads, NUM_ACTIONS)
        likely, meant = self._read(values, pilot, np.abs(observation[:, :, 0]))
        given = pilot, likely, self.assist
        if self.mode is Mode.GUARDIAN and env is not None:
            asked = tuple(Push.of(*push) for push in pushed.tolist())
            chosen, known = self._save(env, asked, values, known, whole=whole)
            source = np.array([choice.source for choice in chosen])
            overridden = source != ActionSource.PILOT
            action = np.where(overridden, [choice.push.action for choice in chosen], pilot)
            flown, held = np.array([choice.push.shares for choice in chosen]), np.array([each.held for each in chosen])
            return SharedDecision(*given, action, source, flown, overridden, asked, tuple(known), held)
        weigh = _guard if self.mode is Mode.GUARDIAN else _tolerate
        best, feasible = weigh(meant, pilot, np.where(pilot == COAST, 1.0, self.assist), self.reward_scale)
        candidates = _candidates(pilot, best)
        rows = np.arange(slots)
        source = feasible[rows, candidates].argmax(axis=0)
        action = candidates[source, rows]
        overridden = action != pilot
        source[(pilot == COAST) & overridden] = ActionSource.HANDS_OFF
        flown = np.where(overridden[:, None], ACTION_SHARES[action], pushed)
        return SharedDecision(*given, action, source, flown, overridden)

    def _seen(self, observation: Floats, surroundings: Floats | None) -> Floats:
        """Return what the network reads, (n, pads, features): the surroundings, too, if it has inputs for them."""
        features = getattr(self.agent, "num_features", NUM_FEATURES)
        if features <= observation.shape[2] or surroundings is None:
            return observation
        around = surroundings.reshape(*observation.shape[:2], -1)[:, :, : features - NUM_FEATURES]
        return np.concatenate([observation, around], axis=2)

    def _read(self, values: Floats, pilot: Ints, away: Floats) -> tuple[Doubles, Floats]:
        """Return how likely each pad is meant, (n, pads), and the values with the likeliest's where a pad is not."""
        slots, pads, _ = values.shape
        if pads == 1:
            return np.ones((slots, 1)), values
        likely = self._intent.watch(values, pilot)
        likeliest = (likely - 1e-6 * away).argmax(axis=1)[:, None]  # among equals, the nearest
        open_ = (likely >= DOUBT * likely.max(axis=1, keepdims=True)) & (pilot != COAST)[:, None]
        pad = np.where(open_, np.arange(pads), likeliest)
        return likely, values[np.arange(slots)[:, None], pad]

    # The guardian

    def futures(self, env: LanderEnv) -> Futures:
        """Return what comes of each action if the network then flies on, in every slot."""
        return Futures(self.foresee(env, [None] * env.num_envs))

    def foresee(self, env: LanderEnv, asked: Sequence[Push | None], *, whole: bool = False) -> list[Known]:
        """Fly ahead, in one batch, what may be flown where pilots push `asked` (n), or each action where that is None.

        Returns what comes of each push, for every slot. Of several plans, that to the pad counts which is the likeliest
        by what the pilot has done so far. `whole` is as in `decide`.
        """
        self._void(env)
        here = Here.all(env)

        def needs(slot: int) -> Sequence[Push]:
            push = asked[slot]
            return KEYS if push is None else self.guardians[slot].needs(here[slot], push, whole=whole)

        flying = np.flatnonzero(env.outcome == Outcome.FLYING).tolist()
        needed = [(slot, push) for slot in flying for push in needs(slot)]
        known: list[dict[Push, Future]] = [{} for _ in asked]
        if needed:
            moment = Moment.of(env)
            moment.target[:] = self._target(env)
            found = self.lookahead.futures(moment, needed, decisions_of(self.assist))
            for (slot, push), future in zip(needed, found, strict=True):
                known[slot][push] = future
        return list(known)

    def _target(self, env: LanderEnv) -> Ints:
        """Return the number of the pad that is the likeliest so far, (n,), the nearest among equals."""
        pads = env.ground.at_once
        if pads == 1:
            return env.target
        away = np.abs(env.ground.middles[:pads, 0] - env.position[:, :1])
        target: Ints = (self._intent.likely(env.num_envs, pads) - 1e-6 * away).argmax(axis=1)
        return target

    def _save(
        self, env: LanderEnv, asked: Sequence[Push], values: Floats, known: Sequence[Known] | None, *, whole: bool
    ) -> tuple[list[Choice], Sequence[Known]]:
        """Let each pilot fly what a landing plan begins with; else do the least that such a plan begins with.

        Returns what is chosen, (n), and what was `known` of each push, (n).
        """
        slots, pads, _ = values.shape
        if env.num_envs != slots or DECISION_STEPS % env.frame_skip:
            raise ValueError(
                f"{slots} observations are of as many landers, whose steps are 1, 2 or 4 physics steps long"
            )
        pad = self._target(env) if pads == len(env.ground.pads) else np.zeros(slots, dtype=np.intp)
        best = values[np.arange(slots), pad].argmax(axis=1)
        self._void(env)
        choices = [Choice(push) for push in asked]
        if self.assist == 0:
            known = known or [{}] * slots
        else:
            known = known or self.foresee(env, asked, whole=whole)
            here = Here.all(env)
            for slot in np.flatnonzero(env.outcome == Outcome.FLYING).tolist():
                network, guardian = KEYS[best[slot]], self.guardians[slot]
                choices[slot] = guardian.choose(here[slot], asked[slot], network, known[slot], whole=whole)
        return choices, known

    def _void(self, env: LanderEnv) -> None:
        """Drop all plans where the rules, the ground or the number of landers are others than before."""
        rules = env.params, env.limits, env.conditions, env.world.gravity, env.ground, env.num_envs
        if self._rules and any(a is not b for a, b in zip(rules, self._rules, strict=True)):
            self.forget()
        self._rules = rules
        self.guardians += [Guardian() for _ in range(env.num_envs - len(self.guardians))]


def _checked(observation: Floats, pilot: Any, shares: Doubles | None) -> tuple[Floats, Ints, Doubles]:
    """Return observations (n, pads, 9), actions (n,) and shares of thrust (n, 2); raises ValueError for others."""
    observation, pilot = np.atleast_2d(observation), np.atleast_1d(pilot)
    if observation.ndim == 2:
        observation = observation[:, None]
    slots = len(observation)
    if pilot.shape != (slots,) or pilot.dtype.kind not in "iu":
        raise ValueError(f"pilot actions must be {slots} whole numbers, not {pilot.dtype} {pilot.shape}")
    if ((pilot < 0) | (pilot >= NUM_ACTIONS)).any():
        raise ValueError(f"actions run from 0 to {NUM_ACTIONS - 1}, not {pilot.min()} to {pilot.max()}")
    pushed = ACTION_SHARES[pilot] if shares is None else np.asarray(shares, dtype=float)
    if pushed.shape != (slots, 2):
        raise ValueError(f"shares of thrust must be {slots} rows of two, not {pushed.shape}")
    return observation, pilot, pushed


# By values: each rule returns the co-pilot's action (n,), and which are feasible (n, 6), at `assist` (n,)


def _candidates(pilot: Ints, best: Ints) -> Ints:
    """Return what may be flown, (4, n), the least change first, in the order of `ActionSource`."""
    return np.stack([pilot, pilot - pilot % _STEERS + best % _STEERS, best - best % _STEERS + pilot % _STEERS, best])


def _tolerate(values: Floats, pilot: Ints, assist: Floats, _: float) -> tuple[Ints, Bools]:
    """Allow what is as good as `assist` asks for."""
    above = values - values.min(axis=2, keepdims=True)
    most = above.max(axis=2, keepdims=True)
    asked = assist.astype(above.dtype)[:, None, None] * most
    # The pilot's action need only be good for one of several pads; the co-pilot's must be good for all.
    feasible = (above >= asked).all(axis=1)
    rows = np.arange(len(pilot))
    feasible[rows, pilot] = (above[rows, :, pilot] >= asked[:, :, 0]).any(axis=1)
    best = (above / np.maximum(most, np.finfo(above.dtype).tiny)).min(axis=1).argmax(axis=1)
    return best, _certain(values, pilot, best, feasible)


def _guard(values: Floats, pilot: Ints, assist: Floats, reward_scale: float) -> tuple[Ints, Bools]:
    """Allow the co-pilot's own, and the pilot's if that is not worse by the margin."""
    rows = np.arange(len(pilot))
    gain = (values - values[rows, :, pilot][:, :, None]).min(axis=1)
    best = gain.argmax(axis=1)
    feasible = np.zeros(gain.shape, dtype=bool)
    with np.errstate(divide="ignore"):
        margin = GUARDIAN_MARGIN * (1.0 - assist) / assist
    feasible[rows, pilot] = gain[rows, best] <= margin * reward_scale
    return best, _certain(values, pilot, best, feasible)


def _certain(values: Floats, pilot: Ints, best: Ints, feasible: Bools) -> Bools:
    """Allow the pilot's action where none is better, too: values are not finite, or pads need different actions."""
    rows = np.arange(len(pilot))
    worse = ~(values[rows, :, best] >= values[rows, :, pilot]).all(axis=1)
    feasible[rows[worse], pilot[worse]] = True
    feasible[rows, best] = True
    return feasible
