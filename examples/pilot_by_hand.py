"""A pilot by hand that lands nearly always: `python main.py evaluate --pilot examples/pilot_by_hand.py`."""

import numpy as np

from ai.pilots import drift, fall, height, offset, spin, tilt


def act_many(observations):
    """Choose an action (n,) for each of n landers: 3 for the main engine, and 1 for a turn to the left, 2 right."""
    aim = np.clip(-0.35 * offset(observations), -2.5, 2.5)  # the drift that leads to the pad
    lean = np.clip(0.35 * (drift(observations) - aim), -0.4, 0.4)
    turn = 3 * (lean - tilt(observations)) - 2 * spin(observations)
    above = height(observations) - 0.3 * np.abs(offset(observations))  # far from the pad, it stays up
    main = fall(observations) > np.clip(0.4 + 0.3 * above, -0.5, 3)
    return 3 * main + np.where(turn > 0.25, 1, np.where(turn < -0.25, 2, 0))
