"""The co-pilot's tables in parts, which may be flown on many cores: some pilots of one table each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from ai.agent.agent import DeepQAgent
from ai.copilot import measurement
from ai.copilot.measurement import AssistedFlights, Help
from ai.lander.pilots import Pilot, ScriptedPilot
from ai.sweep.shards import pack_agent, packed_agent

_PILOTS: Final = 8  # of a part: the more fly at once, the less time each takes


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
        Part(agent, scripted, table, names[first : first + _PILOTS], tuple(helps), episodes, seed)
        for table, agent in packed.items()
        for names in [measurement.TABLES[table][1]]
        for first in range(0, len(names), _PILOTS)
    ]


def fly(part: Part) -> list[AssistedFlights]:
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
