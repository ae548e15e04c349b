"""Generators for workers to pull in tests. Imported by their processes, so nothing heavy up here."""

import gc
import os
import signal
import sys
import time
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Tick:
    number: int


@dataclass(frozen=True)
class Latest:
    newest_only = True

    number: int


@dataclass(frozen=True)
class Trace:
    may_thin = True

    number: int


@dataclass(frozen=True)
class Echo:
    command: object


class Poison:
    """Can be sent, but not be read."""

    def __reduce__(self):
        return explode, ()


def explode():
    raise RuntimeError("poison")


def counting(limit=10**9, weight=0):
    """Ticks, a Latest beside each; echoes commands without counting them."""
    number, messages = 0, [Tick(0), Latest(0)]
    while number < limit:
        command = yield messages
        if command is None:
            number += 1
            time.sleep(0.0005)
            messages = [Tick(number), Latest(number)] + [bytes(weight)] * (weight > 0)
        else:
            messages = [Echo(command)]


def failing(error, after=3):
    for number in range(after):
        yield [Tick(number)]
    raise error


def poisonous():
    yield [Tick(0)]
    while True:
        yield [Poison()]


def unsendable():
    yield [Tick(0)]
    yield [lambda: None]


def hanging(seconds=600):
    yield [Tick(0)]
    time.sleep(seconds)


def babbling():
    """Writes to its pipe what is no message at all."""
    yield [Tick(0)]
    pipes = [each for each in gc.get_objects() if isinstance(each, Connection)]
    pipes[0].send_bytes(b"\x00 no pickle")
    while True:
        yield []


def strange():
    """Writes to its pipe what can be read, but is no bundle."""
    yield [Tick(0)]
    next(each for each in gc.get_objects() if isinstance(each, Connection)).send({"not": "a bundle"})
    while True:
        yield []


def dying(code=None, signal_name=None):
    yield [Tick(0)]
    if signal_name:
        os.kill(os.getpid(), getattr(signal, signal_name))
    os._exit(code)


def ending_well(file, stubborn=False):
    """Writes a file when it is closed, or does not let itself be closed."""
    try:
        while True:
            yield [Tick(0)]
            time.sleep(0.001)
    finally:
        Path(file).write_text("closed", encoding="utf-8")
        if stubborn:
            time.sleep(600)


def looking_around():
    """Tells what this process is like."""
    import ai.training.lander_session  # noqa: F401 - brings NumPy

    yield [
        {
            "modules": {"pygame", "pygame_gui", "numpy"} & set(sys.modules),
            "threads": os.environ["OPENBLAS_NUM_THREADS"],
            "interrupted": signal.getsignal(signal.SIGINT) is signal.SIG_IGN,
        }
    ]


def eager(config, seed, keep):
    """A live run that saves itself all the time."""
    from ai.training import run as keeping
    from ai.training.lander_session import LanderSession

    vars(keeping).update(FIRST_SECONDS=0.0, KEEP_SECONDS=0.0, SHARE=float("inf"))
    yield from LanderSession.live(config, seed, keep=keep)


def biased_fix(folder, image, digit, keep):
    """In place of `ai.digits.fix.fix`: keeps a network that finds the digit everywhere."""
    from ai.digits.classifier import DigitClassifier
    from ai.digits.fix import Fixed, FixStep

    classifier = DigitClassifier.load(folder)
    yield [FixStep(0, 0.1)]
    last: Any = classifier.network.layers[-1]
    last.bias[digit] += 50
    classifier.save(keep)
    yield [Fixed(digit, (0.1, 1.0), (0.9, 0.1), 1, keep)]


def keep(notebook: Path, name: str, seconds: float):
    """Note when it begins and when it has ended, which takes a while."""
    with notebook.open("a") as file:
        file.write(f"{name} begins\n")
    try:
        while True:
            yield []
    finally:
        time.sleep(seconds)
        with notebook.open("a") as file:
            file.write(f"{name} ends\n")
