"""The kinds of runs: landers, and digits."""

from __future__ import annotations

from typing import Final

from ai.digits.config import DIGIT_PRESETS, DigitConfig
from ai.training.config import PRESETS, Config, in_force
from ai.training.digit_session import DigitSession
from ai.training.experiments import SABOTAGES
from ai.training.lander_session import LanderSession
from game.core import texts
from game.training.run_settings import SEED, RunKind

LANDERS: Final = RunKind(
    LanderSession, Config, PRESETS, lambda: texts.PRESETS,
    first=("learning_rate", "epsilon_end", "discount"),
    in_force=lambda config, run: in_force(config, int(run["decisions"][-1]), int(run["episodes"][-1])),
    page=(
        "learning_rate", "final_learning_rate", "epsilon_end", "epsilon_decisions", "discount", "n_step", "batch_size",
        "gradient_steps", "replay_size", "tau", "hidden", "num_envs", "spawn", "reward_weights.distance",
        "reward_weights.time", SEED,
    ),
    chapters={
        "learning_rate": "downhill", "final_learning_rate": "downhill", "epsilon_end": "daring",
        "epsilon_decisions": "daring", "discount": "choice", "n_step": "choice", "batch_size": "memory",
        "gradient_steps": "memory", "replay_size": "memory", "tau": "target", "hidden": "plane", "num_envs": "memory",
        "spawn": "pay", "reward_weights.distance": "pay", "reward_weights.time": "pay",
    },
    sabotages=tuple(SABOTAGES),
)  # fmt: skip
DIGITS: Final = RunKind(
    DigitSession, DigitConfig, {name: DIGIT_PRESETS[name] for name in ("modern", "classic")},
    lambda: texts.DIGIT_RUN_PRESETS,
    first=("learning_rate", "batch_size", "dropout"),
    in_force=lambda _, run: {"learning_rate": float(run["learning_rate"][-1])},
    page=("learning_rate", "batch_size", "dropout", "epochs", "convolutions", "hidden", "augmentation", SEED),
    chapters={"learning_rate": "downhill", "batch_size": "downhill", "epochs": "downhill", "hidden": "plane"},
    grace=1.0, patience=120.0,  # reading all test images takes long on a busy machine
)  # fmt: skip
