"""What a co-pilot has changed in one flight: the sentence, the lamp, and where it stepped in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from ai.environment import Doubles
from ai.lander.environment import ACTION_NAMES
from ai.lander.pilots import COAST
from game.core import texts
from game.drawing.tokens import HUMAN, NET
from game.explain.readouts import Lamp
from game.flight.choosers import Crew
from game.flight.flight import Flight, StickHolder
from game.scenes.play.words import changed_by

if TYPE_CHECKING:
    from ai.copilot.copilot import SharedDecision

_LASTS: Final = 75  # steps that a sentence stays: long enough to be read
_FADES: Final = 14  # steps that the lamp shows an override
_CALM: Final = 60  # steps without a change after which another one counts anew


class Interventions:
    """Interventions in one flight; call `follow` once after every step.

    Attributes:
        moments: where the co-pilot stepped in, positions (2,); changes within a second of each other are the same one.
        throughout: assist of the guardian by futures that watched over every step alike, 0 to 1; 0 if there was none.

    """

    def __init__(self) -> None:
        self.moments: list[Doubles] = []
        self.throughout = -1.0  # before the first step
        self._since, self._ago, self._calm = _FADES, _LASTS, _CALM  # steps since the lamp, a sentence, a change
        self._word = ""
        self._decision: SharedDecision | None = None  # the latest

    def follow(self, flight: Flight[Crew]) -> None:
        choice, guard = flight.choice, flight.chooser.guard
        guarded = choice.together if flight.chooser.shared and choice.guarded else None
        assist = guarded.assist if guarded else 0.0
        self.throughout = assist if self.throughout in (-1.0, assist) else 0.0
        changed = choice.overridden and (guarded is None or guard is None or guard.saves)
        if changed and self._calm >= _CALM:
            self.moments.append(flight.env.position[0].copy())
        self._calm = 0 if changed else self._calm + 1
        self._since = 0 if choice.overridden else self._since + 1
        self._ago += 1
        said = ""
        if guarded is None:
            said = difference(choice.asked.action, choice.push.action) if choice.overridden else ""
        elif guarded is not self._decision:
            said = changed_by(guarded)
        self._decision = guarded
        if said:
            self._word, self._ago = said, 0

    def forget(self) -> None:
        """Leave out what was said last, in another language."""
        self._ago = _LASTS

    @property
    def word(self) -> str:
        """What the co-pilot has just changed, in one sentence; empty once that is long enough ago to have been read."""
        return self._word if self._ago < _LASTS else ""

    @property
    def counted(self) -> str:
        """Text that says how often the co-pilot stepped in; empty if it did not."""
        return texts.CARD_SAVED.format(count=len(self.moments)) if self.moments else ""

    def lamp(self, flight: Flight[Crew]) -> Lamp:
        """Return shape, colour and glow: disc for who has the stick, ring for hands off, diamond for an override."""
        if flight.chooser.hand is StickHolder.NETWORK:
            return "circle", NET, 0.8
        if self._since < _FADES:
            return "diamond", NET, 1.6
        choice = flight.choice
        hands_off = choice.by is StickHolder.NETWORK and choice.asked.action == COAST and not choice.guarded
        if flight.chooser.shared and hands_off:
            return "ring", NET, 0.5
        return "circle", HUMAN, 0.8


def difference(asked: int, flown: int) -> str:
    """Say what is flown in place of what was asked for."""
    return texts.OVERRIDE.format(flown=texts.said(ACTION_NAMES[flown]), asked=texts.said(ACTION_NAMES[asked]))
