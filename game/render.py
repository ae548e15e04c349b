"""The one place where metres become pixels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from game.ui.tokens import VIEW_SIZE

Metres = npt.NDArray[np.float64]
Pixels = npt.NDArray[np.float64]

WORLD_WIDTH: Final = 40.0
POINTS_PER_METRE: Final = VIEW_SIZE[0] / WORLD_WIDTH
# The bottom edge of the view at rest, in metres: it leaves room below the ground line for the read-outs.
VIEW_BOTTOM: Final = -1.1
HOME: Final = (0.0, VIEW_BOTTOM + VIEW_SIZE[1] / POINTS_PER_METRE / 2)


@dataclass(frozen=True)
class View:
    """What part of the world a picture shows: `centre` in metres is its middle.

    `scale` is the canvas's pixels per point; at a zoom of 1 the whole width of the world is seen.
    """

    scale: float
    centre: tuple[float, float] = HOME
    zoom: float = 1.0

    @property
    def pixels_per_metre(self) -> float:
        """How large the world is drawn."""
        return POINTS_PER_METRE * self.scale * self.zoom

    @property
    def shift(self) -> tuple[float, float]:
        """How far, in pixels, the world has moved from rest; what lies far away moves a share of it."""
        across, up = self.centre[0] - HOME[0], self.centre[1] - HOME[1]
        return -across * self.pixels_per_metre, up * self.pixels_per_metre

    def pixels(self, position: npt.ArrayLike) -> Pixels:
        """Turn world positions (..., 2) into pixels of the view."""
        return self._project(position, self.pixels_per_metre, self.scale)

    def points(self, position: npt.ArrayLike) -> Pixels:
        """Turn world positions (..., 2) into points of the canvas."""
        return self._project(position, POINTS_PER_METRE * self.zoom, 1.0)

    def metres(self, point: npt.ArrayLike) -> Metres:
        """Turn points of the canvas (..., 2), such as the mouse's, into world positions."""
        from_middle = np.asarray(point, dtype=float) - np.array(VIEW_SIZE) / 2
        return self.centre + from_middle * (1, -1) / (POINTS_PER_METRE * self.zoom)

    def _project(self, position: npt.ArrayLike, per_metre: float, scale: float) -> Pixels:
        from_centre = np.asarray(position, dtype=float) - self.centre
        return from_centre * (per_metre, -per_metre) + np.array(VIEW_SIZE) * (scale / 2)


class Camera:
    """Eases from view to view; moved in steps, drawn in between."""

    def __init__(self) -> None:
        self.centre = np.array(HOME)
        self.zoom = 1.0
        self._before = (self.centre.copy(), self.zoom)

    def follow(self, position: npt.ArrayLike, ease: float = 0.03, pull: float = 0.045) -> None:
        """Lean a little towards a position; call once a step."""
        self._before = (self.centre.copy(), self.zoom)
        wanted = HOME + pull * (np.asarray(position, dtype=float) - HOME) * (1.0, 0.4)
        self.centre = self.centre + ease * (wanted - self.centre)

    def view(self, scale: float, alpha: float = 1.0) -> View:
        """Return the view on a canvas of that scale, `alpha` of the way from the last step to this one."""
        before, zoom = self._before
        x, y = (before + alpha * (self.centre - before)).tolist()
        return View(scale, (x, y), zoom + alpha * (self.zoom - zoom))
