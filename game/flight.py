"""Flights as the game runs them: the lander's rules, who flies, and poses to draw in between steps."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Final

import numpy as np

from ai.env import Bools, Doubles, Floats, Ints
from ai.lander import PARAMS, LanderEnv, Outcome
from engine.integrate import integrate_position, integrate_velocity
from engine.world import DT
from game.networks import Flyer

# A network decides every so many physics steps, in training and here.
DECISION_STEPS: Final = 4
# Steps that an ended flight of a swarm stays to be seen.
_REST_STEPS: Final = 75
_PATH_STRIDE: Final = 4


class Hand(Enum):
    """Who has the stick."""

    HUMAN = "human"
    NETWORK = "network"


class Poses:
    """The last two poses x, y, angle of every lander, to draw in between."""

    def __init__(self, env: LanderEnv) -> None:
        self._env = env
        self.now = self._read()
        self.before = self.now

    def take(self, jumped: Bools | None = None) -> None:
        """Note the pose after a step; the slots of `jumped` began anew and did not move there."""
        self.before, self.now = self.now, self._read()
        if jumped is not None and jumped.any():
            self.before = np.where(jumped[:, None], self.now, self.before)

    def at(self, alpha: float) -> Doubles:
        """Poses (n, 3), `alpha` of the way from the last step but one to the last."""
        poses: Doubles = self.before + alpha * (self.now - self.before)
        return poses

    def _read(self) -> Doubles:
        return np.concatenate([self._env.position, self._env.angle[:, None]], axis=1)


@dataclass
class Recording:
    """All it takes to fly a flight again, bit for bit: where it began, and what was done in every step."""

    seed: int
    spawn: str
    actions: list[int] = field(default_factory=list)
    hands: list[Hand] = field(default_factory=list)


class Flight:
    """One lander, flown by a person, by a network, or by both in turns."""

    def __init__(self, seed: int, network: Flyer | None = None, spawn: str = "random") -> None:
        self.env = LanderEnv(1, seed, spawn, frame_skip=1)
        self.observation: Floats = self.env.reset()
        self.network = network
        self.hand = Hand.HUMAN
        self.recording = Recording(seed, spawn)
        self.poses = Poses(self.env)
        self._decision = 0
        self._held_for = 0

    @property
    def outcome(self) -> Outcome:
        """How the flight stands."""
        return Outcome(int(self.env.outcome[0]))

    @property
    def over(self) -> bool:
        """Whether it has ended."""
        return self.outcome is not Outcome.FLYING

    @property
    def share(self) -> float:
        """The person's share of the steps flown, 0 to 1."""
        hands = self.recording.hands
        return hands.count(Hand.HUMAN) / len(hands) if hands else 1.0

    def change_network(self, network: Flyer | None) -> None:
        """Let another network take the stick from here on; without one, the person has it."""
        self.network = network
        self._held_for = 0
        if network is None:
            self.hand = Hand.HUMAN

    def hand_over(self) -> bool:
        """Give the stick to the other one. False if there is no other, or nothing left to fly."""
        if self.over or (self.network is None and self.hand is Hand.HUMAN):
            return False
        self.hand = Hand.NETWORK if self.hand is Hand.HUMAN else Hand.HUMAN
        self._held_for = 0  # a network that takes over decides at once
        return True

    def step(self, held: int) -> None:
        """Fly 1/60 s; `held` is the action the person's hands ask for right now."""
        if self.over:
            self.poses.take()
            return
        action = held if self.hand is Hand.HUMAN else self._ask_network()
        self.observation = self.env.step(np.array([action])).observation
        self.recording.actions.append(action)
        self.recording.hands.append(self.hand)
        self.poses.take()

    def _ask_network(self) -> int:
        if self._held_for == 0:
            assert self.network is not None
            self._decision = int(self.network.act(self.observation, held=self.env.actions)[0])
        self._held_for = (self._held_for + 1) % DECISION_STEPS
        return self._decision


class Swarm:
    """Any number of landers, flown by one network again and again.

    Attributes:
        since_end: steps each flight has been over, 0 while it flies.
        landed, lost: flights ended so since the start.
        fresh: slots whose flight began with the last step.

    """

    def __init__(self, count: int, seed: int, flyer: Flyer, spawn: str = "random") -> None:
        self.env = LanderEnv(count, seed, spawn, frame_skip=1)
        self.observation: Floats = self.env.reset()
        self.flyer = flyer
        self.poses = Poses(self.env)
        self.since_end: Ints = np.zeros(count, dtype=np.intp)
        self.landed = self.lost = 0
        self.fresh: Bools = np.ones(count, dtype=bool)
        self._actions: Ints = np.zeros(count, dtype=np.intp)
        self._slots: Ints = np.arange(count)
        self._step = 0

    def step(self) -> Bools:
        """Fly 1/60 s, and begin anew where a flight has been over for a while. Returns who just ended."""
        self.fresh = self.since_end >= _REST_STEPS
        if self.fresh.any():
            self.observation = self.env.reset(self.fresh)
            self.since_end[self.fresh] = 0
            self._actions[self.fresh] = 0
        due = self._slots[-self._step % DECISION_STEPS :: DECISION_STEPS]  # in turns, for frames of equal cost
        if len(due):
            self._actions[due] = self.flyer.act(self.observation[due], held=self._actions[due])
        self._step += 1
        result = self.env.step(self._actions)
        self.observation = result.observation
        ended: Bools = result.ended & (self.since_end == 0)
        self.since_end += result.ended
        landed = int((result.outcome[ended] == Outcome.LANDED).sum())
        self.landed += landed
        self.lost += int(ended.sum()) - landed
        self.poses.take(self.fresh)
        return ended


def coast_path(env: LanderEnv, slot: int = 0, seconds: float = 9.0) -> Doubles:
    """Where a lander goes if nobody touches anything: positions (k, 2), every 1/15 s, down to the ground."""
    world, body = env.world, env.lander.index
    state = world.state
    state = replace(
        state,
        **{name: getattr(state, name)[slot : slot + 1].copy() for name in ("pose", "velocity", "active", "cos", "sin")},
        force=np.zeros_like(state.force[:1]),
    )
    path = [state.pose[0, body, :2].copy()]
    for _ in range(round(seconds / (_PATH_STRIDE * DT))):
        integrate_velocity(state, world.params, world.moving, world.gravity, _PATH_STRIDE * DT)
        integrate_position(state, world.moving, _PATH_STRIDE * DT)
        x, y = state.pose[0, body, :2].tolist()
        path.append(np.array((x, y)))
        if y < surface_height(env, x, slot) + PARAMS.stand or abs(x) > env.limits.half_width:
            break
    return np.array(path)


def surface_height(env: LanderEnv, x: float, slot: int = 0) -> float:
    """Height of what lies under x: the pad's top or the moon."""
    pad_x, pad_y = env.pad[slot].tolist()
    return pad_y if abs(x - pad_x) <= env.pad_width[slot] / 2 else PARAMS.ground
