"""Damage every kind of file, kill every writer at every step, and count what becomes of it.

    python -m benchmarks.faults [--count 2000] [--seed 0] [--only NAME]

What is damaged, how, and what has to hold is in `tests.support.faults`; here it is done thousands of times, within
500 MB of memory. Exit code 1 if any of that fails.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
os.environ.setdefault("SDL_VIDEODRIVER", "dummy")

import argparse
import sys
import time
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.support.faults import damaged, killed
from tests.support.saved import SUBJECTS

MEGABYTES = 500  # of memory, all in all


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
        print(
            f"{subject.name:15} {found['read']:6,} read {found['refused']:6,} refused; after a kill"
            f" {kills['old']:4} old {kills['new']:4} new {time.monotonic() - began:6.0f} s",
            flush=True,
        )
    print(*faults, sep="\n", end="\n" * bool(faults))
    import resource  # which not every system has

    megabytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{len(faults)} faults; at most {megabytes:.0f} MB of memory")
    return int(bool(faults) or megabytes > MEGABYTES)


if __name__ == "__main__":
    sys.exit(main())
