"""The co-pilot's table in parts, which may be flown on many cores: one for each pilot, one for each ground."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from ai.agent.agent import DeepQAgent
from ai.copilot import measurement
from ai.copilot.measurement import COPILOT, AssistedFlights, mean_rows, one_pad_rows, three_pads_rows
from ai.lander.pilots import Pilot, ScriptedPilot
from ai.sweep.shards import pack_agent, packed_agent

ONE_PAD: Final = "one_pad"
THREE_PADS: Final = "three_pads"


@dataclass(frozen=True)
class Part:
    """Part of the table: the rows of a pilot by name, or those of a ground by number."""

    agent: bytes  # the co-pilot, packed
    scripted: bool  # whether the imperfect pilots are made of the scripted one, not of the network
    of: str | int
    episodes: int
    seed: int

    @property
    def table(self) -> str:
        """Name of the table that it belongs to."""
        return ONE_PAD if isinstance(self.of, str) else THREE_PADS


def parts(agent: DeepQAgent, scripted: bool, episodes: int, seed: int) -> list[Part]:
    """Return all parts of the table of an agent."""
    packed = pack_agent(agent)
    return [Part(packed, scripted, of, episodes, seed) for of in _all()]


def _all() -> list[str | int]:
    return [*measurement.PILOTS, COPILOT, *range(measurement.GROUNDS)]


def fly(part: Part) -> list[AssistedFlights]:
    """Fly a part; what comes of it does not depend on the others."""
    agent = packed_agent(part.agent)
    good: Pilot = ScriptedPilot() if part.scripted else agent
    if isinstance(part.of, str):
        return one_pad_rows(agent, good, part.of, part.episodes, part.seed)
    return three_pads_rows(agent, good, part.of, part.episodes, part.seed)


def tables_of(asked: Sequence[Part], done: Mapping[int, list[AssistedFlights]]) -> dict[str, list[AssistedFlights]]:
    """Return the rows of both tables from those of all parts."""
    rows = {
        name: [done[index] for index, part in enumerate(asked) if part.table == name] for name in (ONE_PAD, THREE_PADS)
    }
    return {ONE_PAD: [row for each in rows[ONE_PAD] for row in each], THREE_PADS: mean_rows(rows[THREE_PADS])}
