"""Drawing of an exhibit's labels."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from engine.vector import Array
from game.drawing.canvas import Canvas
from game.drawing.figures import write_figures
from game.drawing.tokens import INK, SMALL
from game.scenes.physics.exhibit import Label
from game.world.camera import View

_GAUGE: Final = 64.0
_AROUND: Final = 180  # points: labels are written around their places


def draw_label(canvas: Canvas, view: View, label: Label, poses: Array, covered: pygame.Rect | None) -> None:
    """Draw a label, with its mark and its bar, unless a panel has it `covered`; `poses` (bodies, 3) are as drawn."""
    place = np.asarray(label.place)
    if label.body is not None:
        place = place + poses[label.body.index, :2]
    x, y = view.points(place).tolist()
    if covered and covered.inflate(_AROUND, 24).collidepoint(x, y):
        return
    left, _ = write_figures(canvas, label.text, (x, y + 4), size=SMALL, centred=True)
    palette = canvas.palette
    if label.within is not None:
        if label.within:
            canvas.dot((left - 10, y), 2.5, palette.good)
        else:
            canvas.marker("triangle", (left - 10, y), 9, palette.warn)
    if label.fill is not None:
        canvas.bar((x - _GAUGE / 2, y + 11, _GAUGE, 2), label.fill, INK)
    if label.limit is not None:
        tick = x - _GAUGE / 2 + label.limit * _GAUGE
        canvas.line((tick, y + 8), (tick, y + 16), INK)
