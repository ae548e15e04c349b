"""Evaluation of very many flights in shards, and the co-pilot's tables in parts, on many cores or nodes.

Flight i begins as the i-th of one large batch of the same seed would, whichever shard flies it. A shard is always the
same number of flights. So the counts are the same bit for bit, however many workers there are, and whether Ray is
there or not; and sums are taken in the order of the shards.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, reduce
from pathlib import Path
from typing import Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.storage import write_agent
from ai.copilot import measurement
from ai.copilot.measurement import AssistedFlights, Help
from ai.lander.environment import LanderEnv
from ai.lander.pilots import Pilot, ScriptedPilot
from ai.sweep.cluster import each
from ai.sweep.trial import archive, unpack
from ai.training.config import Config
from ai.training.tasks import FlightSums, finished, flown

SHARD: Final = 10_000  # flights at once, in 5 KB each
PILOTS: Final = 8  # of a part of a table: the more fly at once, the less time each takes


@dataclass(frozen=True)
class Shard:
    """Part of an evaluation: flights `first` to `last`, without `last`, of an agent that is packed."""

    agent: bytes
    first: int
    last: int
    seed: int
    spawn: str
    frame_skip: int


def shards(agent: DeepQAgent, episodes: int, seed: int, spawn: str) -> list[Shard]:
    """Return the shards of an evaluation of an agent."""
    packed = pack_agent(agent)
    frame_skip = Config.of(agent).frame_skip
    return [
        Shard(packed, first, min(episodes, first + SHARD), seed, spawn, frame_skip)
        for first in range(0, episodes, SHARD)
    ]


def fly(shard: Shard) -> FlightSums:
    """Fly a shard."""
    env = LanderEnv(shard.last - shard.first, shard.seed, shard.spawn, shard.frame_skip)
    for slot, number in enumerate(range(shard.first, shard.last)):
        # The generator that number `number` of a batch gets, which NumPy spawns from the seed.
        env.streams[slot] = np.random.default_rng(np.random.SeedSequence(shard.seed, spawn_key=(number,)))
    env.reset()
    return finished(flown(packed_agent(shard.agent), env))


def flown_shards(parts: list[Shard], address: str | None, workers: int | None) -> Iterator[FlightSums | None]:
    """Fly all shards; yield None as each is done, and the sums of all at the end."""
    done: dict[int, FlightSums] = {}
    for index, sums in each(fly, parts, address, workers):
        done[index] = sums
        yield None
    yield reduce(FlightSums.plus, (done[index] for index in range(len(parts))))


def pack_agent(agent: DeepQAgent) -> bytes:
    """Return an agent as an archive: what was read of it, and no file as it lies."""
    with tempfile.TemporaryDirectory() as folder:
        write_agent(agent, Path(folder))
        return archive(Path(folder))


@lru_cache(maxsize=2)
def packed_agent(packed: bytes) -> DeepQAgent:
    """Return the agent of an archive; a worker flies one part after another with the same."""
    with tempfile.TemporaryDirectory() as folder:
        unpack(packed, Path(folder))
        return DeepQAgent.load(folder)


# The co-pilot's tables in parts: some pilots of one table each.


@dataclass(frozen=True)
class Part:
    """Part of a table: the rows of some of its pilots."""

    agent: bytes  # the co-pilot, packed
    scripted: bool  # whether the imperfect pilots are made of the scripted one, not of the network
    table: str
    names: tuple[str, ...]
    helps: tuple[Help, ...]
    episodes: int
    seed: int


def parts(
    agents: Mapping[str, DeepQAgent], scripted: bool, helps: Sequence[Help], episodes: int, seed: int
) -> list[Part]:
    """Return all parts of the tables that have a network: `agents` are these by the table's name."""
    packed = {table: pack_agent(agent) for table, agent in agents.items()}
    return [
        Part(agent, scripted, table, names[first : first + PILOTS], tuple(helps), episodes, seed)
        for table, agent in packed.items()
        for names in [measurement.TABLES[table][1]]
        for first in range(0, len(names), PILOTS)
    ]


def fly_part(part: Part) -> list[AssistedFlights]:
    """Fly a part; what comes of it does not depend on the others."""
    agent = packed_agent(part.agent)
    good: Pilot = ScriptedPilot() if part.scripted else agent
    return measurement.rows(agent, good, part.table, part.names, part.helps, part.episodes, part.seed)


def tables_of(asked: Sequence[Part], done: Mapping[int, list[AssistedFlights]]) -> dict[str, list[AssistedFlights]]:
    """Return the rows of all tables from those of all parts."""
    tables: dict[str, list[AssistedFlights]] = {}
    for index, part in enumerate(asked):
        tables.setdefault(part.table, []).extend(done[index])
    return tables
