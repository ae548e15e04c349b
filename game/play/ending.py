"""How a flight ends: written down, then, after a moment, its card, while the camera draws back to all of it."""

from __future__ import annotations

import time
from typing import Final

from ai.lander.environment import Outcome
from game.cockpit import hud
from game.cockpit.cockpit import Cockpit
from game.core.pace import Pace
from game.drawing.canvas import Canvas
from game.flight import outcomes
from game.flight.flight import Flight
from game.flight.logbook import Records
from game.flight.networks import Network
from game.flight.skill import Skill
from game.input.controls import Controls
from game.play import captions as flight_words
from game.play.challenge import Course
from game.play.ghost import Ghost
from game.ui.context import Context
from game.world.camera import Shot
from game.world.scenery import Scenery

_CARD_AFTER: Final = 45  # steps from the end of a flight to its card
_CARD_RISE: Final = 16
_CRASH_SEEN: Final = 6  # steps of a crash's slow motion before it can be cut short: a thrust may still be held


class Ending:
    """Of one flight; `follow` once for every step of time since it is over.

    Attributes:
        calm: whether motion is reduced.
        card: how it ended; None before, and where it is tried again at once.

    """

    def __init__(self, flight: Flight, pace: Pace, reduced_motion: bool) -> None:
        self._flight, self._pace, self.calm = flight, pace, reduced_motion
        self._since = 0
        self._whole: Shot | None = None
        self.card: outcomes.Card | None = None

    @property
    def due(self) -> bool:
        """Whether the moment between the end and what follows it is over."""
        return self._since > _CARD_AFTER

    @property
    def shown(self) -> float:
        """How far the card has come in, 0 to 1."""
        since = self._since - _CARD_AFTER
        if since <= 0:
            return 0.0
        return 1.0 if self.calm else 1 - (1 - min(1.0, since / _CARD_RISE)) ** 3

    @property
    def shot(self) -> Shot | None:
        """What the camera is to show instead of the craft, if anything."""
        return self._whole if self.due else None

    def follow(self) -> None:
        """Let a step pass; with the first one a crash goes into slow motion."""
        self._since += 1
        if self._since == 1 and self._flight.outcome is Outcome.CRASHED and not self.calm:
            self._pace.slow_down()

    def hurry(self) -> None:
        """Cut slow motion short, and show the card."""
        if self._pace.slow and self._since > _CRASH_SEEN:
            self._pace.hurry()
            self._since = _CARD_AFTER

    def make_card(self, cockpit: Cockpit, course: Course | None, skill: Skill, scenery: Scenery) -> None:
        """Say how it ended; the best score so far is that of free flights."""
        self._whole = scenery.shot_of(cockpit.track.path)
        card = cockpit.card(0 if course and course.name else skill.best, self._whole.view(1.0))
        self.card = course.card(card, self._flight, cockpit.credit) if course else card

    def draw(
        self, canvas: Canvas, controls: Controls, course: Course | None, ghost: Ghost | None, advise: bool
    ) -> None:
        """Draw the card, once there is one."""
        if self.card is None or self.shown == 0:
            return
        rival = ghost.row(self._flight.env) if ghost else None
        keys = flight_words.card_keys(controls, self.card.good, course)
        hud.draw_card(canvas, self.card, keys, self.shown, advise, rival)


def write_down(
    context: Context, flight: Flight, cockpit: Cockpit, course: Course | None,
    records: Records, skill: Skill, network: Network, hands: str,
) -> None:  # fmt: skip
    """Keep a flight that is over, as an example too if wished, and count it; tell the player what went wrong."""
    credit = cockpit.credit
    told = "" if course or credit.bar == "practice" else cockpit.keep_lesson(context.user_dir, hands)
    entry = records.keep(
        flight,
        time.time(),
        alone=credit.counts,
        barred=credit.bar,
        network=network.name if network.flyer else "",
        course=course.name if course else "",
        medal=credit.medal,
        pace=credit.pace,
    )
    skill.add(entry)
    if told or records.problem:
        context.note(told or records.problem)
