"""Try the remedies of the hints: break a run on purpose, press Apply whenever a hint offers something, and look again.

    python -m benchmarks.remedies [--only WORD] [--output tests/ai/training/remedies.json]    # fifteen seconds a case

*Modern* with a small network and starts near the pad lands after two seconds. A setting of it is turned then, or is
wrong from the beginning. A run whose setting was turned is also left alone. A line has the share of the last hundred
flights that landed before the fault, with it, and after the remedies (or as long a time without them).
What is in the file already is not tried again, but with --only. `tests/ai/training/test_remedies.py` reads the file: a
hint offers only what brought the run back here.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"  # before NumPy is imported

import argparse
import json
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.training.config import PRESETS, Config
from ai.training.curves import RecentCurves
from ai.training.hints import Adviser, Hint
from ai.training.history import Checkpoint, History, SettingChange
from ai.training.lander_session import LanderSession
from ai.training.loop import Progress
from ai.training.messages import NetworkState, RunStarted
from benchmarks.broken_runs import WEAKENED

NEAR: Final = PRESETS["modern"].changed(
    num_envs=128, spawn="near", hidden=(64,), gradient_steps=8, learning_starts=500, epsilon_decisions=4_000,
    schedule_decisions=30_000,
)  # fmt: skip
HEALTHY: Final = 38_000  # decisions before a setting is turned
WITH_FAULT: Final = 200_000  # most decisions with it before a hint is given up
RECOVERY: Final = 240_000  # after the last remedy
PACE, ALONE = 10_000.0, 500.0  # decisions a second of the clock that hints go by: of many landers, and of one
TURNS: Final[dict[str, dict[str, Any]]] = {
    "epsilon_end 1": {"epsilon_end": 1.0},
    "epsilon_end 0.6": {"epsilon_end": 0.6},
    "rates 1": {"learning_rate": 1.0, "final_learning_rate": 1.0},
    "steadiness 1": {"steadiness": 1.0},
    "rates 1 and back": {"learning_rate": 1.0, "final_learning_rate": 1.0},
    "paid for staying away": {"reward_weights.distance": -5.0, "reward_weights.time": 5.0},
}
FROM_THE_START: Final[dict[str, Callable[[Config], dict[str, Any]]]] = {
    **{name: WEAKENED[name] for name in ("plain_steps", "no_replay", "one_lander")},
    "epsilon_end 0.6 from the start": lambda _: {"epsilon_end": 0.6},
    "tau 0.0001 from the start": lambda _: {"tau": 1e-4},
}


@dataclass
class Watched:
    """A live run with its hints, as the scene follows it."""

    config: Config
    resume: Path | None = None
    keep: Path | None = None
    history: History = field(default_factory=History)

    def __post_init__(self) -> None:
        pace = ALONE if self.config.num_envs == 1 else PACE
        clock = count(0.0, 0.5 * self.config.num_envs / pace).__next__
        self._run = LanderSession.live(self.config, 0, keep=self.keep, resume=self.resume, clock=clock)
        self.adviser = Adviser()
        self.history.reward_scale = self.config.reward_scale
        if self.resume:
            self.history = History.read(self.resume)
        self.problem = ""
        self.take(next(self._run))

    @property
    def decisions(self) -> int:
        """How many there were."""
        return int(self.history["decisions"][-1]) if len(self.history) else 0

    @property
    def landed(self) -> float:
        """Share of the last hundred flights."""
        return round(RecentCurves(self.history, self.config).last("success"), 3)

    def send(self, *command: Any) -> None:
        """Carry out a command."""
        self.take(self._run.send(command))
        if command[0] == "change":
            self.config = self.config.turned(*command[1:])

    def go_on(self) -> Hint | None:
        """Take one step; return the hint that is shown."""
        return self.take(next(self._run))

    def take(self, messages: tuple[Any, ...]) -> Hint | None:
        """Follow the messages."""
        for message in messages:
            if isinstance(message, RunStarted):
                self.config = message.config
            elif isinstance(message, Progress | SettingChange | Checkpoint):
                self.history.append(message)
            elif isinstance(message, NetworkState):
                return self.adviser.advise(self.history, self.config)
        return self.adviser.shown

    def close(self) -> None:
        """End it, and keep it."""
        self._run.close()


def follow(run: Watched, *, apply: bool, until: int) -> tuple[list[str], float, Watched]:
    """Press Apply on every hint, if `apply`; return what was pressed, what landed with the fault, and the run."""
    pressed: list[str] = []
    fault = np.nan
    last = run.decisions + WITH_FAULT
    while run.decisions < (last if apply else until):
        hint = run.go_on()
        if not (apply and hint and (hint.remedy or hint.back_to is not None)):
            continue
        fault = run.landed if not pressed else fault
        remedy, back_to = dict(hint.remedy), hint.back_to
        run.adviser.dismiss()
        pressed.append(f"{hint.name} {remedy}" + ("" if back_to is None else f" back to {back_to:,}"))
        last = run.decisions + RECOVERY
        live_ones = all(Config.__dataclass_fields__[name.partition(".")[0]].metadata["live"] for name in remedy)
        if not live_ones:  # it takes a new run
            parts = {name: value for name, value in remedy.items() if "." in name}
            config = run.config.changed(**{name: value for name, value in remedy.items() if name not in parts})
            for name, value in parts.items():
                config = config.turned(name, value)
            run.close()
            run, last = Watched(config), WITH_FAULT
            continue
        for name, value in remedy.items():
            run.send("change", name, value)
        if back_to is not None:
            run.send("restore", back_to)
    return pressed, fault, run


def broken(name: str, base: Path) -> tuple[float, Watched]:
    """Return what landed before a fault, and the run with it."""
    if name in FROM_THE_START:
        return np.nan, Watched(NEAR.changed(**FROM_THE_START[name](NEAR)))
    run = Watched(NEAR, base)
    before = run.landed
    for knob, value in TURNS[name].items():
        run.send("change", knob, value)
    if name == "rates 1 and back":
        while run.decisions < HEALTHY + 5_000:
            run.go_on()
        for knob in TURNS[name]:
            run.send("change", knob, getattr(NEAR, knob))
    return before, run


def main() -> None:
    """Print a line for each fault, and write them all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", metavar="WORD")
    parser.add_argument("--output", type=Path)
    options = parser.parse_args()
    found = json.loads(options.output.read_text()) if options.output and options.output.exists() else {}
    with tempfile.TemporaryDirectory() as folder:
        base = Path(folder) / "healthy"
        healthy = Watched(NEAR, keep=base)
        while healthy.decisions < HEALTHY:
            healthy.go_on()
        healthy.close()
        for name in (*TURNS, *FROM_THE_START):
            if options.only not in name or (name in found and not options.only):
                continue
            before, run = broken(name, base)
            began = run.decisions
            pressed, fault, run = follow(run, apply=True, until=0)
            after, spent = run.landed, min(run.decisions, began + RECOVERY)
            run.close()
            alone = np.nan
            if name in TURNS:
                _, run = broken(name, base)
                follow(run, apply=False, until=spent)
                alone = run.landed
                run.close()
            found[name] = {"before": before, "with": fault, "pressed": pressed, "after": after, "left alone": alone}
            print(f"{name}: {found[name]}", flush=True)
            if options.output:
                options.output.write_text(json.dumps(found, indent=1).replace("NaN", "null") + "\n")


if __name__ == "__main__":
    main()
