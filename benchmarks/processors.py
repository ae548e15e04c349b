"""The tests whose numbers could depend on the processor, once for each that this one can stand in for.

    python -m benchmarks.processors [--only Haswell ...] [TESTS ...] [-- PYTEST OPTIONS]

OpenBLAS multiplies matrices by other code on each kind of processor, and NumPy has other loops for each set of
instructions: both round otherwise. Of the kernels in this machine's library, those that it can run are taken one after
another, then its own with ever fewer of NumPy's instructions. Fails if any test does, and names under what.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from typing import Final

TESTS: Final = ("tests/engine", "tests/ai/nn", "tests/ai/agent", "tests/ai/training", "tests/game/learn")
KERNELS: Final = (
    "Prescott", "Nehalem", "Sandybridge", "Haswell", "Zen", "SkylakeX", "Cooperlake", "SapphireRapids",
    "ARMV8", "NEOVERSEN1", "NEOVERSEV1", "CORTEXA57",
)  # fmt: skip
# Multiplies two matrices, in case an instruction is not there, and prints the kernel that did and NumPy's instructions.
_PROBE: Final = """
import ctypes, glob, numpy as np
from numpy._core._multiarray_umath import __cpu_dispatch__ as known, __cpu_features__ as there
for kind in np.float32, np.float64:
    np.ones((64, 64), kind) @ np.ones((64, 64), kind)
kernel = "the library's own"
for path in glob.glob(np.__path__[0] + "/../numpy.libs/libscipy_openblas*"):
    name = ctypes.CDLL(path).scipy_openblas_get_corename64_
    name.restype = ctypes.c_char_p
    kernel = name().decode()
print(kernel, *(feature for feature in known if there[feature]), sep=",")
"""


def probe(**settings: str) -> list[str]:
    """Return the kernel and NumPy's instructions in a process with these settings; nothing if it can't run."""
    command = [sys.executable, "-W", "ignore", "-c", _PROBE]
    run = subprocess.run(command, env={**os.environ, **settings}, capture_output=True, text=True, check=False)
    return run.stdout.strip().split(",") if run.returncode == 0 else []


def processors() -> dict[str, dict[str, str]]:
    """Return the environment variables of every processor that this one can stand in for, by name."""
    own, *instructions = probe()
    found, seen = {own: {"OPENBLAS_CORETYPE": ""}}, {own}
    for name in KERNELS:
        kernel = probe(OPENBLAS_CORETYPE=name)[:1]
        if not seen.issuperset(kernel):
            seen.update(kernel)
            found[name] = {"OPENBLAS_CORETYPE": name}
    for first in reversed(range(len(instructions))):
        fewer = " ".join(instructions[first:])
        found[f"{own} without {fewer}"] = {"NPY_DISABLE_CPU_FEATURES": fewer}
    return found


def main() -> int:
    """Run the tests on each."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", help="kernels of these names alone")
    parser.add_argument("tests", nargs="*", default=list(TESTS))
    options, given = parser.parse_known_args()
    found = processors()
    chosen = {name: each for name, each in found.items() if not options.only or name in options.only}
    if not chosen:
        parser.error(f"this processor has {', '.join(found)}")
    print("processors:", ", ".join(chosen), flush=True)
    failed = []
    for name, settings in chosen.items():
        print(f"\n{name}: {settings}", flush=True)
        command = [sys.executable, "-m", "pytest", "-q", "-n", "2", *options.tests, *given]
        if subprocess.run(command, env={**os.environ, **settings}, check=False).returncode:
            failed.append(name)
    print(f"\n{len(chosen)} processors; failures on: {', '.join(failed) or 'none'}")
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main())
