"""Trial of a study: the same settings trained with several seeds, in turn, on one thread."""

from __future__ import annotations

import errno
import hashlib
import io
import tempfile
import time
import zipfile
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.files import read_bytes, remove_state
from ai.sweep.metric import Metric, Point
from ai.sweep.plan import Plan
from ai.sweep.results import FinishedTrial, SeedResult
from ai.sweep.runs import SeedRun, begin

_ROOT: Final = Path(__file__).parents[2]
_MOST: Final = 1_000_000_000  # bytes of an archive
_MOST_SENT: Final = 100_000_000  # of a checkpoint; a larger one goes without the memories, and so on with none


@dataclass(frozen=True)
class Asked:
    """What is asked of one trial.

    Attributes:
        number: of the trial in its study.
        params: values of the knobs that are searched.
        parent: the finished trial whose runs it goes on with, in a population; else None.

    """

    number: int
    params: dict[str, Any]
    parent: FinishedTrial | None = None


@dataclass
class _State:
    """What a trial has so far, of each seed: its curve, and why it ended early."""

    at: int
    curves: list[list[Point]]
    problems: list[str] = field(default_factory=list)


class Trial:
    """Trial that goes from mark to mark.

    Args:
        plan: of the study.
        asked: of this trial.
        runs: archive of the runs to go on with, the parent's or its own, as `archive` gave it; else empty.
        so_far: what there was of this trial when `checkpoint` gave these runs; None for one that begins.

    Raises ValueError for settings that make no sense, ModelFormatError for runs that cannot be read.

    """

    def __init__(self, plan: Plan, asked: Asked, runs: bytes = b"", so_far: FinishedTrial | None = None) -> None:
        self.plan, self.asked = plan, asked
        self.metric = Metric.named(plan.metric)
        self.begun, self.end = plan.span(asked.number)
        self._restarts = so_far.restarts + 1 if so_far else 0
        self._began = time.monotonic() - (so_far.seconds if so_far else 0.0)
        source = so_far or asked.parent
        earlier = [list(seed.curve) for seed in source.seeds] if source else [[] for _ in plan.seeds]
        self._state = _State(so_far.at if so_far else self.begun, earlier, [""] * len(plan.seeds))
        settings = plan.settings | asked.params
        with tempfile.TemporaryDirectory() as folder:
            if runs:
                unpack(runs, Path(folder))
            kept = {seed: Path(folder, seed_folder(seed)) for seed in plan.seeds}
            self._runs: list[SeedRun] = [  # what diverged at once has kept nothing, and begins anew
                begin(plan.kind, settings, seed, run if run.is_dir() else None, plan.validation)
                for seed, run in kept.items()
            ]

    @property
    def at(self) -> int:
        """Decisions or epochs that every seed has trained for."""
        return self._state.at

    @property
    def done(self) -> bool:
        """Whether there is nothing left to train."""
        return self.at >= self.end or all(self._state.problems)

    @property
    def value(self) -> float | None:
        """Value of the trial so far, as its seeds are judged."""
        return self.metric.judged([self._value_of(index) for index in range(len(self._runs))], self.plan.judge)

    def _value_of(self, index: int) -> float | None:
        curve = self._state.curves[index]
        of = self.metric.lost if self._state.problems[index] else self.metric.of
        return of(curve, self.plan.budget)

    def step(self) -> None:
        """Train every seed up to the next mark, and measure it there."""
        mark = min(self.end, (self.at // self.plan.every + 1) * self.plan.every)
        for index, run in enumerate(self._runs):
            if not self._state.problems[index]:
                try:
                    self._state.curves[index].append(run.advance(mark))
                except FloatingPointError as error:
                    self._state.problems[index] = str(error)
        self._state.at = mark

    def result(self, figures: Mapping[int, Mapping[str, Any]] | None = None) -> FinishedTrial:
        """Return what there is to tell of the trial; `figures` are those of the networks kept, by seed."""
        seeds = tuple(
            SeedResult(
                seed, tuple(self._state.curves[index]), self._value_of(index), self._state.problems[index],
                round(run.seconds, 3), dict((figures or {}).get(seed, {})),
            )
            for index, (seed, run) in enumerate(zip(self.plan.seeds, self._runs, strict=True))
        )  # fmt: skip
        parent = self.asked.parent.number if self.asked.parent else None
        return FinishedTrial(
            self.asked.number, self.asked.params, self.value, self.at, self.at < self.end,
            round(time.monotonic() - self._began, 3), seeds, parent, restarts=self._restarts,
        )  # fmt: skip

    def checkpoint(self) -> bytes:
        """Return an archive of every seed's run as it is now, to go on with; empty if one has diverged."""
        if any(self._state.problems):
            return b""
        with tempfile.TemporaryDirectory() as temporary:
            folders = [Path(temporary, seed_folder(seed)) for seed in self.plan.seeds]
            for folder, run in zip(folders, self._runs, strict=True):
                run.keep(folder)
            if sum(path.stat().st_size for path in Path(temporary).rglob("*")) > _MOST_SENT:
                for folder in folders:
                    remove_state(folder)
            return archive(Path(temporary))

    def finish(self) -> tuple[FinishedTrial, bytes]:
        """Save and measure every seed's run as its command would; return the result and an archive of the folders."""
        figures: dict[int, dict[str, Any]] = {}
        goes_on = self.plan.generation(self.asked.number) + 1 < self.plan.generations  # its state is needed then
        with tempfile.TemporaryDirectory() as temporary:
            for index, (seed, run) in enumerate(zip(self.plan.seeds, self._runs, strict=True)):
                folder = Path(temporary, seed_folder(seed))
                if not self._state.problems[index]:
                    figures[seed] = run.save(folder, goes_on)
                else:
                    with suppress(ValueError):  # its numbers were never finite after a step
                        run.salvage(folder)
            packed = archive(Path(temporary))
        return self.result(figures), packed


def seed_folder(seed: int) -> str:
    """Return the name of the folder of a seed's run within its trial's."""
    return f"seed-{seed}"


def archive(folder: Path) -> bytes:
    """Return the files in a folder as one archive, not compressed.

    Raises OSError for a link, for what is no ordinary file, and for more than an archive may hold: nothing is sent to
    other processes that does not lie in the folder itself.
    """
    packed, left = io.BytesIO(), _MOST
    with zipfile.ZipFile(packed, "w") as writer:
        for path in sorted(folder.rglob("*")):
            if path.is_symlink():
                raise OSError(errno.ELOOP, "is a link", str(path))
            if not path.is_dir():
                content = read_bytes(path, left)
                left -= len(content)
                writer.writestr(path.relative_to(folder).as_posix(), content)
    return packed.getvalue()


def unpack(packed: bytes, folder: Path) -> None:
    """Write the files of an archive into a folder; raises OSError."""
    with zipfile.ZipFile(io.BytesIO(packed)) as reader:
        reader.extractall(folder)


@cache
def fingerprint() -> str:
    """Return a hash of the code that decides a run, and of NumPy's version: with another one, results may differ."""
    code = hashlib.sha256(np.__version__.encode())
    for package in ("ai", "engine"):
        for path in sorted((_ROOT / package).rglob("*.py")):
            code.update(path.relative_to(_ROOT).as_posix().encode() + path.read_bytes())
    return code.hexdigest()[:16]
