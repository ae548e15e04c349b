"""Landings: after which of the six actions a network still lands, as a guardian saw it before it chose."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING, Final

from ai.lander.environment import ACTION_NAMES, NUM_ACTIONS
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, INK, MUTE, NET, SMALL
from game.explain.q_values import FIRST, NAME, ROW

if TYPE_CHECKING:
    from ai.copilot.copilot import SharedDecision


_RECENT: Final = 8  # decisions, half a second, for which what was seen of an action is shown


class Landing(Enum):
    """What comes of an action; its value is the key of its words."""

    LANDS = "lands"
    BRIEFLY = "briefly"  # only if it is not held as long as the dial asks for
    LOST = "lost"
    UNKNOWN = "unknown"  # it was not flown ahead in time


@dataclass(frozen=True)
class Landings:
    """What comes of each action in one decision of one lander.

    Attributes:
        after: what comes of each action with all its thrust.
        asked: the action that was asked for, and what comes of it with the thrust that was asked for.
        flown: the action that is flown.
        seconds: after how long an action there must be a landing.

    """

    after: tuple[Landing, ...]
    asked: tuple[int, Landing]
    flown: int
    seconds: float

    @classmethod
    def of(cls, decision: SharedDecision) -> Landings:
        """Return those of one lander's decision by futures."""
        from ai.copilot.futures import DECISION_STEPS
        from ai.copilot.guardian import decisions_of
        from ai.lander.push import KEYS, Push
        from engine import DT

        assert decision.known is not None
        known, pilot = decision.known[0], int(decision.pilot[0])

        def after(push: Push) -> Landing:
            if push not in known:
                return Landing.UNKNOWN
            future = known[push]
            return Landing.LOST if future.plan is None else Landing.LANDS if future.passes else Landing.BRIEFLY

        seconds = decisions_of(decision.assist) * DECISION_STEPS * DT
        return cls(tuple(map(after, KEYS)), (pilot, after(decision.asked[0])), int(decision.action[0]), seconds)

    @property
    def lost(self) -> bool:
        """Whether no action is known to lead to a landing."""
        return not any(after in (Landing.LANDS, Landing.BRIEFLY) for after in (*self.after, self.asked[1]))


class RecentLandings:
    """What comes of each action as it was last seen: not all six can be flown ahead anew for each decision."""

    def __init__(self) -> None:
        self._seen = dict.fromkeys(range(NUM_ACTIONS), (Landing.UNKNOWN, 0))  # and how many decisions ago

    def fill(self, landings: Landings) -> Landings:
        """Follow those of another decision; return them, and in place of what is unknown what was seen before.

        Of the action that is asked for, only what the decision knew is shown.
        """
        for action, after in enumerate(landings.after):
            before, age = self._seen[action]
            kept = (before, age + 1) if age < _RECENT else (Landing.UNKNOWN, 0)
            self._seen[action] = kept if after is Landing.UNKNOWN else (after, 0)
        rows, (asked, now) = [after for after, _ in self._seen.values()], landings.asked
        if now is Landing.UNKNOWN is landings.after[asked]:  # that it is not known decided: the row says so too
            rows[asked] = now
        return replace(landings, after=tuple(rows))


def draw_landings(canvas: Canvas, landings: Landings, left: float, top: float, width: float, who: str) -> None:
    """Draw a row for each action: its name, and whether `who` then flies still lands; `top` is the first baseline."""
    canvas.text(texts.LANDINGS_HEADING.format(who=who), (left, top), size=SMALL, colour=MUTE, room=width)
    for action, after in enumerate(landings.after):
        y, flown = top + FIRST + ROW * action, action == landings.flown
        colour = INK if flown else MUTE
        canvas.text(texts.said(ACTION_NAMES[action]), (left, y + 4), size=SMALL, colour=colour, room=NAME - 20)
        if flown:
            canvas.marker("triangle", (left + NAME - 8, y), 6, NET)
        if action == landings.asked[0]:
            canvas.dot((left + NAME + 6, y), 4, HUMAN)
        said = texts.LANDINGS[after.value]
        lit = NET if after is Landing.LANDS else colour
        canvas.text(said, (left + width, y + 4), size=SMALL, colour=lit, align="right", room=width - NAME - 20)
        canvas.explain((left, y - ROW / 2, width, ROW), texts.EXPLAIN_LANDING)
