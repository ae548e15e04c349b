"""Co-pilot (shared autonomy): a person flies, and a network that values every action corrects bad ones."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum, StrEnum
from functools import cached_property
from typing import Any, Final, Literal, Protocol

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.config import Config
from ai.common.decision import in_points
from ai.common.environment import Bools, Doubles, Floats, Ints
from ai.copilot.clock import FlightClock
from ai.copilot.critic import SafetyCritic, critic_beside
from ai.copilot.guardian import Guardian
from ai.copilot.intent import Intent, in_question
from ai.lander.environment import NUM_ACTIONS, NUM_FEATURES
from ai.lander.pilots import COAST

# Points of reward by which the guardian's action must be better than the pilot's, at an assist of one half.
GUARDIAN_MARGIN: Final = 3.0
OUT_OF_REACH: Final = 0.6  # chance to be saved on a pad below which it counts as lost
_STEERS: Final = 3  # action = 3 * main + steer


class QFunction(Protocol):
    """Protocol of a source of Q-values, such as a DeepQAgent."""

    def q_values(self, observation: Floats) -> Floats:
        """Return the Q-value of every action, (n, 6), for observations (n, 9)."""


class Mode(StrEnum):
    """Condition on which the co-pilot steps in."""

    TOLERANCE = "tolerance"  # where the pilot's action is not nearly as good as the best
    GUARDIAN = "guardian"  # only where the network might soon no longer save the flight


class ActionSource(IntEnum):
    """Source of the action that is flown, in the order in which the sources are tried."""

    PILOT = 0  # the pilot's, untouched
    PILOT_MAIN = 1  # the pilot's main engine with the co-pilot's steering
    PILOT_STEER = 2  # the co-pilot's main engine with the pilot's steering
    COPILOT = 3  # the co-pilot's
    HANDS_OFF = 4  # the co-pilot's, because nothing is pressed


@dataclass(frozen=True, eq=False)
class SharedDecision:
    """Joint decision of a pilot and a co-pilot, with all that explains it."""

    observation: Floats  # (n, pads, 9) that it was made on
    action: Ints  # (n,) what is flown
    pilot: Ints  # (n,) what the pilot asked for
    best: Ints  # (n,) what the co-pilot would do
    source: Ints  # (n,) of ActionSource
    values: Floats  # (n, pads, 6) what each action is worth on the way to each pad
    meant: Floats  # (n, pads, 6) the same, with the likeliest pad's in place of those that can't be meant
    feasible: Bools  # (n, 6) which actions the pilot could have had
    likely: Doubles  # (n, pads) how likely it is that each pad is meant
    assist: float  # how much the co-pilot helped, 0 to 1
    mode: Mode  # and when it stepped in
    reward_scale: float  # size of one point of reward in the unit of `values`
    chances: Floats | None = None  # (n, 6) to be saved after each action, for the best pad that may be meant
    required: Doubles | None = None  # (n,) chance that the dial asks for by now; None without a critic

    @property
    def chance(self) -> Floats | None:
        """Chance to be saved after the pilot's own action, (n,); None without a critic."""
        return None if self.chances is None else self.chances[np.arange(len(self.pilot)), self.pilot]

    @cached_property
    def points(self) -> Floats:
        """Values (n, pads, 6) in points of reward."""
        return in_points(self.values, self.reward_scale)

    @property
    def gain(self) -> Floats:
        """Advantage of the co-pilot's action over the pilot's in points of reward, the least over all pads, (n,)."""
        rows = np.arange(len(self.action))
        more: Floats = (self.meant[rows, :, self.best] - self.meant[rows, :, self.pilot]).min(axis=1)
        return in_points(more, self.reward_scale)

    @property
    def overridden(self) -> Bools:
        """Whether another action is flown than the pilot asked for, (n,)."""
        overridden: Bools = self.action != self.pilot
        return overridden


def _candidates(pilot: Ints, best: Ints) -> Ints:
    """Return what may be flown, (4, n), the least change first, in the order of `ActionSource`."""
    return np.stack([pilot, pilot - pilot % _STEERS + best % _STEERS, best - best % _STEERS + pilot % _STEERS, best])


def guardian_margin(assist: Any) -> Any:
    """Return by how many points of reward the guardian must be better than the pilot, for assist (n,), 0 to 1."""
    with np.errstate(divide="ignore"):
        return GUARDIAN_MARGIN * (1.0 - np.asarray(assist)) / assist


