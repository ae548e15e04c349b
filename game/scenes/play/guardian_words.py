"""Words on a guardian: what its dial means, whose action it flies and why, by the futures that were flown ahead."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from ai.lander.environment import ACTION_NAMES
from game.core import texts
from game.panels.landings import Landing, Landings

if TYPE_CHECKING:
    from ai.copilot.copilot import CoPilot, SharedDecision
    from game.flight.flight import Flight
    from game.flight.last_chance import LastChance

Why = tuple[str, str, str]  # a title, and two lines
_PLACES: Final = {1: "guard", 8: "guide"}  # of the dial that have names, by the decisions it looks ahead there


def dial_words(assist: float, copilot: CoPilot | None, problem: str = "") -> str:
    """Say when a guardian at that assist, 0 to 1, steps in; empty for a co-pilot of another kind.

    `problem` says why it goes by points of reward, if it does.
    """
    from ai.copilot.copilot import Mode, guardian_margin
    from ai.copilot.futures import DECISION_STEPS
    from ai.copilot.guardian import decisions_of
    from engine import DT

    if copilot is None or copilot.mode is not Mode.GUARDIAN:
        return ""
    if assist == 0:
        return texts.DIAL_NEVER
    if problem:
        by_points = texts.DIAL_BY_POINTS.format(margin=float(guardian_margin(assist)))
        return f"{by_values(problem)} {by_points}"
    ahead = decisions_of(assist)
    words = texts.DIAL_LOOKS_AHEAD.format(seconds=f"{ahead * DECISION_STEPS * DT:.1f}")
    return texts.DIAL_PLACES[_PLACES[ahead]].format(words=words) if ahead in _PLACES else words


def by_values(problem: str) -> str:
    """Say that a guardian goes by points of reward, and why."""
    return texts.GUARDIAN_BY_VALUES.format(problem=problem)


def sentence(decision: SharedDecision) -> str:
    """Say in one sentence what a guardian has just changed; empty where it has changed nothing."""
    landings = Landings.of(decision)
    if not decision.overridden[0]:
        return texts.GUARDIAN_LOST if landings.lost and Landing.UNKNOWN not in landings.after else ""
    action, after = landings.asked
    name, seconds = texts.said(ACTION_NAMES[action]), f"{landings.seconds:.1f}"
    return texts.GUARDIAN_SAVED[after.value].format(asked=name, seconds=seconds)


def is_late(decision: SharedDecision) -> bool:
    """Whether a guardian has changed what was asked for because that had not been flown ahead in time."""
    return bool(decision.overridden[0]) and Landings.of(decision).asked[1] is Landing.UNKNOWN


def why_not_saved(flight: Flight, last_chance: LastChance | None) -> str:
    """Say of a helped flight that was lost why it was not saved, and what would have."""
    from ai.copilot.copilot import Mode

    guard, copilot = flight.guard, flight.copilot
    words = ""
    if guard and guard.bare:
        since, why = guard.bare
        words = texts.GUARDIAN_BARE[why].format(since=f"{since:.1f}")
    elif copilot and copilot.mode is Mode.TOLERANCE:
        words = texts.NOT_SAVED_TOLERANCE
    elif copilot and (guard is None or guard.ahead.problem):
        words = texts.NOT_SAVED_BY_VALUES
    if last_chance is None or not words:
        return words
    told = texts.LAST_CHANCE if last_chance.seconds is not None else texts.LAST_CHANCE_NONE
    return f"{words} {told.format(seconds=f'{last_chance.seconds or 0.0:.1f}')}"


def why_saved(decision: SharedDecision, landings: Landings) -> Why:
    """Explain whose action a guardian flies, by the futures that decided it."""
    from ai.copilot.guardian import ActionSource

    source = ActionSource(int(decision.source[0]))
    title = texts.COPILOT_PANEL_WHY[source.name][0]
    action, after = landings.asked
    if source is not ActionSource.PILOT:
        key = f"changed_{after.value}"
    elif decision.held is not None and decision.held[0]:
        key = "passes"
    else:
        key = "looking" if Landing.UNKNOWN in landings.after else "none"
    asked, flown = (texts.said(ACTION_NAMES[each]) for each in (action, landings.flown))
    words = {"asked": asked.capitalize(), "flown": flown.capitalize(), "seconds": f"{landings.seconds:.1f}"}
    first, second = (line.format(**words) for line in texts.GUARDIAN_WHY[key])
    return title, first, second
