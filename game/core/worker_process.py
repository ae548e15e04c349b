"""What runs in a worker's own process: it pulls a generator, and hands over what that tells when it is asked.

Nothing here may import pygame or NumPy: the child's settings come before both.
"""

from __future__ import annotations

import os
import pickle
import signal
import time
import traceback
from collections.abc import Callable, Generator, Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import cycle
from multiprocessing.connection import Connection
from queue import Empty, SimpleQueue
from threading import Thread
from typing import Any, Final

HEARTBEAT: Final = 1.0  # seconds after which it answers even if there is nothing to tell
GRACE: Final = 3.0  # seconds to come to an end in, once the window has gone
CREDIT: Final = 2  # bundles wanted ahead: with one, every other turn would pass while the request is under way
MOST_WAITING: Final = 2000  # messages, before some of those that may be thinned are dropped
MOST_AT_ONCE: Final = 250
_NICENESS: Final = 5  # the window goes first
_LONGEST: Final = 300  # letters of a problem: a file can say anything, at any length

Order = tuple[str, Any]
Turns = Generator[Iterable[Any], Any, None]
Function = Callable[..., Turns]


@dataclass
class Bundle:
    """What a worker's process tells at once. Without `problem`, one that has ended has ended well."""

    messages: list[Any] = field(default_factory=list)
    ended: bool = False
    problem: str = ""
    trace: str = ""  # for the log


class Waiting:
    """Messages that nobody has fetched yet.

    Of a class with `newest_only`, the latest alone is kept. Of those with `may_thin`, every other one goes when
    too many wait. All others stay, in their order.
    """

    def __init__(self) -> None:
        self._queue: list[Any] = []
        self._newest: dict[type, Any] = {}
        self._limit = MOST_WAITING

    def __bool__(self) -> bool:
        return bool(self._queue or self._newest)

    def add(self, messages: Iterable[Any]) -> None:
        """Let messages wait."""
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
        """Hand over so many of the queue and all that is newest, which then wait no longer."""
        taken = [*self._queue[:most], *self._newest.values()]
        self._queue = [] if most is None else self._queue[most:]
        self._newest = {}
        return taken


def serve(connection: Connection, payload: bytes) -> None:
    """Run the pickled (function, args, kwargs), whose turns are told through `connection`, until its end."""
    _settle()
    service = _Service(connection)
    signal.signal(signal.SIGTERM, lambda *_: service.terminate())
    bundle = Bundle(ended=True)
    try:
        function, args, kwargs = pickle.loads(payload)
        service.run(function(*args, **kwargs))
    except BrokenPipeError:
        return  # the window has gone
    except Exception as error:
        bundle.problem, bundle.trace = _in_words(error), traceback.format_exc()
    if service.terminated:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGTERM)  # so that the window hears how it ended
    with suppress(OSError):
        try:
            bundle.messages = service.waiting.take()
            connection.send(bundle)
        except Exception as error:  # among the messages is one that cannot be sent
            connection.send(Bundle([], True, bundle.problem or _in_words(error), bundle.trace))


def _settle() -> None:
    """Be a good neighbour to the window: one core, below its priority, ended by it and not by Ctrl-C."""
    for library in ("OPENBLAS", "OMP", "MKL"):
        os.environ[f"{library}_NUM_THREADS"] = "1"
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with suppress(AttributeError, OSError):
        os.nice(_NICENESS)


def _in_words(error: Exception) -> str:
    said = " ".join(str(error)[:_LONGEST].split())
    if isinstance(error, OSError) and error.strerror:  # without its number, which helps nobody
        said = f"{error.strerror}: {error.filename}" if error.filename else error.strerror
    # These say in their own words what a person can do something about; of others the kind is needed as well.
    if said and isinstance(error, ArithmeticError | ValueError | OSError | MemoryError | ImportError):
        return said
    return f"{type(error).__name__}: {said}".removesuffix(": ")


class _Service:
    """Turns a generator at the pace that is asked for, and answers between turns."""

    def __init__(self, connection: Connection) -> None:
        self.waiting = Waiting()
        self._connection = connection
        self._orders: SimpleQueue[Order] = SimpleQueue()
        self.terminated = self._stopped = self._paused = False
        self._steps = 0  # to be taken in spite of the pause
        self._period = 0.0  # seconds from turn to turn
        self._due = 0.0  # when the next turn is
        self._wanted = CREDIT  # bundles that the window has asked for
        self._since = time.monotonic()  # when it last asked, or was told something
        Thread(target=_listen, args=(connection, self._orders), daemon=True).start()

    def terminate(self) -> None:
        """End as when the window asks for it, so that a run keeps itself; called from within a signal's handler."""
        self.terminated = True
        self._orders.put(("stop", None))

    def run(self, turns: Turns) -> None:
        """Turn until the generator or the window ends it."""
        try:
            self.waiting.add(next(turns))  # a generator takes commands from its second turn on
            while not self._stopped:
                self._follow_orders(turns)
                self._answer()
                now = time.monotonic()
                if not self._stopped and self._seconds_to_turn(now) == 0.0:
                    self._due = max(self._due + self._period, now)
                    self._steps = max(0, self._steps - 1)
                    self.waiting.add(next(turns))
        except StopIteration:
            pass
        finally:
            turns.close()

    def _seconds_to_turn(self, now: float) -> float | None:
        """Seconds until the next turn is due, or None while paused."""
        if self._paused:
            return 0.0 if self._steps else None
        return max(0.0, self._due - now) if self._period else 0.0

    def _answer(self) -> None:
        if self._wanted and (self.waiting or time.monotonic() - self._since >= HEARTBEAT):
            self._wanted -= 1
            self._since = time.monotonic()
            self._connection.send(Bundle(self.waiting.take(MOST_AT_ONCE)))

    def _follow_orders(self, turns: Turns) -> None:
        """Do all that has been ordered; with nothing else to do, wait for an order."""
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
                self.waiting.add(turns.send(command))
            case "pause", _:
                self._paused = True
            case "resume", _:
                self._paused, self._steps = False, 0
            case "step", _:
                self._steps += 1
            case "pace", per_second:
                self._period, self._due = (1.0 / per_second if per_second else 0.0), time.monotonic()
            case "stop", _:
                self._stopped = True
            case "raise", error:
                raise error


def _listen(connection: Connection, orders: SimpleQueue[Order]) -> None:
    """Pass on what the window orders. When it has gone, see to it that this process does not outlive it."""
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
