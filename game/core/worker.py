"""Worker process: runs a generator, such as a training, in a child process. The window never waits for it."""

from __future__ import annotations

import atexit
import logging
import pickle
import signal
import time
import weakref
from collections.abc import Callable, Iterable
from enum import Enum, auto
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from queue import SimpleQueue
from threading import Thread
from typing import Any, Final

from game.core import texts
from game.core.worker_process import CREDIT, NICENESS, Function, MessageBatch, serve

PATIENCE: Final = 30.0  # seconds without an answer after which a process counts as hung
STOP_SECONDS: Final = 3.0  # seconds to end after a request to stop
_LONGEST_FRAME: Final = 0.25  # seconds counted between two polls at most: for longer, the window itself was stalled
_LONGEST_BUNDLE: Final = 1 << 29  # bytes; only a faulty process sends more at once
_log = logging.getLogger("tranquility")


class WorkerState(Enum):
    """State of a worker."""

    STARTING = auto()
    RUNNING = auto()
    PAUSED = auto()
    ENDED = auto()  # the generator finished or was stopped
    FAILED = auto()  # `problem` says why


class Worker:
    """A child process that pulls `function(*args, **kwargs)`, any picklable function that returns a generator.

    Every turn of the generator yields an iterable of messages; `poll` returns them here. A class of messages may
    say `newest_only = True`: of these only the latest comes across; or `may_thin = True`: of these some may be
    left out when nobody asks for long. The first turn is taken at once. A command that is sent makes a turn of
    its own, also while paused. After a turn that yields None, the next is that of a command. Nothing but `close`
    ever waits, and the process ends with the window, however that ends. The reasons are in
    docs/adr/0011-training-in-a-process-of-its-own.md.
    """

    niceness = NICENESS

    def __init__(self, function: Function, *args: Any, **kwargs: Any) -> None:
        self.problem = ""
        self.patience = PATIENCE
        self.clock: Callable[[], float] = time.monotonic
        self._paused = self._heard = self._lost = False
        self._wanted = CREDIT  # bundles requested but not yet received; the process starts with the first request
        self._over: WorkerState | None = None
        self._deadline: float | None = None  # deadline for it to end by itself
        self._silence = 0.0
        self._polled = self.clock()
        self._inbox: SimpleQueue[MessageBatch | Exception | None] = SimpleQueue()
        self._orders: SimpleQueue[bytes | None] = SimpleQueue()
        context = get_context("spawn")
        payload = pickle.dumps((function, args, kwargs))
        connection, theirs = context.Pipe()
        # No daemon, as such a process may have no children: those that fly and pay from the player's files.
        self._process = context.Process(target=serve, args=(theirs, payload, self.niceness))
        threads = (
            Thread(target=_read, args=(connection, self._inbox), daemon=True),
            Thread(target=_write, args=(connection, self._orders), daemon=True),
        )
        self._release = weakref.finalize(self, _end, self._process, connection, self._orders, threads)
        # Runs before multiprocessing's own exit handler, which would wait for ever for the child.
        atexit.register(self._release)
        try:
            self._process.start()
        except OSError as error:
            self._fail(texts.WORKER_NOT_STARTED.format(reason=error.strerror or error))
            self._let_go()
            return
        finally:
            theirs.close()
        for thread in threads:
            thread.start()

    @property
    def state(self) -> WorkerState:
        """State as of the last `poll`."""
        if self._over is not None:
            return self._over
        if not self._heard:
            return WorkerState.STARTING
        return WorkerState.PAUSED if self._paused else WorkerState.RUNNING

    @property
    def process_id(self) -> int | None:
        """Number of the process in the operating system; None if it could not be started."""
        return self._process.pid

    @property
    def gone(self) -> bool:
        """Whether the worker has ended and its process is cleaned up, which `poll` does."""
        return not self._release.alive

    def poll(self) -> list[Any]:
        """Return all messages received since the last call; call it once a frame. Never waits."""
        messages: list[Any] = []
        while not self._inbox.empty():
            messages += self._hear(self._inbox.get_nowait())
        now = self.clock()
        self._silence += min(now - self._polled, _LONGEST_FRAME)
        self._polled = now
        if self._over is None:
            self._look_after(now)
        if self._over is not None:
            self._clear_up(now)
        else:
            self._ask()
        return messages

    def pause(self) -> None:
        """Pause the generator; a paused worker uses no processor time."""
        self._paused = True
        self._order("pause")

    def resume(self) -> None:
        """Resume the generator after a pause."""
        self._paused = False
        self._order("resume")

    def set_pace(self, per_second: float | None) -> None:
        """Limit the generator to `per_second` turns a second; None for no limit."""
        self._order("pace", per_second)

    def set_limit(self, turns: int | None) -> None:
        """Let the generator take so many turns in all, besides those of commands, and then wait; None for no limit."""
        self._order("limit", turns)

    def send(self, command: Any) -> None:
        """Send a command into the generator; its answer arrives with `poll`."""
        self._order("command", command)

    def stop(self) -> None:
        """Ask the worker to end; `poll` ends its process if it does not within a few seconds."""
        if self._over is None and self._deadline is None:
            self._order("stop")
            self._deadline = self.clock() + STOP_SECONDS

    def close(self, grace: float = 0.5) -> None:
        """End the process for certain, after waiting at most `grace` seconds for it to end by itself."""
        if self._over is None:
            self._order("stop")
            self._over = WorkerState.ENDED
        if self._release.alive:
            self._process.join(grace)
            self._let_go()

    def _ask(self) -> None:
        if self._wanted < CREDIT:
            self._order("ask", CREDIT - self._wanted)
            self._wanted = CREDIT

    def _order(self, name: str, value: Any = None) -> None:
        if self._over is None:
            self._orders.put(pickle.dumps((name, value)))

    def _hear(self, received: MessageBatch | Exception | None) -> list[Any]:
        """Handle one bundle, or a reading error, from the process; None means that the connection has closed."""
        if isinstance(received, MessageBatch):
            self._wanted, self._heard, self._silence = self._wanted - 1, True, 0.0
            if received.ended and self._over is None:
                if received.trace:
                    _log.error("in the worker:\n%s", received.trace)
                if received.problem:
                    self._fail(texts.WORKER_RAISED.format(reason=received.problem), STOP_SECONDS)
                else:
                    self._finish(STOP_SECONDS)
            return received.messages
        if received is None:
            self._lost = True
        elif self._over is None:
            _log.error("a worker's message cannot be read", exc_info=received)
            self._fail(texts.WORKER_NONSENSE.format(reason=received))
        return []

    def _look_after(self, now: float) -> None:
        """Detect a process that died, hangs, or does not stop after a request."""
        if self._lost and not self._process.is_alive():
            if self._deadline is not None:
                self._finish()
            else:
                self._fail(_cause_of_death(self._process.exitcode))
        elif self._deadline is not None and now > self._deadline:
            self._finish()
        elif self._silence > self.patience:
            self._fail(texts.WORKER_SILENT.format(seconds=self.patience))

    def _fail(self, problem: str, grace: float = 0.0) -> None:
        self._finish(grace)
        self._over, self.problem = WorkerState.FAILED, problem

    def _finish(self, grace: float = 0.0) -> None:
        """Mark the worker as ended; its process has `grace` seconds to exit."""
        self._over, self._deadline = WorkerState.ENDED, self.clock() + grace

    def _clear_up(self, now: float) -> None:
        """Release the process, its threads and its connection, without waiting."""
        if not self._release.alive:
            return
        if not self._process.is_alive():
            self._let_go()
        elif self._deadline is not None and now >= self._deadline:
            self._process.kill()

    def _let_go(self) -> None:
        self._release()
        atexit.unregister(self._release)


