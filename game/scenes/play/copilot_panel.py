"""Co-pilot panel: what a shared decision weighs, Q-values or landings ahead, and whose action is flown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pygame

from ai.agent.decision import Decision
from ai.lander.pilots import COAST
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, LINE, MUTE, NET, SMALL
from game.explain.landings import Landing, Landings, RecentLandings, draw_landings
from game.explain.q_values import HEIGHT, QValues, decision_words, draw_q_values
from game.explain.readouts import draw_share
from game.flight.choosers import Crew
from game.flight.flight import Flight, StickHolder
from game.flight.foresight import HELD, SixFutures
from game.flight.networks import QPolicy, flew, word
from game.scenes.play.words import Why, why_by_futures, why_by_values
from game.ui.listing import shortened

if TYPE_CHECKING:
    from ai.copilot.copilot import SharedDecision

_SIZE: Final = (280.0, 388.0)
_TOP, _SIDE = 96.0, 36.0  # points from the edges of the window
_LEFT: Final = 20  # left edge of the content, from the panel's corner
_WIDTH: Final = _SIZE[0] - 40
_VALUES: Final = 62  # first baseline of the values, from the panel's top
_WHY: Final = _VALUES + int(HEIGHT) + 20


class CopilotPanel:
    """What the network thinks, for whoever asks: what it weighs, whose action is flown, and why.

    Attributes:
        shown: whether there is something to explain.
        values: what the decision that is flown weighs: where the network lands if a guardian has looked ahead, or if
            the person flies alone, else the Q-values; None before the first.
        why: whose action is flown, and why: a title and two lines.

    """

    def __init__(self) -> None:
        self.shown = False
        self.values: QValues | Landings | None = None
        self.why: Why = ("", "", "")
        self._overridden = False  # whether the co-pilot flies something else than was asked for
        self._recent = RecentLandings()
        self._seen: object = None

    def forget(self) -> None:
        """Say anew what is said, in another language."""
        self._seen = None

    def follow(self, flight: Flight[Crew], futures: SixFutures | None = None) -> None:
        """Update the panel after a step; `futures` are those of a flight that nobody shares."""
        if flight.over:
            return
        alone = flight.chooser.hand is StickHolder.NETWORK and isinstance(flight.chooser.network, QPolicy)
        decision = flight.choice.decision if alone or flight.chooser.shared else None
        if decision is None and futures:
            self.shown, self._seen = True, None
            self.values = landings_of(futures, flight)
            self.why = ("" if flight.chooser.shared else texts.SIX_FUTURES_WHY, "", "")
            return
        self.shown, self._overridden = decision is not None, self._overridden and decision is self._seen
        if decision is None or decision is self._seen:
            return
        self._seen = decision
        if isinstance(decision, Decision):
            self.values = QValues.of(decision)
            first, second = decision_words(decision)
            self.why = texts.COPILOT_PANEL_ALONE, first, second
        else:
            self._explain(decision, int(flight.env.target[0]))

    def _explain(self, decision: SharedDecision, pad: int) -> None:
        """Show a shared decision, by its values for one of the pads where there are no futures."""
        if decision.held is not None:
            landings = Landings.of(decision)
            self.values, self.why = self._recent.fill(landings), why_by_futures(decision, landings)
        else:
            self.values, self.why = shared_values(decision, pad), why_by_values(decision, pad)
        self._overridden = bool(decision.overridden[0])

    def box(self, canvas: Canvas) -> pygame.FRect:
        view, (width, height) = canvas.view, _SIZE
        side = min(_SIDE, 0.03 * view.width)
        top = max(0.0, min(_TOP, view.bottom - height - 90))
        return pygame.FRect(view.right - side - width, top, width, height)

    def draw(self, canvas: Canvas, share: float | None, network: str = "") -> None:
        """Draw the panel; `share` is the person's of the flight so far, None before its first step."""
        box = self.box(canvas)
        left, top = box.left + _LEFT, box.top
        canvas.panel(box)
        looks = isinstance(self.values, Landings)
        title = canvas.text(texts.LANDINGS_TITLE if looks else texts.DECISION_TITLE, (left, top + 34), room=_WIDTH - 60)
        room = left + _WIDTH - title.right - 12
        name = shortened(canvas, word(network), SMALL, room)
        canvas.text(name, (left + _WIDTH, top + 34), size=SMALL, colour=NET, align="right", room=room)
        if isinstance(self.values, Landings):
            draw_landings(canvas, self.values, left, top + _VALUES, _WIDTH, flew(network))
        elif self.values is not None:
            draw_q_values(canvas, self.values, left, top + _VALUES, _WIDTH)
        canvas.line((left, top + _WHY), (left + _WIDTH, top + _WHY), LINE)
        self._draw_why(canvas, left, top + _WHY + 26)
        if share is not None:
            draw_share(canvas, left, top + _WHY + 104, _WIDTH, share, flew(network))

    def _draw_why(self, canvas: Canvas, left: float, top: float) -> None:
        title, *lines = self.why
        canvas.text(title, (left, top), colour=NET if self._overridden else INK, room=_WIDTH)
        for number, line in enumerate(lines):
            canvas.text(line, (left, top + 22 + 18 * number), size=SMALL, colour=MUTE, room=_WIDTH)


def landings_of(futures: SixFutures, flight: Flight[Crew]) -> Landings:
    """Return what comes of each action as a row of the panel."""
    after = [Landing.UNKNOWN if lands is None else Landing.LANDS if lands else Landing.LOST for lands in futures.lands]
    flown = flight.choice.push.action
    return Landings(tuple(after), (flown, after[flown]), flown, HELD)


def shared_values(decision: SharedDecision, pad: int) -> QValues:
    """Return the Q-values of one lander's shared decision, for one of the pads as the goal."""
    asked = int(decision.pilot[0])
    return QValues(tuple(decision.points[0, pad].tolist()), int(decision.action[0]), None if asked == COAST else asked)
