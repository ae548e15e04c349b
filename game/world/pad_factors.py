"""Score factors above several pads, brighter the more surely a pad is understood to be meant."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import pygame

from ai.environment import Doubles
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, NIGHT0
from game.flight.flight import Flight
from game.world.camera import View

_ABOVE: Final = (0.75, 8.0)  # metres and points between a deck and the factor above it
_BELOW: Final = (0.2, 22.0)  # and below a deck, where something else stands above it
_SIZE: Final = 17.0
_CAPITAL: Final = 0.72  # height of a figure, in shares of its size
_PLAIN: Final = 0.5  # opacity of a pad that is surely not meant
_NEAR, _FAR = 2.2, 4.4  # metres from the craft within which a factor has gone, and from which it is whole
_SHADE: Final = 0.62  # behind a factor, over paths and the dawn
_EASE: Final = 0.08  # share of the remaining difference, per step


class PadFactors:
    """Score factors of a flight's pads; call `follow` once after every step. A flight with one goal has none.

    Attributes:
        meant: how sure it is that each pad is the one that is meant, (pads,), 0 to 1; eased.

    """

    def __init__(self, flight: Flight) -> None:
        self._flight = flight
        pads = flight.env.ground.pads
        self._pads = pads if sum(pad.factor > 0 for pad in pads) > 1 else ()
        self.forget()

    def forget(self) -> None:
        """Show at once what is known now: another moment is shown."""
        self.meant = self._known()

    def follow(self, calm: bool) -> None:
        """Ease towards what is known after a step, or, while `calm`, take it over at once."""
        self.meant = self.meant + (1.0 if calm else _EASE) * (self._known() - self.meant)

    def _known(self) -> Doubles:
        """Return how likely each pad is meant, as the co-pilot reads it; without one, the pad that is aimed at."""
        flight = self._flight
        if flight.shared and flight.decision is not None:
            likely: Doubles = flight.decision.likely[0]
            return likely
        aimed_at: Doubles = np.eye(len(flight.env.ground.pads))[int(flight.env.target[0])]
        return aimed_at

    def draw(self, canvas: Canvas, view: View, craft: Doubles) -> None:
        """Write each factor above its pad; one to which the craft at (x, y) comes near gives way."""
        shift = float(self._flight.env.pad_shift[0])
        metre = view.pixels_per_metre / view.scale
        for pad, meant in zip(self._pads, self.meant.tolist(), strict=False):
            if not pad.factor:  # nothing is earned there
                continue
            x, deck = view.point(pad.x + shift, pad.top)
            word = f"×{pad.factor}"
            width, rise = canvas.text_width(word, size=_SIZE, weight="medium"), _CAPITAL * _SIZE
            row = deck - _ABOVE[0] * metre - _ABOVE[1]
            box = pygame.FRect(x - width / 2 - 7, row - rise - 6, width + 14, rise + 12)
            if _covered(canvas, box):
                lower = deck + _BELOW[0] * metre + _BELOW[1] - row
                box, row = box.move(0, lower), row + lower
            away = math.dist(view.points(craft[:2]).tolist(), box.center) / metre
            seen = min(max((away - _NEAR) / (_FAR - _NEAR), 0.0), 1.0)
            if seen > 0:
                with canvas.unnoted():  # what is noted would push it aside in the next frame
                    canvas.pill(box, NIGHT0, _SHADE * seen)
                    bright = seen * (_PLAIN + (1 - _PLAIN) * meant)
                    canvas.text(word, (x, row), size=_SIZE, colour=INK, weight="medium", align="centre", alpha=bright)


def _covered(canvas: Canvas, box: pygame.FRect) -> bool:
    """Return whether a panel or words stood in a box, in points, in the last frame."""
    return canvas.rect(*box).collidelist(canvas.words) >= 0
