"""Many measurements at once, each in a process of its own."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from typing import TypeVar

Asked = TypeVar("Asked")
Result = TypeVar("Result")


def results(measure: Callable[[Asked], Result], asked: Sequence[Asked], processes: int) -> list[Result]:
    """Return what is measured of each, in their order; one process is this one."""
    if processes == 1:
        return list(map(measure, asked))
    with ProcessPoolExecutor(processes, multiprocessing.get_context("spawn")) as pool:
        return list(pool.map(measure, asked))
