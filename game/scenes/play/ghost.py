"""Ghost: another pilot's flight from the same start, shown beside the player's without touching it."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any, Final

import numpy as np
import pygame

from ai.environment import Doubles
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.rules import tenths
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import NET
from game.flight.flight import Flight
from game.world import lander as art
from game.world.camera import ClearArea, View
from game.world.flame import NET_PLUME, plume
from game.world.landscape.sheet import fitted
from game.world.paths import Trails

Named = str | Callable[[], str]  # a name, or what says it in the player's language
_FIRE: Final = 0.5  # share of full thrust drawn, so that a ghost's flame is not mistaken for the player's
_SEEN, _FADED = 150, 80  # of 255: opacity of a ghost, and of one that has crashed
_SHADE: Final = (102, 102, 102)  # two fifths of 255: a ghost keeps that share of the lander's colours
_TINT: Final = tuple(round(0.6 * level) for level in NET)  # the other three fifths are the network's blue
_FINEST: Final = 64.0  # pixels per metre of its picture, which is translucent and costs a new one at every angle
_EDGE: Final = 18.0  # points from the edge of the view to the mark of a ghost that is beyond it
_HIDDEN: Final = 24.0  # points beyond the edge from which a ghost counts as beyond it


class Ghost:
    """A rival's flight, replayed or flown by a network; call `step` once for every step of the player's."""

    def __init__(self, flight: Flight[Any], name: Named) -> None:
        self.flight, self._named = flight, name
        self._trail = Trails(1, keep=1)

    @property
    def name(self) -> str:
        return self._named if isinstance(self._named, str) else self._named()

    def step(self) -> None:
        flight = self.flight
        was_over = flight.over
        flight.step()
        ended = np.array([flight.over and not was_over])
        self._trail.follow(flight.env.position, flight.env.outcome, np.zeros(1, bool), ended)

    def result(self, yours: LanderEnv) -> str:
        """Return the rival's result and, where both have landed, who was first, for the card of a finished flight."""
        theirs = self.flight.env
        outcome = Outcome(int(theirs.outcome[0]))
        if theirs.intact[0]:
            return texts.BESIDE_RESULT
        if not (outcome is Outcome.LANDED and yours.outcome[0] == outcome):
            return texts.RIVAL_RESULTS[outcome.name]
        behind = tenths(tenths(float(theirs.time[0])) - tenths(float(yours.time[0])))  # of the figures on the card
        if behind == 0:
            return texts.RIVAL_TOGETHER
        return (texts.RIVAL_AFTER if behind > 0 else texts.RIVAL_BEFORE).format(seconds=f"{abs(behind):.1f}")

    def draw_way(self, canvas: Canvas, view: View) -> None:
        self._trail.draw(canvas, view, 0, ClearArea.head)

    def draw(self, canvas: Canvas, view: View, alpha: float) -> None:
        """Draw the ghost as a translucent blue shape, or a mark at the edge towards one outside the view."""
        flight = self.flight
        pose = flight.poses.at(alpha)[0]
        if not flight.over and flight.env.fired[0] >= 3:
            _draw_fire(canvas, view, pose, int(flight.env.steps[0]))
        fine, degrees = min(view.painted_per_metre, _FINEST), round(math.degrees(pose[2])) % 360
        crashed = flight.wrecked
        ratio, place = view.pixels_per_metre / fine, tuple(view.pixels(pose[:2]).tolist())
        canvas.surface.blit(*fitted(lambda halves: _phantom(fine, degrees, halves, crashed), ratio, place))
        x, y = view.points(pose[:2]).tolist()
        edge, near = canvas.view.inflate(-2 * _EDGE, -2 * _EDGE), canvas.view.inflate(2 * _HIDDEN, 2 * _HIDDEN)
        if not near.left <= x <= near.right or not near.top <= y <= near.bottom:
            spot = (min(max(x, edge.left), edge.right), min(max(y, edge.top), edge.bottom))
            canvas.glow(spot, 14, NET, 0.5)
            canvas.marker("diamond", spot, 9, NET, 0.9)


def _draw_fire(canvas: Canvas, view: View, pose: Doubles, step: int) -> None:
    x, y, angle = pose.tolist()
    if fire := plume(NET_PLUME, view.pixels_per_metre, angle, _FIRE, step // 2):
        sheet, (left, top) = fire
        reach = art.NOZZLE[1]
        nozzle = view.pixel(x - reach * math.sin(angle), y + reach * math.cos(angle))
        corner = (round(nozzle[0] - left), round(nozzle[1] - top))
        canvas.surface.blit(sheet, corner, special_flags=pygame.BLEND_RGB_ADD)


@lru_cache(maxsize=192)
def _phantom(pixels_per_metre: float, degrees: int, halves: tuple[int, int], wrecked: bool) -> pygame.Surface:
    """Return a translucent picture of the lander in shades of blue."""
    phantom = art.painted(pixels_per_metre, degrees, halves, art.LANDER).copy()
    phantom.fill(_SHADE, special_flags=pygame.BLEND_RGB_MULT)
    phantom.fill(_TINT, special_flags=pygame.BLEND_RGB_ADD)
    phantom.fill((255, 255, 255, _FADED if wrecked else _SEEN), special_flags=pygame.BLEND_RGBA_MULT)
    return phantom
