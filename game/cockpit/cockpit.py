"""Everything of the co-pilot that is seen in a flight, in one place for the scene that flies it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Final

import pygame

from ai.env import Doubles
from ai.lander import Outcome
from game import texts
from game.cockpit.dial import Dial, draw_title
from game.cockpit.hands import OWN
from game.cockpit.insight import PANEL, Insight
from game.cockpit.lesson import keep_lesson
from game.cockpit.overrides import Overrides
from game.cockpit.track import Track
from game.controls import Command, translate
from game.flight import Flight, Hand
from game.hud import CARD, Card
from game.outcomes import landing_score, outcome_card
from game.render import Clear, View
from game.settings import Settings
from game.ui.canvas import Canvas
from game.ui.tokens import HUMAN, MARGIN, VIEW_SIZE

MODES: Final = ("tolerance", "guardian")
_CARD_LEFT: Final = float(MARGIN)  # where else a card may stand, to leave the path in sight
_CARD_RIGHT: Final = float(VIEW_SIZE[0] - MARGIN - CARD.width)


class Cockpit:
    """Of one flight; `help` before every step of it, `follow` after.

    `alone` is a check flight: the dial is out of reach, and nobody helps.
    """

    def __init__(self, flight: Flight, settings: Settings, *, alone: bool = False) -> None:
        self._flight, self._settings, self._alone = flight, settings, alone
        self._dial = Dial(settings)
        self.overrides = Overrides()
        self.track = Track(flight)
        self._insight = Insight(flight.env.ground)
        self.helped = False  # whether the co-pilot shared the stick at any time
        if settings.copilot not in MODES:
            settings.copilot = MODES[0]
        self.help()

    def take(self, event: pygame.event.Event) -> bool:
        """Turn the dial, or change when the co-pilot steps in; whether the event meant that."""
        if self._alone or not self._flight.shares:
            return False
        if translate(event) is Command.MODE:
            self._settings.copilot = MODES[1 - MODES.index(self._settings.copilot)]
            return True
        return self._dial.take(event)

    def help(self) -> None:
        """Let the co-pilot help as the dial says."""
        self._flight.help(0.0 if self._alone else self._settings.assist, self._settings.copilot)

    def follow(self) -> None:
        """Note the step just flown."""
        stepped_in = self.overrides.follow(self._flight)
        self.track.follow(self._flight, stepped_in)
        self._insight.follow(self._flight)
        self.helped |= self._flight.shared

    def alone(self, hands: str) -> bool:
        """Whether the flight was flown by the person's own hands from start to end, and without help."""
        return hands == OWN and self._unaided

    @property
    def _unaided(self) -> bool:
        return not self.helped and self._flight.share == 1.0

    def keep_lesson(self, folder: Path, hands: str) -> str:
        """Keep a flight that is over as an example, if wished and worth it; return what to tell the player of that."""
        flight = self._flight
        if not (flight.outcome is Outcome.LANDED and self._settings.teach and hands == OWN):
            return ""
        try:
            return texts.TAUGHT if keep_lesson(flight, folder) else ""
        except (OSError, ValueError) as error:
            return texts.NOT_TAUGHT.format(reason=error)

    def card(self, best: int, view: View) -> Card:
        """Return the card of the flight, which is over; `best` is the score to beat without help."""
        env = self._flight.env
        score = landing_score(env)
        beaten = score > best > 0 and self._unaided
        words = (texts.SCORE_BEST if beaten else texts.SCORE).format(points=score) if score else ""
        card = replace(outcome_card(env, self._flight.share), score=words)
        if not self.helped:
            return card
        left = self.track.beside((CARD.left, _CARD_LEFT, _CARD_RIGHT), CARD, view)
        return replace(card, stepped_in=self.overrides.times, left=left)

    def ease(self) -> None:
        """Let 1/60 s pass, whether or not anything flies."""
        self._dial.follow(self._flight.hand)

    @property
    def clear(self) -> Clear:
        """Where on the screen the flight is to be seen, beside the panel that explains it."""
        return Clear(right=PANEL.left - 16.0) if self._explains else Clear()

    @property
    def _explains(self) -> bool:
        return self._settings.explain and self._insight.shown and not self._flight.over

    def draw_behind(self, canvas: Canvas) -> None:
        """Draw what the craft flies in front of."""
        if self._explains:
            self._insight.draw(canvas, self._flight.share)

    def draw_beside(self, canvas: Canvas, view: View, pose: Doubles) -> None:
        """Draw what was changed of what the hands asked for."""
        if not self._flight.over:
            self.overrides.draw_word(canvas, view, pose)

    def draw_top(self, canvas: Canvas) -> None:
        """Say who flies, and who flew just now."""
        flight = self._flight
        if self._alone and flight.hand is Hand.HUMAN:
            draw_title(canvas, texts.DIAL_JOIN.join((texts.CHECK_FLIGHT, texts.CHECK_ALONE)), ("circle", HUMAN, 0.8))
            return
        lamp = self.overrides.lamp(flight)
        if flight.shares:
            self._dial.draw(canvas, flight.hand, lamp)
        else:
            draw_title(canvas, texts.NETWORK_FLIES if flight.hand is Hand.NETWORK else texts.YOU_FLY, lamp)
        if self.helped:
            self.overrides.draw_line(canvas)
