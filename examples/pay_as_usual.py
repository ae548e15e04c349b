"""What each decision earns: the nine parts of the usual pay. Change a copy, and train --pay FILE."""

import numpy as np

from ai.pilots import CRASHED, FLYING, LANDED, OUT


def pay(before, action, after):
    """Return the points (n,) of n landers for one decision. All of before, action and after are arrays (n,)."""
    # distance: metres from standing on the pad's middle, offset: of these sideways. speed: m/s. tilt: radians.
    # aligned: upright above the pad, 0 to 1. steps: sixtieths of a second flown; tilted_steps, feet_steps: of these
    # tilted by more than 0.6 radians, with both feet down. outcome: FLYING, LANDED, CRASHED, OUT or late.
    steps, flew = after.steps - before.steps, before.outcome == FLYING
    held, lost = before.actions, (after.outcome == CRASHED) | (after.outcome == OUT)
    points = 5.0 * (before.distance - after.distance)
    points = points + 0.5 * (before.speed - after.speed)
    points += 30.0 * (after.aligned - before.aligned)
    points -= 0.05 * (after.tilted_steps - before.tilted_steps)
    points += np.minimum(after.feet_steps, 30) - np.minimum(before.feet_steps, 30)
    points -= 0.02 * steps * (action > 0)  # an engine fires
    points -= 0.0 * flew * (((held >= 3) != (action >= 3)) * 1 + (held % 3 != action % 3))  # an engine is switched
    points -= 0.2 * steps  # hovering must not pay
    points += 120.0 * flew * (after.outcome == LANDED) - 120.0 * flew * lost
    return points
