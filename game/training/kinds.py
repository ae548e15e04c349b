"""Kinds of runs, as the window starts them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

from ai.common.knobs import Knobs
from ai.digits.config import DigitConfig
from ai.training.config import Config
from ai.training.digit_session import live_digits
from ai.training.history import COLUMNS, DIGIT_COLUMNS
from ai.training.lander_session import live
from game.core.worker import PATIENCE


@dataclass(frozen=True)
class WorkedRun:
    """Kind of run, as the window starts it.

    Attributes:
        live: the generator that a worker pulls.
        config: settings before the first run.
        columns: what its history measures.
        grace: seconds that a run has to end by itself when the window closes it.
        patience: seconds for a turn of its worker.

    """

    live: Callable[..., Any]
    config: Knobs
    columns: Sequence[str]
    grace: float
    patience: float = PATIENCE


LANDERS: Final = WorkedRun(live, Config(), COLUMNS, grace=3.0)  # which save themselves at the end
# Reading all test images takes long on a busy machine.
DIGITS: Final = WorkedRun(live_digits, DigitConfig(), DIGIT_COLUMNS, grace=1.0, patience=120.0)
