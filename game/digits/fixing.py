"""Fix it: a network learns what a misread drawing was, in a process of its own; the last such lesson can be undone."""

from __future__ import annotations

import json
import shutil
from contextlib import suppress
from pathlib import Path
from typing import Final

from ai.digit_fix import Fixed, FixStep, fix
from ai.ink import Image
from game import texts
from game.worker import State, Worker

FIXES: Final = "digits"  # in the player's folder: a folder for each network, and in that one for each fix
_MOST: Final = 30  # fixes that can be undone


class Fixing:
    """One fix at a time; `poll` once a frame. Networks are found by name, in the player's folder or the shipped one.

    Attributes:
        step: how the fix that goes on stands; None before its first word, and between fixes.
        fixed: what the last fix has done, until the next begins or it is undone.
        problem: why the last one failed, in words.

    """

    def __init__(self, user_dir: Path, models_dir: Path) -> None:
        self._fixes, self._shipped = user_dir / FIXES, models_dir / "digits"
        self._worker: Worker | None = None
        self.name = ""
        self.step: FixStep | None = None
        self.fixed: Fixed | None = None
        self.problem = ""

    @property
    def busy(self) -> bool:
        """Whether a fix goes on."""
        return self._worker is not None

    def folder(self, name: str) -> Path:
        """Return where the network of that name is, with all fixes until now."""
        return [self._shipped / name, *self._kept(name)][-1]

    def count(self, name: str) -> int:
        """Return how many fixes can be undone."""
        return len(self._kept(name))

    def begin(self, name: str, image: Image, digit: int) -> bool:
        """Begin to teach a network that an image (28, 28) is that digit; false while another fix goes on."""
        if self.busy:
            return False
        self.step = self.fixed = None
        self.name, self.problem = name, ""
        folder = self.folder(name)
        number = int(folder.name) + 1 if folder.parent.parent == self._fixes else 1
        keep = self._fixes / name / f"{number:04}"
        self._worker = Worker(fix, folder, image, digit, keep, before=_accuracy(folder))
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
            self.close()
            for old in self._kept(self.name)[:-_MOST]:
                shutil.rmtree(old, ignore_errors=True)
        return done

    def undo(self, name: str) -> bool:
        """Take the last fix of a network back; false if there is none, or it can't be removed."""
        kept = self._kept(name)
        if not kept or self.busy:
            return False
        self.fixed, self.problem = None, ""
        try:
            shutil.rmtree(kept[-1])
        except OSError as error:
            self.problem = texts.FIX_NOT_UNDONE.format(problem=error.strerror or error)
            return False
        return True

    def close(self) -> None:
        """End what goes on."""
        if self._worker:
            self._worker.close()
        self._worker, self.step = None, None

    def _kept(self, name: str) -> list[Path]:
        """Return the folders of a network's fixes, the last one last."""
        with suppress(OSError):
            return sorted(path for path in (self._fixes / name).iterdir() if path.name.isdecimal())
        return []


def _accuracy(folder: Path) -> float | None:
    """Return the accuracy on the test images that a network's folder tells of, if it does."""
    for file in ("config.json", "training.json"):
        with suppress(OSError, ValueError, KeyError, TypeError):
            return float(json.loads((folder / file).read_text(encoding="utf-8"))["test"])
    return None
