"""A monkey plays the real game at random, until something breaks: see `tests.support.monkey`.

    python -m benchmarks.monkey [--events 100000] [--seed 0]

Exit code 1 if there is any fault, if memory or the number of open files grows, or if a scene was never seen.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
os.environ["SDL_VIDEODRIVER"] = os.environ["SDL_AUDIODRIVER"] = "dummy"

import argparse
import ctypes
import sys
from contextlib import suppress
from pathlib import Path

from tests.support.monkey import Monkey, playground
from tests.support.tour import scene_types

LOOKS = 10  # times that it is looked whether anything is left behind
GROWTH = 30.0  # megabytes from the third look to the last that are no leak
_NO_SCREENS = ("ErrorScene", "Dialog")  # what is not to be seen, and what is only a part of others


def resident() -> float:
    """Return the megabytes this process has in memory; 0 where the system does not tell.

    What the allocator holds free between what is in use, some 100 MB, first goes back to the system.
    """
    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).malloc_trim(0)
    file = Path("/proc/self/statm")
    return int(file.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6 if file.exists() else 0.0


def open_files() -> int:
    """Return how many files this process holds open; 0 where the system does not tell."""
    folder = Path("/proc/self/fd")
    return len(list(folder.iterdir())) if folder.exists() else 0


def main() -> int:
    """Play, and say where it has been and what went wrong."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--events", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    problems: list[str] = []
    memory, files, printed = [], [], 0
    with playground() as folder:
        monkey = Monkey(folder, arguments.seed)
        for look in range(1, LOOKS + 1):
            monkey.play(round(arguments.events * look / LOOKS))
            left = monkey.left_behind()
            problems += [f"left behind: {each}" for each in left]
            memory.append(resident())
            files.append(open_files())
            print(
                f"{monkey.events:7d} events, {monkey.games:3d} games, {memory[-1]:4.0f} MB, {files[-1]} open files, "
                f"{len(monkey.faults.found)} faults, {len(left)} left behind",
                flush=True,
            )
            for each in (*left, *monkey.faults.found[printed:]):
                print(f"\n{each}\n", flush=True)
            printed = len(monkey.faults.found)
    if monkey.faults.found:
        problems.append(f"{len(monkey.faults.found)} faults")
    if memory[-1] - memory[2] > GROWTH:
        problems.append("memory grew: " + " ".join(f"{each:.0f}" for each in memory) + " MB")
    if files[-1] > files[2]:
        problems.append(f"open files: {files}")
    for name in sorted({each.__name__ for each in scene_types()} | set(monkey.visits)):
        print(f"{name:20s}{monkey.entered[name]:6d} times{monkey.visits[name]:8d} frames")
        if not monkey.visits[name] and name not in _NO_SCREENS:
            problems.append(f"{name} was never seen")
    print("\n".join(problems) or "nothing broke, and nothing was left behind")
    return int(bool(problems))


if __name__ == "__main__":  # a process that trains imports this file and must not run it again
    sys.exit(main())
