"""Ablation of preprocessing steps, measured in a process of its own while the screen goes on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

from ai.digits.ablation import StageAccuracy, stage_accuracy
from game.core import texts
from game.core.worker import Worker, WorkerState
from game.digits.answer import percent
from game.digits.reader import Switches
from game.training.digit_models import PATIENCE, called


class AccuracyMeasurement:
    """Measures the accuracy for each setting of the switches once; call `listen` once a frame.

    `folders` gives networks by name.
    """

    def __init__(self, folders: Callable[[], dict[str, Path]]) -> None:
        self._folders = folders
        self._worker: Worker | None = None
        self._asked: set[Switches] = set()
        self.found: dict[Switches, StageAccuracy] = {}

    def ask(self, switches: Switches) -> None:
        """Request the accuracy with these switches, unless it is known."""
        if self._worker is None:
            self._worker = Worker(stage_accuracy, self._folders())
            self._worker.patience = PATIENCE
            self._worker.pause()  # it works on request only
        if switches not in self._asked:
            self._asked.add(switches)
            self._worker.send(asdict(switches))

    def anew(self, switches: Switches) -> None:
        """Discard all results because the networks have changed; measure again if anything was measured before."""
        if self._worker:
            self.close()
            self._worker = None
            self._asked.clear()
            self.found.clear()
            self.ask(switches)

    def listen(self) -> None:
        """Receive finished measurements."""
        if self._worker:
            for told in self._worker.poll():
                self.found[Switches(**dict(told.steps))] = told

    def words(self, switches: Switches) -> str:
        """Return the result for these switches in words, or how to get one."""
        if self._worker is None:
            return texts.DIGITS_HINT
        told = self.found.get(switches)
        if told is None:
            failed = self._worker.state is WorkerState.FAILED
            return texts.DIGITS_NOT_MEASURED.format(problem=self._worker.problem) if failed else texts.DIGITS_MEASURING
        reads = ", ".join(
            texts.DIGITS_READS_AS.format(name=called(name), percent=percent(part)) for name, part in told.read.items()
        )
        return texts.DIGITS_READS.format(count=told.count) + reads + "."

    def close(self) -> None:
        """End the process."""
        if self._worker:
            self._worker.close(0.0)  # there is nothing to be kept, and the window may go on
