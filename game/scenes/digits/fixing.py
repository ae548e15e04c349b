"""Fixing: fine-tune a network on a misread drawing, in a process of its own; the last fix can be undone."""

from __future__ import annotations

import shutil
from pathlib import Path

from ai.digits.fix import Fixed, FixStep, fix
from ai.digits.preprocessing import Image
from game.core import texts
from game.core.worker import Worker, WorkerState
from game.training.library import models_by_name
from game.training.run_kind import DIGITS


class FixRunner:
    """Runs one fix at a time; call `poll` once a frame. Networks have their names in `game.training.library`.

    Every fix has a folder of its own, which only `undo` removes.

    Attributes:
        digit: digit taught by the current fix, or by the last one; None before the first.
        step: progress of the current fix; None before its first message, and between fixes.
        networks: all networks, by name.
        fixed: result of the last fix, until the next begins or it is undone.
        problem: why the last fix failed, in words; empty if it did not.

    """

    def __init__(self, user_dir: Path, models_dir: Path) -> None:
        self._folders = models_dir, user_dir
        self.refresh()
        self._worker: Worker | None = None
        self.name = ""
        self.digit: int | None = None
        self.step: FixStep | None = None
        self.fixed: Fixed | None = None
        self.problem = ""

    @property
    def busy(self) -> bool:
        """Whether a fix is running."""
        return self._worker is not None

    def refresh(self) -> None:
        """Reread the list of networks."""
        self.networks = models_by_name(*self._folders)

    def folder(self, name: str) -> Path:
        """Return the folder of the named network with all its fixes."""
        return self.networks[name].versions()[0]

    def begin(self, name: str, image: Image, digit: int) -> bool:
        """Begin to teach a network that an image (28, 28) is that digit; return False while another fix runs."""
        if self.busy:
            return False
        self.step = self.fixed = None
        self.name, self.digit, self.problem = name, digit, ""
        network = self.networks[name]
        number = int(network.fixed()[-1].name) + 1 if network.fixed() else 1
        self._worker = Worker(fix, self.folder(name), image, digit, network.fixes / f"{number:04}")
        self._worker.patience = DIGITS.patience
        return True

    def poll(self) -> Fixed | None:
        """Receive the fix's progress; return its result once, when it is finished."""
        if self._worker is None:
            return None
        done: Fixed | None = None
        for message in self._worker.poll():
            if isinstance(message, Fixed):
                self.fixed = done = message
            else:
                self.step = message
        if done or self._worker.state in (WorkerState.ENDED, WorkerState.FAILED):
            self.problem = self._worker.problem or (
                texts.FIX_NOT_KEPT.format(problem=done.problem) if done and done.problem else ""
            )
            self._let_go(0.0)  # it has said all it had to say: the window goes on
        return done

    def undo(self, name: str) -> bool:
        """Undo the last fix of a network; return False if there is none, or it can't be removed."""
        kept = self.networks[name].fixed()
        if not kept or self.busy:
            return False
        self.fixed, self.problem = None, ""
        try:
            shutil.rmtree(kept[-1])  # one that is half removed is passed over as a damaged one
        except OSError as error:
            self.problem = texts.FIX_NOT_UNDONE.format(problem=error.strerror or error)
            return False
        return True

    def close(self) -> None:
        """End the running fix, if any; what it is just writing gets a moment to be whole."""
        self._let_go(0.5)

    def _let_go(self, grace: float) -> None:
        if self._worker:
            self._worker.close(grace)
        self._worker, self.step = None, None
