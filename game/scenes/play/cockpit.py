"""Displays of a flight, gathered for the scene that flies it: who helps, what it thinks, and the card at the end."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import pygame

from ai.environment import Doubles
from ai.lander.environment import Outcome
from game.core import texts
from game.core.settings import Settings
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, SMALL
from game.flight.credit import Credit
from game.flight.demonstrations import add_demonstration
from game.flight.flight import Flight
from game.flight.handicap import OWN
from game.flight.outcomes import OutcomeCard, outcome_card
from game.flight.rescues import Rescues
from game.panels.landings import Landings
from game.panels.readouts import Lamp, draw_arrow
from game.scenes.play.copilot_panel import CopilotPanel
from game.scenes.play.guardian_words import dial_words, why_not_saved
from game.scenes.play.help_words import HelpWords
from game.scenes.play.overrides import Overrides
from game.scenes.play.sentence import wind
from game.scenes.play.track import FlownPath
from game.world.camera import ClearArea, View

if TYPE_CHECKING:
    from game.flight.last_chance import LastChance
    from game.flight.six_futures import SixFutures

MODES: Final = ("tolerance", "guardian")
_CALM: Final = 0.05  # m/s², below which there is no wind
_STRONGEST: Final = 0.6  # m/s², of the longest arrow
_ARROW: Final = (14.0, 40.0)  # points of the shortest and more for the longest
_BESIDE: Final = 1.9  # metres from the middle of a craft to the wind beside it


class Cockpit:
    """Cockpit of one flight; call `help` before every step, `follow` after it.

    Where `credit` allows no help, nobody helps.

    Attributes:
        help_words: the words that choose the help.
        track: the path that was flown.
        overrides: what the co-pilot has changed.
        copilot_panel: what the network thinks, for whoever asks.
        rescues: how often a guardian has saved the person.

    """

    def __init__(self, flight: Flight, settings: Settings, credit: Credit) -> None:
        self._flight, self._settings, self.credit = flight, settings, credit
        self.help_words = HelpWords(settings)
        self.overrides, self.rescues = Overrides(), Rescues()
        self.track = FlownPath(flight)
        self.copilot_panel = CopilotPanel(flight.env.ground)
        if settings.copilot not in MODES:
            settings.copilot = MODES[0]
        self.help()

    @property
    def helps(self) -> bool:
        """Whether a network may help in this flight."""
        return self._flight.shares and not self.credit.alone

    def take(self, event: pygame.event.Event, boxes: dict[str, pygame.FRect]) -> bool:
        """Choose the help; return whether the event meant that."""
        return self.helps and self.help_words.take(event, boxes)

    def help(self) -> None:
        """Set the co-pilot's assist for the next step from the settings."""
        self._flight.help(0.0 if self.credit.alone else self._settings.assist, self._settings.copilot)

    def follow(self, futures: SixFutures | None = None) -> None:
        """Update the displays after a step."""
        stepped_in, saved = self.overrides.follow(self._flight), self.rescues.follow(self._flight)
        self.track.follow(self._flight, saved if self._flight.guarded else stepped_in)
        self.copilot_panel.follow(self._flight, futures)
        self.credit.follow()

    def breathe(self) -> None:
        """Advance by 1/60 s, whether or not anything flies."""
        self.help_words.shown = max(0, self.help_words.shown - 1)

    def add_demonstration(self, folder: Path, hands: str) -> str:
        """Save a finished flight as a demonstration, if wished and good enough; return a message for the player."""
        flight = self._flight
        if not (flight.outcome is Outcome.LANDED and self._settings.teach and hands == OWN):
            return ""
        try:
            return texts.TAUGHT if add_demonstration(flight, folder) else ""
        except (OSError, ValueError) as error:
            return texts.NOT_TAUGHT.format(reason=error)

    def card(self, best: int, last_chance: LastChance | None = None) -> OutcomeCard:
        """Return the outcome card of the finished flight; `best` is the score to beat without help."""
        credit, card = self.credit, outcome_card(self._flight.env, self._flight.share)
        card = replace(card, score=credit.score(best), reason=credit.reason(card.reason), assists=credit.assists)
        if not credit.helped:
            return card
        bare = "" if card.good else why_not_saved(self._flight, last_chance)
        watched = self.rescues.saved(self._flight) is not None
        advice = "" if bare else card.advice  # why it was not saved says more
        return replace(card, stepped_in=len(self.track.moments), watched=watched, bare=bare, advice=advice)

    @property
    def coasting(self) -> tuple[float, bool] | None:
        """A guardian's future of coasting, for the mark on the path; None without one, or if nobody asks."""
        values = self.copilot_panel.values
        shown = self._settings.show_thinking and self.copilot_panel.shown
        return values.coasting if shown and isinstance(values, Landings) else None

    # The picture

    def panel_box(self, canvas: Canvas) -> pygame.FRect:
        """Return where the panel stands, in points of a canvas for text that flows."""
        return self.copilot_panel.box(canvas)

    def draw_beside(self, canvas: Canvas, view: View, pose: Doubles, clear: ClearArea) -> None:
        """Draw the wind beside the craft."""
        push = wind(self._flight.env)
        if abs(push) >= _CALM and not self._flight.over:
            _draw_wind(canvas, view, pose, push, clear)

    def lamp(self) -> Lamp:
        """Return shape, colour and glow of the lamp that says who flies."""
        return self.overrides.lamp(self._flight)

    def means(self) -> str:
        """Say what the help that is set means now."""
        guard = self._flight.guard
        problem = guard.ahead.problem if guard else texts.FUTURES_NOT_YET
        return dial_words(self._settings.assist, self._flight.copilot, problem)


def _draw_wind(canvas: Canvas, view: View, pose: Doubles, push: float, clear: ClearArea) -> None:
    """Draw the wind as an arrow that blows at the craft, with its strength over it."""
    side = -1.0 if push > 0 else 1.0  # from where it comes
    reach = _ARROW[0] + _ARROW[1] * min(1.0, abs(push) / _STRONGEST)
    x, y = view.points((pose[0] + side * _BESIDE, pose[1])).tolist()
    middle = x + side * reach / 2
    seen = canvas.view
    if not seen.left + reach < middle < min(clear.right, seen.right) - reach:  # beyond an edge: on the other side
        middle = view.points((pose[0] - side * _BESIDE, pose[1])).tolist()[0] - side * reach / 2
    y = min(max(y, seen.top + clear.head), seen.bottom - 110)
    draw_arrow(canvas, (middle, y), -side * reach, INK)
    size = max(SMALL, 12.0 / canvas.scale)
    words = texts.WIND_FIGURE.format(push=abs(push))
    canvas.text(words, (middle, y - 8), size=size, colour=INK, align="centre", tabular=True)
