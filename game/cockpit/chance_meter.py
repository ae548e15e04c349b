"""Chance to be saved during a flight: a ring round the lamp, with a mark for the chance that the dial asks for."""

from __future__ import annotations

import math
from typing import Final

from game.core import texts
from game.core.settings import Settings
from game.drawing.arcs import draw_arc, on_ring
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import FAINT, HUMAN, INK, NET, Colour
from game.flight.chances import Critic, chances_to_any_pad, critic_of, known_for
from game.flight.flight import DECISION_STEPS, Flight
from game.flight.networks import Policy
from game.panels.chance_values import of_hundred, told_apart

__all__ = ["ChanceMeter", "depth"]

_RADIUS, _WIDTH = 10.5, 2.0  # points
_MARK: Final = (7.5, 14.0)  # points from the middle of the ring to both ends of the mark
_EASE: Final = 0.3
_REACH: Final = 14.0  # points to each side that explain the ring


def depth(chance: float) -> float:
    """Return how far below the top a chance is drawn, 0 to 1: small risks take more room than large ones."""
    return math.sqrt(min(max(1.0 - chance, 0.0), 1.0))


class ChanceMeter:
    """Meter of the chance to be saved, for one flight; call `follow` after every step.

    It shows what a guardian with a safety critic has decided by. If the player wishes (`settings.edge`), it shows the
    chance in flights without such a guardian, too, of the action that is flown.

    Attributes:
        chance: chance to be saved after the action asked for, 0 to 1; None while it is not known.
        required: chance that the dial asks for; None without a guardian.
        critic: the safety critic, once the player has wished to see the chance.

    """

    def __init__(self, flight: Flight, settings: Settings, *, wishes: bool) -> None:
        self._settings, self._wishes = settings, wishes
        self._policy: Policy | None = None
        self.critic: Critic | None = None
        self._reason = texts.CHANCE_NO_NETWORK
        self.chance: float | None = None
        self.required: float | None = None
        self._held = False  # whether the guardian has the stick
        self._shown = 1.0
        self._seen: object = None
        self._flight = flight

    @property
    def wished(self) -> bool:
        """Whether the chance is to be shown in a flight without a guardian, too, and can be."""
        return self._settings.edge and self._wishes and not self.problem

    @property
    def problem(self) -> str:
        """Text that says why the chance can't be shown though it is wished; empty if it can, or is not."""
        flight = self._flight
        if not (self._settings.edge and self._wishes):
            return ""
        if flight.network is not self._policy:
            self._policy = flight.network
            self.critic, self._reason = critic_of(flight.network)
        if not known_for(flight.env, self.critic):
            return texts.CHANCE_MOON_ONLY
        return "" if self.critic is not None else texts.MAP_NO_CRITIC.format(problem=self._reason)

    def follow(self) -> None:
        """Follow a step of the flight: the critic is asked once for each decision."""
        flight, decision = self._flight, self._flight.decision
        if flight.over:
            return
        chance = decision.chance if decision is not None and flight.shared else None
        if decision is not None and chance is not None and decision.required is not None:
            self.chance, self.required = _finite(float(chance[0])), float(decision.required[0])
            self._held = int(decision.source[0]) > 0
            return
        self.required = None
        if not self.wished:
            self.chance = None
        elif self.chance is None or len(flight.recording.actions) % DECISION_STEPS == 0:
            assert self.critic is not None
            chances = chances_to_any_pad(self.critic, flight.env.observe_around())
            self.chance = _finite(float(chances[0, flight.recording.actions[-1]]))

    def ease(self) -> None:
        """Advance the ring by 1/60 s."""
        wanted = 1.0 if self.chance is None else self.chance
        self._shown += (1.0 if self._settings.reduced_motion else _EASE) * (wanted - self._shown)

    @property
    def low(self) -> bool:
        """Whether the chance is below what the dial asks for."""
        return self.chance is not None and self.required is not None and self.chance < self.required

    def draw(self, canvas: Canvas, lamp: Point) -> None:
        """Draw the ring round the lamp, open where something is lost; below what is asked for it is blue."""
        if self.chance is None:
            return
        draw_arc(canvas, lamp, _RADIUS, 1.0, FAINT, 1.0, 0.9)
        colour: Colour = NET if self.low else HUMAN
        draw_arc(canvas, lamp, _RADIUS, 1.0 - depth(self._shown), colour, _WIDTH)
        if self.required is not None:
            share = 1.0 - depth(self.required)
            canvas.line(on_ring(lamp, _MARK[0], share), on_ring(lamp, _MARK[1], share), INK, 1.5)
        box = (lamp[0] - _REACH, lamp[1] - _REACH, 2 * _REACH, 2 * _REACH)
        canvas.explain(box, texts.EXPLAIN_RING[self.required is not None], self.said)

    def said(self) -> str:
        """Say what the chance is now, and what the dial asks for."""
        if self.chance is None:
            return ""
        if self.required is None:
            return texts.EXPLAIN_RING_NOW.format(chance=of_hundred(self.chance))
        chance, required = told_apart(self.chance, self.required)
        held = 2 if self._held and not self.low else int(self.low)
        return texts.EXPLAIN_RING_ASKED[held].format(chance=chance, required=required)


def _finite(chance: float) -> float | None:
    return chance if math.isfinite(chance) else None
