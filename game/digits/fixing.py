"""Fix it: a network learns what a misread drawing was, in a process of its own; the last such lesson can be undone."""

from __future__ import annotations

import shutil
import time
from contextlib import suppress
from pathlib import Path
from typing import Final

from ai.digits.fix import Fixed, FixStep, fix
from ai.digits.preprocessing import Image
from ai.nn.files import read_json
from game.core import texts
from game.core.worker import State, Worker
from game.training.digit_models import PATIENCE, shelf

_UNDONE: Final = ".undone"  # beside the fixes, until it is removed


class Fixing:
    """One fix at a time; `poll` once a frame. Networks go by the names that `game.training.digit_models` gives.

    Every fix is a folder of its own and none is ever thrown away but by `undo`.

    Attributes:
        digit: what the fix that goes on teaches, or the last one taught; None before the first.
        step: how the fix that goes on stands; None before its first word, and between fixes.
        networks: all there are, by name.
        fixed: what the last fix has done, until the next begins or it is undone.
        problem: why the last one failed, in words.

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
        """Whether a fix goes on."""
        return self._worker is not None

    def refresh(self) -> None:
        """Look again at which networks there are."""
        self.networks = shelf(*self._folders)

    def folder(self, name: str) -> Path:
        """Return where the network of that name is, with all fixes until now."""
        return self.networks[name].versions()[0]

    def count(self, name: str) -> int:
        """Return how many fixes can be undone."""
        return len(self.networks[name].fixed())

    def begin(self, name: str, image: Image, digit: int, source: Path | None = None) -> bool:
        """Begin to teach a network that an image (28, 28) is that digit; false while another fix goes on.

        `source` is the folder it was read from, where the last fix is damaged.
        """
        if self.busy:
            return False
        self.step = self.fixed = None
        self.name, self.digit, self.problem = name, digit, ""
        network, folder = self.networks[name], source or self.folder(name)
        number = int(network.fixed()[-1].name) + 1 if network.fixed() else 1
        self._worker = Worker(fix, folder, image, digit, network.fixes / f"{number:04}", before=_accuracy(folder))
        self._worker.patience = PATIENCE
        return True

    def poll(self) -> Fixed | None:
        """Hear how it stands; returns what a fix has done once, when it is done."""
        if self._worker is None:
            return None
        done: Fixed | None = None
        for told in self._worker.poll():
            if isinstance(told, Fixed):
                self.fixed = done = told
            else:
                self.step = told
        if done or self._worker.state in (State.ENDED, State.FAILED):
            self.problem = self._worker.problem or (texts.FIX_NOT_KEPT.format(problem=done.problem)
                                                    if done and done.problem else "")  # fmt: skip
            self._let_go(0.0)  # it has said all it had to say: the window goes on
        return done

    def undo(self, name: str) -> bool:
        """Take the last fix of a network back; false if there is none, or it can't be removed."""
        kept = self.networks[name].fixed()
        if not kept or self.busy:
            return False
        self.fixed, self.problem = None, ""
        aside = kept[-1].with_name(f"{_UNDONE}{time.time_ns()}")
        try:
            kept[-1].rename(aside)  # at once, so that no half of it is ever read
            shutil.rmtree(aside, ignore_errors=True)
        except OSError as error:
            self.problem = texts.FIX_NOT_UNDONE.format(problem=error.strerror or error)
            return False
        return True

    def close(self) -> None:
        """End what goes on, for leaving; what is just being written has a moment to be whole."""
        self._let_go(0.5)

    def _let_go(self, grace: float) -> None:
        if self._worker:
            self._worker.close(grace)
        self._worker, self.step = None, None


def _accuracy(folder: Path) -> float | None:
    """Return the accuracy on the test images that a network's folder tells of, if it does."""
    for file in ("config.json", "training.json"):
        with suppress(OSError, ValueError, KeyError, TypeError):
            return float(read_json(folder / file)["test"])
    return None
