"""Camera: the one place where metres become pixels."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from game.core.clock import STEP
from game.drawing.tokens import VIEW_SIZE

if TYPE_CHECKING:
    import pygame

    from game.drawing.canvas import Canvas

Metres = npt.NDArray[np.float64]
Pixels = npt.NDArray[np.float64]

WORLD_WIDTH: Final = 40.0
POINTS_PER_METRE: Final = VIEW_SIZE[0] / WORLD_WIDTH
# The bottom edge of the view at rest, in metres: it leaves room below the ground line for the read-outs.
VIEW_BOTTOM: Final = -1.1
HOME: Final = (0.0, VIEW_BOTTOM + VIEW_SIZE[1] / POINTS_PER_METRE / 2)
# The ground stays on one row of the screen, whatever the zoom: a camera that comes nearer also comes lower.
GROUND_LINE: Final = 1.0  # metres
GROUND_ROW: Final = VIEW_SIZE[1] / 2 + (HOME[1] - GROUND_LINE) * POINTS_PER_METRE  # points
WIDEST: Final = 0.6  # zoom at which all of the world in which a flight may be is seen, and the least at which land is
FARTHEST: Final = 0.25  # of a craft that flies high where words leave little of a window
CLOSEST: Final = 2.0
# Lines of a page for which the world is painted at most. A larger window shows the same pictures, scaled: at arm's
# length that is not seen, and 2,160 lines would take twice as long to paint, and to scale at every zoom.
MOST_LINES: Final = 1440
_LEAST: Final = 0.4 * VIEW_SIZE[0]  # points of the width that a flight has at least
LAND_REACH: Final = 34.0  # metres of visible land to either side of the middle of the world

_PACE: Final = 2.6  # rad/s, of the spring that moves the camera
_EDGE: Final = 1.5  # metres around a position to be kept in view
_TREMOR: Final = (71.0, 97.0)  # rad/s, across and up
_CALM: Final = 0.16  # seconds in which a shaking dies down to a third


@dataclass(frozen=True)
class View:
    """The part of the world that a picture shows: `centre` is its middle, in metres.

    `scale` is the canvas's pixels per point; at a zoom of 1 the whole width of the world is seen. `closest` is the
    greatest zoom that there will be, 0 for this one: what is painted once and then scaled is painted for that.

    A shot is made for the page of a canvas; `filling` shows it in the whole view, with the ground at its lower edge,
    and more of the world beside and above. `origin` is where the corner of the page lies on the surface, in pixels;
    `lower` is how far the shot is moved down from the page, in points.
    """

    scale: float
    centre: tuple[float, float] = HOME
    zoom: float = 1.0
    closest: float = 0.0
    origin: tuple[int, int] = (0, 0)
    lower: float = 0.0

    @classmethod
    def within(cls, box: pygame.FRect, scale: float, centre: npt.ArrayLike, per_metre: float) -> View:
        """Return the view with a place in the middle of a box of the canvas, at so many points a metre."""
        aside = np.array((VIEW_SIZE[0] / 2 - box.centerx, box.centery - VIEW_SIZE[1] / 2)) / per_metre
        x, y = (np.asarray(centre) + aside).tolist()
        return cls(scale, (x, y), per_metre / POINTS_PER_METRE)

    def filling(self, canvas: Canvas) -> View:
        """Return this view as it fills that canvas."""
        lower = canvas.view.bottom - VIEW_SIZE[1]
        return View(canvas.scale, self.centre, self.zoom, self.closest, canvas.origin, lower)

    @property
    def pixels_per_metre(self) -> float:
        """Scale of the drawn world, in pixels per metre."""
        return POINTS_PER_METRE * self.scale * self.zoom

    @property
    def painted_per_metre(self) -> float:
        """Scale, in pixels per metre, at which to paint pictures that are then scaled to this view and later ones."""
        return POINTS_PER_METRE * min(self.scale, MOST_LINES / VIEW_SIZE[1]) * (self.closest or self.zoom)

    @property
    def of_land(self) -> View:
        """This view of land, which goes on at its size where a camera goes farther away than the land is painted."""
        zoom = max(self.zoom, WIDEST)
        height = GROUND_LINE + (self.centre[1] - GROUND_LINE) * self.zoom / zoom
        return replace(self, centre=(self.centre[0], height), zoom=zoom)

    def pixels(self, position: npt.ArrayLike) -> Pixels:
        """Turn world positions (..., 2) into pixels of the view."""
        return np.stack(self.pixel(*_columns(position)), axis=-1)

    def points(self, position: npt.ArrayLike) -> Pixels:
        """Turn world positions (..., 2) into points of the canvas."""
        return np.stack(self.point(*_columns(position)), axis=-1)

    def pixel(self, x: float, y: float) -> tuple[float, float]:
        """Turn one world position into pixels of the view: an array takes five times as long."""
        across, down = self._place(x, y, self.pixels_per_metre, self.scale)
        return across + self.origin[0], down + self.origin[1]

    def point(self, x: float, y: float) -> tuple[float, float]:
        """Turn one world position into points of the canvas."""
        return self._place(x, y, POINTS_PER_METRE * self.zoom, 1.0)

    def metres(self, point: npt.ArrayLike) -> Metres:
        """Turn points of the canvas (..., 2), such as the mouse's, into world positions."""
        from_middle = np.asarray(point, dtype=float) - np.array(VIEW_SIZE) / 2 - (0, self.lower)
        return self.centre + from_middle * (1, -1) / (POINTS_PER_METRE * self.zoom)

    def _place(self, x: float, y: float, per_metre: float, scale: float) -> tuple[float, float]:
        across, down = VIEW_SIZE[0] / 2 * scale, (VIEW_SIZE[1] / 2 + self.lower) * scale
        return (x - self.centre[0]) * per_metre + across, (y - self.centre[1]) * -per_metre + down


