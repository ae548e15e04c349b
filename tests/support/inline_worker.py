"""Stands in for a worker: pulls the generator in the test's own process, a few turns for each time it is polled.

For tests of what a window makes of the messages; that a process is started, dies or is ended is asked of real ones.
"""

import pickle
from collections.abc import Callable
from typing import Any

from ai.training import lander_session
from game.core.worker import Worker, WorkerState
from game.core.worker_process import Function, MessageQueue
from game.scenes.digits import fixing
from game.scenes.learn import pay, runs
from game.training import run as training_run

TURNS = 10  # taken for each poll: some 10 ms of a small training
POINT = 64  # decisions from one point of a run's curves to the next


class InlineWorker(Worker):
    """Does as a `Worker` does, without a process: orders are carried out at once, messages come with the next poll."""

    def __init__(self, function: Function, *args: Any, **kwargs: Any) -> None:
        function, args, kwargs = pickle.loads(pickle.dumps((function, args, kwargs)))  # nothing is shared
        self.problem, self._ended, self._polled_once = "", False, False
        self._paused, self._per_poll = False, TURNS
        self._taken = 0
        self._limit: int | None = None
        self._waiting = MessageQueue()
        self._turns = function(*args, **kwargs)
        self._take(lambda: next(self._turns))

    @property
    def state(self) -> WorkerState:
        if self._ended:
            return WorkerState.FAILED if self.problem else WorkerState.ENDED
        if not self._polled_once:
            return WorkerState.STARTING
        return WorkerState.PAUSED if self._paused else WorkerState.RUNNING

    @property
    def gone(self) -> bool:
        return self._ended

    def poll(self) -> list[Any]:
        if not self._ended:
            self._polled_once = True
            for _ in range(0 if self._paused else self._per_poll):
                if self._limit is None or self._taken < self._limit:
                    self._taken += 1
                    self._take(lambda: next(self._turns))
        messages: list[Any] = pickle.loads(pickle.dumps(self._waiting.take()))
        return messages

    def stop(self) -> None:
        self.close()

    def close(self, grace: float = 0.5) -> None:
        if not self._ended:
            self._ended = True
            self._turns.close()

    def _order(self, name: str, value: Any = None) -> None:
        if name == "command":
            self._take(lambda: self._turns.send(value))
        elif name == "step":
            self._take(lambda: next(self._turns))
        elif name == "limit":
            self._limit = value
        elif name == "pace":
            self._per_poll = 1 if value else TURNS

    def _take(self, turn: Callable[[], Any]) -> None:
        """Take one turn, if there is one to take, and keep its messages."""
        if self._ended:
            return
        try:
            self._waiting.add(turn())
        except StopIteration:
            self._ended = True
        except Exception as error:
            self._ended, self.problem = True, str(error)


def install(patch: Callable[[object, str, object], None]) -> None:
    """Let runs, fixes and measurements work without a process; `patch` sets an attribute, as `setattr` does."""
    patch(lander_session, "POINT_DECISIONS", POINT)
    for module in (training_run, fixing, pay, runs):
        patch(module, "Worker", InlineWorker)
