"""The world view of one flight: land, craft, flames and dust, as the camera sees them."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from ai.environment import Doubles
from ai.lander.environment import Outcome
from game.drawing.canvas import Canvas
from game.drawing.tokens import VIEW_SIZE
from game.flight.flight import Flight, StickHolder
from game.world import framing
from game.world.callouts import draw_factors, draw_words
from game.world.camera import LAND_REACH, Camera, CameraTarget, ClearArea, View
from game.world.landscape.backdrop import EARTH, landscape
from game.world.landscape.ground import draw_ground
from game.world.landscape.themes import LOOKS, look_of
from game.world.particles import DUST
from game.world.stage import Stage, flames

_EDGE, _FOOT = 24.0, 100.0  # points that a mark keeps from the sides, and from the lower edge with its read-outs

_BORDER: Final = 40.0  # points from the sides within which a craft is about to leave a view that rests
_INTO: Final = 20.0  # points that it flies into what words have at the top


class Scenery:
    """The world around a flight; call `follow` once after every step of it.

    With reduced motion the camera rests and nothing shakes. Decoration has a random generator of its own: a flight
    never depends on what is drawn.

    Attributes:
        calm: whether motion is reduced.
        clear: the part of the screen in which to show the flight from now on.
        stage: the craft's flames, its dust and the wreck of a crash.

    """

    def __init__(self, flight: Flight[Any], reduced_motion: bool, clear: ClearArea = framing.ALL) -> None:
        self._flight, self.calm, self.clear = flight, reduced_motion, clear
        self._look = look_of(flight.recording.mission)
        chance = np.random.default_rng(flight.recording.seed)
        self.stage = Stage(flight.env, chance, reduced_motion, LOOKS[self._look].on_dust(DUST), LOOKS[self._look].light)
        self._camera = Camera()
        self.cut()

    def set_calm(self, calm: bool) -> None:
        """Set whether motion is reduced; that may change during a flight."""
        if calm != self.calm:
            self.calm = self.stage.calm = calm
            self._camera = Camera()
            self.cut()

    @property
    def starry(self) -> bool:
        """Whether stars are seen there."""
        return LOOKS[self._look].stars

    @property
    def across(self) -> float:
        """Horizontal place of the craft on the screen, in points."""
        place = self._flight.poses.now[0, :2]
        return float(self._camera.view(1.0).points(place)[0])

    def cut(self) -> None:
        """Cut the camera to the flight. With reduced motion, zoom out, and stay out, only where text would hide it."""
        shot = framing.framed(self._flight.env, clear=self.clear)
        if not self.calm:
            self._camera.cut(shot)
        elif shot.zoom < self._camera.shot.zoom:
            self._camera.cut(CameraTarget(zoom=shot.zoom))
        if self.calm:
            self._keep_in_view()

    def _keep_in_view(self) -> None:
        """With reduced motion, show all of the world, once and for good, before the craft leaves what is seen."""
        env, clear = self._flight.env, self.clear
        x, y = self._camera.view(1.0).points(env.position[0]).tolist()
        seen = _BORDER <= x <= VIEW_SIZE[0] - _BORDER and y >= clear.head + clear.foot - _INTO
        zoom = CameraTarget.around(-LAND_REACH, LAND_REACH, env.limits.ceiling, clear).zoom
        if not seen and self._camera.shot.zoom > zoom:
            self._camera.cut(CameraTarget(zoom=zoom))

    def wind_to(self) -> None:
        """Show the flight at another moment, without the traces of the steps before."""
        flight = self._flight
        self.stage.forget()
        self.stage.thrust[0] = 0.0 if flight.over else flames(flight.env)[0]
        self.stage.blue[:] = flight.flown_by is StickHolder.NETWORK
        self.cut()

    def follow(self, ended: bool, shot: CameraTarget | None = None) -> None:
        """Follow one step; `ended` is whether the flight ended with it. A `shot` replaces the flight's own."""
        flight = self._flight
        self.stage.follow(np.array([flight.flown_by is StickHolder.NETWORK]), np.array([ended]))
        if self.calm:
            self._keep_in_view()
            return
        self._camera.shake(self.stage.jolt)
        if shot is None:
            framing.follow(self._camera, flight.env, clear=self.clear)
        else:
            self._camera.follow(shot)

    def view(self, scale: float, alpha: float = 1.0) -> View:
        """Return the camera's view, `alpha` of the way from the last step to this one."""
        return self._camera.view(scale, alpha)

    def draw_land(self, canvas: Canvas, alpha: float, earth: tuple[float, float] = EARTH) -> None:
        """Fill the view with sky and land; `earth` is where the Earth stands, in points."""
        env = self._flight.env
        landscape(canvas.surface.get_size(), self._look).draw(canvas, self._camera, alpha, earth)
        view = self.view(canvas.scale, alpha).filling(canvas)
        draw_ground(canvas, view, env.ground, float(env.pad_shift[0]))
        if env.conditions.pushes and not self.calm:
            self.stage.wind.draw(canvas.surface, view, alpha)

    def draw_craft(self, canvas: Canvas, alpha: float, words: bool = True) -> None:
        """Draw the factors of the pads, and the craft with its flames, dust and, if asked for, `words` above it.

        Where a craft has left the area is a cross.
        """
        view, pose = self.view(canvas.scale, alpha).filling(canvas), self._flight.poses.at(alpha)[0]
        draw_factors(canvas, view, self._flight, pose, self.clear)
        if self._flight.outcome is Outcome.OUT_OF_BOUNDS:
            mark_lost(canvas, view, pose)
            return
        self.stage.draw_lander(canvas, view, pose, alpha=alpha)
        self.stage.particles.draw(canvas.surface, view, alpha)
        shown = self.stage.pose_after(alpha)
        if words:
            draw_words(canvas, view, self._flight.env, pose if shown is None else shown)


def mark_lost(canvas: Canvas, view: View, pose: Doubles) -> None:
    """Mark where a craft has left the area, or the nearest place that is clear of text."""
    x, y = view.points(pose[:2]).tolist()
    seen = canvas.view
    place = (
        min(max(x, seen.left + _EDGE), seen.right - _EDGE),
        min(max(y, seen.top + framing.ALL.head), seen.bottom - _FOOT),
    )
    canvas.glow(place, 18, canvas.palette.warn, 0.5)
    canvas.marker("cross", place, 12, canvas.palette.warn)
