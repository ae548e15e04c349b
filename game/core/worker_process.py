"""Child-process side of a worker: runs the generator, and sends its messages on request.

This module must not import pygame or NumPy: the child process is configured before either is loaded.
"""

from __future__ import annotations

import os
import pickle
import signal
import time
import traceback
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import cycle
from multiprocessing.connection import Connection
from queue import Empty, SimpleQueue
from threading import Thread
from typing import Any, Final, Protocol

HEARTBEAT: Final = 1.0  # seconds after which it answers even without messages
GRACE: Final = 3.0  # seconds to end in once the window has closed
CREDIT: Final = 2  # bundles requested ahead: with one, every other turn would pass while the request is under way
MOST_WAITING: Final = 2000  # waiting messages above which some of those with `may_thin` are dropped
MOST_AT_ONCE: Final = 250
NICENESS: Final = 5  # the window goes first
_LONGEST: Final = 300  # characters of a problem: an error's text can have any length

Order = tuple[str, Any]


class Turns(Protocol):
    """What a worker pulls: a generator that takes commands, or what looks like one."""

    def __next__(self) -> Iterable[Any] | None:
        """Take a turn; return its messages."""

    def send(self, command: Any, /) -> Iterable[Any] | None:
        """Take a turn that carries out a command; return its messages."""

    def close(self) -> object:
        """End: there are no more turns."""


Function = Callable[..., Turns]


@dataclass
class MessageBatch:
    """Messages that a worker's process sends at once. An end without `problem` is a success."""

    messages: list[Any] = field(default_factory=list)
    ended: bool = False
    problem: str = ""
    trace: str = ""  # for the log


class MessageQueue:
    """Queue of messages not yet fetched.

    Of a class with `newest_only`, only the latest is kept. Of those with `may_thin`, every other one is dropped when
    too many wait. All others stay, in order.
    """

    def __init__(self) -> None:
        self._queue: list[Any] = []
        self._newest: dict[type, Any] = {}
        self._limit = MOST_WAITING

    def __bool__(self) -> bool:
        return bool(self._queue or self._newest)

    def add(self, messages: Iterable[Any]) -> None:
        """Append messages to the queue."""
        for message in messages:
            if getattr(message, "newest_only", False):
                self._newest[type(message)] = message
            else:
                self._queue.append(message)
        if len(self._queue) > self._limit:
            odd = cycle((True, False))
            self._queue = [each for each in self._queue if not getattr(each, "may_thin", False) or next(odd)]
            self._limit = max(MOST_WAITING, 2 * len(self._queue))

    def take(self, most: int | None = None) -> list[Any]:
        """Remove and return up to `most` messages of the queue, and all `newest_only` ones."""
        taken = [*self._queue[:most], *self._newest.values()]
        self._queue = [] if most is None else self._queue[most:]
        self._newest = {}
        return taken


def serve(connection: Connection, payload: bytes, niceness: int = NICENESS) -> None:
    """Run the pickled (function, args, kwargs) to its end, and send its messages through `connection`."""
    _configure(niceness)
    service = _Service(connection)
    signal.signal(signal.SIGTERM, lambda *_: service.terminate())
    bundle = MessageBatch(ended=True)
    try:
        function, args, kwargs = pickle.loads(payload)
        service.run(function(*args, **kwargs))
    except BrokenPipeError:
        return  # the window has gone
    except Exception as error:
        bundle.problem, bundle.trace = _in_words(error), traceback.format_exc()
    if service.terminated:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGTERM)  # so that the window learns how it ended
    with suppress(OSError):
        try:
            bundle.messages = service.waiting.take()
            connection.send(bundle)
        except Exception as error:  # one of the messages cannot be pickled
            connection.send(MessageBatch([], True, bundle.problem or _in_words(error), bundle.trace))


def _configure(niceness: int) -> None:
    """Configure the process to spare the window: one core, lower priority; what ends the window is left to it."""
    for library in ("OPENBLAS", "OMP", "MKL"):
        os.environ[f"{library}_NUM_THREADS"] = "1"
    for name in ("SIGINT", "SIGHUP"):  # which reach all processes of a terminal
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    with suppress(AttributeError, OSError):
        os.nice(niceness)


