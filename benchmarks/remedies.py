"""Try the remedies of the hints: break a run on purpose, press Apply whenever a hint offers something, and look again.

    python -m benchmarks.remedies    # some three minutes

*Modern* with a small network and starts near the pad lands after two seconds. A setting of it is turned then, or is
wrong from the beginning. A line has the share of the last hundred flights that landed with the fault, and after the
remedies.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"  # before NumPy is imported

import argparse
from itertools import count
from typing import Any, Final

from ai.training.config import PRESETS, Config
from ai.training.hints import Adviser, Hint
from ai.training.history import Checkpoint, History, SettingChange
from ai.training.lander_session import LanderSession
from ai.training.loop import Progress

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
    "rates 1": {"learning_rate": 1.0, "final_learning_rate": 1.0},
    "steadiness 1": {"steadiness": 1.0},
    "paid for staying away": {"reward_weights.distance": -5.0, "reward_weights.time": 5.0},
}
FROM_THE_START: Final[dict[str, dict[str, Any]]] = {
    "plain steps": {"optimizer": "sgd"},
    "no memory": {"replay_size": NEAR.batch_size, "replay_prune": 1},
    "one lander": {"num_envs": 1},
    "epsilon_end 0.6": {"epsilon_end": 0.6},
    "tau 0.0001": {"tau": 1e-4},
}


class Watched:
    """A live run with its hints, as Train follows it."""

    def __init__(self, config: Config) -> None:
        pace = ALONE if config.num_envs == 1 else PACE
        self._run = LanderSession.live(config, clock=count(0.0, 0.5 * config.num_envs / pace).__next__)
        self.config, self.adviser, self.history = config, Adviser(), History()
        self.history.reward_scale = config.reward_scale

    @property
    def decisions(self) -> int:
        """How many there were."""
        return self._run.training.moment

    @property
    def landed(self) -> float:
        """Share of the last hundred flights."""
        return self._run.training.statistics.shares[0]

    def go_on(self, *command: Any) -> Hint | None:
        """Take a step, or carry out a command; return the hint that is shown."""
        for message in self._run.send(command) if command else next(self._run):
            if isinstance(message, Progress | SettingChange | Checkpoint):
                self.history.append(message)
        self.config = self._run.training.config
        return self.adviser.advise(self.history, self.config)


def mended(run: Watched) -> tuple[list[str], float, float]:
    """Press Apply on every hint; return what was pressed, and what landed before that and at last."""
    pressed: list[str] = []
    fault, last = 0.0, run.decisions + WITH_FAULT
    while run.decisions < last:
        hint = run.go_on()
        if hint is None or not (hint.remedy or hint.back_to is not None):
            continue
        fault = fault if pressed else run.landed
        pressed.append(hint.name)
        run.adviser.dismiss()
        if not set(run.config.live_names()).issuperset(name.partition(".")[0] for name in hint.remedy):
            run, last = Watched(run.config.changed(**hint.remedy)), RECOVERY  # it takes a new run
            continue
        for name, value in hint.remedy.items():
            run.go_on("change", name, value)
        if hint.back_to is not None:
            run.go_on("restore", hint.back_to)
        last = run.decisions + RECOVERY
    return pressed, fault, run.landed


def main() -> None:
    """Print a line for each fault."""
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    for name, changes in (TURNS | FROM_THE_START).items():
        run = Watched(NEAR if name in TURNS else NEAR.changed(**changes))
        if name in TURNS:
            while run.decisions < HEALTHY:
                run.go_on()
            for knob, value in changes.items():
                run.go_on("change", knob, value)
        pressed, fault, landed = mended(run)
        print(f"{name:22} {fault:5.0%} with it, {landed:5.0%} after {', '.join(pressed) or 'no hint'}", flush=True)


if __name__ == "__main__":
    main()
