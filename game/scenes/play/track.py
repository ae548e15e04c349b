"""Flown path in the colours of who flew, with marks where the co-pilot stepped in."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby, pairwise
from typing import Final

import numpy as np

from ai.environment import Doubles
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, NET, VIEW_SIZE
from game.flight.flight import Flight, StickHolder
from game.world.camera import ClearArea, View
from game.world.paths import draw_faint

_STRIDE: Final = 4  # steps between points
_MOST_MARKS: Final = 24
_CARD: Final = (480.0, 136.0, 280.0)  # points: width, top and height of the outcome card
_DIM: Final = 0.62  # dimmed, as the past must not outshine the present


class FlownPath:
    """Path of one flight, recorded step by step and drawn once the flight is over."""

    def __init__(self, flight: Flight) -> None:
        self._points: list[Doubles] = [flight.env.position[0].copy()]
        self._hands: list[StickHolder] = []
        self.moments: list[Doubles] = []

    def follow(self, flight: Flight, stepped_in: bool) -> None:
        """Record a step, and whether the co-pilot stepped in with it."""
        here = flight.env.position[0]
        if stepped_in:
            self.moments.append(here.copy())
        if len(flight.recording.actions) % _STRIDE == 0 or flight.over:
            self._points.append(here.copy())
            self._hands.append(flight.flown_by)

    @property
    def path(self) -> Doubles:
        """The path so far: positions (k, 2) in metres."""
        return np.array(self._points)

    def beside(self, places: Sequence[float], view: View) -> float:
        """Return the place of a card across the view, out of `places` from 0 to 1, at which it hides least of it."""
        points = view.points(self.path)

        def hidden(place: float) -> int:
            left = place * (VIEW_SIZE[0] - _CARD[0])
            inside = (points >= (left, _CARD[1])) & (points <= (left + _CARD[0], _CARD[1] + _CARD[2]))
            return int(inside.all(axis=1).sum())

        return min(places, key=hidden)

    def draw(self, canvas: Canvas, view: View, shown: float = 1.0) -> None:
        """Draw the share `shown` (0 to 1) of the path, and a diamond for each intervention, below the head."""
        pixels = view.pixels(self.path)
        last = round(shown * len(self._hands))
        ends = [0]
        for _, run in groupby(self._hands[:last]):
            ends.append(ends[-1] + len(list(run)))
        for start, end in pairwise(ends):
            colour = HUMAN if self._hands[start] is StickHolder.HUMAN else NET
            draw_faint(canvas.surface, pixels[start : end + 1], colour, _DIM, canvas.scale * ClearArea.head)
        if shown >= 1:
            for place in self._marked():
                spot = view.points(place).tolist()
                if spot[1] > canvas.view.top + ClearArea.head:
                    canvas.marker("diamond", spot, 8, NET)

    def _marked(self) -> list[Doubles]:
        """Return the places of interventions, thinned out where they are too close to tell apart."""
        every = max(1, -(-len(self.moments) // _MOST_MARKS))
        return self.moments[::every]
