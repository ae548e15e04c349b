"""Benchmarks need nothing but the game to start; what else they compare with, they name."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
EXTRAS = {
    "pytest", "hypothesis", "torch", "gymnasium", "Box2D", "envpool", "pymunk", "stable_baselines3", "ray", "optuna",
}  # fmt: skip

# Starts each benchmark so, one after another, with everything of the extras made impossible to find.
SESSION = """
import importlib, importlib.util, sys

class LeftOut:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in EXTRAS:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, LeftOut())
found = importlib.util.find_spec
importlib.util.find_spec = lambda name, *more: None if name in EXTRAS else found(name, *more)
for name, *options in CASES:
    sys.argv = [name, *options]
    try:
        importlib.import_module(f"benchmarks.{name}").main()
        end = "went on to its end"
    except SystemExit as ended:
        end = ended.code
    except BaseException as error:
        end = f"{type(error).__name__}: {error}"
    print("ENDED", name, end)
"""


@pytest.mark.slow
def test_every_benchmark_says_what_it_does_and_what_it_needs():
    names = [path.stem for path in sorted((ROOT / "benchmarks").glob("*.py")) if "def main(" in path.read_text()]
    assert len(names) > 20
    cases = [*([name, "--help"] for name in names), ["lunar_lander"]]
    program = f"EXTRAS, CASES = {EXTRAS!r}, {cases!r}\n{SESSION}"
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False, timeout=300
    )
    ends = [line.split(" ", 2)[1:] for line in done.stdout.splitlines() if line.startswith("ENDED ")]
    assert len(ends) == len(cases), done.stderr
    assert [end for end in ends[:-1] if end[1] != "0"] == []
    assert ends[-1][1].startswith("this needs "), "one that cannot do without an extra names it"
    assert "pip install" in ends[-1][1]
