"""Evaluation of very many flights in shards, and the co-pilot's tables in parts, on many cores or nodes.

Flight i begins as the i-th of one large batch of the same seed would, whichever shard flies it. A shard is always the
same number of flights. So the counts are the same bit for bit, however many workers there are, and whether Ray is
there or not; and sums are taken in the order of the shards. What is sent is an agent as it was read and checked, and
no file as it lies.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.copilot import measurement
from ai.copilot.measurement import AssistedFlights, Help
from ai.lander.environment import LanderEnv
from ai.lander.pilots import Pilot
from ai.sweep.cluster import each
from ai.training.config import Config
from ai.training.lander_task import FlightSums, counted

SHARD: Final = 10_000  # flights at once, in 5 KB each
PILOTS: Final = 8  # of a part of a table: the more fly at once, the less time each takes


@dataclass(frozen=True)
class Shard:
    """Part of an evaluation of an agent: flights `first` to `last`, without `last`."""

    agent: DeepQAgent
    first: int
    last: int
    seed: int
    spawn: str

    def fly(self) -> FlightSums:
        """Fly them."""
        env = LanderEnv(self.last - self.first, self.seed, self.spawn, Config.of(self.agent).frame_skip)
        for slot, number in enumerate(range(self.first, self.last)):
            # The generator that number `number` of a batch gets, which NumPy spawns from the seed.
            env.draw_from(slot, np.random.default_rng(np.random.SeedSequence(self.seed, spawn_key=(number,))))
        going = counted(self.agent, env)
        while True:
            try:
                next(going)
            except StopIteration as done:
                sums: FlightSums = done.value
                return sums


def shards(agent: DeepQAgent, episodes: int, seed: int, spawn: str) -> list[Shard]:
    """Return the shards of an evaluation of an agent."""
    starts = range(0, episodes, SHARD)
    return [Shard(agent, first, min(episodes, first + SHARD), seed, spawn) for first in starts]


def flown_shards(parts: list[Shard], address: str | None, workers: int | None) -> Iterator[FlightSums | None]:
    """Fly all shards; yield None as each is done, and the sums of all at the end."""
    done: dict[int, FlightSums] = {}
    for index, sums in each(Shard.fly, parts, address, workers):
        done[index] = sums
        yield None
    yield reduce(FlightSums.plus, (done[index] for index in range(len(parts))))


@dataclass(frozen=True)
class Part:
    """Part of a table: the rows of some of its pilots, of which some are made of a `good` one."""

    agent: DeepQAgent
    good: Pilot
    table: str
    names: tuple[str, ...]
    helps: Sequence[Help]
    episodes: int
    seed: int

    def fly(self) -> list[AssistedFlights]:
        """Fly it; what comes of it does not depend on the others."""
        return measurement.rows(self.agent, self.good, self.table, self.names, self.helps, self.episodes, self.seed)


def parts(
    agents: Mapping[str, DeepQAgent], good: Pilot | None, helps: Sequence[Help], episodes: int, seed: int
) -> list[Part]:
    """Return all parts of the tables that have a network: `agents` are these by the table's name.

    Without a `good` pilot, the network itself is it.
    """
    return [
        Part(agent, good or agent, table, names[first : first + PILOTS], helps, episodes, seed)
        for table, agent in agents.items()
        for names in [measurement.TABLES[table][1]]
        for first in range(0, len(names), PILOTS)
    ]


def tables_of(asked: Sequence[Part], done: Mapping[int, list[AssistedFlights]]) -> dict[str, list[AssistedFlights]]:
    """Return the rows of all tables from those of all parts."""
    tables: dict[str, list[AssistedFlights]] = {}
    for index, part in enumerate(asked):
        tables.setdefault(part.table, []).extend(done[index])
    return tables
