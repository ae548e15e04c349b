"""Descent: an endless chain of legs from pad to pad with one tank, which landings refill.

A run is flown from its first leg until the craft is lost. The next leg hangs, on its feet, until it is touched. The
network flies every leg beside the player as a ghost, or as a relief; a run that it has had a part in does not count
as the player's own. After a run its own flights are the ghosts of the next try over the same ground.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from ai.flights.verification import DESCENT, landing_score
from ai.lander.descent import TANK, LegStart, leg_of
from ai.lander.environment import LanderEnv, Outcome
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.cursor import LEADING, Cursor
from game.drawing.tokens import HUMAN, INK, MUTE, NET, SMALL, TEXT
from game.flight.choosers import Alone
from game.flight.flight import Flight, Recording
from game.flight.networks import Policy, sentence, who
from game.flight.outcomes import OutcomeCard
from game.flight.replay import replayed
from game.scenes.play.challenge import Challenge, Start, Wanted, Words
from game.scenes.play.ghost import Ghost
from game.world.camera import ClearArea, View

if TYPE_CHECKING:
    from game.scenes.play.flown_flight import FlownFlight

_MOST: Final = 5  # the highest factor of a row of landings
_GAUGE, _WORDS = 120.0, 220.0  # points of the gauge's width, and of the words over it
_OVER_PAD: Final = (0.75, 42.0)  # metres and points above the goal at which its mark points down, over its factor
_EDGE: Final = (90.0, 140.0)  # points that marks keep from the sides, and from the lower edge
_ANTENNA: Final = 2.0  # metres from the middle of a craft to the word of its contact light
_CLEAR: Final = 80.0  # points from there up to what the landing has brought


class Descent(Challenge):
    """One run after another.

    Attributes:
        begins: where the present leg begins.
        legs: how many legs the run has landed.
        streak: landings in a row by the player's own hands.
        best: legs and points of the player's best run before this one.

    """

    name = DESCENT

    def __init__(self, best: tuple[int, int] = (0, 0)) -> None:
        super().__init__()
        self.best, self._seed = best, -1
        self._flown: list[Recording] = []
        self._before: list[Recording] = []  # an earlier run over the same ground
        self._clear()

    def _clear(self) -> None:
        self.begins = self._next = LegStart()
        self.legs = self.total = self.streak = 0
        self.rules.bar, self._landed, self._counts = "", False, True
        self._points, self._gained = 0, 0.0
        self._relief = ""  # who flew the last leg in the player's place

    def start(self, wanted: Wanted) -> Start:
        """Begin the next leg after a landing; otherwise begin a run."""
        seed = wanted.seed
        if seed != self._seed or not self._landed:
            self._start_run(seed)
        self.begins, self._landed = self._next, False
        self.rules.again, self.rules.staked = False, self.legs > 0
        recording = Recording(seed, "random", leg=self.begins)
        # The ground of the next leg, as it will be unless this one ends on a flat spot.
        ahead = leg_of(seed, LegStart(self.begins.number + 1)).ground
        return Start(recording, self._ghost(recording, wanted.network), ahead=ahead)

    def _start_run(self, seed: int) -> None:
        """Begin a run; over the same ground as the last one, beside the longest so far."""
        longest = max(self._before, self._flown, key=len)
        self._before, self._flown = longest if seed == self._seed else [], []
        if self._counts:
            self.best = max(self.best, (self.legs, self.total))
        self._seed = seed
        self._clear()

    def _ghost(self, start: Recording, network: Policy | None) -> Ghost | None:
        """Return the ghost: the player's earlier flight of this leg or, without one, the network."""
        number = self.begins.number
        if number <= len(self._before):
            return Ghost(replayed(self._before[number - 1]), lambda: texts.GHOST_BEFORE)
        return Ghost(Flight(start, Alone(network)), partial(who, network)) if network else None

    def words(self, flown: FlownFlight) -> Words:
        leg = leg_of(self._seed, self.begins)
        kinds = texts.AND.join(texts.DESCENT_KINDS[kind] for kind in leg.kinds)
        goal = [texts.DESCENT_POINTS.format(count=self.total)]
        if self.streak > 1:
            goal.append(texts.DESCENT_STREAK.format(factor=min(self.streak, _MOST)))
        if self.best[0]:
            goal.append(texts.DESCENT_BEST.format(count=self.best[0]))
        spot = any(pad.bare and pad.factor for pad in leg.ground.pads)
        hint = texts.DESCENT_SPOT if spot else texts.DESCENT_HINTS[leg.kinds[-1]]
        return Words(
            texts.DESCENT_TITLE, texts.DESCENT_LEG.format(number=self.begins.number, kinds=kinds),
            texts.DIAL_JOIN.join(goal), texts.DESCENT_BEGIN if self.begins.number == 1 else hint,
            marks=partial(self._draw, flown), card=partial(self._add_to, flown),
            stake=(texts.DESCENT_STAKE, texts.DESCENT_STAKE_MORE.format(count=self.legs)),
        )  # fmt: skip

    def ended(self, flown: FlownFlight) -> None:
        """Count a finished leg: points, the row of landings, and what it brings into the tank; or end the run."""
        flight = flown.flight
        self._flown.append(flight.recording)
        self._landed = self.rules.again = flight.outcome is Outcome.LANDED  # then the next leg follows
        self._counts &= flown.credit.counts
        own = flown.credit.own
        self.rules.bar = self.rules.bar if own else "relieved"
        if self._landed:
            self._count(flown, own=own)
        self.rules.staked &= self._landed
        flown.keep(self.total)

    def _count(self, flown: FlownFlight, *, own: bool) -> None:
        env = flown.flight.env
        spot, score = env.ground.pads[int(env.landed_on[0])], landing_score(env)
        self.streak = self.streak + 1 if own else 0
        self._relief = flown.credit.who
        self._points = score * min(self.streak, _MOST)
        self.total += self._points
        self.legs = self.begins.number
        self._next = self.begins.after(float(env.fuel[0]), score, bare=spot.bare)
        self._gained = max(0.0, self._next.tank - max(0.0, self.begins.tank - float(env.fuel[0])))
        flown.ahead = leg_of(self._seed, self._next).ground

    def _add_to(self, flown: FlownFlight, card: OutcomeCard) -> None:
        """Say how far the run has come."""
        best = self._counts and (self.legs, self.total) > self.best and self.legs > 0
        values = self.legs, self.total, max(self.best[0], self.legs if best else 0)
        card.figures = tuple(
            (label, f"{value}", "") for label, value in zip(texts.DESCENT_FIGURES, values, strict=True)
        )
        card.score = ""
        env = flown.flight.env
        if float(env.fuel[0]) >= env.conditions.tank:
            card.advice = texts.DESCENT_EMPTY
        elif best or self.rules.bar:
            card.advice = texts.DESCENT_NEW_BEST if best else flown.credit.barred

    # The picture

    def _draw(self, flown: FlownFlight, canvas: Canvas, view: View, alpha: float) -> None:
        """Draw the mark of the goal and, on the ground, what the landing has brought."""
        flight = flown.flight
        if not flight.over:
            _draw_goal(canvas, view, flight.env)
        elif self._landed:
            place = canvas.pixels(view.points(flight.poses.at(alpha)[0, :2] + (0.0, _ANTENNA)).tolist())
            self._draw_landing(canvas.reading, canvas.reading.points(place))

    def _draw_landing(self, canvas: Canvas, craft: tuple[float, float]) -> None:
        (x, y), half = craft, _WORDS / 2
        x = min(max(x, canvas.view.left + half), canvas.view.right - half)
        canvas.panel((x - half, y - _CLEAR - 8, _WORDS, 60), 0.9)  # the path behind the words is hardly seen
        rows = Cursor(x - half, y - _CLEAR, _WORDS, canvas.scale, canvas)
        relieved = sentence(texts.DESCENT_RELIEVED, self._relief)
        words = texts.DESCENT_LANDED.format(count=self._points) if self._points else relieved
        rows.in_style(TEXT, HUMAN if self._points else NET).text(words, "centre")
        rows.gap(LEADING * TEXT)
        fuel = texts.DESCENT_NO_FUEL if self._next.bare else texts.DESCENT_FUEL.format(seconds=self._gained)
        rows.in_style(SMALL, MUTE).text(fuel, "centre")
        rows.gap(LEADING * SMALL + 2)
        replace(rows, left=x - _GAUGE / 2, width=_GAUGE).bar(self._next.tank / TANK, canvas.palette.good)


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
