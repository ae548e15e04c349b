"""Score of a landing, in points."""

from __future__ import annotations

from ai.lander.environment import LanderEnv


def landing_score(env: LanderEnv, slot: int = 0) -> int:
    """Return the score of a landing: up to 100 times its pad's factor, less for a hard touch or off the middle."""
    number = int(env.landed_on[slot])
    if number < 0:
        return 0
    pad = env.ground.pads[number]
    hard = min(1.0, float(env.impact[slot, 0]) / env.limits.touch_speed)
    aside = min(1.0, abs(float(env.position[slot, 0] - env.pad_shift[slot]) - pad.x) / (pad.width / 2))
    return pad.factor * round(100 - 40 * hard - 30 * aside)
