"""Record short runs with a knob at an absurd value each, for the tests of the hints that Train gives.

    python -m benchmarks.broken_runs [--only WORD] [--output tests/ai/broken_runs.npz]

Every case is a real run of the live training, single-threaded: each knob that matters at its lowest and highest
value for either preset, healthy runs, and runs in which a knob is turned on the way. What the rules of
`ai.training.hints` look at is written down: the points of the curves, silent units, gradients that were cut short.
Seconds are those of a clock that ticks with the decisions, as on a machine with much else to do, so that the same
seed makes the same file. A file that is there is added to; --only records the cases with that word in their names,
also anew.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"  # before NumPy is imported

import argparse
import json
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, fields
from itertools import count
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.training.config import PRESETS, Config
from ai.training.experiments import SABOTAGES
from ai.training.lander_session import LanderSession
from ai.training.loop import Progress

COLUMNS: Final = (
    "seconds", "decisions", "episodes", "success_rate", "mean_return", "loss", "mean_q", "epsilon", "stage",
    "crashed", "out_of_bounds", "timed_out",
)  # fmt: skip
MANY, ALONE = 2_500.0, 150.0  # decisions a second of many landers, and of one
SHORT: Final = {"modern": 30_000, "classic": 3_000}  # decisions of a run
LATE: Final = 180_000  # decisions after which modern should land
PATIENCE: Final = 40.0  # seconds of the processor for one run
_MANTISSA: Final = 12  # bits that are kept of a number
TURNED: Final = (
    "discount", "n_step", "batch_size", "gradient_steps", "gradient_clip", "schedule_decisions", "output_scale",
    "replay_size", "learning_starts", "target_update_interval", "tau", "epsilon_start", "epsilon_end",
    "epsilon_decay", "epsilon_decisions", "epsilon_spread", "random_main", "steadiness", "num_envs", "frame_skip",
    "final_touchdown_limits", "reward_scale",
)  # fmt: skip


# Parts that are taken away from a preset; the sabotages of Train are some of them.
WEAKENED: Final[dict[str, Callable[[Config], dict[str, Any]]]] = {
    **SABOTAGES,
    "no_target": lambda _: {"target_update_interval": 1, "tau": 1.0},
    "no_n_step": lambda _: {"n_step": 1},
    "one_lander": lambda _: {"num_envs": 1},
    "uniform_actions": lambda _: {"random_main": 0.5},
    "no_practice": lambda _: {"spawn": "random"},
    "plain_steps": lambda _: {"optimizer": "sgd"},
}


@dataclass(frozen=True)
class Case:
    """One run: a preset with changes, for so many decisions, and knobs that are turned on the way."""

    preset: str
    changes: dict[str, Any] = field(default_factory=dict)
    decisions: int = 0
    turns: dict[int, dict[str, Any]] = field(default_factory=dict)  # by the decisions after which
    seed: int = 0

    @property
    def config(self) -> Config:
        """What it begins with."""
        return PRESETS[self.preset].changed(**self.changes)


def cases() -> Iterator[tuple[str, Case]]:
    """Name every run there is to record, the most telling first."""
    rates = ("learning_rate", "final_learning_rate")
    at_one, as_preset = (lambda _: dict.fromkeys(rates, 1.0)), (lambda p: {n: getattr(PRESETS[p], n) for n in rates})
    for preset, short in SHORT.items():
        for rate in (1.0, 0.3, 0.1, 0.03, 1e-5):
            yield f"{preset} rates {rate:g}", Case(preset, dict.fromkeys(rates, rate), 2 * short)
        yield f"{preset} learning_rate 1", Case(preset, {"learning_rate": 1.0}, 2 * short)
        yield f"{preset} healthy", Case(preset, {}, LATE if preset == "modern" else 4 * short)
        mended = {short: at_one(preset), 2 * short: as_preset(preset)}
        yield f"{preset} rates to 1 and back", Case(preset, {}, (LATE if preset == "modern" else 3 * short), mended)
    yield "modern healthy, another seed", Case("modern", {}, LATE, seed=1)
    broken = {140_000: at_one("modern"), 160_000: as_preset("modern")}
    yield "modern rates to 1 and back, late", Case("modern", {}, LATE, broken)
    for name, sabotage in WEAKENED.items():
        changed = PRESETS["modern"].changed(**sabotage(PRESETS["modern"]))
        changes = {
            item.name: value
            for item in fields(Config)
            if (value := getattr(changed, item.name)) != getattr(PRESETS["modern"], item.name)
        }
        late = name in ("short_sight", "rate_times_100", "no_shaping", "plain_steps")
        length = 2_000 if name == "one_lander" else LATE if late else SHORT["modern"]
        yield f"modern sabotage {name}", Case("modern", changes, length)
    for preset, short in SHORT.items():
        for name in TURNED:
            described = Config.__dataclass_fields__[name].metadata
            for value in (described["low"], described["high"]):
                kind = type(getattr(Config(), name))
                if kind(value) != getattr(PRESETS[preset], name):
                    alone = name == "num_envs" and value == 1
                    more = {"replay_prune": 1} if name == "replay_size" else {}
                    yield (
                        f"{preset} {name} {value:g}",
                        Case(preset, {name: kind(value)} | more, 2_000 if alone else short),
                    )


def record(case: Case) -> tuple[np.ndarray, dict[str, Any]]:
    """Run a case; return its points, (n, len(COLUMNS)), and what is to be known of it."""
    config = case.config
    rows: list[list[float]] = []
    turns = sorted(case.turns.items())
    done: list[tuple[int, str, Any]] = []
    problem, taken, began = "", 0, time.process_time()
    going = LanderSession.live(
        config, case.seed, clock=_clock(ALONE if config.num_envs == 1 else MANY / config.num_envs)
    )
    try:
        messages = next(going)
        while taken < case.decisions and time.process_time() - began < PATIENCE:
            for message in messages:
                if isinstance(message, Progress):
                    taken = int(message.decisions)
                    rows.append([getattr(message, name) for name in COLUMNS])
            if turns and taken >= turns[0][0]:
                for name, value in turns.pop(0)[1].items():
                    going.send(("change", name, value))
                    done.append((taken, name, value))
            messages = next(going)
    except FloatingPointError as error:
        problem = str(error)
    finally:
        going.close()
    described = {"preset": case.preset, "changes": case.changes, "turns": done, "problem": problem}
    return np.array(rows), described


def _clock(turns: float) -> Callable[[], float]:
    """Return a clock by which so many turns of a live run take a second: each looks at it twice."""
    return count(0.0, 1.0 / turns).__next__


def write(file: Path, tables: dict[str, np.ndarray], described: dict[str, Any]) -> None:
    """Write all cases; numbers keep as many digits as a curve shows, so that the file is small."""
    arrays = {name: _short(table).T.copy() for name, table in tables.items()}
    text = np.array(json.dumps({"columns": COLUMNS, "cases": described}, default=vars))
    np.savez_compressed(file, allow_pickle=False, described=text, **arrays)


def _short(table: np.ndarray) -> np.ndarray:
    bits = table.astype(np.float32).view(np.uint32)
    half = np.uint32(1 << (22 - _MANTISSA))
    rounded = ((bits + half) & ~np.uint32((1 << (23 - _MANTISSA)) - 1)).view(np.float32)
    return np.where(np.isfinite(table), rounded, table.astype(np.float32))


def main() -> None:
    """Record what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", metavar="WORD")
    parser.add_argument("--output", type=Path, default=Path("tests/ai/training/broken_runs.npz"))
    options = parser.parse_args()
    tables: dict[str, np.ndarray] = {}
    described: dict[str, Any] = {}
    if options.output.exists():
        with np.load(options.output, allow_pickle=False) as arrays:
            described = json.loads(str(arrays["described"]))["cases"]
            tables = {name: arrays[name].T for name in described}
    for name, case in cases():
        if options.only not in name or (not options.only and name in tables):
            continue
        began = time.process_time()
        tables[name], described[name] = record(case)
        last = dict(zip(COLUMNS, tables[name][-1], strict=True)) if len(tables[name]) else {}
        print(
            f"{name}: {time.process_time() - began:.1f} s,",
            {k: round(float(v), 3) for k, v in last.items()},
            described[name]["problem"],
            flush=True,
        )
        write(options.output, tables, described)


if __name__ == "__main__":
    main()
