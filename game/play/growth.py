"""What a flight has shown of the player's own skill, in words for the outcome card; and the help that follows it."""

from __future__ import annotations

from typing import Final

from ai.copilot.alone import Estimate
from game.core import texts
from game.core.settings import Settings
from game.flight import fading
from game.flight.becoming import Change

_OF: Final = 10  # flights, of which so many


def follow(change: Change | None, settings: Settings, *, check: bool, landed: bool) -> tuple[str, ...]:
    """Let help fade after a free flight, and return the lines of its card: of a check's result, and of the dial's turn.

    Args:
        change: what the flight has shown; None if it tells nothing.
        settings: the player's, whose dial is turned.
        check: whether it was a check flight.
        landed: whether it landed.

    """
    if change is None:
        return ()
    lines = [_check_line(change, landed=landed)] if check else []
    before = settings.assist
    if fading.fade(settings, change.after):
        dial = {"before": round(100 * before), "after": round(100 * settings.assist)}
        lines.append(texts.FADE_LINE.format(share=_tenths(change.after.mean), **dial))
    return tuple(lines)


def said(estimate: Estimate) -> str:
    """Return an estimate in words, with its uncertainty."""
    if not estimate.known:
        return texts.BECOMING_TOO_FEW.format(count=estimate.alone)
    low, high = _tenths(estimate.low), _tenths(estimate.high)
    mean = _tenths(estimate.mean)
    if low == high:
        return texts.BECOMING_SURE.format(share=mean)
    return texts.BECOMING_ESTIMATE.format(share=mean, low=low, high=high)


def _check_line(change: Change, *, landed: bool) -> str:
    """Return the text that tells a check flight's result beside what was expected."""
    if not change.before.known:
        return texts.CHECK_FIRST[landed]
    return texts.CHECK_RESULT[landed].format(before=_tenths(change.before.mean), after=_tenths(change.after.mean))


def _tenths(share: float) -> int:
    return round(_OF * share)
