"""Damages files of every kind, and kills their writers at every step they take on the disk.

A whole file is damaged in one way after another: cut, flipped, filled, mutated as JSON, swapped for a pipe, a device,
a link, a folder or a file that is all holes. Its reader has to return something, or to refuse it as it says it does,
within two seconds.

A writer is killed at every single step it takes on the disk (files opened, folders made, names changed), and what is
found afterwards has to be the old version or the new one, whole.
"""

from __future__ import annotations

import os
import shutil
import signal
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from tests.support.damage import DAMAGES, HOLES
from tests.support.saved import Subject

SECONDS = 2.0  # that a reader may take


class HangError(BaseException):
    """A reader has taken too long."""


def damaged(subject: Subject, count: int, seed: int, folder: Path) -> Iterator[str]:
    """Damage a subject so many times; yield what became of each: read, refused, or a fault with its reason."""
    rng = np.random.default_rng(seed)
    whole, hurt = folder / "whole", folder / "hurt"
    subject.write(whole, 0)
    for _ in range(count):
        shutil.rmtree(hurt, ignore_errors=True)
        shutil.copytree(whole, hurt)
        files = sorted(path for path in hurt.rglob("*") if path.is_file())
        done = []
        for _ in range(int(rng.choice([1, 1, 2]))):
            path, damage = files[rng.integers(len(files))], DAMAGES[rng.integers(len(DAMAGES))]
            if path.is_file() and not path.is_symlink() and path.stat().st_size < HOLES:
                damage(path, rng)
                done.append(f"{damage.__name__} {path.relative_to(hurt)}")
        yield _outcome(subject, hurt, ", ".join(done))


def _outcome(subject: Subject, folder: Path, done: str) -> str:
    try:
        with limited(), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            subject.read(folder)
    except subject.refusals as error:
        return "refused" if len(str(error)) < 10_000 else f"{done}: a message of {len(str(error)):,} letters"
    except HangError:
        return f"{done}: more than {SECONDS:g} s"
    except Exception as error:
        return f"{done}: {type(error).__name__}: {str(error)[:200]}"
    return "read"


@contextmanager
def limited(seconds: float = SECONDS) -> Iterator[None]:
    """Raise HangError in a block that takes longer."""

    def stop(*_: object) -> None:
        raise HangError

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def killed(subject: Subject, folder: Path, every: int = 1) -> Iterator[str]:
    """Kill a writer at each step it takes on the disk, or at some; yield what is found then: old, new, or a fault."""
    step = 1
    while True:
        place = folder / f"{subject.name} {step}"
        subject.write(place, 0)
        if not _write_until(subject, place, step):
            return
        try:
            version = subject.read(place)
        except Exception as error:
            yield f"step {step}: {type(error).__name__}: {str(error)[:200]}"
        else:
            yield {0: "old", 1: "new"}.get(version, f"step {step}: neither version, but {version!r}")
        subject.write(place, 1)  # what is left behind must not be in the way
        if subject.read(place) != 1:
            yield f"step {step}: the next save is lost"
        shutil.rmtree(place)
        step += every


STEPS = ("open", "os.rename", "os.remove", "os.mkdir", "os.rmdir", "os.truncate", "shutil.rmtree")


def _write_until(subject: Subject, folder: Path, step: int) -> bool:
    """Write version 1 in a process of its own that ends at that step; whether it came so far."""
    child = os.fork()
    if child == 0:
        left = step

        def count(event: str, arguments: tuple[Any, ...]) -> None:
            nonlocal left
            if event in STEPS and str(folder) in str(arguments[0]):
                left -= 1
                if left == 0:
                    os._exit(9)

        try:
            sys.addaudithook(count)
            subject.write(folder, 1)
        finally:
            os._exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 9
