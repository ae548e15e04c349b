"""Help that fades: the dial follows the estimate of how often the player would land alone, in small steps.

It changes between flights only, and is switched off once the player has turned the dial by hand.
"""

from __future__ import annotations

from typing import Final

from ai.copilot.alone import Estimate
from game.core.settings import Settings

STEP: Final = 0.1  # of the dial
MOST: Final = 0.6  # help for those who would rarely land alone
RARELY, SURELY = 0.4, 0.9  # lower ends of an estimate at which help is greatest, and at which there is none


def fitting(estimate: Estimate) -> float:
    """Return the assist, 0 to 1, that fits an estimate; it goes by the interval's lower end, to be on the safe side."""
    return MOST * min(max((SURELY - estimate.low) / (SURELY - RARELY), 0.0), 1.0)


def faded(assist: float, estimate: Estimate) -> float:
    """Return the assist for the next flight: the same, or one step nearer to what fits.

    It stays while less than a step is missing, so that chance alone does not move it to and fro.
    """
    missing = fitting(estimate) - assist
    if not estimate.known or abs(missing) < STEP - 1e-9:
        return assist
    return round(min(max(assist + (STEP if missing > 0 else -STEP), 0.0), 1.0), 2)


def switch(settings: Settings, *, on: bool) -> None:
    """Switch fading on or off; on, it begins at the dial's present place."""
    settings.fade, settings.faded_to = on, settings.assist


def follow_hand(settings: Settings) -> bool:
    """Switch fading off if the dial is no longer where it was left, as the player has turned it; return whether so."""
    turned = settings.fade and settings.assist != settings.faded_to
    if turned:
        settings.fade = False
    return turned


def fade(settings: Settings, estimate: Estimate) -> bool:
    """Turn the dial for the next flight; return whether it has changed."""
    if follow_hand(settings) or not settings.fade:
        return False
    before = settings.assist
    settings.assist = settings.faded_to = faded(before, estimate)
    return settings.assist != before
