"""Measurement of the co-pilot: pilots good and bad, alone and with help, over many flights each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, fields, replace
from typing import Any, Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.common.environment import Doubles
from ai.common.intervals import wilson
from ai.copilot.copilot import CoPilot, Mode
from ai.copilot.hands import FAMILIES, UNSEEN, MakePilot
from ai.copilot.oracle import Oracle
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.ground import Ground, hilly
from ai.lander.pilots import NoPilot, Pilot

PILOTS: Final[dict[str, MakePilot]] = {**FAMILIES, **UNSEEN, "none": lambda slots, rng, good: NoPilot()}  # noqa: ARG005
INTENT_PILOTS: Final = ("good", "laggy", "noisy", "noisier")  # pilots that have a pad in mind
GROUNDS: Final = 5  # different hills for the flights with a hidden intent
ALONE: Final = "alone"
COPILOT: Final = "co-pilot"  # the pilot of the row in which the network flies alone
OPEN: Final = "guardian, all pads open"  # the same rule, with nothing read into what the pilot does
ORACLE: Final = "oracle"  # the limit: it flies ahead in the exact simulation
VALUES: Final = "guardian by values"  # without a critic
ORACLE_FLIGHTS: Final = 60  # of a row: each takes as long as a hundred others

Help = tuple[str, float]  # alone, or how the co-pilot helps; and how much
ONE_PAD: Final[tuple[Help, ...]] = (
    (ALONE, 0.0),
    (Mode.TOLERANCE, 0.4),
    *((Mode.GUARDIAN, assist) for assist in (0.2, 0.4, 0.6)),
    (VALUES, 0.4),
    (ORACLE, 0.0),
)
THREE_PADS: Final[tuple[Help, ...]] = (
    (ALONE, 0.0),
    (Mode.TOLERANCE, 0.4),
    *((Mode.GUARDIAN, assist) for assist in (0.2, 0.4, 0.6, 0.8)),
    (VALUES, 0.4),
    (OPEN, 0.4),
)


@dataclass(frozen=True)
class AssistedFlights:
    """Results of a number of flights of one pilot with one kind of help."""

    pilot: str
    mode: str
    assist: float
    episodes: int
    success: float  # shares of the flights
    crash: float
    out_of_bounds: float
    time_out: float
    mean_return: float
    overridden: float  # share of the decisions in which something else was flown than the pilot asked for
    own_pad: float  # share of the flights that ended on the pad the pilot had in mind

    @property
    def success_interval(self) -> tuple[float, float]:
        """Confidence interval of 95% of the success (Wilson 1927)."""
        return wilson(self.success, self.episodes)

    def to_json(self) -> dict[str, Any]:
        """Return the values as JSON can hold them."""
        return asdict(self) | {"success_interval": self.success_interval}


@dataclass(frozen=True)
class AssistedPilot:
    """Pilot with the kind of help it gets."""

    name: str
    pilot: Pilot
    mode: str = ALONE
    assist: float = 0.0
    copilot: CoPilot | Oracle | None = None


def one_pad(agent: DeepQAgent, good: Pilot, episodes: int, seed: int = 0) -> Iterator[AssistedFlights]:
    """Fly every pilot of the table with every help to a single pad; yield the rows as they are done.

    `agent` is the co-pilot, `good` the pilot that some of the imperfect ones are made of. All fly from the same
    starts, and with the same mishaps, which follow from `seed`; the oracle's flights are fewer.
    """
    for name in (*PILOTS, COPILOT):
        yield from one_pad_rows(agent, good, name, episodes, seed)


def one_pad_rows(agent: DeepQAgent, good: Pilot, name: str, episodes: int, seed: int) -> list[AssistedFlights]:
    """Return the rows of one pilot of the table, or of COPILOT; they do not depend on the other pilots."""
    if name == COPILOT:
        return _measure([AssistedPilot(COPILOT, agent)], episodes, seed)
    fast = [help_ for help_ in ONE_PAD if help_[0] != ORACLE]
    rows = _measure(_assisted_pilots(agent, good, [name], fast, episodes, seed), episodes, seed)
    if len(fast) < len(ONE_PAD):
        few = min(episodes, ORACLE_FLIGHTS)
        rows += _measure(_assisted_pilots(agent, good, [name], [(ORACLE, 0.0)], few, seed), few, seed)
    return rows


def three_pads(agent: DeepQAgent, good: Pilot, episodes: int, seed: int = 0) -> Iterator[AssistedFlights]:
    """Fly pilots with one of three pads in mind, which the co-pilot isn't told; yield the rows.

    The flights are spread over several grounds, so `episodes` is rounded to a multiple of their number.
    """
    yield from mean_rows([three_pads_rows(agent, good, ground, episodes, seed) for ground in range(GROUNDS)])


def three_pads_rows(agent: DeepQAgent, good: Pilot, ground: int, episodes: int, seed: int) -> list[AssistedFlights]:
    """Return the rows of one of the grounds, with its part of the flights; they do not depend on the others."""
    rng = np.random.default_rng([seed, ground])
    start, each = int(rng.integers(2**31)), max(1, round(episodes / GROUNDS))
    assisted = _assisted_pilots(agent, good, INTENT_PILOTS, THREE_PADS, each, start)
    return _measure(assisted, each, start, hilly(rng))


def mean_rows(parts: Sequence[Sequence[AssistedFlights]]) -> list[AssistedFlights]:
    """Return the means of tables of the same rows and as many flights."""
    return [_mean(rows) for rows in zip(*parts, strict=True)]


def _assisted_pilots(
    agent: DeepQAgent, good: Pilot, names: Sequence[str], helps: Sequence[Help], episodes: int, seed: int
) -> list[AssistedPilot]:
    return [
        AssistedPilot(name, PILOTS[name](episodes, np.random.default_rng(seed), good), str(mode), assist,
                      _help(agent, mode, assist))
        for name in names
        for mode, assist in helps
    ]  # fmt: skip


def _help(agent: DeepQAgent, mode: str, assist: float) -> CoPilot | Oracle | None:
    if mode == ALONE:
        return None
    if mode == ORACLE:
        return Oracle(agent)
    guardian = mode in (OPEN, VALUES)
    copilot = CoPilot(agent, assist, Mode.GUARDIAN if guardian else mode, infers_intent=mode != OPEN)
    if mode == VALUES:
        copilot.critic = None
    return copilot


def _measure(
    assisted: Sequence[AssistedPilot], episodes: int, seed: int, ground: Ground | None = None
) -> list[AssistedFlights]:
    """Fly `episodes` flights of every assisted pilot, all at once and from the same starts."""
    env = LanderEnv(len(assisted) * episodes, seed, ground=ground)
    for first in range(0, env.num_envs, episodes):
        for slot, rng in enumerate(np.random.default_rng(seed).spawn(episodes), first):
            env.draw_from(slot, rng)
    intended = np.random.default_rng(seed).integers(len(env.ground.pads), size=episodes)
    env.target = np.tile(intended, len(assisted))
    env.reset()
    returns, overridden, decisions = _fly(env, assisted)
    rows = []
    for number, each in enumerate(assisted):
        mine = slice(number * episodes, (number + 1) * episodes)
        _, landed, crashed, gone, late = (float((env.outcome[mine] == outcome).mean()) for outcome in Outcome)
        changed = float(overridden[mine].sum() / decisions[mine].sum())
        own = float((env.landed_on[mine] == intended).mean())
        rows.append(AssistedFlights(each.name, each.mode, each.assist, episodes, landed, crashed, gone, late,
                        float(returns[mine].mean()), changed, own))  # fmt: skip
    return rows


def _fly(env: LanderEnv, assisted: Sequence[AssistedPilot]) -> tuple[Doubles, Doubles, Doubles]:
    """Fly until all have ended; return every flight's return, overridden decisions, and decisions, (n,) each."""
    returns, overridden, decisions = np.zeros((3, env.num_envs))
    episodes = env.num_envs // len(assisted)
    while (flying := env.outcome == Outcome.FLYING).any():
        seen, wished, around, actions = env.observe_pads(), env.observe(), env.around_pads(), env.actions.copy()
        for row, each in enumerate(assisted):
            mine = slice(row * episodes, (row + 1) * episodes)
            if flying[mine].any():
                asked = each.pilot.act(wished[mine], held=env.actions[mine])
                if isinstance(each.copilot, Oracle):
                    actions[mine] = each.copilot.share(env, asked)
                elif each.copilot is not None:
                    actions[mine] = each.copilot.share(seen[mine], asked, around[mine])[0]
                else:
                    actions[mine] = asked
                overridden[mine] += flying[mine] & (actions[mine] != asked)
        decisions += flying
        returns += env.step(actions).reward
    return returns, overridden, decisions


def _mean(rows: Sequence[AssistedFlights]) -> AssistedFlights:
    """Return the mean of rows of as many flights each."""
    figures = {
        figure.name: float(np.mean([getattr(row, figure.name) for row in rows]))
        for figure in fields(AssistedFlights)[4:]
    }
    return replace(rows[0], episodes=sum(row.episodes for row in rows), **figures)  # type: ignore[arg-type]
