"""What ten demonstration landings by the scripted pilot do to the time a network needs to land 95%.

    python -m benchmarks.demonstrations [--seeds 5] [--demonstrations 10] [--seconds 60] [--classic-seconds 900]

Each preset learns alone, with the second pass over successes, and with demonstrations in its memory and its list
of successes before the first decision. The rest is as in `benchmarks.learning`: every second of training the
network flies 2,000 random validation spawns, the best so far is kept, and 95% counts as reached when it lands that
share of those; last stands what each seed's network then lands of 2,000 others. Seconds are processor time on one
thread, of training alone.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import statistics
import time
from collections.abc import Iterator

import numpy as np

from ai.lander.pilots import ScriptedPilot
from ai.training.config import PRESETS, Config
from ai.training.demonstrations import Demonstration, teach
from ai.training.loop import Training
from benchmarks.learning import Checkpoint, race
from tests.support.demonstrated import demonstrate

SHARE = 0.95
PAUSE = {"modern": 1.0, "classic": 15.0}  # seconds between two looks at the network


def lander_run(config: Config, seed: int, lessons: list[Demonstration], pause: float) -> Iterator[Checkpoint]:
    """Train one without end; flying the demonstrations again counts as training."""
    training = Training(config, seed, evaluate_every=0)
    start = time.process_time()
    teach(training.agent, lessons)
    spent = time.process_time() - start
    while True:
        start = time.process_time()
        while time.process_time() - start < pause:
            training.advance()
        spent += time.process_time() - start
        yield spent, training.agent.decisions, training.agent, training.best_agent


def reached(training: Iterator[Checkpoint], limit: float) -> tuple[float, float, float]:
    """Seconds and decisions until the network kept lands the share, infinite if not reached; and its test share."""
    (kept,), landed = race(training, limit, shares=(SHARE,))
    return (kept.seconds, float(kept.decisions), landed) if kept else (np.inf, np.inf, landed)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--demonstrations", type=int, default=10, metavar="N")
    parser.add_argument("--presets", nargs="+", choices=tuple(PAUSE), default=list(PAUSE))
    parser.add_argument("--seconds", type=float, default=60.0, help="limit of a modern run")
    parser.add_argument("--classic-seconds", type=float, default=900.0, help="limit of a classic run")
    arguments = parser.parse_args()
    lessons = demonstrate(ScriptedPilot(), arguments.demonstrations, seed=1000)
    print("| | 95% landed after: median (each seed) | decisions, median | of test then, each seed |\n|---|---|---|---|")
    for preset in arguments.presets:
        config, limit = PRESETS[preset], arguments.classic_seconds if preset == "classic" else arguments.seconds
        ways = {
            "alone": (config, []),
            "second pass": (config.changed(success_pass=True), []),
            f"{len(lessons)} demonstrations": (config.changed(success_pass=True), lessons),
        }
        if config.success_pass:
            del ways["second pass"]
        for name, (settings, given) in ways.items():
            runs = [reached(lander_run(settings, seed, given, PAUSE[preset]), limit) for seed in range(arguments.seeds)]
            seconds, decisions, shares = zip(*runs, strict=True)
            each = " ".join("–" if np.isinf(second) else f"{second:.0f}" for second in seconds)
            middle, flown = statistics.median(seconds), statistics.median(decisions)
            print(
                f"| {preset}, {name} | {_figure(middle, limit)} ({each}) | {_thousands(flown)}"
                f" | {' '.join(f'{share:.1%}' for share in shares)} |",
                flush=True,
            )


def _figure(seconds: float, limit: float) -> str:
    return f"not within {limit:g} s" if np.isinf(seconds) else f"{seconds:.0f} s"


def _thousands(decisions: float) -> str:
    return "–" if np.isinf(decisions) else f"{decisions / 1000:,.0f}k"


if __name__ == "__main__":
    main()
