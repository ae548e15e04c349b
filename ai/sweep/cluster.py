"""Ray, as this program starts or joins it: one thread to a worker, nothing open to the network unless asked for.

Comes with the extra `sweep`. Nothing of Ray is imported before it is used.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final, TypeVar

MISSING: Final = 'this needs Ray and Optuna: pip install -e ".[sweep]"'
LOOPBACK: Final = "127.0.0.1"
_ROOT: Final = Path(__file__).parents[2]
_STORE: Final = 256 << 20  # bytes of Ray's object store on one machine; results are some hundred KB each
_QUIET: Final = {
    "RAY_USAGE_STATS_ENABLED": "0",  # Ray reports its use by default
    "RAY_AIR_NEW_OUTPUT": "0",  # with verbose=0, Tune then prints nothing; the table is ours
    "RAY_TRAIN_ENABLE_V2_MIGRATION_WARNINGS": "0",
    "TUNE_DISABLE_AUTO_CALLBACK_LOGGERS": "1",  # results are kept once, in the study
    "TUNE_DISABLE_SIGINT_HANDLER": "1",  # Ctrl-C is ours too
    "TUNE_GLOBAL_CHECKPOINT_S": "1000000",  # and so is what a killed driver goes on from
    "TUNE_WARN_THRESHOLD_S": "60",
}
# Ray binds its ports to the loopback interface alone only if it takes itself to be on a system without clusters; by
# itself, "127.0.0.1" is replaced by the machine's address on the network, and the ports are open to all.
_LOCAL: Final = {"RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER": "0"}

Item = TypeVar("Item")
Result = TypeVar("Result")


def installed() -> bool:
    """Whether the extra is there."""
    return find_spec("ray") is not None and find_spec("optuna") is not None


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def worker_environment() -> dict[str, str]:
    """Return the environment of workers: our own code first, and one thread, as `train` has."""
    path = os.pathsep.join([str(_ROOT), *filter(None, [os.environ.get("PYTHONPATH", "")])])
    threads = {f"{library}_NUM_THREADS": "1" for library in ("OPENBLAS", "OMP", "MKL")}
    return {"PYTHONPATH": path, **threads}


@contextmanager
def joined(address: str | None = None, workers: int | None = None) -> Iterator[int]:
    """Start Ray on this machine, or join the cluster at an address; yield the number of cores there are for workers.

    Raises ImportError without the extra, ConnectionError where no cluster answers.
    """
    if not installed():
        raise ImportError(MISSING)
    if "ray" not in sys.modules and (address is None or _is_local(address)):
        os.environ.update(_LOCAL)  # read when Ray is imported
    os.environ.update(_QUIET)
    import ray

    quiet: dict[str, Any] = {"log_to_driver": False, "logging_level": "ERROR"}
    if address is not None:
        ray.init(address=address, runtime_env={"env_vars": worker_environment()}, **quiet)
    else:
        with _environment(worker_environment()):
            ray.init(address="local", num_cpus=workers or cores(), include_dashboard=False, _node_ip_address=LOOPBACK,
                     object_store_memory=_STORE, **quiet)  # fmt: skip
    try:
        if address is None and (opened := _opened()):
            raise ConnectionError(f"Ray would listen on {opened}, and not on this machine alone; nothing was started")
        count = int(ray.cluster_resources().get("CPU", 1))
        # Trials that wait for a worker: one is enough for a search that learns, but fills a large cluster slowly.
        os.environ["TUNE_MAX_PENDING_TRIALS_PG"] = str(max(1, count // 8))
        yield count
    finally:
        ray.shutdown()


def _is_local(address: str) -> bool:
    """Whether an address leads to this machine by its loopback interface."""
    return address.removeprefix("ray://").startswith(("127.", "localhost", "[::1]"))


def _opened() -> str:
    """Return the address that Ray's node has on the network; empty if it is the loopback address."""
    import ray

    node = ray.util.get_node_ip_address()
    return "" if node == LOOPBACK else str(node)


@contextmanager
def _environment(values: Mapping[str, str]) -> Iterator[None]:
    """Set variables of the environment while a block runs; processes started there keep them."""
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def each(
    function: Callable[[Item], Result],
    items: Sequence[Item],
    address: str | None = None,
    workers: int | None = None,
) -> Iterator[tuple[int, Result]]:
    """Yield the place of each item and what a function gives for it, as they are done, on many cores.

    On one core of this machine the function is simply called: Ray is started for more, or with an address. A call
    whose worker or node dies is made again elsewhere. `function` is one of a module, and depends on nothing else.
    """
    if address is None and (workers or cores()) == 1:
        yield from ((index, function(item)) for index, item in enumerate(items))
        return
    with joined(address, workers) as count:
        import ray

        remote = ray.remote(num_cpus=1, max_retries=4)(function)
        waiting: dict[Any, int] = {}
        left = list(enumerate(items))[::-1]
        while left or waiting:
            while left and len(waiting) < 2 * count:
                index, item = left.pop()
                waiting[remote.remote(item)] = index
            for done in ray.wait(list(waiting))[0]:
                yield waiting.pop(done), ray.get(done)
