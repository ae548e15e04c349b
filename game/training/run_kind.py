"""The kinds of runs: landers, and digits."""

from __future__ import annotations

from typing import Final

from ai.digits.config import DIGIT_PRESETS, DigitConfig
from ai.training.config import PRESETS, Config, idle
from ai.training.digit_session import DigitSession
from ai.training.experiments import SABOTAGES
from ai.training.lander_session import LanderSession
from game.core import texts
from game.training.run_settings import RunKind

LANDERS: Final = RunKind(
    LanderSession, Config, PRESETS, lambda: texts.PRESETS, "lander", ("learning_rate", "epsilon_end", "discount"),
    tuple(SABOTAGES), idle,
)  # fmt: skip
DIGITS: Final = RunKind(
    DigitSession, DigitConfig, {name: DIGIT_PRESETS[name] for name in ("modern", "classic")},
    lambda: texts.DIGIT_RUN_PRESETS, "images", ("learning_rate", "batch_size", "dropout"),
    grace=1.0, patience=120.0,  # reading all test images takes long on a busy machine
)  # fmt: skip
