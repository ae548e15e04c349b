"""The ladder of starts: free flights of a new player begin above the pad, farther out with every landing.

It is a curriculum, as networks have one: a landing leads a rung up, two misses in a row a rung down. A
player who has reached its top flies from anywhere, and has left it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

from ai.lander.environment import Outcome
from ai.lander.spawns import LADDER, RUNGS
from game.core import texts
from game.core.settings import TOP_RUNG, Settings
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, HUMAN
from game.flight.flight import Flight, StickHolder
from game.flight.flight_file import Entry
from game.flight.outcomes import OutcomeCard

COUNT: Final = len(RUNGS)
MISSES: Final = 2  # in a row, after which the next flight begins nearer
_PITCH: Final = 7.0  # points from rung to rung
_HIGH: Final = (5.0, 0.7)  # points, of the lowest, and more for each above it
WIDTH: Final = _PITCH * COUNT  # points of its picture


class Ladder:
    """The player's place on the ladder, kept in the settings; `entries` are the logbook of one who has none yet."""

    def __init__(self, settings: Settings, entries: Iterable[Entry]) -> None:
        self._settings = settings
        self._misses = 0  # in a row, on this rung
        if settings.rung < 0:
            settings.rung = min(TOP_RUNG, sum(entry.landed and not entry.course for entry in entries))

    @property
    def spawn(self) -> str:
        """The kind of start of the next flight."""
        return LADDER.spawn(max(0, self._settings.rung))  # progress can be put away during a flight

    def climb(self, flight: Flight, card: OutcomeCard) -> OutcomeCard:
        """Move a rung up after a landing, and down after two misses in a row; return the card, which says so.

        Only flights that the player has brought to their end move it, with help or without.
        """
        if flight.recording.spawn not in RUNGS:
            return card
        rung = LADDER.stage_of(flight.recording.spawn)
        mine, landed = flight.hand is StickHolder.HUMAN, flight.outcome is Outcome.LANDED
        if mine and landed:
            self._settings.rung, self._misses = rung + 1, 0
        elif mine and not flight.intact:
            self._misses += 1
            if self._misses >= MISSES:
                self._settings.rung, self._misses = max(0, rung - 1), 0
        # What a landing counts for, helped or not, is said once, by the line of the ladder.
        words = _words(rung, self._settings.rung) if mine or not landed else texts.LADDER_NOT_FLOWN
        reason = texts.OUTCOMES[Outcome.LANDED.name][1] if landed else card.reason
        return replace(card, reason=reason, rung=self._settings.rung, climb=words)


def rung_of(flight: Flight) -> int | None:
    """Return on which rung a flight has begun, from 0; None if it was on none."""
    return LADDER.stage_of(flight.recording.spawn) if flight.recording.spawn in RUNGS else None


def _words(before: int, now: int) -> str:
    """Return what a flight has changed."""
    if now == TOP_RUNG:
        return texts.LADDER_TOP
    if now == before:
        return (texts.LADDER_STAYS if now else texts.LADDER_LOWEST).format(number=now + 1)
    return (texts.LADDER_UP if now > before else texts.LADDER_DOWN).format(number=now + 1)


def draw_ladder(canvas: Canvas, left: float, baseline: float, rung: int) -> None:
    """Draw the ladder from `left`; of a player at its top, all rungs are lit."""
    low, more = _HIGH
    for number in range(COUNT):
        x = left + number * _PITCH
        lit = number <= rung
        canvas.line((x, baseline), (x, baseline - low - more * number), HUMAN if lit else FAINT, 2.0)
