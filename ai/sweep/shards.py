"""Evaluation of very many flights in shards, the co-pilot's tables in parts: tasks for many processes of this machine.

Flight i begins as the i-th of one large batch of the same seed would, whichever shard flies it. A shard is always the
same number of flights. So the counts are the same bit for bit, however many processes there are; and sums are taken in
the order of the shards.
"""

from __future__ import annotations

import multiprocessing
import tempfile
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import partial
from pathlib import Path
from typing import Final, TypeVar

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.storage import write_agent
from ai.copilot import measurement
from ai.copilot.measurement import AssistedFlights, Help
from ai.environment import Doubles
from ai.lander.environment import LanderEnv
from ai.lander.pilots import Pilot, ScriptedPilot
from ai.sweep.study import Files, files_in, write_files
from ai.training.config import Config
from ai.training.tasks import finished, flown

SHARD: Final = 10_000  # flights at once, in 5 KB each
PILOTS: Final = 32  # of a part of a table: the more fly at once, the less time each takes

Result = TypeVar("Result")


def results(
    tasks: Sequence[Callable[[], Result]], processes: int = 1, told: Callable[[], object] = lambda: None
) -> list[Result]:
    """Return what each task returns, in their order, from so many processes; `told` is called as each is done.

    One process is this one. Raises BrokenProcessPool, a RuntimeError, if one dies.
    """
    done: dict[int, Result] = {}
    if processes == 1:
        for index, task in enumerate(tasks):
            done[index] = task()
            told()
    else:
        with ProcessPoolExecutor(processes, multiprocessing.get_context("spawn")) as pool:
            places = {pool.submit(task): index for index, task in enumerate(tasks)}
            for future in as_completed(places):
                done[places[future]] = future.result()
                told()
    return [done[index] for index in range(len(tasks))]


def packed(agent: DeepQAgent) -> Files:
    """Return an agent as files: what was read of it and checked, and no file as it lies."""
    with tempfile.TemporaryDirectory() as folder:
        write_agent(agent, Path(folder))
        return files_in(Path(folder))


def received(files: Files) -> DeepQAgent:
    """Return the agent that was `packed`."""
    with tempfile.TemporaryDirectory() as folder:
        write_files(files, Path(folder))
        return DeepQAgent.load(folder)


def fly(files: Files, flights: range, seed: int, spawn: str) -> Doubles:
    """Fly some flights of an evaluation, by their numbers; return their sums (`ai.training.tasks.flown`)."""
    agent = received(files)
    env = LanderEnv(len(flights), seed, spawn, Config.of(agent).frame_skip)
    for slot, number in enumerate(flights):
        # The generator that number `number` of a batch gets, which NumPy spawns from the seed.
        env.streams[slot] = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(number,)))
    env.reset()
    return finished(flown(agent, env))


def shards(agent: DeepQAgent, episodes: int, seed: int, spawn: str) -> list[partial[Doubles]]:
    """Return the shards of an evaluation of an agent, as tasks; their sums add up."""
    files, parts = packed(agent), [range(first, min(episodes, first + SHARD)) for first in range(0, episodes, SHARD)]
    return [partial(fly, files, flights, seed, spawn) for flights in parts]


def fly_part(
    files: Files, scripted: bool, table: str, names: Sequence[str], helps: Sequence[Help], episodes: int, seed: int
) -> list[AssistedFlights]:
    """Fly a part of a table; what comes of it does not depend on the others."""
    agent = received(files)
    good: Pilot = ScriptedPilot() if scripted else agent
    return measurement.rows(agent, good, table, names, helps, episodes, seed)


def parts_of(
    agents: Mapping[str, DeepQAgent], scripted: bool, helps: Sequence[Help], episodes: int, seed: int
) -> list[tuple[str, Callable[[], list[AssistedFlights]]]]:
    """Return the co-pilot's tables by name, in parts of some pilots each: `agents` are the co-pilots of the tables.

    Some pilots are made of a good one: the `scripted` one, or the co-pilot's network.
    """
    return [
        (table, partial(fly_part, files, scripted, table, names[first:][:PILOTS], helps, episodes, seed))
        for table, agent in agents.items()
        for files, names in [(packed(agent), measurement.TABLES[table][1])]
        for first in range(0, len(names), PILOTS)
    ]
