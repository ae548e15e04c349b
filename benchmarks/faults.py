"""Damage every kind of file, kill every writer at every step, and count what becomes of it.

    python -m benchmarks.faults [--count 2000] [--seed 0] [--only NAME]

For each kind of file or folder, a whole one is damaged in one way after another: cut, flipped, filled, mutated as
JSON, swapped for a pipe, a device, a link, a folder or a file that is all holes, arrays that claim to be huge or are
packed to be. Its reader has to return something, or to refuse it as it says it does, within two seconds and 500 MB.

Then each writer is killed at every single step it takes on the disk (files opened, folders made, names changed), and
what is found afterwards has to be the old version or the new one, whole. Exit code 1 if any of that fails.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
os.environ.setdefault("SDL_VIDEODRIVER", "dummy")

import argparse
import io
import json
import shutil
import signal
import sys
import time
import warnings
import zipfile
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from ai.agent.config import PRESETS
from ai.digits.checkpoints import resume_digit_run, save_digit_run
from ai.digits.classifier import DigitClassifier
from ai.digits.config import DIGIT_PRESETS
from ai.digits.training import DigitTraining
from ai.nn import FullyConnectedLayer, ModelFormatError, NeuralNetwork
from ai.nn.costs import CostFunctions
from ai.training import demonstrations
from ai.training.checkpoints import resume_run, snapshot
from ai.training.demonstrations import Demonstration
from ai.training.history import Checkpoint, History, Point, SettingChange, Validation
from ai.training.loop import Training
from game.core.settings import Settings, SettingsFile
from game.flight import flight_file
from game.flight.flight import Recording, StickHolder
from game.flight.flight_file import Entry, Record
from game.flight.logbook import Records
from game.training.library import Library

SECONDS = 2.0  # that a reader may take
MEGABYTES = 500  # of memory, all in all
HOLES = 300_000_000  # bytes of a file that takes no room on the disk
NASTY: tuple[Any, ...] = (
    None, True, -1, 0, 2, 0.5, 1e308, 10**30, 10**400, float("inf"), float("nan"), "", "x", "x" * 100_000, [], {},
    [1024] * 400, [1] * 60_000, "os:system", "../../etc", "\ud800", "\0", 1_000_000, -(10**18),
)  # fmt: skip

Data = tuple[Any, Any]


@dataclass(frozen=True)
class Subject:
    """A kind of file or folder.

    Attributes:
        write: writes version 0 or 1 of it into a folder.
        read: reads it there, and uses it a little; returns which version it is, or None where it says none.
        refusals: what it may raise.

    """

    name: str
    write: Callable[[Path, int], None]
    read: Callable[[Path], Any]
    refusals: tuple[type[Exception], ...] = ()


class HangError(BaseException):
    """A reader has taken too long."""


def _data() -> Data:
    rng = np.random.default_rng(0)
    return rng.random((160, 28, 28), dtype=np.float32), rng.integers(10, size=160).astype(np.uint8)


def _network(folder: Path, version: int) -> None:
    network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(FullyConnectedLayer(3, 2))
    network.values = np.full_like(network.values, version)
    network.save(folder / "network")


def _read_network(folder: Path) -> Any:
    network = NeuralNetwork.load(folder / "network")
    network.predict(np.zeros(network.layers[0].inputs or 1) if network.layers else np.zeros(1))
    return int(network.values[0]) if len(network.values) else None


def _training(version: int) -> Training:
    config = PRESETS["modern"].changed(hidden=(8,), num_envs=2, replay_size=200, normalise_inputs=True)
    training = Training(config, evaluate_every=0, validation_episodes=1)
    training.episodes = version
    return training


def _run(folder: Path, version: int) -> None:
    training, history = _training(version), History()
    training.best = training.task.evaluate(training.agent, 1, 0)
    history.append(Point(*[float(version)] * 10))
    history.append(Checkpoint(0.0, 0, 0.0, training.agent.network.values.copy(), None))
    history.append(Validation(0, 0.5, 1.0, best=True))
    history.append(SettingChange(0, "discount", 0.9, 0.99))
    snapshot(training, history).save(folder / "models" / "run")


def _read_run(folder: Path) -> Any:
    """Read a run in all ways there are: in a list, its history, and to go on with."""
    for listed in Library(folder).runs():
        f"{listed.name} {listed.decisions:,} {listed.seconds:.0f} {listed.success or 0:.0%}"
    History.read(folder / "models" / "run")
    training = resume_run(folder / "models" / "run")
    training.advance()
    if training.best is not None:
        training.best.better_than(training.best)
    return training.episodes


def _digits(folder: Path, version: int) -> None:
    config = DIGIT_PRESETS["modern"].changed(filters=(2,), hidden=(4,), held_out=10, batch_size=30, epochs=4)
    training = DigitTraining(config, 0, _data())
    training.advance()
    training.seconds = float(version)
    save_digit_run(training, folder / "run")


def _read_digits(folder: Path) -> Any:
    DigitClassifier.load(folder / "run").predict(np.zeros((28, 28)))
    training = resume_digit_run(folder / "run", data=_data())
    if not training.done:
        with np.errstate(all="ignore"):
            training.advance()
    return int(training.seconds)


def _demonstrations(folder: Path, version: int) -> None:
    flights = [Demonstration(version, (0, 3, 3, 1, 2), begins=1), Demonstration(9, (0, 1), ground=4, pad=1)]
    demonstrations.write(folder / "demonstrations.json", flights)


def _read_demonstrations(folder: Path) -> Any:
    found = demonstrations.read(folder / "demonstrations.json")
    demonstrations.relive([each for each in found if len(each.actions) < 10], PRESETS["modern"])
    return found[0].seed if found else None


def _settings(folder: Path, version: int) -> None:
    SettingsFile(folder).save(Settings(model=str(version), keys={"up": ["w"]}, unknown={"new": [1, {"a": 2}]}))


def _read_settings(folder: Path) -> Any:
    settings = SettingsFile(folder).load()
    json.dumps(settings.to_dict())
    return int(settings.model) if settings.model in ("0", "1") else None


def _flight(folder: Path, version: int) -> None:
    recording = Recording(version, "random", 1, [0, 3, 3, 1], [StickHolder.HUMAN] * 4)
    entry = Entry(1e9, "CRASHED", 1.0, 0.5, 3.0, 1.0, network="modern", file=f"{version}.json")
    with suppress(FileExistsError):
        flight_file.write(folder / "flights" / entry.file, Record(recording, entry, (0.0, 1.0, 0.0)))
    with (folder / "logbook.jsonl").open("a", encoding="utf-8") as file:
        file.write(2 * (json.dumps(vars(entry)) + "\n"))


def _read_flight(folder: Path) -> Any:
    records = Records(folder)
    for entry in records.entries():
        f"{entry.when:.0f} {entry.score:,} {entry.network}"
    return [records.read(name).recording.seed for name in sorted(records.kept() or {"0.json"})][-1]


SUBJECTS = (
    Subject("network", _network, _read_network, (ModelFormatError,)),
    Subject("run", _run, _read_run, (ModelFormatError,)),
    Subject("digits", _digits, _read_digits, (ModelFormatError,)),
    Subject("demonstrations", _demonstrations, _read_demonstrations, (OSError, ValueError)),
    Subject("settings", _settings, _read_settings),
    Subject("flight", _flight, _read_flight, (ValueError,)),
)


# Damage


def _cut(path: Path, rng: np.random.Generator) -> None:
    held = path.read_bytes()
    path.write_bytes(held[: rng.integers(len(held) + 1)])


def _flip(path: Path, rng: np.random.Generator) -> None:
    held = bytearray(path.read_bytes())
    for place in rng.integers(max(1, len(held)), size=rng.integers(1, 6)):
        held[place : place + 1] = rng.bytes(1)
    path.write_bytes(held)


def _splice(path: Path, rng: np.random.Generator) -> None:
    held = path.read_bytes()
    start, end = sorted(rng.integers(len(held) + 1, size=2))
    path.write_bytes(held[:end] + rng.bytes(int(rng.integers(200))) + held[start:])


def _mutate(path: Path, rng: np.random.Generator) -> None:
    """Change one value in a JSON file, in a line of JSON lines, or in the JSON within an archive."""
    if path.suffix == ".npz":
        _mutate_archive(path, rng)
        return
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
    except ValueError:
        _flip(path, rng)
        return
    path.write_text(json.dumps(_changed(values, rng)), encoding="utf-8")


def _changed(values: Any, rng: np.random.Generator) -> Any:
    places: list[tuple[Any, Any]] = []
    level = [values]
    while level:
        each = level.pop()
        inside = list(each.items()) if isinstance(each, dict) else list(enumerate(each))
        places += [(each, key) for key, _ in inside]
        level += [value for _, value in inside if isinstance(value, dict | list)]
    if not places:
        return NASTY[rng.integers(len(NASTY))]
    holder, key = places[rng.integers(len(places))]
    choice = rng.integers(len(NASTY) + 3)
    if choice < len(NASTY):
        holder[key] = NASTY[choice]
    elif choice == len(NASTY):
        del holder[key]
    elif choice == len(NASTY) + 1:
        for _ in range(int(rng.choice([30, 200]))):
            holder[key] = [holder[key]]
    elif isinstance(holder[key], list):
        holder[key] = holder[key] * int(rng.choice([0, 2, 20_000]))
    else:
        holder[rng.choice(["x", "format"]) if isinstance(holder, dict) else 0] = holder[key]
    return values


def _mutate_archive(path: Path, rng: np.random.Generator) -> None:
    try:
        with np.load(path) as arrays:
            kept = dict(arrays)
    except Exception:
        _flip(path, rng)
        return
    name = str(rng.choice(list(kept)))
    array = kept[name]
    choices: list[Any] = [
        np.zeros((4_000, 4_000), np.float32), np.full(array.shape, 7), np.array("x" * 1000), array[..., None],
        np.zeros(0), array.astype(complex) if array.dtype.kind in "if" else array, np.asfortranarray(array),
        np.array([None]), np.full_like(array, np.nan) if array.dtype.kind == "f" else np.array(-(2**62)),
    ]  # fmt: skip
    kept[name if rng.random() < 0.8 else "more"] = choices[rng.integers(len(choices))]
    (np.savez_compressed if rng.random() < 0.5 else np.savez)(path, **kept)


def _repack(path: Path, rng: np.random.Generator) -> None:
    """Pack an archive in a way that NumPy does not, or let it claim so."""
    if not zipfile.is_zipfile(path):
        _splice(path, rng)
        return
    with zipfile.ZipFile(path) as old:
        members = {name: old.read(name) for name in old.namelist()}
    made = io.BytesIO()
    kind = int(rng.choice([zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA, zipfile.ZIP_DEFLATED]))
    with warnings.catch_warnings(), zipfile.ZipFile(made, "w", kind) as new:
        warnings.simplefilter("ignore")
        for name, held in members.items():
            for _ in range(int(rng.integers(1, 3))):
                new.writestr(name, held)
    held = bytearray(made.getvalue())
    if rng.random() < 0.5:  # encrypted, or of a kind that nobody knows
        place = held.rfind(b"PK\1\2")
        held[place + 8], held[place + 10] = int(rng.integers(2)), int(rng.choice([8, 99]))
    path.write_bytes(held)


def _claim(path: Path, rng: np.random.Generator) -> None:
    """Let an array be as large as a file full of holes."""
    if path.suffix != ".npy":
        _holes(path, rng)
        return
    header = io.BytesIO()
    shape = [(HOLES // 4,), (10_000, 7_500), (2**40,), (0, 3), (-1, 3)][rng.integers(5)]
    np.lib.format.write_array_header_1_0(header, {"descr": "<f4", "fortran_order": False, "shape": shape})
    with path.open("wb") as file:
        file.write(header.getvalue())
        file.truncate(HOLES)


def _holes(path: Path, _: np.random.Generator) -> None:
    with path.open("r+b") as file:
        file.truncate(HOLES)


def _pipe(path: Path, _: np.random.Generator) -> None:
    path.unlink()
    os.mkfifo(path)


def _folder(path: Path, _: np.random.Generator) -> None:
    path.unlink()
    path.mkdir()


def _link(path: Path, rng: np.random.Generator) -> None:
    path.unlink()
    path.symlink_to(
        [path.name, "nowhere", "/dev/zero", "/dev/tty", "/etc/passwd", "/proc/self/environ"][rng.integers(6)]
    )


def _deep(path: Path, rng: np.random.Generator) -> None:
    depth = int(rng.choice([50, 900, 100_000]))
    path.write_text('{"a":' * depth if rng.random() < 0.5 else "[" * depth + "]" * depth, encoding="utf-8")


def _remove(path: Path, _: np.random.Generator) -> None:
    path.unlink()


def _empty(path: Path, _: np.random.Generator) -> None:
    path.write_bytes(b"")


DAMAGES: tuple[Callable[[Path, np.random.Generator], None], ...] = (
    _cut, _flip, _flip, _splice, _mutate, _mutate, _mutate, _mutate, _repack, _claim, _holes, _pipe, _folder, _link,
    _deep, _remove, _empty,
)  # fmt: skip


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


# Kills


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


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=2000, help="faults for each kind of file")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", choices=[subject.name for subject in SUBJECTS])
    arguments = parser.parse_args()
    faults = []
    for subject in SUBJECTS:
        if arguments.only not in (None, subject.name):
            continue
        began = time.monotonic()
        with TemporaryDirectory() as folder:
            found = Counter(damaged(subject, arguments.count, arguments.seed, Path(folder)))
            kills = Counter(killed(subject, Path(folder)))
        faults += [f"{subject.name}: {outcome}" for outcome in {*found, *kills} - {"read", "refused", "old", "new"}]
        print(f"{subject.name:15} {found['read']:6,} read {found['refused']:6,} refused; after a kill"
              f" {kills['old']:4} old {kills['new']:4} new {time.monotonic() - began:6.0f} s", flush=True)  # fmt: skip
    print(*faults, sep="\n", end="\n" * bool(faults))
    import resource  # which not every system has

    megabytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{len(faults)} faults; at most {megabytes:.0f} MB of memory")
    return int(bool(faults) or megabytes > MEGABYTES)


if __name__ == "__main__":
    sys.exit(main())