def _columns(position: npt.ArrayLike) -> Any:
    """Return x and y of positions (..., 2), each (...)."""
    return np.moveaxis(np.asarray(position, dtype=float), -1, 0)


@dataclass(frozen=True)
class ClearArea:
    """The part of the world's page, in points, that is kept clear for the flight; text has the rest.

    `head` is measured from the upper edge of the window; `foot` is by how much less than a page is left of the height.
    """

    left: float = 0.0
    right: float = float(VIEW_SIZE[0])
    head: float = 104.0
    foot: float = 0.0

    @classmethod
    def of(cls, canvas: Canvas, free: pygame.FRect) -> ClearArea:
        """Return what rows leave free of the world, whose box is in points of what is read."""
        world, below = canvas.whole, canvas.view.bottom - free.bottom
        (left, top), (right, _) = (world.points(canvas.pixels(place)) for place in (free.topleft, free.topright))
        left, right = max(left, 0.0), min(right, float(VIEW_SIZE[0]))
        foot = VIEW_SIZE[1] - world.above(below).view.height
        return cls(min(left, right - _LEAST), right, max(top - world.view.top, cls.head), foot)

    def earth(self, place: tuple[float, float], radius: float) -> tuple[float, float]:
        """Return where the Earth stands, in points: in its place, but below the words at the head."""
        return place[0], max(place[1], self.head + self.foot + 1.3 * radius)


@dataclass(frozen=True)
class CameraTarget:
    """Target of a camera: `across`, in metres, is the middle of the view."""

    across: float = 0.0
    zoom: float = 1.0

    @classmethod
    def around(cls, left: float, right: float, top: float, clear: ClearArea) -> CameraTarget:
        """Return the closest shot whose clear part shows `left` to `right`, and up to `top`, in metres."""
        wide = (clear.right - clear.left) / (POINTS_PER_METRE * max(right - left, 1.0))
        high = (GROUND_ROW - clear.head - clear.foot) / (POINTS_PER_METRE * max(top - GROUND_LINE, 1.0))
        zoom = max(min(max(min(wide, CLOSEST), WIDEST), high), FARTHEST)
        aside = ((clear.left + clear.right) - VIEW_SIZE[0]) / (2 * POINTS_PER_METRE * zoom)
        return cls((left + right) / 2 - aside, zoom).on_land()

    def on_land(self) -> CameraTarget:
        """Return this shot, moved so that it never shows where the land ends."""
        reach = max(0.0, LAND_REACH - VIEW_SIZE[0] / (2 * POINTS_PER_METRE * self.zoom))
        return CameraTarget(min(max(self.across, -reach), reach), self.zoom)

    def view(self, scale: float) -> View:
        """Return the view of this shot, at `scale` pixels per point."""
        return View(scale, (self.across, centre_height(self.zoom)), self.zoom, CLOSEST)


