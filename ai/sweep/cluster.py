"""Ray, as this program starts or joins it: one thread to a worker, nothing open to the network unless asked for.

Comes with the extra `sweep`. Nothing of Ray is imported before it is used.
"""

from __future__ import annotations

import os
import re
import secrets
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

MISSING: Final = 'this needs Ray and Optuna: pip install -e ".[sweep]"'
LOOPBACK: Final = "127.0.0.1"
_ROOT: Final = Path(__file__).parents[2]
_STORE: Final = 256 << 20  # bytes of Ray's object store on one machine; results are some hundred KB each
# Ray binds its ports to the loopback interface alone only if it takes itself to be on a system without clusters; by
# itself, "127.0.0.1" is replaced by the machine's address on the network, and the ports are open to all.
LOCAL: Final = {"RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER": "0"}
_PATIENCE: Final = 5.0  # seconds in which a cluster has to answer; Ray itself waits for minutes


def installed() -> bool:
    """Whether the extra is there."""
    return find_spec("ray") is not None and find_spec("optuna") is not None


def worker_environment() -> dict[str, str]:
    """Return the environment of workers: our own code first, and one thread, as `train` has."""
    path = os.pathsep.join(filter(None, [str(_ROOT), os.environ.get("PYTHONPATH")]))
    return {"PYTHONPATH": path} | {f"{library}_NUM_THREADS": "1" for library in ("OPENBLAS", "OMP", "MKL")}


@contextmanager
def joined(address: str | None = None) -> Iterator[int]:
    """Start Ray on this machine, or join the cluster at an address; yield the number of cores there are for workers.

    Raises ConnectionError where no cluster answers or its token is another, ValueError for an address that is none.
    """
    os.environ["RAY_USAGE_STATS_ENABLED"] = "0"  # Ray reports its use by default
    if address is None:
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        # A token that only this process and those it starts know. Ray's own would stay in the user's home.
        token = {"RAY_AUTH_MODE": "token", "RAY_AUTH_TOKEN": secrets.token_hex(32)}
        os.environ.update(LOCAL | token | worker_environment())
        options: dict[str, Any] = {"address": "local", "num_cpus": cores, "include_dashboard": False}
        options |= {"_node_ip_address": LOOPBACK, "object_store_memory": _STORE}
    else:
        options = {"address": answering(address), "runtime_env": {"env_vars": worker_environment()}}
    import ray

    try:
        try:
            ray.init(log_to_driver=False, logging_level="ERROR", **options)
        except (ConnectionError, ray.exceptions.AuthenticationError) as error:
            named = "the token in RAY_AUTH_TOKEN or ~/.ray/auth_token may be missing or another cluster's"
            raise ConnectionError(f"could not join the cluster at {options['address']}: {named}") from error
        if address is None and (opened := ray.util.get_node_ip_address()) != LOOPBACK:
            raise ConnectionError(f"Ray would listen on {opened}, and not on this machine alone; nothing was started")
        yield int(ray.cluster_resources().get("CPU", 1))
    finally:
        ray.shutdown()


def answering(address: str) -> str:
    """Return an address; raises ValueError for none, ConnectionError unless something answers there."""
    if (parts := re.fullmatch(r"\[?([^/\[\]]+)\]?:(\d+)", address)) is None:
        raise ValueError(f"--address is HOST:PORT, not {address}")
    if parts[1].startswith(("127.", "localhost", "::1")):
        os.environ.update(LOCAL)
    try:
        socket.create_connection((parts[1], int(parts[2])), _PATIENCE).close()
    except (OSError, OverflowError, UnicodeError) as error:
        raise ConnectionError(f"no cluster answers at {address}: {getattr(error, 'strerror', '') or error}") from error
    return address
