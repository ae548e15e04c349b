"""Sliders of an exhibit's quantities, in the band above its room."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

import pygame

from game.core import texts
from game.drawing.tokens import HUMAN, MARGIN, VIEW_SIZE
from game.exhibits.exhibit import Exhibit
from game.ui.widget import PointsManager
from game.ui.widgets import Slider

LEFT: Final = 868.0  # points from the left edge of the view, for all that is on the right of this band
_TOP, _PITCH, _HEIGHT = 78.0, 24.0, 20.0
_LABEL_WIDTH, _FIGURE_WIDTH = 142.0, 76.0


def quantity_sliders(manager: PointsManager, exhibit: Exhibit, on_change: Callable[[str, float], None]) -> list[Slider]:
    """Return a slider for each quantity; `on_change` gets its name and its new value."""
    sliders = []
    for row, quantity in enumerate(exhibit.quantities):
        label, figure = texts.QUANTITIES[quantity.name]
        slider = Slider(
            manager,
            pygame.Rect(LEFT, _TOP + row * _PITCH, VIEW_SIZE[0] - MARGIN - LEFT, _HEIGHT),
            label,
            exhibit.values[quantity.name],
            quantity.limits,
            partial(on_change, quantity.name),
            step=quantity.step,
            label_width=_LABEL_WIDTH,
            figure_width=_FIGURE_WIDTH,
            figure=lambda value, figure=figure: figure.format(value=value),  # type: ignore[misc]
            colour=HUMAN,
        )
        sliders.append(slider)
    return sliders