class Camera:
    """Camera that pans and zooms on a critically damped spring; stepped at 60 Hz, interpolated when drawn.

    Without a shot it stays at rest, with the whole width of the world in view. The subject that it follows never
    leaves the view, however fast it is.
    """

    def __init__(self) -> None:
        self._moves = False
        self._state = np.array([0.0, 0.0])  # metres across, logarithm of the zoom: near and far at an even pace
        self._speed = np.zeros(2)
        self._before = self._state
        self._tremor, self._time = 0.0, 0.0

    @property
    def shot(self) -> CameraTarget:
        """The shot that is shown now."""
        return CameraTarget(float(self._state[0]), math.exp(self._state[1]))

    def cut(self, shot: CameraTarget) -> None:
        """Show a shot at once, without easing."""
        self._moves = True
        self._state = self._before = np.array([shot.across, math.log(shot.zoom)])
        self._speed = np.zeros(2)
        self._tremor = 0.0

    def follow(self, shot: CameraTarget, subject: tuple[float, float] | None = None) -> None:
        """Ease towards a shot, and keep a position in view; call once per step of 1/60 s.

        A critically damped spring reaches a fixed target without overshoot. This is its exact solution over a step,
        so the result does not depend on the step size.
        """
        self._moves = True
        self._before = self._state
        wanted = np.array([shot.across, math.log(shot.zoom)])
        away = self._state - wanted
        pull = (self._speed + _PACE * away) * STEP
        decay = math.exp(-_PACE * STEP)
        self._state = wanted + (away + pull) * decay
        self._speed = (self._speed - _PACE * pull) * decay
        if subject is not None:
            self._keep(*subject)
        self._time += STEP
        self._tremor *= math.exp(-STEP / _CALM)

    def shake(self, strength: float) -> None:
        """Start a shake of the near world, of at most `strength` points."""
        self._tremor = max(self._tremor, strength)

    def view(self, scale: float, alpha: float = 1.0) -> View:
        """Return the view on a canvas of that scale, `alpha` of the way from the last step to this one."""
        if not self._moves:
            return View(scale)
        across, near = (self._before + alpha * (self._state - self._before)).tolist()
        zoom = math.exp(near)
        x, y = self._shaken(alpha)
        metre = POINTS_PER_METRE * zoom
        return View(scale, (across + x / metre, centre_height(zoom) + y / metre), zoom, CLOSEST)

    def _keep(self, x: float, y: float) -> None:
        """Keep a position in view, even where the spring is too slow for it."""
        most = VIEW_SIZE[0] / (2 * POINTS_PER_METRE)
        high = math.log(GROUND_ROW / (POINTS_PER_METRE * max(y + _EDGE - GROUND_LINE, 1.0)))
        bounded = max(min(self._state[1], max(high, math.log(WIDEST))), math.log(FARTHEST))
        room = most / math.exp(bounded) - _EDGE
        held = np.array([min(max(self._state[0], x - room), x + room), bounded])
        self._speed = np.where(held == self._state, self._speed, (held - self._before) / STEP)
        self._state = held

    def _shaken(self, alpha: float) -> tuple[float, float]:
        """Return the offset of the view by the shake, in points."""
        if self._tremor <= 0.1:
            return 0.0, 0.0
        time = self._time + (alpha - 1) * STEP
        return self._tremor * math.sin(_TREMOR[0] * time), self._tremor * math.sin(_TREMOR[1] * time + 1)


def centre_height(zoom: float) -> float:
    """Return the height in metres of the middle of a view at that zoom, with the ground on its row."""
    return GROUND_LINE + (HOME[1] - GROUND_LINE) / zoom