def _read(connection: Connection, inbox: SimpleQueue[MessageBatch | Exception | None]) -> None:
    """Receive in a thread: half a message from a process suspended in the middle of it would block the window."""
    try:
        while True:
            inbox.put(_understood(connection.recv_bytes(_LONGEST_BUNDLE)))
    except (EOFError, OSError):
        inbox.put(None)


def _understood(message: bytes) -> MessageBatch | Exception:
    try:
        bundle = pickle.loads(message)
    except Exception as error:  # corrupt bytes can raise any exception
        return error
    return bundle if isinstance(bundle, MessageBatch) else TypeError(f"{type(bundle).__name__}")


def _write(connection: Connection, orders: SimpleQueue[bytes | None]) -> None:
    """Send in a thread: a process that does not read must not block the window."""
    try:
        for order in iter(orders.get, None):
            connection.send_bytes(order)
    except OSError:
        pass  # the reader notices as well, and reports it


def _end(
    process: BaseProcess, connection: Connection, orders: SimpleQueue[bytes | None], threads: Iterable[Thread]
) -> None:
    """End the process and the threads, and close the connection."""
    if process.pid is not None:
        if process.is_alive():
            process.kill()
        process.join(1.0)
        orders.put(None)
        for thread in threads:
            thread.join(1.0)
    connection.close()


def _cause_of_death(code: int | None) -> str:
    if code is None or code >= 0:
        return texts.WORKER_EXITED.format(code=code)
    killed = code == -getattr(signal, "SIGKILL", 9)
    try:
        name = signal.Signals(-code).name
    except ValueError:
        name = str(-code)
    return (texts.WORKER_KILLED if killed else texts.WORKER_SIGNAL).format(signal=name)
