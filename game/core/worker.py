"""Runs a generator, a training above all, in a process of its own. The window never waits for it."""

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
from game.core.worker_process import CREDIT, Bundle, Function, serve

PATIENCE: Final = 30.0  # seconds without an answer after which a process counts as hung
STOP_SECONDS: Final = 3.0  # to come to an end when asked
_LONGEST_FRAME: Final = 0.25  # what counts of the time between two polls: the rest, the window itself was away
_LONGEST_BUNDLE: Final = 1 << 29  # bytes; no process that is in its right mind tells more at once
_log = logging.getLogger("tranquility")


class State(Enum):
    """How a worker stands."""

    STARTING = auto()
    RUNNING = auto()
    PAUSED = auto()
    ENDED = auto()  # the generator has finished, or was stopped
    FAILED = auto()  # `problem` says why


class Worker:
    """A child process that pulls `function(*args, **kwargs)`, any picklable function that returns a generator.

    Every turn of the generator yields an iterable of messages; `poll` returns them here. A class of messages may
    say `newest_only = True`: of these only the latest comes across; or `may_thin = True`: of these some may be
    left out when nobody asks for long. The first turn is taken at once. A command that is sent makes a turn of
    its own, also while paused. Nothing but `close` ever waits, and the process ends with the window, however
    that ends. The reasons are in docs/adr/0011-training-in-a-process-of-its-own.md.
    """

    def __init__(self, function: Function, *args: Any, **kwargs: Any) -> None:
        self.problem = ""
        self.patience = PATIENCE
        self.clock: Callable[[], float] = time.monotonic
        self._paused = self._heard = self._lost = False
        self._wanted = CREDIT  # bundles asked for and not yet come; the process knows of the first
        self._over: State | None = None
        self._deadline: float | None = None  # for it to have ended by itself
        self._silence = 0.0
        self._polled = self.clock()
        self._inbox: SimpleQueue[Bundle | Exception | None] = SimpleQueue()
        self._orders: SimpleQueue[bytes | None] = SimpleQueue()
        context = get_context("spawn")
        payload = pickle.dumps((function, args, kwargs))
        connection, theirs = context.Pipe()
        self._process = context.Process(target=serve, args=(theirs, payload), daemon=True)
        threads = (
            Thread(target=_read, args=(connection, self._inbox), daemon=True),
            Thread(target=_write, args=(connection, self._orders), daemon=True),
        )
        self._release = weakref.finalize(self, _end, self._process, connection, self._orders, threads)
        # The exit of multiprocessing would wait for a child that is stopped in its tracks: this one comes before it.
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
    def state(self) -> State:
        """How it stands now, as far as `poll` has heard."""
        if self._over is not None:
            return self._over
        if not self._heard:
            return State.STARTING
        return State.PAUSED if self._paused else State.RUNNING

    @property
    def gone(self) -> bool:
        """Whether it is over and nothing is left of its process; `poll` sees to it."""
        return not self._release.alive

    def poll(self) -> list[Any]:
        """Return all messages that have come since; call it once a frame. Never waits."""
        told: list[Any] = []
        while not self._inbox.empty():
            told += self._hear(self._inbox.get_nowait())
        now = self.clock()
        self._silence += min(now - self._polled, _LONGEST_FRAME)
        self._polled = now
        if self._over is None:
            self._look_after(now)
        if self._over is not None:
            self._clear_up(now)
        else:
            self._ask()
        return told

    def pause(self) -> None:
        """Take no more turns, and no time of the processor."""
        self._paused = True
        self._order("pause")

    def resume(self) -> None:
        """Go on."""
        self._paused = False
        self._order("resume")

    def step(self) -> None:
        """Take one turn while paused."""
        if self._paused:
            self._order("step")

    def set_pace(self, per_second: float | None) -> None:
        """Take so many turns a second at the most; with None, as many as there is time for."""
        self._order("pace", per_second)

    def send(self, command: Any) -> None:
        """Send a command into the generator; the answer comes with `poll`."""
        self._order("command", command)

    def stop(self) -> None:
        """Ask it to end, and let `poll` end it if it does not within a few seconds."""
        if self._over is None and self._deadline is None:
            self._order("stop")
            self._deadline = self.clock() + STOP_SECONDS

    def close(self, grace: float = 0.5) -> None:
        """End it for certain, after waiting so many seconds for it to end by itself. For leaving."""
        if self._over is None:
            self._order("stop")
            self._over = State.ENDED
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

    def _hear(self, told: Bundle | Exception | None) -> list[Any]:
        """Take in one thing the process said; None is the end of the line."""
        if isinstance(told, Bundle):
            self._wanted, self._heard, self._silence = self._wanted - 1, True, 0.0
            if told.ended and self._over is None:
                if told.trace:
                    _log.error("in the worker:\n%s", told.trace)
                if told.problem:
                    self._fail(texts.WORKER_RAISED.format(reason=told.problem), STOP_SECONDS)
                else:
                    self._finish(STOP_SECONDS)
            return told.messages
        if told is None:
            self._lost = True
        elif self._over is None:
            _log.error("a worker's message cannot be read", exc_info=told)
            self._fail(texts.WORKER_NONSENSE.format(reason=told))
        return []

    def _look_after(self, now: float) -> None:
        """Notice a process that died, hangs, or was asked to stop and does not."""
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
        self._over, self.problem = State.FAILED, problem

    def _finish(self, grace: float = 0.0) -> None:
        """Count it as ended; its process has so many seconds to be gone."""
        self._over, self._deadline = State.ENDED, self.clock() + grace

    def _clear_up(self, now: float) -> None:
        """Get rid of what is left, without waiting for any of it."""
        if not self._release.alive:
            return
        if not self._process.is_alive():
            self._let_go()
        elif self._deadline is not None and now >= self._deadline:
            self._process.kill()

    def _let_go(self) -> None:
        self._release()
        atexit.unregister(self._release)


def _read(connection: Connection, inbox: SimpleQueue[Bundle | Exception | None]) -> None:
    """Receive in a thread: half a message from a process that was stopped in the middle of it would block."""
    try:
        while True:
            inbox.put(_understood(connection.recv_bytes(_LONGEST_BUNDLE)))
    except (EOFError, OSError):
        inbox.put(None)


def _understood(message: bytes) -> Bundle | Exception:
    try:
        bundle = pickle.loads(message)
    except Exception as error:  # from bytes that make no sense, anything can come
        return error
    return bundle if isinstance(bundle, Bundle) else TypeError(f"{type(bundle).__name__}")


def _write(connection: Connection, orders: SimpleQueue[bytes | None]) -> None:
    """Send in a thread: a process that does not read must not hold up the window."""
    try:
        for order in iter(orders.get, None):
            connection.send_bytes(order)
    except OSError:
        pass  # the reader notices as well, and says so


def _end(
    process: BaseProcess, connection: Connection, orders: SimpleQueue[bytes | None], threads: Iterable[Thread]
) -> None:
    """Leave nothing behind: no process, no thread, no open end."""
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
