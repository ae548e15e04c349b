"""Ray, as this program starts or joins it: one thread to a worker, nothing open to the network unless asked for.

Comes with the extra `sweep`. Nothing of Ray is imported before it is used.
"""

from __future__ import annotations

import os
import re
import secrets
import signal
import socket
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

from ai.files import brief

MISSING: Final = 'this needs Ray and Optuna: pip install -e ".[sweep]"'
LOOPBACK: Final = "127.0.0.1"
_ROOT: Final = Path(__file__).parents[2]
_STORE: Final = 256 << 20  # bytes of Ray's object store on one machine; results are some hundred KB each
_QUIET: Final = {"RAY_USAGE_STATS_ENABLED": "0"}  # Ray reports its use by default
# Ray binds its ports to the loopback interface alone only if it takes itself to be on a system without clusters; by
# itself, "127.0.0.1" is replaced by the machine's address on the network, and the ports are open to all.
_LOCAL: Final = {"RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER": "0"}
# A token that only this process and those it starts know. Ray's own would stay in the user's home, readable for all.
_TOKEN: Final = {"RAY_AUTH_MODE": "token", "RAY_AUTH_TOKEN": secrets.token_hex(32)}
_PATIENCE: Final = 5.0  # seconds in which a cluster has to answer; Ray itself waits for minutes
# How a client of HTTP/2 begins, with settings that are empty; a server, as all of Ray's are, answers with its own.
_PREFACE: Final = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + bytes([0, 0, 0, 4, 0, 0, 0, 0, 0])


def installed() -> bool:
    """Whether the extra is there."""
    return find_spec("ray") is not None and find_spec("optuna") is not None


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def worker_environment() -> dict[str, str]:
    """Return the environment of workers: our own code first, and one thread, as `train` has."""
    path = os.pathsep.join(filter(None, [str(_ROOT), os.environ.get("PYTHONPATH")]))
    return {"PYTHONPATH": path} | {f"{library}_NUM_THREADS": "1" for library in ("OPENBLAS", "OMP", "MKL")}


@contextmanager
def joined(address: str | None = None, workers: int | None = None) -> Iterator[int]:
    """Start Ray on this machine, or join the cluster at an address; yield the number of cores there are for workers.

    Raises ImportError without the extra, ConnectionError where no cluster answers or its token is another, ValueError
    for an address that is none.
    """
    if not installed():
        raise ImportError(MISSING)
    if address is None:
        os.environ.update(_LOCAL | _QUIET | _TOKEN | worker_environment())
        options: dict[str, Any] = {"address": "local", "num_cpus": workers or cores(), "include_dashboard": False}
        options |= {"_node_ip_address": LOOPBACK, "object_store_memory": _STORE}
    else:
        options = {"address": answering(address), "runtime_env": {"env_vars": worker_environment()}}
    import ray
    from ray._private import worker

    worker.print_to_stdstream = _print_lost
    try:
        try:
            with _own_signals():
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
    """Return an address; raises ValueError for none, ConnectionError unless a server like Ray's answers there."""
    if address.removeprefix("ray://").startswith(("127.", "localhost", "[::1]")):
        os.environ.update(_LOCAL)
    os.environ.update(_QUIET)
    if (parts := re.fullmatch(r"(?:ray://)?\[?([^/\[\]]+)\]?:(\d+)", address)) is None:
        raise ValueError(f"--address is HOST:PORT, not {address}")
    try:
        with socket.create_connection((parts[1], int(parts[2])), _PATIENCE) as link:
            link.settimeout(_PATIENCE)
            link.sendall(_PREFACE)
            answer = link.recv(9)
    except (OSError, OverflowError, UnicodeError) as error:
        raise ConnectionError(f"no cluster answers at {address}: {getattr(error, 'strerror', '') or error}") from error
    if "RAY_USE_TLS" not in os.environ and answer[3:4] != b"\4":
        raise ConnectionError(f"what answers at {address} is no head of a Ray cluster")
    return address


@contextmanager
def _own_signals() -> Iterator[None]:
    """Keep SIGTERM ours while Ray begins in a block: it waits meanwhile, and does afterwards what it did before.

    Ray and its library in C++ take it for themselves, and would end the program in the midst of a trial. Processes that
    Ray starts are a group of their own, so that a signal to ours, as `timeout` sends it, does not end them first.
    """
    if not hasattr(signal, "pthread_sigmask") or threading.current_thread() is not threading.main_thread():
        yield
        return
    from ray._private import services

    def begin(*arguments: Any, preexec_fn: Callable[[], None] = lambda: None, **options: Any) -> Any:
        def prepare() -> None:
            preexec_fn()
            signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})

        return popen(*arguments, preexec_fn=prepare, process_group=0, **options)

    popen, before = services.ConsolePopen, signal.getsignal(signal.SIGTERM)
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM})
    services.ConsolePopen = begin
    try:
        yield
    finally:
        services.ConsolePopen = popen
        signal.signal(signal.SIGTERM, before)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


def _print_lost(news: Mapping[str, Any], ignore_prefix: bool = False) -> None:  # noqa: ARG001 - as Ray calls it
    """Print what Ray says of workers and nodes that die, a line each: it would print pages among our results."""
    for text in news["lines"]:
        print(f"Ray: {brief(text.strip().partition('. ')[0].replace(chr(10), ' '))}", file=sys.stderr)
