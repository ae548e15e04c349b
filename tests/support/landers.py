"""Landers put where a test wants them, and flown by one action."""

from __future__ import annotations

from typing import Any

import numpy as np

from ai.environment import StepResult
from ai.lander.environment import PARAMS, LanderEnv

STAND = PARAMS.pad_top + PARAMS.stand  # metres: where the middle of a lander is that stands on the pad


def put(env: LanderEnv, *starts: Any) -> LanderEnv:
    """Begin flights at x, y, vx, vy, angle, spin, zeros where less is said: one for each lander, or one for all."""
    rows = np.zeros((len(starts), 6))
    for row, start in zip(rows, starts, strict=True):
        row[: len(start)] = start
    env.place(np.ones(env.num_envs, dtype=bool), np.broadcast_to(rows, (env.num_envs, 6)))
    return env


def placed(*starts: Any, frame_skip: int = 1, **options: Any) -> LanderEnv:
    """Return landers that begin at these starts."""
    return put(LanderEnv(len(starts), 0, frame_skip=frame_skip, **options), *starts)


def fly(env: LanderEnv, action: Any = 0, steps: int = 600) -> StepResult:
    """Take one action, or one for each, until all have ended or for so many decisions; return the last result."""
    for _ in range(steps):
        result = env.step(np.broadcast_to(action, env.num_envs))
        if result.ended.all():
            break
    return result
