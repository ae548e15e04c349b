"""What a flight has shown of the player's own skill, in words for the outcome card; and the help that follows it."""

from __future__ import annotations

from game.core import texts
from game.core.settings import Settings
from game.flight import fading
from game.flight.becoming import Change
from game.flight.skill import tenths_of


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
        lines.append(texts.FADE_LINE.format(share=tenths_of(change.after.mean), **dial))
    return tuple(lines)


def _check_line(change: Change, *, landed: bool) -> str:
    """Return the text that tells a check flight's result beside what was expected."""
    if not change.before.known:
        return texts.CHECK_FIRST[landed]
    return texts.CHECK_RESULT[landed].format(before=tenths_of(change.before.mean), after=tenths_of(change.after.mean))
