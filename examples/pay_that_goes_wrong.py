"""A pay that goes wrong: it pays for staying up, so that is what is learnt: train --pay FILE."""

from ai.pilots import CRASHED, OUT


def pay(before, action, after):  # noqa: ARG001
    """Pay a point for each second in the air, and nothing for a landing."""
    lost = (after.outcome == CRASHED) | (after.outcome == OUT)
    return (after.steps - before.steps) / 60 - 10.0 * (lost & (before.outcome == 0))
