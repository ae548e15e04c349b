"""Paths drawn in the sky: previews of a flight, six futures of it, and trails of past flights."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import pygame

from ai.environment import Bools, Doubles, Ints
from ai.lander.environment import Outcome
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import HUMAN, NET, Colour
from game.flight.flight import Flight
from game.flight.foresight import Preview, SixFutures
from game.flight.networks import Policy
from game.world.camera import View

_SPACING, _CLEAR = 0.62, 1.6  # metres between dots, and before the first one
_TRAIL_STRIDE: Final = 6  # steps between points of a trail
_FINEST: Final = 40  # points of a trail that is done: it is smooth, and there are many to draw
_STRETCH: Final = 12  # points of a trail drawn in one colour
_PLACES: Final = 18  # of the path without thrust in a step, so that it is complete after a few


def draw_dotted(canvas: Canvas, view: View, path: Doubles, colour: Colour, head: float = 0.0) -> None:
    """Draw a path (k, 2) as dots that fade along the way, clear of the craft, and below the uppermost `head` points."""
    head += canvas.view.top
    if len(path) < 2:
        return
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    marks = np.arange(_CLEAR, lengths[-1], _SPACING)
    if not len(marks):
        return
    places = np.stack([np.interp(marks, lengths, path[:, k]) for k in range(2)], axis=1)
    fade = np.linspace(0.95, 0.22, len(marks))
    for place, alpha in zip(view.points(places).tolist(), fade.tolist(), strict=True):
        if place[1] > head:
            canvas.dot(place, 1.5, colour, alpha)
    end = view.points(path[-1]).tolist()
    if end[1] > head:
        canvas.marker("diamond", end, 7, colour, 0.55)


@dataclass
class _Trail:
    points: Doubles
    outcome: int
    age: float = 0.0


class Trails:
    """Fading trails of the recent flights of `count` landers; call `follow` once after every step.

    A point is kept every `stride` steps, and the last `keep` finished flights stay visible.
    """

    def __init__(self, count: int, keep: int = 12, stride: int = _TRAIL_STRIDE) -> None:
        self._open: list[list[tuple[float, float]]] = [[] for _ in range(count)]
        self._done: deque[_Trail] = deque(maxlen=keep)
        self._keep = keep
        self._fade = 0.1 ** (1 / max(1, keep))
        self._stride = stride
        self._step = 0

    def begin(self, slot: int) -> None:
        """Begin the trail of a slot anew, because its lander has been put elsewhere."""
        self._open[slot] = []

    def follow(self, position: Doubles, outcome: Ints, fresh: Bools, ended: Bools) -> None:
        """Note positions (n, 2) and outcomes (n,); `fresh` slots (n,) began a new flight, `ended` ones just ended."""
        for slot in np.flatnonzero(fresh):
            self._open[slot] = []
        self._step += 1
        if self._step % self._stride == 0:
            for way, place, state in zip(self._open, position.tolist(), outcome.tolist(), strict=True):
                if state == Outcome.FLYING:
                    way.append(place)
        for slot in np.flatnonzero(ended)[-self._keep :]:
            points = [*self._open[slot], position[slot].tolist()]
            if len(points) > 1:
                self._done.append(_Trail(_thinned(np.array(points)), int(outcome[slot])))
        for trail in self._done:
            trail.age += 1 / 60

    def draw(self, canvas: Canvas, view: View, shown: int, head: float = 0.0) -> None:
        """Draw the trails of finished flights, newest brightest, and that of slot `shown` so far, below the `head`."""
        top = canvas.view.top + head
        for rank, trail in enumerate(reversed(self._done)):
            strength = 0.55 * self._fade**rank * max(0.0, 1 - trail.age / 40)
            landed = trail.outcome == Outcome.LANDED
            colour = canvas.palette.good if landed else canvas.palette.warn
            if strength > 0.06:
                draw_faint(canvas.surface, view.pixels(trail.points), colour, strength, head * canvas.scale)
                end = view.points(trail.points[-1]).tolist()
                if not landed and end[1] > top:
                    canvas.marker("cross", end, 7, colour, min(1.0, strength * 1.8))
        way = self._open[shown]
        if len(way) > 1:
            draw_faint(canvas.surface, view.pixels(np.array(way)), NET, 0.6, head * canvas.scale)


def _thinned(points: Doubles) -> Doubles:
    """Return some of the points (k, 2), the first and the last among them."""
    count = len(points)
    return points if count <= _FINEST else points[np.linspace(0, count - 1, _FINEST).astype(int)]


def draw_faint(surface: pygame.Surface, points: Doubles, colour: Colour, strength: float, head: float = 0.0) -> None:
    """Draw a line as if translucent: each stretch is blended with the colour under its middle.

    It ends below the uppermost `head` pixels, where text stands.
    """
    places, seen = points.tolist(), surface.get_clip()
    area = seen.clip((0, head, *surface.get_size()))
    surface.set_clip(area)
    for start in range(0, len(places) - 1, _STRETCH):
        stretch = places[start : start + _STRETCH + 1]
        x, y = stretch[len(stretch) // 2]
        if area.collidepoint(x, y):
            draw_stretch(surface, surface.get_at((int(x), int(y))).lerp(colour, strength), stretch)
    surface.set_clip(seen)


def draw_stretch(surface: pygame.Surface, colour: Colour | pygame.Color, places: Sequence[Point]) -> None:
    """Draw a thin open line through places in pixels, two or more.

    With just two points, pygame's `aalines` reads beyond their end and draws garbage.
    """
    if len(places) > 2:
        pygame.draw.aalines(surface, colour, False, places)
    else:
        pygame.draw.aaline(surface, colour, places[0], places[1])


class PathPreview:
    """Path preview of one flight; call `follow` once after every step, and while the craft waits.

    Attributes:
        drift: where the craft goes if nothing is done.
        forecast: where the network would fly it; None without a network.

    """

    def __init__(self, flight: Flight[Any], network: Policy | None) -> None:
        self._flight = flight
        self.drift = Preview(flight.env)
        while not len(self.drift.path):
            self.drift.follow(1)
        self._drifts = False
        self.ask(network)

    def ask(self, network: Policy | None) -> None:
        """Preview this network's path from here on; with None, only the path without input."""
        self.forecast = Preview(self._flight.env, network) if network else None

    def follow(self, waiting: bool) -> None:
        """Extend both paths; the path without input stays the same while the craft hangs and waits."""
        if self._arrived:
            return
        self._drifts = not self._drifts and not waiting  # every other step, so that no frame has all of both
        if self._drifts:
            self.drift.follow(_PLACES)
        if self.forecast:
            self.forecast.follow(1 if self._drifts else 2)

    def draw(self, canvas: Canvas, view: View, head: float) -> None:
        """Draw what is left of both paths, below the text in the uppermost `head` points."""
        if self._arrived:
            return
        draw_dotted(canvas, view, self.drift.path, HUMAN, head=head)
        if self.forecast:
            draw_dotted(canvas, view, self.forecast.ahead, NET, head=head)

    @property
    def _arrived(self) -> bool:
        return self._flight.over or bool(self._flight.env.feet_down[0].any())


def draw_futures(canvas: Canvas, view: View, futures: SixFutures, head: float) -> None:
    """Draw six futures as paths: blue to a landing, with a tick, or red to a cross."""
    for path, lands in zip(futures.paths, futures.lands, strict=False):
        colour = NET if lands else canvas.palette.warn
        draw_faint(canvas.surface, view.pixels(path), colour, 0.55 if lands else 0.45, canvas.scale * head)
        end = view.points(path[-1]).tolist()
        if end[1] > head:
            canvas.marker("check" if lands else "cross", end, 10, colour)
