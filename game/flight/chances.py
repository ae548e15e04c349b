"""Chance to be saved: how likely a network still lands if it takes the stick after an action; and where it fell.

A safety critic beside the network says so (`ai.copilot.critic`). A person who flies alone can be told by it, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Final, Protocol

import numpy as np

from ai.common.environment import Floats
from ai.lander.conditions import CALM
from ai.lander.environment import NUM_ACTIONS, NUM_FEATURES, PARAMS, LanderEnv, Outcome
from game.core import texts
from game.flight.flight import DECISION_STEPS, Flight, StickHolder
from game.flight.networks import Policy, QPolicy
from game.flight.replay import FlightReplay

FALL: Final = 0.4  # chance that must be lost from a height before it is a fall
_LEVEL: Final = 0.02  # a chance that much below the highest is as high
_REBOUND: Final = 0.15  # rise from the lowest chance that ends a fall
_MOSTLY: Final = 0.5  # share of a fall from which on one press of keys has taken it
_ROWS: Final = 24  # moments judged at once: some tenths of a millisecond
_CALM: Final = 60  # steps without a dangerous action after which another one is another rescue


class Critic(Protocol):
    """Protocol of a safety critic, such as `ai.copilot.critic.SafetyCritic`."""

    @property
    def anywhere(self) -> bool:
        """Whether it has learnt from flights in other gravity, in wind, on small tanks, with a failing engine."""

    def chances(self, observation: Floats, surroundings: Floats) -> Floats:
        """Return the chance (n, 6), 0 to 1, to be saved after each action.

        `observation` is (n, 9), `surroundings` (n, k) are those of `LanderEnv.around`.
        """


def critic_of(policy: Policy | None) -> tuple[Critic | None, str]:
    """Return the safety critic beside a network, and, if there is none, the reason."""
    if not isinstance(policy, QPolicy):
        return None, texts.CHANCE_NO_NETWORK
    from ai.copilot.critic import critic_beside

    return critic_beside(policy)


def known_for(env: LanderEnv, critic: Critic | None) -> bool:
    """Whether a critic has learnt from such flights; most know the moon alone: calm, a pad at rest, a full tank."""
    if critic is not None and critic.anywhere:
        return True
    return env.conditions == CALM and env.params == PARAMS and env.gravity == PARAMS.gravity


def chances_to_any_pad(critic: Critic, moments: Floats) -> Floats:
    """Return the chances (n, 6) to be saved to one of the pads or another for moments (n, pads, 9 + k).

    `LanderEnv.observe_around` returns such.
    """
    rows, pads, numbers = moments.shape
    flat = moments.reshape(-1, numbers)
    every = critic.chances(flat[:, :NUM_FEATURES], flat[:, NUM_FEATURES:]).reshape(rows, pads, NUM_ACTIONS)
    chances: Floats = every.max(axis=1)
    return chances


@dataclass(frozen=True)
class Fall:
    """Stretch of a flight in which the chance to be saved was lost; steps are physics steps.

    Attributes:
        begins: the last step at which the chance was still `high`.
        ends: the step at which it had come down to `low`.
        action: the action that took the most of it.
        by: who chose that action.
        held: whether one press of it took most of the fall; then `since`, `before` and `after` are that press's.
        since: the step from which the action took it.
        before, after: the chance before and after.

    """

    begins: int
    ends: int
    high: float
    low: float
    action: int
    by: StickHolder
    held: bool
    since: int
    before: float
    after: float


def find_falls(chances: Sequence[float], actions: Sequence[int], hands: Sequence[StickHolder]) -> list[Fall]:
    """Return the falls of a flight, in their order.

    Args:
        chances: chance to be saved after each decision, every `DECISION_STEPS` steps.
        actions: the action of each physics step.
        hands: who chose it.

    """
    falls, top = [], 0
    number = 1
    while number < len(chances):
        if chances[number] >= chances[top] - _LEVEL:
            top = number if chances[number] >= chances[top] else _last_as_high(chances, top, number)
        elif chances[top] - chances[number] >= FALL:
            bottom = _bottom(chances, number)
            falls.append(_fall(chances, actions, hands, top, bottom))
            top = number = bottom
        number += 1
    return falls


def _last_as_high(chances: Sequence[float], top: int, number: int) -> int:
    """Return the later of two moments, unless many small steps down would add up to a long one unseen."""
    return number if chances[number] >= chances[top] - _LEVEL / 4 else top


def _bottom(chances: Sequence[float], number: int) -> int:
    """Return the moment from `number` on at which the chance has stopped falling."""
    low = number
    while number + 1 < len(chances) and chances[number + 1] <= chances[low] + _REBOUND:
        number += 1
        if chances[number] < chances[low] - _LEVEL:
            low = number
    return low


def _fall(
    chances: Sequence[float], actions: Sequence[int], hands: Sequence[StickHolder], top: int, bottom: int
) -> Fall:
    """Describe the fall from one moment to another by what took it."""
    moments = range(top + 1, bottom + 1)
    presses = [list(same) for _, same in groupby(moments, key=lambda number: actions[number * DECISION_STEPS])]
    lost = [chances[press[0] - 1] - chances[press[-1]] for press in presses]
    most = presses[int(np.argmax(lost))]
    held = max(lost) >= _MOSTLY * (chances[top] - chances[bottom])
    if held:
        since, before, after = most[0], chances[most[0] - 1], chances[most[-1]]
        action = actions[since * DECISION_STEPS]
    else:  # many presses: the action that took the most in all
        taken = np.zeros(NUM_ACTIONS)
        for press, loss in zip(presses, lost, strict=True):
            taken[actions[press[0] * DECISION_STEPS]] += loss
        action = int(taken.argmax())
        since, before, after = top + 1, chances[top], chances[bottom]
    step = since * DECISION_STEPS
    by = hands[next(n for n in range(step, len(actions)) if actions[n] == action)]
    if held:
        while step > top * DECISION_STEPS and actions[step - 1] == action:  # it can begin between two decisions
            step -= 1
    return Fall(top * DECISION_STEPS, bottom * DECISION_STEPS, chances[top], chances[bottom], action, by, held, step,
                before, after)  # fmt: skip


class FlightChances:
    """Chances to be saved over a recorded flight, judged a little in every frame while the scout flies ahead.

    Attributes:
        chances: of the decisions judged so far, every `DECISION_STEPS` steps; the last is before the first touch.
        falls: where the chance fell, once the whole flight has been judged.

    """

    def __init__(self, replay: FlightReplay, critic: Critic) -> None:
        self._replay, self._critic = replay, critic
        self.chances: list[float] = []
        self.falls: list[Fall] = []
        self.complete = False

    def follow(self) -> None:
        """Judge the next moments, if enough are known."""
        if self.complete:
            return
        seen, done = self._replay.observations, len(self.chances)
        if len(seen) - done < _ROWS and not self._replay.complete:
            return
        rows = np.array(seen[done : done + _ROWS])
        if len(rows):
            actions = self._replay.record.recording.actions[done * DECISION_STEPS :: DECISION_STEPS][: len(rows)]
            chances = chances_to_any_pad(self._critic, rows)[np.arange(len(rows)), actions]
            self.chances += np.nan_to_num(chances).astype(float).tolist()
        if self._replay.complete and len(self.chances) == len(seen):
            self.complete = True
            recording = self._replay.record.recording
            self.falls = find_falls(self.chances, recording.actions, recording.hands)

    def at(self, step: int) -> float | None:
        """Return the chance at a physics step; None if it is not known."""
        number = step // DECISION_STEPS
        return self.chances[number] if number < len(self.chances) else None

    @property
    def worst(self) -> Fall | None:
        """The fall that took the most; None if there is none."""
        return max(self.falls, key=lambda fall: fall.high - fall.low, default=None)


class Rescues:
    """Rescues of one flight; call `follow` once after every step.

    A rescue is a stretch in which the guardian changes actions after which fewer such moments could have been saved
    than its dial asks for; within a second of each other they are the same one.

    Attributes:
        times: how many there were.
        guarded: whether the flight, or a part of it, was guarded by a safety critic.
        throughout: assist of the guardian that watched over every step alike, 0 to 1; 0 if there was none.

    """

    def __init__(self) -> None:
        self.times, self.guarded = 0, False
        self.throughout: float = -1.0  # before the first step
        self._since = _CALM

    def follow(self, flight: Flight) -> None:
        """Count the step just flown."""
        decision = flight.decision
        chance = decision.chance if decision is not None and flight.shared else None
        self._since += 1
        assist = 0.0 if decision is None or chance is None else decision.assist
        self.throughout = assist if self.throughout in (-1.0, assist) else 0.0
        if decision is None or chance is None or decision.required is None:
            return
        self.guarded = True
        lost = bool(chance[0] < decision.required[0])
        if flight.overridden and (lost or self._since < _CALM):
            self.times += self._since >= _CALM
            self._since = 0

    def saved(self, flight: Flight) -> int | None:
        """Return how often the person was saved in a flight that is over; None unless it was guarded and landed."""
        return self.times if self.guarded and flight.outcome is Outcome.LANDED else None
