"""Measurement of the co-pilot: hands good, bad and hostile, alone and with help, over many flights each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.copilot.copilot import CoPilot, Mode
from ai.copilot.futures import Futures, Push
from ai.copilot.hands import HANDS, Adversary
from ai.environment import Bools, Doubles
from ai.lander.anywhere import AnywhereEnv
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.ground import hilly
from ai.lander.pilots import Pilot
from ai.lander.rules import ACTION_SHARES
from ai.training.statistics import wilson

SOME: Final = "slow", "holds right", "a key each second", "thrust 0.3", "adversary, random"
ALONE: Final = "alone"
VALUES: Final = "guardian by values"  # without futures
Help = tuple[str, float]  # alone, or how the co-pilot helps; and how much
GUARD: Final[Help] = (Mode.GUARDIAN, 0.04)  # there must be a landing after one decision of an action
HELPS: Final[tuple[Help, ...]] = ((ALONE, 0.0), (Mode.TOLERANCE, 0.4), (VALUES, 0.4), GUARD)
_STARTS: Final = 0x5AFE7AB1E  # beside the seed, so that no start is one that anything was trained with


@dataclass(frozen=True)
class AssistedFlights:
    """Results of a number of flights of one pilot with one kind of help, as shares of these flights."""

    pilot: str
    mode: str
    assist: float
    episodes: int
    success: float
    crash: float
    out_of_bounds: float
    time_out: float
    overridden: float  # share of the decisions in which something else was flown than the pilot asked for
    own_pad: float  # that ended on the pad the pilot had in mind
    held: float  # in which the guardian held a plan
    lost_held: float  # that did not land although it did

    @property
    def success_interval(self) -> tuple[float, float]:
        """Confidence interval of 95% of the success (Wilson 1927)."""
        return wilson(self.success, self.episodes)

    def to_json(self) -> dict[str, Any]:
        """Return the values as JSON can hold them."""
        return asdict(self) | {"success_interval": self.success_interval}


MakeEnv = Callable[[int, np.random.Generator], LanderEnv]


def _hills(slots: int, rng: np.random.Generator) -> LanderEnv:
    return LanderEnv(slots, rng, ground=hilly(rng))


# Tables by name: in which world they are flown, and by which pilots.
TABLES: Final[dict[str, tuple[MakeEnv, tuple[str, ...]]]] = {
    "one_pad": (LanderEnv, tuple(HANDS)),
    "three_pads": (_hills, SOME),
    "other_worlds": (AnywhereEnv, SOME),
}


def rows(
    agent: DeepQAgent, good: Pilot, table: str, names: Sequence[str], helps: Sequence[Help], episodes: int, seed: int
) -> list[AssistedFlights]:
    """Return the rows of pilots by name with every help, in a table of `TABLES`; all fly from the same starts.

    `agent` is the co-pilot, `good` the pilot that some of the imperfect ones are made of.
    """
    found = [_measure(agent, good, table, names, help_, episodes, seed) for help_ in helps]
    return [row for pilot in zip(*found, strict=True) for row in pilot]


def _begun(good: Pilot, table: str, names: Sequence[str], episodes: int, seed: int) -> tuple[LanderEnv, list[Pilot]]:
    """Return landers at the starts of all flights, and who flies them: as many each, from the same starts."""
    env = TABLES[table][0](len(names) * episodes, np.random.default_rng([_STARTS, seed]))
    for first in range(0, env.num_envs, episodes):
        for slot, rng in enumerate(np.random.default_rng([_STARTS, seed, 1]).spawn(episodes), first):
            env.streams[slot] = rng
    env.reset()
    if env.ground.at_once > 1:
        intended = np.random.default_rng([_STARTS, seed, 2]).integers(env.ground.at_once, size=episodes)
        env.target = np.tile(intended, len(names))
    return env, [HANDS[name](episodes, np.random.default_rng([_STARTS, seed, 3]), good) for name in names]


def _measure(
    agent: DeepQAgent, good: Pilot, table: str, names: Sequence[str], help_: Help, episodes: int, seed: int
) -> list[AssistedFlights]:
    """Fly `episodes` flights of every pilot with one help, all at once."""
    env, pilots = _begun(good, table, names, episodes, seed)
    mode, assist = help_
    copilot = None
    if mode != ALONE:
        copilot = CoPilot(agent, assist, Mode.GUARDIAN if mode == VALUES else Mode(mode))
    overridden, decisions, held = fly(env, agent, pilots, copilot, by_values=mode == VALUES)
    landed, own = env.outcome == Outcome.LANDED, env.landed_on == env.target
    found = []
    for number, name in enumerate(names):
        mine = slice(number * episodes, (number + 1) * episodes)
        _, success, crash, gone, late = (float((env.outcome[mine] == outcome).mean()) for outcome in Outcome)
        changed = float(overridden[mine].sum() / decisions[mine].sum())
        on_own, planned, lost = (float(each[mine].mean()) for each in (own, held, held & ~landed))
        came = success, crash, gone, late, changed, on_own, planned, lost
        found.append(AssistedFlights(name, str(mode), assist, episodes, *came))
    return found


def fly(
    env: LanderEnv,
    agent: DeepQAgent,
    pilots: Sequence[Pilot],
    copilot: CoPilot | None,
    *,
    by_values: bool = False,
) -> tuple[Doubles, Doubles, Bools]:
    """Fly until all have ended, with as many slots for every pilot.

    Returns each flight's overridden decisions, its decisions, and whether a plan was ever held, (n,) each.
    """
    overridden, decisions = np.zeros((2, env.num_envs))
    held = np.zeros(env.num_envs, dtype=bool)
    each = env.num_envs // len(pilots)
    hands = [(pilot, slice(number * each, (number + 1) * each)) for number, pilot in enumerate(pilots)]
    foresees = copilot is not None and copilot.mode is Mode.GUARDIAN and not by_values
    while (flying := env.outcome == Outcome.FLYING).any():
        wished, action, shares = env.observe(), env.actions.copy(), env.shares.copy()
        asked: list[Push | None] = [None] * env.num_envs
        for pilot, mine in hands:
            if not flying[mine].any():
                continue
            action[mine] = pilot.act(wished[mine], held=env.actions[mine])
            pushes = getattr(pilot, "shares", ACTION_SHARES.__getitem__)
            shares[mine] = pushes(action[mine])
            if not isinstance(pilot, Adversary):
                rows = zip(action[mine].tolist(), *shares[mine].T.tolist(), strict=True)
                asked[mine] = [Push(*row) for row in rows]
        known = copilot.foresee(env, asked) if copilot and foresees else None
        for pilot, mine in hands:
            if known and isinstance(pilot, Adversary):
                action[mine] = pilot.act(wished[mine], passes=Futures(known[mine]).lasts)
                shares[mine] = ACTION_SHARES[action[mine]]
        if copilot:
            seen = env.observe_pads(agent) if env.ground.at_once > 1 else env.observe_for(agent)
            decision = copilot.decide(seen, action, None, shares, env if foresees else None, known)
            action, shares = decision.action, decision.shares
            overridden += flying & decision.overridden
            held |= flying & (decision.held if decision.held is not None else False)
        decisions += flying
        env.fly(action, shares)
    return overridden, decisions, held
