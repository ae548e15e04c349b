"""Displays of shared control: the lamp, and what the co-pilot has just changed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from ai.lander.pilots import COAST
from game.core import texts
from game.drawing.shapes import Shape
from game.drawing.tokens import HUMAN, NET, Colour
from game.flight.flight import Flight, StickHolder
from game.scenes.play.guardian_words import is_late, sentence

if TYPE_CHECKING:
    from ai.copilot.copilot import SharedDecision

_LASTS: Final = 75  # steps that a message stays after the last override: long enough to be read
_FADES: Final = 14
_LATE: Final = 3  # decisions in a row that come too late, from which on that is said


class Overrides:
    """Overrides of one flight; call `follow` once after every step.

    Attributes:
        times: number of interventions by the co-pilot; overrides in quick succession count as one.

    """

    def __init__(self) -> None:
        self.times = 0
        self._since = _LASTS + _FADES
        self._word = ""
        self._decision: SharedDecision | None = None  # the latest
        self._said = ""  # what a guardian has to say about it
        self._late = 0  # decisions in a row, up to it, for which a guardian had not looked ahead in time

    def follow(self, flight: Flight) -> bool:
        """Update after a step; return whether the co-pilot has just stepped in."""
        begins, seen = flight.overridden and self._since > _FADES, self.word
        self._since = 0 if flight.overridden else self._since + 1
        if flight.decision is not self._decision:
            self._decision = flight.decision
            guarded = flight.decision if flight.shared and flight.guarded else None
            self._said = sentence(guarded) if guarded else ""
            self._late = self._late + 1 if guarded and is_late(guarded) else 0
        if flight.overridden and 0 < self._late < _LATE:
            self._word = seen
        elif flight.overridden:
            self._word = self._said or difference(flight.asked, flight.recording.actions[-1])
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
