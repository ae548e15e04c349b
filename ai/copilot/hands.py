"""Clumsy hands: pilots with faults drawn anew for every flight, stuck keys and adversaries, to be measured with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from ai.environment import Doubles, Floats, Ints
from ai.lander.environment import ACTION_NAMES, NUM_ACTIONS
from ai.lander.pilots import COAST, GAINS, Gains, LaggyPilot, NoisyPilot, Pilot, ScriptedPilot, SensorPilot
from ai.lander.rules import ACTION_SHARES

_LATEST: Final = 11  # decisions that hands can be late
_STEERS: Final = 3  # action = 3 * main + steer
_SECOND: Final = 15  # decisions


@dataclass(frozen=True)
class Faults:
    """Faults of a pair of hands; each is one number, or one for every slot (n,). Chances are per decision."""

    late: ArrayLike = 0  # decisions of 1/15 s
    sticky: ArrayLike = 0.0  # chance that the last action is held on
    one_key: ArrayLike = False  # whether main engine and jets are never pressed together
    thrust: ArrayLike = 0.0  # chance that the main engine fires, whatever was meant
    timid: ArrayLike = 0.0  # chance that it does not, whatever was meant
    freeze: ArrayLike = 0.0  # chance to do nothing new for one to three seconds
    inverted: ArrayLike = False  # whether left and right are confused
    flip: ArrayLike = 0.0  # chance that the main engine does the opposite of what was meant
    change: ArrayLike = 0.0  # chance that the steering is another


class ClumsyHands:
    """Pilot that passes on the wishes of another with faults; row k of every call is the same flight."""

    def __init__(self, pilot: Pilot, slots: int, rng: np.random.Generator, faults: Faults) -> None:
        self.pilot, self.rng, self.slots = pilot, rng, slots
        self.faults = Faults(**{name: np.broadcast_to(fault, slots) for name, fault in asdict(faults).items()})
        self._late: Ints = np.minimum(self.faults.late, _LATEST).astype(np.intp)
        self._wishes: Ints = np.zeros((_LATEST + 1, slots), dtype=np.intp)
        self._asked = 0
        self._last: Ints = np.zeros(slots, dtype=np.intp)
        self._frozen: Ints = np.zeros(slots, dtype=np.intp)  # decisions for which each does nothing new

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:
        """Actions (n,) for observations (n, 9)."""
        rng, slots, faults = self.rng, self.slots, self.faults
        self._wishes[self._asked % len(self._wishes)] = self.pilot.act(observation, held=held)
        late = np.minimum(self._late, self._asked)
        main, steer = np.divmod(self._wishes[(self._asked - late) % len(self._wishes), np.arange(slots)], _STEERS)
        self._asked += 1
        slips = rng.random((7, slots))
        main = np.where(slips[0] < faults.flip, 1 - main, main)
        steer = np.where(slips[1] < faults.change, (steer + rng.integers(1, _STEERS, slots)) % _STEERS, steer)
        main = np.where(slips[2] < faults.thrust, 1, main)
        main = np.where(slips[6] < faults.timid, 0, main)
        steer = np.where(np.logical_and(faults.inverted, steer > 0), _STEERS - steer, steer)
        both = np.logical_and(faults.one_key, (main > 0) & (steer > 0))
        main, steer = np.where(both & (slips[3] < 0.5), 0, main), np.where(both & (slips[3] >= 0.5), 0, steer)
        begins = (self._frozen == 0) & (slips[4] < faults.freeze)
        self._frozen = np.where(begins, rng.integers(15, 45, slots), np.maximum(self._frozen - 1, 0))
        held_on = (slips[5] < faults.sticky) | (self._frozen > 0)
        self._last = np.where(held_on, self._last, _STEERS * main + steer)
        return self._last


class HeldKeys:
    """Pilot who holds the same keys all the time, or, without an action, others from each second to the next."""

    def __init__(self, action: int | None, slots: int, rng: np.random.Generator) -> None:
        self.action, self.slots, self.rng = action, slots, rng
        self._asked = 0
        self._last: Ints = np.full(slots, action or COAST, dtype=np.intp)

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:  # noqa: ARG002
        """Actions (n,) for observations (n, 9)."""
        if self.action is None and self._asked % _SECOND == 0:
            self._last = self.rng.integers(NUM_ACTIONS, size=self.slots)
        self._asked += 1
        return self._last


class PartThrust:
    """Pilot whose main engine never gives more than a share of its thrust, 0 to 1."""

    def __init__(self, pilot: Pilot, most: float) -> None:
        self.act, self.most = pilot.act, most

    def shares(self, action: Ints) -> Doubles:
        """Return the shares of thrust of main engine and jets, (n, 2), that are pushed with actions (n,)."""
        return ACTION_SHARES[action] * (self.most, 1.0)


class Adversary:
    """Pilot who wants to crash: of the actions that pass, one at random, or the one that the network values least."""

    def __init__(self, agent: Any, rng: np.random.Generator, *, least: bool) -> None:
        self.agent, self.rng, self.least = agent, rng, least

    def act(self, observation: Floats, *, held: Ints | None = None, passes: Any = True) -> Ints:  # noqa: ARG002
        """Actions (n,) for observations (n, features), where those that `passes` (n, 6) are flown; all by default."""
        rank = self.agent.q_values(observation) if self.least else self.rng.random((len(observation), NUM_ACTIONS))
        passes = np.broadcast_to(passes, rank.shape)
        action: Ints = np.where(passes | ~passes.any(axis=1, keepdims=True), rank, np.inf).argmin(axis=1)
        return action


MakePilot = Callable[[int, np.random.Generator, Pilot], Pilot]  # of slots, randomness, and a good pilot


def _drawn(slots: int, rng: np.random.Generator, spread: float) -> ScriptedPilot:
    """Return a scripted controller whose gains are drawn anew for every slot, each off by up to a factor e^spread."""
    return ScriptedPilot(Gains(*(gain * np.exp(rng.uniform(-spread, spread, slots)) for gain in vars(GAINS).values())))


def _scripted(**faults: Any) -> MakePilot:
    """Make hands with faults around a scripted controller with gains of its own in every flight."""

    def make(slots: int, rng: np.random.Generator, good: Pilot) -> Pilot:  # noqa: ARG001
        drawn = {name: fault(slots, rng) if callable(fault) else fault for name, fault in faults.items()}
        return ClumsyHands(_drawn(slots, rng, 0.3), slots, rng, Faults(**drawn))

    return make


def _holding(action: int | None) -> MakePilot:
    return lambda slots, rng, _: HeldKeys(action, slots, rng)


# Hands by name: some good, many with faults; then stuck keys, a weak stick, and somebody who wants to crash.
HANDS: Final[dict[str, MakePilot]] = {
    "good": lambda _slots, _rng, good: good,
    "scripted": lambda *_: ScriptedPilot(),
    "gains drawn anew": lambda slots, rng, _: _drawn(slots, rng, 0.6),
    "late": _scripted(late=lambda slots, rng: rng.integers(4, 7, slots)),
    "sticky keys": _scripted(sticky=0.75),
    "one key": _scripted(one_key=True),
    "too much thrust": _scripted(thrust=0.25),
    "freezing": _scripted(freeze=0.03),
    "inverted": _scripted(inverted=True),
    "laggy": lambda _, rng, good: LaggyPilot(good, rng),
    "noisy": lambda _, rng, good: NoisyPilot(good, rng),
    "sensor": lambda *_: SensorPilot(),
    **{f"holds {name}": _holding(action) for action, name in enumerate(ACTION_NAMES)},
    "a key each second": _holding(None),
    "slow": _scripted(late=_LATEST, sticky=0.75),
    "thrust 0.45": lambda *_: PartThrust(ScriptedPilot(), 0.45),
    "thrust 0.3": lambda *_: PartThrust(ScriptedPilot(), 0.3),
    "adversary, random": lambda _, rng, good: Adversary(good, rng, least=False),
    "adversary, least": lambda _, rng, good: Adversary(good, rng, least=True),
}
