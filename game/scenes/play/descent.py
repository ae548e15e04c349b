"""Descent: an endless chain of legs from pad to pad with one tank, which landings refill.

A run is flown from its first leg until the craft is lost. The next leg hangs, on its feet, until it is touched. The
network flies every leg beside the player as a ghost, or as a relief; a run that it has had a part in does not count
as the player's own. After a run its own flights are the ghosts of the next try over the same ground.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.flights.verification import DESCENT, landing_score
from ai.lander.descent import TANK, LegStart, leg_of
from ai.lander.environment import LanderEnv, Outcome
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.cursor import LEADING, Cursor
from game.drawing.tokens import HUMAN, INK, MUTE, NET, NIGHT0, SMALL, TEXT
from game.flight.choosers import Alone, Crew
from game.flight.credit import Credit
from game.flight.flight import Flight, Recording, begin
from game.flight.flight_file import Entry
from game.flight.logbook import best_descent
from game.flight.networks import Policy, sentence, who
from game.flight.outcomes import OutcomeCard
from game.flight.replay import replayed
from game.scenes.play.challenge import Challenge
from game.scenes.play.ghost import Ghost
from game.world.camera import ClearArea, View

if TYPE_CHECKING:
    from game.scenes.play.flown_flight import FlownFlight

_MOST: Final = 5  # the highest factor of a row of landings
_FILLS: Final = 40  # steps in which the tank is seen to fill
_FADES: Final = 24  # steps in which a new leg appears
_GAUGE, _WORDS = 120.0, 220.0  # points of the gauge's width, and of the words over it
_OVER_PAD: Final = (0.75, 42.0)  # metres and points above the goal at which its mark points down, over its factor
_EDGE: Final = (90.0, 140.0)  # points that marks keep from the sides, and from the lower edge
_ANTENNA: Final = 2.0  # metres from the middle of a craft to the word of its contact light
_CLEAR: Final = 84.0  # points from there up to what the landing has brought


class Descent(Challenge):
    """One run after another.

    Attributes:
        start: where the present leg begins.
        legs: how many legs the run has landed.
        streak: landings in a row by the player's own hands.
        best: legs and points of the player's best run before this one.

    """

    name = DESCENT
    fixed = compares = False

    def __init__(self) -> None:
        self.best, self._seed = (0, 0), -1
        self._flown: list[Recording] = []
        self._before: list[Recording] = []  # an earlier run over the same ground
        self._clear()

    def _clear(self) -> None:
        self.start = self._next = LegStart()
        self.legs = self.total = self.streak = 0
        self.bar, self._landed, self._counts = "", False, True
        self._points, self._gained, self._since = 0, 0.0, 0
        self._relief = ""  # who flew the last leg in the player's place

    def recall(self, entries: Iterable[Entry]) -> None:
        self.best = max(self.best, best_descent(entries))

    def flight(self, seed: int, network: Policy | None, spawn: str = "") -> Flight[Crew]:
        """Begin the next leg after a landing; otherwise begin a run."""
        if seed != self._seed or not self._landed:
            self._start_run(seed)
        self.start, self._landed, self._since = self._next, False, 0
        lost = texts.DESCENT_STAKE, texts.DESCENT_STAKE_MORE.format(count=self.legs)
        self.stake = lost if self.legs else None
        # The ground of the next leg, as it will be unless this one ends on a flat spot.
        self.ahead = leg_of(seed, LegStart(self.start.number + 1)).ground
        self.word()
        return begin(Recording(seed, "random", leg=self.start), network)

    def _start_run(self, seed: int) -> None:
        """Begin a run; over the same ground as the last one, beside the longest so far."""
        longest = max(self._before, self._flown, key=len)
        self._before, self._flown = longest if seed == self._seed else [], []
        if self._counts:
            self.best = max(self.best, (self.legs, self.total))
        self._seed = seed
        self._clear()

    def word(self) -> None:
        self.title, self.again_hint, self.new_hint = texts.DESCENT_TITLE, texts.DESCENT_AGAIN, texts.DESCENT_NEW
        leg = leg_of(self._seed, self.start)
        kinds = texts.AND.join(texts.DESCENT_KINDS[kind] for kind in leg.kinds)
        self.line = texts.DESCENT_LEG.format(number=self.start.number, kinds=kinds)
        words = [texts.DESCENT_POINTS.format(count=self.total)]
        if self.streak > 1:
            words.append(texts.DESCENT_STREAK.format(factor=min(self.streak, _MOST)))
        if self.best[0]:
            words.append(texts.DESCENT_BEST.format(count=self.best[0]))
        self.goal = texts.DIAL_JOIN.join(words)
        if self.start.number == 1:
            self.opening = texts.DESCENT_BEGIN
        elif any(pad.bare and pad.factor for pad in leg.ground.pads):
            self.opening = texts.DESCENT_SPOT
        else:
            self.opening = texts.DESCENT_HINTS[leg.kinds[-1]]

    def ghost(self, seed: int, network: Policy | None) -> Ghost | None:
        """Begin the ghost: the player's earlier flight of this leg or, without one, the network."""
        number = self.start.number
        if number <= len(self._before):
            return Ghost(replayed(self._before[number - 1]), lambda: texts.GHOST_BEFORE)
        start = Recording(seed, "random", leg=self.start)
        return Ghost(Flight(start, Alone(network)), partial(who, network)) if network else None

    def note_end(self, flight: Flight[Crew], credit: Credit) -> None:
        """Count a finished leg: points, the row of landings, and what it brings into the tank."""
        env = flight.env
        self._flown.append(flight.recording)
        self._landed = flight.outcome is Outcome.LANDED
        own = flight.share == 1.0
        self._counts &= credit.counts
        self.bar = self.bar if own else "relieved"
        if not self._landed:
            self.stake = None
            return
        spot, score = env.ground.pads[int(env.landed_on[0])], landing_score(env)
        self.streak = self.streak + 1 if own else 0
        self._relief = credit.who
        self._points = score * min(self.streak, _MOST)
        self.total += self._points
        self.legs = self.start.number
        self._next = self.start.after(float(env.fuel[0]), score, bare=spot.bare)
        self._gained = max(0.0, self._next.tank - max(0.0, self.start.tank - float(env.fuel[0])))
        self.ahead = leg_of(self._seed, self._next).ground
        self.word()

    def again(self) -> bool:
        """The next leg follows after every landing."""
        return self._landed

    def follow(self, flight: Flight[Crew]) -> str:
        """Let the tank fill once the craft has landed."""
        self._since += flight.over
        return ""

    def card(self, card: OutcomeCard, flight: Flight[Crew], credit: Credit) -> OutcomeCard:
        best = self._counts and (self.legs, self.total) > self.best and self.legs > 0
        values = self.legs, self.total, max(self.best[0], self.legs if best else 0)
        figures = tuple((label, f"{value}", "") for label, value in zip(texts.DESCENT_FIGURES, values, strict=True))
        advice = texts.DESCENT_NEW_BEST if best else credit.barred if self.bar else card.advice
        if float(flight.env.fuel[0]) >= flight.env.conditions.tank:
            advice = texts.DESCENT_EMPTY
        return replace(card, figures=figures, score="", advice=advice)

    # The picture

    def draw(self, canvas: Canvas, view: View, flown: FlownFlight, alpha: float) -> None:
        """Draw the mark of the goal and, on the ground, what the landing has brought."""
        flight, calm = flown.flight, flown.scenery.calm
        if not flight.over:
            _draw_goal(canvas, view, flight.env)
        elif self._landed:
            craft = view.points(flight.poses.at(alpha)[0, :2] + (0.0, _ANTENNA)).tolist()
            self._draw_landing(canvas, craft, 1.0 if calm else min(1.0, self._since / _FILLS))
        if flown.waiting and self.start.number > 1 and not calm and flown.age < _FADES:
            # Two fills in place take half as long as a translucent picture of the whole window.
            dark = 1 - flown.age / _FADES
            canvas.surface.fill([round(255 * (1 - dark))] * 3, special_flags=pygame.BLEND_RGB_MULT)
            canvas.surface.fill([round(dark * part) for part in NIGHT0], special_flags=pygame.BLEND_RGB_ADD)

    def _draw_landing(self, canvas: Canvas, craft: tuple[float, float], filled: float) -> None:
        (x, y), half = craft, _WORDS / 2
        x = min(max(x, canvas.view.left + half), canvas.view.right - half)
        rows = Cursor(x - half, y - _CLEAR, _WORDS, canvas.scale, canvas)
        relieved = sentence(texts.DESCENT_RELIEVED, self._relief)
        words = texts.DESCENT_LANDED.format(count=self._points) if self._points else relieved
        rows.in_style(TEXT, HUMAN if self._points else NET).text(words, "centre")
        rows.gap(LEADING * TEXT)
        fuel = texts.DESCENT_NO_FUEL if self._next.bare else texts.DESCENT_FUEL.format(seconds=self._gained)
        rows.in_style(SMALL, MUTE).text(fuel, "centre")
        rows.gap(LEADING * SMALL + 2)
        now = self._next.tank - (1 - filled) * self._gained
        replace(rows, left=x - _GAUGE / 2, width=_GAUGE).bar(now / TANK, canvas.palette.good)


def _draw_goal(canvas: Canvas, view: View, env: LanderEnv) -> None:
    """Point to the goal and write how far it is, at the edge of the view where it lies beyond."""
    pad = env.ground.pads[0]
    x, y = view.point(pad.x, pad.top + _OVER_PAD[0])
    (side, low), seen = _EDGE, canvas.view
    y = min(max(y - _OVER_PAD[1], seen.top + ClearArea.head), seen.bottom - low)
    x = min(max(x, seen.left + side), seen.right - side)
    away = float(np.hypot(*(env.position[0] - (pad.x, pad.top + env.params.stand))))
    words = texts.DESCENT_AWAY.format(metres=away)
    canvas.text(words, (x, y - 12), size=SMALL, colour=INK, align="centre", tabular=True, alpha=0.8)
    for lean in (-5, 5):
        canvas.line((x + lean, y - 6), (x, y), INK, 1.5, 0.8)
