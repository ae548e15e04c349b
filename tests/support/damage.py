"""Ways to damage a file, whole or damaged before; each takes its path and a random generator."""

from __future__ import annotations

import io
import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

HOLES = 300_000_000  # bytes of a file that takes no room on the disk
NASTY: tuple[Any, ...] = (
    None, True, -1, 0, 2, 0.5, 1e308, 10**30, 10**400, float("inf"), float("nan"), "", "x", "x" * 100_000, [], {},
    [1024] * 400, [1] * 60_000, "os:system", "../../etc", "\ud800", "\0", 1_000_000, -(10**18),
)  # fmt: skip


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


def mutate(path: Path, rng: np.random.Generator) -> None:
    """Change one value in a JSON file, in a line of JSON lines, or in the JSON within an archive."""
    if path.suffix == ".npz":
        _mutate_archive(path, rng)
        return
    try:
        changed = json.dumps(_changed(json.loads(path.read_text(encoding="utf-8")), rng))
    except (ValueError, RecursionError):  # damaged before: no JSON, or nested too deeply
        _flip(path, rng)
        return
    path.write_text(changed, encoding="utf-8")


def _changed(values: Any, rng: np.random.Generator) -> Any:
    places: list[tuple[Any, Any]] = []
    level = [values] if isinstance(values, dict | list) else []
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
        with np.load(io.BytesIO(path.read_bytes())) as arrays:
            kept = dict(arrays)
        name = str(rng.choice(list(kept)))
    except Exception:  # no archive, an empty one, or one damaged before
        _flip(path, rng)
        return
    array = kept[name] if kept[name].size < 1_000_000 else kept[name].ravel()[:1000]  # huge once is enough for memory
    choices: list[Any] = [
        np.zeros((4_000, 4_000), np.float32), np.full(array.shape, 7), np.array("x" * 1000), array[..., None],
        np.zeros(0), array.astype(complex) if array.dtype.kind in "if" else array, np.asfortranarray(array),
        np.array([None]), np.full_like(array, np.nan) if array.dtype.kind == "f" else np.array(-(2**62)),
    ]  # fmt: skip
    kept[name if rng.random() < 0.8 else "more"] = choices[rng.integers(len(choices))]
    (np.savez_compressed if rng.random() < 0.5 else np.savez)(path, **kept)


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
    _cut, _flip, _flip, _splice, mutate, mutate, mutate, mutate, _holes, _pipe, _folder, _link,
    _deep, _remove, _empty,
)  # fmt: skip
