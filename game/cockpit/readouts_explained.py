"""Explanations of the read-outs on the ground line, with the limits of a touchdown."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

from ai.lander.environment import LanderEnv
from game.cockpit import hud
from game.core import texts
from game.drawing.canvas import Canvas


def explain_readouts(canvas: Canvas, env: LanderEnv, slot: int = 0, columns: Sequence[float] = hud.COLUMNS) -> None:
    """Explain the first read-outs of `hud.flight_readouts`, as many as there are columns."""
    for number, x in enumerate(columns):
        hud.column(canvas, x).explain(
            hud.readout_box(x), texts.EXPLAIN_READOUTS[number], partial(_now, env, slot, number)
        )


def _now(env: LanderEnv, slot: int, number: int) -> str:
    """Say what a read-out means now."""
    limits = env.limits
    across, up = env.velocity[slot].tolist()
    if env.conditions.moves:  # on a moving pad, the speed relative to the pad counts
        across -= float(env.pad_velocity[slot])
    value, limit = (
        (max(0.0, float(env.altitude[slot])), math.inf),
        (-up, limits.touch_speed),
        (abs(across), limits.slide_speed),
        (math.degrees(float(env.tilt[slot])), math.degrees(limits.touch_tilt)),
        (float(env.fuel[slot]), math.inf),
        (float(env.time[slot]), math.inf),
    )[number]
    if number == 1 and up > 0:
        return texts.EXPLAIN_CLIMBING.format(value=up)
    said = texts.EXPLAIN_READOUTS_NOW[number].format(value=value, limit=limits.time if number == 5 else limit)
    return f"{said} {texts.EXPLAIN_BEYOND}" if value > limit else said
