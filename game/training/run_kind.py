"""The kinds of runs: landers, and digits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from ai.digits.config import DIGIT_PRESETS, DigitConfig
from ai.training.config import PRESETS, Config
from ai.training.digit_session import DigitSession
from ai.training.lander_session import LanderSession
from ai.training.session import Session
from game.core import texts
from game.core.worker import PATIENCE

Configuration = Any  # `ai.training.config.Config`, or another dataclass with fields described in the same way


class Knob(NamedTuple):
    """Knob on the screen, for a setting: the values it offers, and the chapter of Learn that explains it.

    Words, shapes and switches are a choice among a few; numbers are on a track, the smallest on the left.
    """

    stops: tuple[Any, ...]
    chapter: str = ""


@dataclass(frozen=True)
class RunKind:
    """Kind of run: how it is started, and its knobs and presets."""

    session: type[Session[Any]]  # leads it in a worker
    of: type[Configuration]
    presets: Mapping[str, Configuration]
    words: Callable[[], Mapping[str, tuple[str, str]]]  # the label of each preset, and a sentence about it
    first: tuple[str, ...]  # names of the few knobs to begin with
    knobs: Mapping[str, Knob]  # those on one page, on demand; all other settings are for `--set` of the command
    grace: float = 3.0  # seconds that a run has to end by itself when the window closes it
    patience: float = PATIENCE  # seconds for a turn of its worker


_RATES: Final = (1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
_SHARES: Final = (0.0, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0)
_DISCOUNTS: Final = (0.8, 0.9, 0.95, 0.97, 0.98, 0.99, 0.995, 0.997, 0.998, 0.999, 0.9995, 0.9999)
_POWERS: Final = tuple(2**power for power in range(11))
_SIZES: Final = (100, 300, 1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000)
_DISTANCE: Final = (0.0, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)
_TIME: Final = (0.0, -0.02, -0.05, -0.1, -0.2, -0.4, -1.0, -2.0)
_LAYERS: Final = ((16, 16), (32, 32), (64, 64), (128, 128), (256, 256), (64, 64, 64))
_DIGIT_LAYERS: Final = ((32,), (128,), (512,), (100, 50), (256, 128))
_SPAWNS: Final = ("near", "curriculum", "widening", "wide", "thorough", "far")

LANDERS: Final = RunKind(
    LanderSession,
    Config,
    PRESETS,
    lambda: texts.PRESETS,
    first=("learning_rate", "epsilon_end", "discount"),
    knobs={
        "learning_rate": Knob(_RATES, "downhill"),
        "final_learning_rate": Knob(_RATES, "downhill"),
        "epsilon_end": Knob(_SHARES, "daring"),
        "epsilon_decisions": Knob((0, *_SIZES[2:]), "daring"),
        "discount": Knob(_DISCOUNTS, "choice"),
        "n_step": Knob(tuple(range(1, 21)), "choice"),
        "batch_size": Knob(_POWERS[3:], "memory"),
        "gradient_steps": Knob(_POWERS[:6], "memory"),
        "replay_size": Knob(_SIZES, "memory"),
        "tau": Knob(_RATES[3:], "target"),
        "hidden": Knob(_LAYERS, "plane"),
        "num_envs": Knob(_POWERS, "memory"),
        "spawn": Knob(_SPAWNS, "pay"),
        "reward_weights.distance": Knob(_DISTANCE, "pay"),
        "reward_weights.time": Knob(_TIME, "pay"),
    },
)
DIGITS: Final = RunKind(
    DigitSession,
    DigitConfig,
    {name: DIGIT_PRESETS[name] for name in ("modern", "classic")},
    lambda: texts.DIGIT_RUN_PRESETS,
    first=("learning_rate", "batch_size", "dropout"),
    knobs={
        "learning_rate": Knob(_RATES, "downhill"),
        "batch_size": Knob((1, 3, 10, 30, 100, 300, 1000, 3000), "downhill"),
        "dropout": Knob(tuple(tenth / 10 for tenth in range(10))),
        "epochs": Knob((1, 2, 3, 5, 10, 20, 30, 50, 100), "downhill"),
        "convolutions": Knob((False, True)),
        "hidden": Knob(_DIGIT_LAYERS, "plane"),
        "augmentation": Knob((0.0, 0.2, 0.5, 1.0, 1.5, 2.0)),
    },
    grace=1.0,
    patience=120.0,  # reading all test images takes long on a busy machine
)
