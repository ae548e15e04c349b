"""Words on a guardian: what its dial means, whose action it flies and why, by the chance to be saved."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ai.lander.environment import ACTION_NAMES
from game.core import texts
from game.panels.chance_values import ChanceValues, of_hundred

if TYPE_CHECKING:
    from ai.copilot.copilot import CoPilot, SharedDecision

Why = tuple[str, str, str]  # a title, and two lines


def dial_words(assist: float, copilot: CoPilot | None, *, among_hills: bool = False) -> str:
    """Say when a guardian at that assist, 0 to 1, steps in; empty for a co-pilot of another kind.

    `among_hills`, where there are several pads, it asks for no more than can be reached.
    """
    from ai.copilot.copilot import Mode, guardian_margin
    from ai.copilot.guardian import required_chance

    if copilot is None or copilot.mode is not Mode.GUARDIAN:
        return ""
    if assist == 0:
        return texts.DIAL_NEVER
    if copilot.critic is None:
        by_points = texts.DIAL_BY_POINTS.format(margin=float(guardian_margin(assist)))
        return f"{no_critic(copilot)} {by_points}"
    percent, required = round(100 * assist), of_hundred(float(required_chance(assist)), digits=int(assist > 0.7))
    means = texts.DIAL_MEANS_HILLS if among_hills else texts.DIAL_MEANS
    return means.format(percent=percent, required=required)


def no_critic(copilot: CoPilot) -> str:
    """Say why a guardian has no safety critic."""
    return texts.GUARDIAN_NO_CRITIC.format(problem=copilot.critic_problem)


def shared_chances(decision: SharedDecision) -> ChanceValues:
    """Return the chances to be saved of one lander's shared decision by a guardian with a safety critic."""
    assert decision.chances is not None
    assert decision.required is not None
    chances = tuple(decision.chances[0].astype(float).tolist())
    return ChanceValues(chances, int(decision.action[0]), int(decision.pilot[0]), float(decision.required[0]))


def why_saved(decision: SharedDecision, values: ChanceValues) -> Why:
    """Explain whose action a guardian with a safety critic flies, by the chances that decided it."""
    from ai.copilot.copilot import ActionSource

    source = ActionSource(int(decision.source[0]))
    title = texts.COPILOT_PANEL_WHY[source.name][0]
    if not values.readable:
        return title, *texts.VALUES_DAMAGED
    if source is not ActionSource.PILOT and values.flown == values.asked:  # it has the stick, and agrees
        title = texts.GUARDIAN_AGREES[0]
    asked, flown = (texts.said(ACTION_NAMES[action]) for action in (values.asked, values.flown))
    chance, required, saved = values.told
    if source is ActionSource.PILOT:
        enough = values.chances[values.asked] >= values.required
        lines = texts.GUARDIAN_YOURS if enough else texts.GUARDIAN_NO_BETTER
    elif values.chances[values.asked] >= values.required:  # it has stepped in, and gives back a little later
        lines = texts.GUARDIAN_NOT_YET
    elif values.flown == values.asked:
        lines = texts.GUARDIAN_AGREES[1:]
    elif values.chances[values.flown] <= values.chances[values.asked]:
        lines = texts.GUARDIAN_HOLDS
    else:
        lines = texts.GUARDIAN_STEPS_IN
    words = {"asked": asked.capitalize(), "flown": flown.capitalize()}
    first, second = (line.format(chance=chance, required=required, saved=saved, **words) for line in lines)
    return title, first, second