def _in_words(error: Exception) -> str:
    said = " ".join(str(error)[:_LONGEST].split())
    if isinstance(error, OSError) and error.strerror:  # without the error number, which does not help a player
        said = f"{error.strerror}: {error.filename}" if error.filename else error.strerror
    # Messages of these errors are clear to a person; others need the name of the exception as well.
    if said and isinstance(error, ArithmeticError | ValueError | OSError | MemoryError | ImportError):
        return said
    return f"{type(error).__name__}: {said}".removesuffix(": ")


class _Service:
    """Loop that advances a generator at the requested pace, and answers the window between turns."""

    def __init__(self, connection: Connection) -> None:
        self.waiting = MessageQueue()
        self._connection = connection
        self._orders: SimpleQueue[Order] = SimpleQueue()
        self.terminated = self._stopped = self._paused = False
        self._taken = 0  # turns so far, besides those of commands
        self._limit: int | None = None  # of these turns: then it waits
        self._idle = False  # whether the generator has nothing to do before the next command
        self._period = 0.0  # seconds between turns
        self._due = 0.0  # time of the next turn
        self._wanted = CREDIT  # bundles the window has requested
        self._since = time.monotonic()  # time of the window's last request, or of the last bundle sent
        Thread(target=_listen, args=(connection, self._orders), daemon=True).start()

    def terminate(self) -> None:
        """End as on a request of the window, so that a run saves itself; called from a signal handler."""
        self.terminated = True
        self._orders.put(("stop", None))

    def run(self, turns: Turns) -> None:
        """Advance the generator until it or the window ends the run."""
        try:
            self._keep(next(turns))  # a generator takes commands from its second turn on
            while not self._stopped:
                self._follow_orders(turns)
                self._answer()
                now = time.monotonic()
                if not self._stopped and self._seconds_to_turn(now) == 0.0:
                    self._due = max(self._due + self._period, now)
                    self._taken += 1
                    self._keep(next(turns))
        except StopIteration:
            pass
        finally:
            turns.close()

    def _keep(self, messages: Iterable[Any] | None) -> None:
        self._idle = messages is None
        self.waiting.add(messages or ())

    def _seconds_to_turn(self, now: float) -> float | None:
        """Seconds until the next turn is due, or None while paused, idle or at the limit."""
        if self._idle or self._paused:
            return None
        if self._limit is not None and self._taken >= self._limit:
            return None
        return max(0.0, self._due - now) if self._period else 0.0

    def _answer(self) -> None:
        if self._wanted and (self.waiting or time.monotonic() - self._since >= HEARTBEAT):
            self._wanted -= 1
            self._since = time.monotonic()
            self._connection.send(MessageBatch(self.waiting.take(MOST_AT_ONCE)))

    def _follow_orders(self, turns: Turns) -> None:
        """Carry out all pending orders of the window; wait for one until the next turn is due."""
        patience = self._seconds_to_turn(time.monotonic())
        if self._wanted and self.waiting:
            patience = 0.0
        elif self._wanted:
            patience = HEARTBEAT if patience is None else min(patience, HEARTBEAT)
        with suppress(Empty):
            self._follow(self._orders.get(timeout=patience) if patience != 0.0 else self._orders.get_nowait(), turns)
            while not self._stopped:
                self._follow(self._orders.get_nowait(), turns)

    def _follow(self, order: Order, turns: Turns) -> None:
        match order:
            case "ask", bundles:
                self._wanted += bundles
                self._since = time.monotonic()
            case "command", command:
                self._keep(turns.send(command))
            case "pause", _:
                self._paused = True
            case "resume", _:
                self._paused = False
            case "pace", per_second:
                self._period, self._due = (1.0 / per_second if per_second else 0.0), time.monotonic()
            case "limit", turns_in_all:
                self._limit = turns_in_all
            case "stop", _:
                self._stopped = True
            case "raise", error:
                raise error


def _listen(connection: Connection, orders: SimpleQueue[Order]) -> None:
    """Receive the window's orders in a thread. Once the window has closed, make sure that this process ends too."""
    while True:
        try:
            orders.put(connection.recv())
        except (EOFError, OSError):
            break
        except Exception as error:  # an order that cannot be read
            orders.put(("raise", error))
    orders.put(("stop", None))
    time.sleep(GRACE)
    os._exit(1)
