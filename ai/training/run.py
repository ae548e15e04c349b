"""What is around a run of any kind (`ai.run.Run`): when it ends, how it is kept, and how it goes on."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from ai.files.folder import atomic_folder
from ai.files.reading import problem_in
from ai.nn import ModelFormatError
from ai.nn.storage import reading
from ai.run import TRAINING_FILE, Run
from ai.training.messages import Saved
from ai.training.state import GOING_ON, read_state, write_state

if TYPE_CHECKING:
    from ai.training.history import History

FIRST_SECONDS: Final = 1.5  # after which a run is kept for the first time
KEEP_SECONDS: Final = 10.0  # between two times
SHARE: Final = 0.01  # of a run's time that it may stand still for it, at most
PACE: Final = 2_000_000  # bytes a second that are written at most, in the mean

R = TypeVar("R", bound=Run)


def resume(kind: type[R], folder: str | Path, **options: Any) -> R:
    """Go on with a run of a kind that is kept in a folder, with the memory that its state holds.

    `Run.lost` says what is missing. `options` are those of `begun`: of an agent, `env` is the environment as the user
    names it, without which "module:Name" is refused. Raises ModelFormatError for anything else.
    """
    folder = Path(folder)
    run = kind.begun(folder, **options)
    state = read_state(folder)
    if state is not None:
        with reading(folder, GOING_ON):
            run.load_state(state)
    elif kind.needs_state:
        raise ModelFormatError(folder, "there is nothing to go on with: the run is finished, or its state is gone")
    else:
        run.lost = "its state is not there, so it goes on with an empty memory"
    return run


def save(run: Run, folder: str | Path, final: bool = False, *, state: bool = True) -> dict[str, Any]:
    """Save a run, whole or not at all; return its description. Without `state`, another will not go on from it.

    `final` lets the latest network stand for the best too, and measures the best one; the state is that of before.
    Raises OSError if it cannot be written, and ValueError, with the disk left as it was, if the numbers of the
    network are not finite.
    """
    return _copied(run, Path(folder), state, final)[0]()


class Limit:
    """Ends a run after so many seconds of training or so many steps, or when it is done.

    Both are counted from the run's own beginning, however often it was interrupted in between.
    """

    def __init__(self, seconds: float | None = None, moment: int | None = None) -> None:
        self.seconds, self.moment = seconds, moment

    def share(self, run: Run) -> float:
        """Return the share of its time or steps that a run has used up, from 0 to 1, whichever is more."""
        elapsed = run.seconds / self.seconds if self.seconds else 0.0
        moment = self.moment or run.steps
        return min(1.0, max(elapsed, run.moment / moment if moment else 0.0))

    def run(self, run: Run) -> Iterator[Any]:
        """Advance until the time or the steps are used up."""
        while self.share(run) < 1.0:
            yield run.advance()


class Keeper:
    """Keeps a run in its own folder now and then, and in any other when asked.

    A thread writes, while training goes on; the run stands still for what is copied, for a hundredth of its time at
    most. Without a folder of its own (None), a run is kept only where that is asked for.
    """

    def __init__(self, run: Run, folder: Path | None, history: History | None = None) -> None:
        self._run, self._folder, self._history = run, folder, history
        self._saved_at = run.moment  # as on the disk
        self._due = run.clock() + FIRST_SECONDS
        self._problem = ""
        self._thread = ThreadPoolExecutor(max_workers=1)
        self._writing: Future[dict[str, Any]] | None = None

    def move_to(self, folder: Path) -> None:
        """Keep it in another folder from now on, the first time as soon as possible."""
        self.wait()
        self._folder, self._saved_at, self._due = folder, -1, self._run.clock()

    def go_on(self, now: float) -> list[Saved]:
        """Start to write when it is time, by the clock; return a message when that did not succeed, once."""
        if self._folder is None or (self._writing is not None and not self._writing.done()):
            return []
        saved, self._writing = self._writing and _outcome(self._folder, self._writing), None
        failures = [saved] if saved and saved.problem not in ("", self._problem) else []
        if saved:
            self._problem = saved.problem
        if now >= self._due:
            began = time.monotonic()
            self._writing, size = self._write(self._folder)
            self._due = now + max(KEEP_SECONDS, (time.monotonic() - began) / SHARE, size / PACE)
        return failures

    def save(self, folder: Path, final: bool = False) -> Saved:
        """Keep it in a folder, and wait until it is done; `final` measures it as well."""
        self.wait()
        return _outcome(folder, self._write(folder, final)[0])

    def wait(self) -> None:
        """Wait until what is being written is on the disk."""
        if self._writing is not None:
            wait([self._writing])

    def end(self) -> None:
        """Keep what has not been kept, and wait until it is on the disk."""
        if self._folder is not None and self._saved_at != self._run.moment:
            self.save(self._folder)
        self._thread.shutdown()

    def _write(self, folder: Path, final: bool = False) -> tuple[Future[dict[str, Any]], int]:
        """Begin to write; return what will come of it, and how many bytes its state has."""
        if folder == self._folder:
            self._saved_at = self._run.moment
        write, size = _copied(self._run, folder, True, final, self._history)
        return self._thread.submit(write), size


def _copied(
    run: Run, folder: Path, goes_on: bool, final: bool, history: History | None = None
) -> tuple[Callable[[], dict[str, Any]], int]:
    """Copy what is to be kept of a run; return what writes that while training goes on, whole or not at all.

    It returns what the training file says. Beside it is returned how many bytes the state has: none of a run that is
    not to go on.
    """
    state = run.state() if goes_on and not run.diverged and not run.done else {}
    described, write_networks = run.snapshot(final)
    history = None if history is None else history.copy()

    def write() -> dict[str, Any]:
        with atomic_folder(folder, run.kind) as temporary:
            write_networks(temporary)
            if state:
                write_state(temporary, state)
            if history is not None:
                history.write(temporary)
            (temporary / TRAINING_FILE).write_text(
                json.dumps(described, indent=2, allow_nan=False) + "\n", encoding="utf-8"
            )
        return described

    return write, sum(part.nbytes for part in state.values() if isinstance(part, np.ndarray))


def _outcome(folder: Path, writing: Future[dict[str, Any]]) -> Saved:
    """Wait for what is written, and return what came of it."""
    try:
        described = writing.result()
    except (OSError, ValueError) as error:
        return Saved(folder, problem_in(error))
    return Saved(folder, "", described.get("test"), described.get("kept_epoch"))
