"""Evaluation of very many flights in shards, the co-pilot's tables in parts: tasks for many processes of this machine.

Flight i begins as the i-th of one large batch of the same seed would, whichever shard flies it. A shard is always the
same number of flights. So the counts are the same bit for bit, however many processes there are; and sums are taken in
the order of the shards. Each process reads the network from its folder.
"""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import partial
from pathlib import Path
from typing import Final, TypeVar

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.copilot import measurement
from ai.copilot.measurement import AssistedFlights, Help
from ai.environment import Doubles, finished
from ai.lander.environment import LanderEnv
from ai.training.config import Config
from ai.training.tasks import flown

SHARD: Final = 10_000  # flights at once, in 5 KB each
PILOTS: Final = 32  # of a part of a table: the more fly at once, the less time each takes

Result = TypeVar("Result")


def results(
    tasks: Sequence[Callable[[], Result]], processes: int = 1, report: Callable[[], object] = lambda: None
) -> list[Result]:
    """Return what each task returns, in their order, from so many processes; `report` is called as each is done.

    One process is this one. Raises BrokenProcessPool, a RuntimeError, if one dies.
    """
    if processes == 1:
        done = []
        for task in tasks:
            done.append(task())
            report()
        return done
    with ProcessPoolExecutor(processes, multiprocessing.get_context("spawn")) as pool:
        futures = [pool.submit(task) for task in tasks]
        for _ in as_completed(futures):
            report()
        return [future.result() for future in futures]


def fly(model: Path, flights: range, seed: int, spawn: str) -> Doubles:
    """Fly some flights of an evaluation, by their numbers; return their sums (`ai.training.tasks.flown`)."""
    agent = DeepQAgent.load(model)
    env = LanderEnv(len(flights), seed, spawn, Config.of(agent).frame_skip)
    for slot, number in enumerate(flights):
        # The generator that number `number` of a batch gets, which NumPy spawns from the seed.
        env.streams[slot] = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(number,)))
    env.reset()
    return finished(flown(agent, env))


def shards(model: Path, episodes: int, seed: int, spawn: str) -> list[partial[Doubles]]:
    """Return the shards of an evaluation of the network in a folder, as tasks; their sums add up."""
    parts = [range(first, min(episodes, first + SHARD)) for first in range(0, episodes, SHARD)]
    return [partial(fly, model, flights, seed, spawn) for flights in parts]


def fly_part(
    model: Path, table: str, names: Sequence[str], helps: Sequence[Help], episodes: int, seed: int
) -> list[AssistedFlights]:
    """Fly a part of a table; what comes of it does not depend on the others."""
    agent = DeepQAgent.load(model)
    return measurement.rows(agent, agent, table, names, helps, episodes, seed)


def parts_of(
    models: Mapping[str, Path], helps: Sequence[Help], episodes: int, seed: int
) -> list[tuple[str, Callable[[], list[AssistedFlights]]]]:
    """Return the co-pilot's tables by name, in parts of some pilots each: `models` have the co-pilots of the tables."""
    return [
        (table, partial(fly_part, model, table, names[first:][:PILOTS], helps, episodes, seed))
        for table, model in models.items()
        for names in [measurement.TABLES[table][1]]
        for first in range(0, len(names), PILOTS)
    ]