class CoPilot:
    """Shared control between a pilot and an agent (Reddy, Dragan and Levine 2018).

    `assist` runs from 0, where every action of the pilot's is flown, to 1, where only the best are good enough.

    In tolerance mode an action is feasible if its value above the worst is at least `assist` times that of the
    best. A pilot who asks for nothing has their hands off the stick: then the co-pilot flies, whatever the assist.

    In guardian mode with a safety `critic`, an action is feasible if the chance that the agent can still save the
    flight after it is at least what `Guardian` asks for, which begins at `required_chance(assist)`. Asking for nothing
    is an action as any other here. When the stick goes back to the pilot, `Guardian` says as well.

    A guardian without a critic (after McMahan et al. 2024) lets every action pass unless the co-pilot's own is worth
    more on the way to every pad by a margin, which falls from infinity at assist 0 to 0 at assist 1; hands off are as
    in tolerance mode. The critic is the one beside the agent's files unless another is given; `critic_problem` says
    why there is none.

    Of several pads, only those count that may still be meant, by what the pilot has done so far
    (`ai.copilot.intent`); with `infers_intent` off, all do. Hands off, the co-pilot flies to the likeliest. So it
    remembers from one decision to the next, which should be some 1/15 s; `forget` makes it ready for another flight.

    `reward_scale` is what a point of reward is in the agent's values; by default, what it was trained with.
    """

    def __init__(
        self,
        agent: QFunction,
        assist: float = 0.5,
        mode: Mode | str = Mode.TOLERANCE,
        *,
        reward_scale: float | None = None,
        infers_intent: bool = True,
        critic: SafetyCritic | Literal["beside"] | None = "beside",
    ) -> None:
        self.agent = agent
        self.assist = assist
        self.mode = Mode(mode)
        config = agent.config if isinstance(agent, DeepQAgent) else Config()
        self.reward_scale = config.reward_scale if reward_scale is None else reward_scale
        self.infers_intent = infers_intent
        self._intent = Intent(self.reward_scale)
        self.critic, self.critic_problem = critic_beside(agent) if critic == "beside" else (critic, "")
        self.guardian, self._clock = Guardian(), FlightClock()

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
        self.guardian.forget(mask)
        self._clock.forget(mask)

    def share(self, observation: Floats, pilot_action: Any, surroundings: Floats | None = None) -> tuple[Ints, Bools]:
        """Return the actions to fly (n,), and where they are not the pilot's, (n,).

        `observation` is (n, 9), or (n, pads, 9) relative to each pad that may be meant; `pilot_action` is (n,)
        of 0 to 5. `surroundings` (n, k), or (n, pads, k), are those of `LanderEnv.around`, if they are known.
        Raises ValueError for others.
        """
        decision = self.decide(observation, pilot_action, surroundings)
        return decision.action, decision.overridden

    def decide(self, observation: Floats, pilot_action: Any, surroundings: Floats | None = None) -> SharedDecision:
        """Decide as `share` does, and return all that explains it; raises as `share` does."""
        observation = np.atleast_2d(observation)
        if observation.ndim == 2:
            observation = observation[:, None]
        slots, pads, features = observation.shape
        pilot = np.atleast_1d(pilot_action)
        if pilot.shape != (slots,) or pilot.dtype.kind not in "iu":
            raise ValueError(f"pilot actions must be {slots} whole numbers, not {pilot.dtype} {pilot.shape}")
        if ((pilot < 0) | (pilot >= NUM_ACTIONS)).any():
            raise ValueError(f"actions run from 0 to {NUM_ACTIONS - 1}, not {pilot.min()} to {pilot.max()}")
        values = self.agent.q_values(observation.reshape(-1, features)).reshape(slots, pads, NUM_ACTIONS)
        likely, meant = self._read(values, pilot, np.abs(observation[:, :, 0]))
        if self.mode is Mode.GUARDIAN and self.critic is not None:
            return self._save(observation, surroundings, values, meant, likely, pilot)
        assist = np.where(pilot == COAST, 1.0, self.assist)
        weigh = self._guard if self.mode is Mode.GUARDIAN else self._tolerate
        best, feasible = weigh(meant, pilot, assist)
        candidates = _candidates(pilot, best)
        rows = np.arange(slots)
        source = feasible[rows, candidates].argmax(axis=0)
        action = candidates[source, rows]
        source[(pilot == COAST) & (action != pilot)] = ActionSource.HANDS_OFF
        return SharedDecision(observation, action, pilot, best, source, values, meant, feasible, likely,
                              self.assist, self.mode, self.reward_scale)  # fmt: skip

    def _read(self, values: Floats, pilot: Ints, away: Floats) -> tuple[Doubles, Floats]:
        """Return how likely each pad is meant, (n, pads), and the values with the likeliest's where a pad is not."""
        slots, pads, _ = values.shape
        if pads == 1 or not self.infers_intent:
            return np.full((slots, pads), 1.0 / pads), values
        likely = self._intent.watch(values, pilot)
        likeliest = (likely - 1e-6 * away).argmax(axis=1)[:, None]  # among equals, the nearest
        open_ = in_question(likely) & (pilot != COAST)[:, None]
        pad = np.where(open_, np.arange(pads), likeliest)
        return likely, values[np.arange(slots)[:, None], pad]

    def _save(
        self,
        observation: Floats,
        surroundings: Floats | None,
        values: Floats,
        meant: Floats,
        likely: Doubles,
        pilot: Ints,
    ) -> SharedDecision:
        """Let the pilot fly while the chance to be saved is what the dial asks for; else do the least that restores it.

        Of several pads that may be meant, one on which the flight can be saved is enough; where there is none left,
        any pad is.
        """
        assert self.critic is not None
        slots, pads, features = observation.shape
        rows = np.arange(slots)
        nine = observation[:, :, :NUM_FEATURES]
        if surroundings is None and features > NUM_FEATURES:
            surroundings = observation[:, :, NUM_FEATURES:]
        elif surroundings is None:
            surroundings, new = self._clock.read(nine)
            self.guardian.forget(new)
        chances = self.critic.chances(nine.reshape(-1, NUM_FEATURES), surroundings.reshape(slots * pads, -1))
        chances = chances.reshape(slots, pads, NUM_ACTIONS)
        required = self.guardian.required(self.assist, slots)
        within, open_ = chances.max(axis=2), in_question(likely)
        # Where the pads that may be meant can hardly be reached any more, any other will do.
        open_ |= (np.where(open_, within, 0.0).max(axis=1) < OUT_OF_REACH)[:, None]
        chances = np.where(open_[:, :, None], chances, -1.0)
        # The likeliest of the pads that can still be reached, else the one that is nearest to it.
        within = chances.max(axis=2)
        pad = np.where(within >= required[:, None], 1.0 + likely, within).argmax(axis=1)
        best = values[rows, pad].argmax(axis=1)
        chance = chances.max(axis=1)
        candidates = _candidates(pilot, best)
        source, asked = self.guardian.choose(chance, candidates, required, among_hills=pads > 1)
        action = candidates[source, rows]
        feasible = chance >= asked[:, None]
        feasible[rows, action] = True
        return SharedDecision(observation, action, pilot, best, source, values, meant, feasible, likely,
                              self.assist, self.mode, self.reward_scale, chance, asked)  # fmt: skip

    def _tolerate(self, values: Floats, pilot: Ints, assist: Floats) -> tuple[Ints, Bools]:
        """Return the co-pilot's action (n,) and the feasible ones (n, 6): those as good as `assist` (n,) asks for."""
        above = values - values.min(axis=2, keepdims=True)
        most = above.max(axis=2, keepdims=True)
        asked = assist.astype(above.dtype)[:, None, None] * most
        # The pilot's action need only be good for one of several pads; the co-pilot's must be good for all.
        feasible = (above >= asked).all(axis=1)
        rows = np.arange(len(pilot))
        feasible[rows, pilot] = (above[rows, :, pilot] >= asked[:, :, 0]).any(axis=1)
        best = (above / np.maximum(most, np.finfo(above.dtype).tiny)).min(axis=1).argmax(axis=1)
        return self._certain(values, pilot, best, feasible)

    def _guard(self, values: Floats, pilot: Ints, assist: Floats) -> tuple[Ints, Bools]:
        """Return the co-pilot's action (n,) and the feasible (n, 6): its own, and the pilot's if not much worse."""
        rows = np.arange(len(pilot))
        gain = (values - values[rows, :, pilot][:, :, None]).min(axis=1)
        best = gain.argmax(axis=1)
        margin = guardian_margin(assist) * self.reward_scale
        feasible = np.zeros(gain.shape, dtype=bool)
        feasible[rows, best] = True
        feasible[rows, pilot] = gain[rows, best] <= margin
        return self._certain(values, pilot, best, feasible)

    @staticmethod
    def _certain(values: Floats, pilot: Ints, best: Ints, feasible: Bools) -> tuple[Ints, Bools]:
        """Keep the pilot's action where none is better: values are not finite, or pads need different actions."""
        rows = np.arange(len(pilot))
        worse = ~(values[rows, :, best] >= values[rows, :, pilot]).all(axis=1)
        feasible[rows[worse], pilot[worse]] = True
        feasible[rows, best] = True
        return best, feasible
