"""Displays of shared control: the lamp, what the co-pilot has just changed, and the flames that it did not fire."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from ai.environment import Doubles
from ai.lander.pilots import COAST
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.shapes import Shape
from game.drawing.tokens import HUMAN, NET, Colour
from game.flight.flight import Flight, StickHolder
from game.scenes.play.guardian_words import sentence
from game.world import lander as art
from game.world.camera import View

if TYPE_CHECKING:
    from ai.copilot.copilot import SharedDecision

_LASTS: Final = 75  # steps that a message stays after the last override: long enough to be read
_FADES: Final = 14
_DOTS: Final = 6  # for an engine that was asked for and not fired


class Overrides:
    """Overrides of one flight; call `follow` once after every step.

    Attributes:
        times: number of interventions by the co-pilot; overrides in quick succession count as one.

    """

    def __init__(self) -> None:
        self.times = 0
        self._since = _LASTS + _FADES
        self._word = ""
        self._asked = self._flown = COAST
        self._decision: SharedDecision | None = None  # the latest
        self._said = ""  # what a guardian has to say about it

    def follow(self, flight: Flight) -> bool:
        """Update after a step; return whether the co-pilot has just stepped in."""
        begins = flight.overridden and self._since > _FADES
        self._since = 0 if flight.overridden else self._since + 1
        if flight.decision is not self._decision:
            self._decision = flight.decision
            guarded = flight.decision if flight.shared and flight.guarded else None
            self._said = sentence(guarded) if guarded else ""
        if flight.overridden:
            self._asked, self._flown = flight.asked, flight.recording.actions[-1]
            self._word = self._said or difference(self._asked, self._flown)
        elif self._said:
            self._word, self._since = self._said, min(self._since, _FADES + 1)
        self.times += begins
        return begins

    @property
    def word(self) -> str:
        """What the co-pilot has just changed, in one sentence; empty once that is long enough ago to have been read."""
        return self._word if self._since < _LASTS else ""

    def lamp(self, flight: Flight) -> tuple[Shape, Colour, float]:
        """Return shape, colour and glow: disc for who has the stick, ring for hands off, diamond for an override."""
        if flight.hand is StickHolder.NETWORK:
            return "circle", NET, 0.8
        if self._since < _FADES:
            return "diamond", NET, 1.6
        if flight.shared and flight.flown_by is StickHolder.NETWORK and flight.asked == COAST and not flight.guarded:
            return "ring", NET, 0.5
        return "circle", HUMAN, 0.8

    def draw(self, canvas: Canvas, view: View, pose: Doubles) -> None:
        """Draw flames that were asked for and not fired as dots."""
        if self._since < _FADES:
            for start, away in _unlit(self._asked, self._flown):
                _draw_unlit(canvas, view, pose, start, away)


def difference(asked: int, flown: int) -> str:
    """Say what the co-pilot has changed, in engines added, stopped or exchanged."""
    words = []
    main, name = flown // 3 - asked // 3, texts.ENGINE_MAIN
    if main:
        words.append((texts.OVERRIDE_ADDS if main > 0 else texts.OVERRIDE_STOPS).format(engine=name))
    before, after = (texts.ENGINES_STEER.get(action % 3, "") for action in (asked, flown))
    if before != after:
        form = texts.OVERRIDE_TURNS if before and after else texts.OVERRIDE_ADDS if after else texts.OVERRIDE_STOPS
        words.append(form.format(engine=after or before, other=before))
    return texts.OVERRIDE.format(changes=texts.AND.join(words))


def _unlit(asked: int, flown: int) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Return nozzle and direction, in the craft's frame, of each flame asked for but not fired."""
    fires = []
    if asked >= 3 > flown:
        fires.append((art.NOZZLE, (0.0, -1.0)))
    if asked % 3 and asked % 3 != flown % 3:
        side = 1 if asked % 3 == 1 else 0  # steering left fires the right-hand jet
        fires.append((art.JETS[side], (1.0 if side else -1.0, 0.0)))
    return fires


def _draw_unlit(
    canvas: Canvas, view: View, pose: Doubles, start: tuple[float, float], away: tuple[float, float]
) -> None:
    x, y, angle = pose.tolist()
    cos, sin = math.cos(angle), math.sin(angle)
    reach = 0.34 if away[1] else 0.2
    for number in range(_DOTS):
        right, up = (at + reach * (number + 0.6) * way for at, way in zip(start, away, strict=True))
        spot = view.point(x + right * cos - up * sin, y + right * sin + up * cos)
        canvas.dot(spot, 2.0 - 0.2 * number, HUMAN, 0.95 - 0.13 * number)
