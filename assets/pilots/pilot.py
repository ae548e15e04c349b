"""A pilot of your own. Whenever you save this file, the new one flies."""

from ai.pilots import COAST, LEFT, MAIN, MAIN_LEFT, MAIN_RIGHT, RIGHT, drift, fall, feet, height, offset, spin, tilt


def act(observation):
    """Choose one of six actions, 15 times a second."""
    # In metres: height above the pad, offset to the right of its middle. Metres a second: fall, drift to the right.
    # Radians: tilt to the left, and a second: spin to the left. feet: how many are down, 0 to 2.
    aim = 0.0  # the drift that it wants, in metres a second. Does it know where the pad is?
    lean = 0.3 * (drift(observation) - aim)  # against the drift, for the engine to brake it
    turn = 3 * (lean - tilt(observation)) - 2 * spin(observation)
    too_fast = fall(observation) > 0.5 + 0.3 * height(observation)  # the lower, the slower
    if turn > 0.25:
        return MAIN_LEFT if too_fast else LEFT
    if turn < -0.25:
        return MAIN_RIGHT if too_fast else RIGHT
    return MAIN if too_fast else COAST
