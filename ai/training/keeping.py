"""Keeping of a run: its network in its folder, and beside that the state that it goes on from."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ai.training.messages import Saved, problem_of
from ai.training.run import Run, RunKind, Snapshot
from ai.training.state import PreparedState, State, StateWriter

if TYPE_CHECKING:
    from ai.training.history import History

FIRST_SECONDS: Final = 1.5  # after which a run is kept for the first time
KEEP_SECONDS: Final = 10.0  # between two times
SHARE: Final = 0.01  # of a run's time that it may stand still for it, at most


class Keeper:
    """Keeps a run in its own folder now and then, and in any other when asked.

    A thread writes, while training goes on; the run stands still for what is copied, for a hundredth of its time at
    most. Without a folder of its own (None), a run is kept only where that is asked for. `around` gives what whoever
    leads the run keeps in its state, for `Run.around`.
    """

    def __init__(
        self, run: Run, kind: RunKind, folder: Path | None, history: History | None = None,
        around: Callable[[], State] | None = None,
    ) -> None:  # fmt: skip
        self._run, self._kind, self._folder, self._history = run, kind, folder, history
        self._around = around or (lambda: run.around)
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
        if self._folder is None:
            return []
        told = []
        if self._writing is not None and self._writing.done():
            saved, self._writing = _outcome(self._folder, self._writing), None
            if saved.problem and saved.problem != self._problem:
                told.append(saved)
            self._problem = saved.problem
        if self._writing is None and now >= self._due:
            began = time.monotonic()
            self._writing = self._write(self._folder)
            self._due = now + max(KEEP_SECONDS, (time.monotonic() - began) / SHARE)
        return told

    def save(self, folder: Path, final: bool = False) -> Saved:
        """Keep it in a folder, and wait until it is done; `final` measures it as well."""
        self.wait()
        return _outcome(folder, self._write(folder, final))

    def wait(self) -> None:
        """Wait until what is being written is on the disk."""
        if self._folder is not None and self._writing is not None:
            _outcome(self._folder, self._writing)

    def end(self) -> None:
        """Keep what has not been kept, and wait until it is on the disk."""
        if self._folder is not None and self._saved_at != self._run.moment:
            self.save(self._folder)
        self._thread.shutdown()

    def _write(self, folder: Path, final: bool = False) -> Future[dict[str, Any]]:
        if folder == self._folder:
            self._saved_at = self._run.moment
        states, prepared = _prepared(self._run, folder, self._around())
        kept = self._kind.snapshot(self._run, self._history, final)
        return self._thread.submit(_save, kept, folder, states, prepared)


def save(run: Run, kind: RunKind, folder: str | Path, *, final: bool = False, state: bool = True) -> dict[str, Any]:
    """Save a run, whole or not at all; return its description. Without `state`, another run will not go on from it.

    `final` lets the latest network stand for the best too, and measures the best one; the state is that of before.
    Raises OSError if it cannot be written, and ValueError, with the disk left as it was, if the numbers of the network
    are not finite.
    """
    folder = Path(folder)
    states, prepared = _prepared(run, folder, run.around) if state else (StateWriter(folder), None)
    return _save(kind.snapshot(run, None, final), folder, states, prepared)


def _prepared(run: Run, folder: Path, around: State) -> tuple[StateWriter, PreparedState | None]:
    """Copy the state of a run, with what is kept around it; None if there is none to go on from."""
    if run.states is None or run.states.folder != folder:
        states = StateWriter(folder)
        if run.states:
            states.take_over(run.states)
        run.states = states
    if run.diverged or run.done:
        return run.states, None
    return run.states, run.states.prepare(run.moment, run.state() | {"around": around}, run.buffers)


def _save(kept: Snapshot, folder: Path, states: StateWriter, prepared: PreparedState | None) -> dict[str, Any]:
    """Write the state first, then the network's folder, and at last delete the state before."""
    if prepared:
        states.write(prepared)
    kept.save(folder)
    states.clear(prepared)
    return kept.described


def _outcome(folder: Path, writing: Future[dict[str, Any]]) -> Saved:
    """Wait for what is written, and return what came of it."""
    try:
        described = writing.result()
    except (OSError, ValueError) as error:
        return Saved(folder, problem_of(error))
    return Saved(folder, "", described.get("test"), described.get("kept_epoch"))
