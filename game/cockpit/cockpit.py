"""Co-pilot displays of a flight, gathered for the scene that flies it: dial, panel, callouts, card."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Final

import pygame

from ai.common.environment import Doubles
from ai.lander.environment import Outcome
from game.cockpit.assist_dial import AssistDial
from game.cockpit.copilot_panel import PADS_HIGH, PANEL, CopilotPanel
from game.cockpit.guardian_words import by_values, dial_words, why_bare
from game.cockpit.hud import CARD, draw_title
from game.cockpit.overrides import Overrides
from game.cockpit.recent_line import RecentLine
from game.cockpit.track import FlownPath
from game.core import texts
from game.core.settings import Settings
from game.drawing.canvas import PAGE, Canvas, moved
from game.drawing.tokens import MARGIN, VIEW_SIZE
from game.flight.credit import Credit
from game.flight.demonstrations import add_demonstration
from game.flight.flight import Flight
from game.flight.handicap import OWN
from game.flight.outcomes import OutcomeCard, outcome_card
from game.flight.rescues import Rescues
from game.input.controls import Command, translate
from game.panels.landings import Landings
from game.world.camera import ClearArea, View

MODES: Final = ("tolerance", "guardian")
_CRAFT: Final = 1.5  # metres from the middle of a craft to its ends
_CARD_LEFT: Final = float(MARGIN)  # the other place of a card, where the path would be hidden
_CARD_RIGHT: Final = float(VIEW_SIZE[0] - MARGIN - CARD.width)


class Cockpit:
    """Cockpit of one flight; call `help` before every step, `follow` after it.

    Where `credit` allows no help, the dial is disabled. `view` is all that the window shows, in points.

    Attributes:
        track: the path that was flown.
        overrides: the marks beside a craft whose action was changed.
        copilot_panel: what the co-pilot weighs.
        rescues: how often a guardian has saved the person.

    """

    def __init__(self, flight: Flight, settings: Settings, credit: Credit, view: pygame.FRect = PAGE) -> None:
        self._flight, self._settings, self.credit, self._view = flight, settings, credit, view
        self._dial = AssistDial(settings, view)
        self.overrides, self.rescues, self._recent = Overrides(), Rescues(), RecentLine()
        self.track = FlownPath(flight)
        self.copilot_panel = CopilotPanel(flight.env.ground)
        if settings.copilot not in MODES:
            settings.copilot = MODES[0]
        self.help()

    def take(self, event: pygame.event.Event) -> bool:
        """Turn the dial, or switch the co-pilot's mode; return whether the event meant that."""
        if self.credit.alone or not self._flight.shares:
            return False
        if translate(event) is Command.MODE:
            self._settings.copilot = MODES[1 - MODES.index(self._settings.copilot)]
            return True
        return self._dial.take(event)

    @property
    def lacks(self) -> str:
        """Text that says why a guardian goes by points of reward; empty where it does not, or does not help."""
        guard, settings = self._flight.guard, self._settings
        if guard is None or not guard.ahead.problem or settings.copilot != MODES[1] or settings.assist == 0:
            return ""
        return by_values(guard.ahead.problem)

    def help(self) -> None:
        """Set the co-pilot's assist for the next step from the dial."""
        self._flight.help(0.0 if self.credit.alone else self._settings.assist, self._settings.copilot)

    def follow(self) -> None:
        """Update the displays after a step."""
        stepped_in = self.overrides.follow(self._flight)
        self.track.follow(self._flight, stepped_in)
        self.copilot_panel.follow(self._flight)
        self.rescues.follow(self._flight)
        self._recent.follow(self._flight)
        self.credit.follow()

    def add_demonstration(self, folder: Path, hands: str) -> str:
        """Save a finished flight as a demonstration, if wished and good enough; return a message for the player."""
        flight = self._flight
        if not (flight.outcome is Outcome.LANDED and self._settings.teach and hands == OWN):
            return ""
        try:
            return texts.TAUGHT if add_demonstration(flight, folder) else ""
        except (OSError, ValueError) as error:
            return texts.NOT_TAUGHT.format(reason=error)

    def card(self, best: int, view: View) -> OutcomeCard:
        """Return the outcome card of the finished flight; `best` is the score to beat without help."""
        credit, card = self.credit, outcome_card(self._flight.env, self._flight.share)
        card = replace(card, score=credit.score(best), reason=credit.reason(card.reason), assists=credit.assists)
        if not credit.helped:
            return card
        left = self.track.beside((CARD.left, _CARD_LEFT, _CARD_RIGHT), CARD, view)
        bare = "" if card.good else why_bare(self._flight.guard)
        saved = self.rescues.saved(self._flight)
        return replace(card, stepped_in=self.overrides.times, saved=saved, bare=bare, left=left)

    def ease(self) -> None:
        """Advance animations by 1/60 s, whether or not anything flies."""
        self._dial.follow(self.credit.stick)

    @property
    def clear(self) -> ClearArea:
        """The part of the page for the flight, beside the panel that explains it."""
        right = PANEL.left - 16.0 + moved(self._view, 1, -1)[0]
        return ClearArea(right=min(right, ClearArea.right)) if self._explains else ClearArea()

    @property
    def free(self) -> ClearArea:
        """The part of the whole view for words beside the craft."""
        right = PANEL.left - 16.0 + moved(self._view, 1, -1)[0] if self._explains else self._view.right
        return ClearArea(self._view.left, right, self._view.top + ClearArea.head)

    @property
    def coasting(self) -> tuple[float, bool] | None:
        """A guardian's future of coasting, for the mark on the path; None without one, or if nothing is explained."""
        values = self.copilot_panel.values
        return values.coasting if self._explains and isinstance(values, Landings) else None

    @property
    def _explains(self) -> bool:
        return self._settings.explain and self.copilot_panel.shown and not self._flight.over

    def draw_panel(self, canvas: Canvas, view: View, pose: Doubles) -> None:
        """Draw the panel that explains the flight; hide it while the craft flies behind it."""
        if self._explains and not self._meets(view, pose):
            self.copilot_panel.draw(canvas.at(1, -1), self._flight.share)

    def _meets(self, view: View, pose: Doubles) -> bool:
        """Return whether the craft is behind the panel, which happens only where the camera can't keep it clear."""
        around = 2 * _CRAFT * view.pixels_per_metre / view.scale
        lower = PADS_HIGH if len(self._flight.env.ground.pads) > 1 else 0
        panel = pygame.Rect(PANEL.topleft, (PANEL.width, PANEL.height + lower))
        panel.move_ip(moved(self._view, 1, -1))
        return bool(panel.inflate(around, around).collidepoint(view.points(pose[:2]).tolist()))

    def draw_beside(self, canvas: Canvas, view: View, pose: Doubles) -> None:
        """Draw the override beside the craft: the difference between the action asked for and the one flown."""
        if not self._flight.over:
            self.overrides.draw_word(canvas, view, pose, self.free)

    def draw_top(self, canvas: Canvas) -> None:
        """Draw who flies, and the line of who flew in the last seconds."""
        flight, credit, canvas = self._flight, self.credit, canvas.at(0, -1)
        lamp = self.overrides.lamp(flight)
        if flight.shares and not credit.alone:
            self._dial.draw(canvas, credit.header, credit.stick, lamp, self._dial_means)
        else:
            draw_title(canvas, credit.header, lamp)
        if credit.helped:
            self._recent.draw(canvas)

    def _dial_means(self) -> str:
        """Say what the dial means now."""
        guard = self._flight.guard
        problem = guard.ahead.problem if guard else texts.FUTURES_NOT_YET
        return dial_words(self._settings.assist, self._flight.copilot, problem)
