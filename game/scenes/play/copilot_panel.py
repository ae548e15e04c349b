"""Co-pilot panel: what a shared decision weighs, Q-values or landings ahead, and whose action is flown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import pygame

from ai.agent.decision import Decision
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import LINE, NET, SMALL
from game.explain.q_values import HEIGHT, QValues, decision_words, draw_landings, draw_q_values
from game.flight.choosers import Crew
from game.flight.flight import Flight, StickHolder
from game.flight.foresight import SixFutures
from game.flight.networks import word
from game.ui.listing import shortened

_SIZE: Final = (280.0, 336.0)
_TOP, _SIDE = 96.0, 36.0  # points from the edges of the window
_NARROW: Final = 720.0  # points of a window in which it has no room
_LEFT: Final = 20  # left edge of the content, from the panel's corner
_WIDTH: Final = _SIZE[0] - 40
_VALUES: Final = 62  # first baseline of the values, from the panel's top
_WHY: Final = _VALUES + int(HEIGHT) + 20


class CopilotPanel:
    """What the network thinks, for whoever asks: what each action is worth to it, or after which it still lands.

    Attributes:
        shown: whether there is something to explain.
        values: the Q-values of the decision that is flown, while the network has the stick; else None.
        lands: whether it lands after each action, as far as that is known.
        why: lines that say why it is flown.

    """

    def __init__(self) -> None:
        self.shown = False
        self.values: QValues | None = None
        self.lands: list[bool | None] = []
        self.flown = 0
        self.why: Sequence[str] = ()

    def follow(self, flight: Flight[Crew], futures: SixFutures | None = None) -> None:
        """Update the panel after a step."""
        if flight.over:
            return
        decision, self.flown = flight.choice.decision, flight.choice.push.action
        alone = flight.chooser.hand is StickHolder.NETWORK and isinstance(decision, Decision)
        self.values = QValues.of(decision) if alone and isinstance(decision, Decision) else None
        self.shown = self.values is not None or futures is not None
        self.why = decision_words(decision) if self.values and isinstance(decision, Decision) else ()
        self.lands = futures.lands if futures else self.lands

    def fits(self, canvas: Canvas) -> bool:
        """Whether a flight has room beside it; in a narrower window, its paths alone say what is thought."""
        return self.shown and canvas.view.width >= _NARROW

    def box(self, canvas: Canvas) -> pygame.FRect:
        view, (width, height) = canvas.view, _SIZE
        side = min(_SIDE, 0.03 * view.width)
        top = max(0.0, min(_TOP, view.bottom - height - 90))
        return pygame.FRect(view.right - side - width, top, width, height)

    def draw(self, canvas: Canvas, network: str = "") -> None:
        box = self.box(canvas)
        left, top = box.left + _LEFT, box.top
        canvas.panel(box)
        title = canvas.text(
            texts.DECISION_TITLE if self.values else texts.LANDINGS_TITLE, (left, top + 34), room=_WIDTH - 60
        )
        room = left + _WIDTH - title.right - 12
        name = shortened(canvas, word(network), SMALL, room)
        canvas.text(name, (left + _WIDTH, top + 34), size=SMALL, colour=NET, align="right", room=room)
        if self.values:
            draw_q_values(canvas, self.values, left, top + _VALUES, _WIDTH)
        else:
            draw_landings(canvas, self.lands, self.flown, left, top + _VALUES, _WIDTH)
        if self.why:
            canvas.line((left, top + _WHY), (left + _WIDTH, top + _WHY), LINE)
        rows = Cursor(left, top + _WHY + 8, _WIDTH, canvas.scale, canvas)
        for line in self.why:
            rows.aside(line)
