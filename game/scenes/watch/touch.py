"""Hand on a lander: while Watch is stopped, the shown lander can be placed, tilted and thrown.

A ring around it is what to drag, a dot on the ring is its tilt, and an arrow its speed. Keys and gamepad drag with a
pointer of their own.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from game.core import texts
from game.drawing.canvas import Align, Canvas, Point
from game.drawing.tokens import HUMAN, INK, NIGHT0, SMALL
from game.input.controls import Controls
from game.ui.hints import Hint
from game.ui.virtual_pointer import VirtualPointer

if TYPE_CHECKING:
    from ai.environment import Doubles
    from game.scenes.watch.watched import Watched

PLACE, TILT, SPEED = range(3)
FASTEST: Final = 8.0  # m/s
NOTCH: Final = math.radians(5.0)  # of the wheel
_RING: Final = 1.5  # radius in metres of a lander of full size
_LEAST: Final = 36.0  # and at least, in points
_ARROW: Final = 12.0  # points between the ring and the arrow
_PER_SPEED: Final = 22.0  # points of the arrow for each m/s
_REACH: Final = 16.0  # points from a knob within which it is taken


class Hand(VirtualPointer):
    """The player's hand on the shown lander, by mouse, keys or gamepad.

    Attributes:
        part: what it holds, or held last: PLACE, TILT or SPEED.
        dragging: whether it holds it.

    """

    follows_mouse = False

    def __init__(self, lander: Watched) -> None:
        super().__init__((0, 0, 1, 1), self._point, hold=texts.TOUCH_DRAG, leave=texts.TOUCH_LEAVE, pace=4.0)
        self.key = "hand"
        self._lander = lander
        self.part, self.dragging = PLACE, False
        self._grip: Point = (0.0, 0.0)  # from the pointer to what it holds, in points
        self._pointer: Point | None = None  # where the keys' own pointer is

    def reach(self, free: pygame.FRect) -> None:
        """Let it put the lander anywhere in this part of the window, in points."""
        self.rect = self.relative_rect = pygame.Rect(free)

    # Where it is, in points

    @property
    def middle(self) -> Point:
        return self._lander.place(self._lander.state[:2])

    @property
    def radius(self) -> float:
        return max(_LEAST, _RING * self._lander.points_per_metre * self._lander.size)

    @property
    def tilt_knob(self) -> Point:
        """The dot that tilts: on the ring, above the lander's cabin."""
        (x, y), angle = self.middle, float(self._lander.state[4])
        return x - self.radius * math.sin(angle), y - self.radius * math.cos(angle)

    @property
    def arrow(self) -> tuple[Point, Point]:
        """Tail and tip of the arrow that throws; at rest it points down and has no length."""
        (x, y), (across, up) = self.middle, self._lander.state[2:4].tolist()
        speed = math.hypot(across, up)
        way = (across / speed, -up / speed) if speed > 1e-6 else (0.0, 1.0)
        tail = self.radius + _ARROW
        tip = tail + _PER_SPEED * min(speed, FASTEST)
        return (x + tail * way[0], y + tail * way[1]), (x + tip * way[0], y + tip * way[1])

    def part_at(self, point: Point) -> int | None:
        """Return the part that the mouse would take at a point, if any."""
        if not (self._lander.playback.stopped and self.box.collidepoint(point)):
            return None
        if math.dist(point, self.tilt_knob) <= _REACH:
            return TILT
        if _distance(point, *self.arrow) <= _REACH:
            return SPEED
        return PLACE if math.dist(point, self.middle) <= self.radius else None

    # What it does

    def turn(self, notches: float) -> None:
        """Tilt by so many notches counter-clockwise."""
        if self._lander.playback.stopped:
            self._put(angle=float(self._lander.state[4]) + NOTCH * notches)

    def mouse(self, event: pygame.event.Event) -> bool:
        """Take a mouse event, its position in points; false leaves it to others."""
        if event.type == pygame.MOUSEMOTION and self.dragging:
            if self._lander.playback.stopped:
                self._drag_to(event.pos)
            return True
        if event.type not in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP) or event.button != 1:
            return False
        if event.type == pygame.MOUSEBUTTONUP:
            taken, self.dragging = self.dragging, False
            return taken
        part = self.part_at(event.pos)
        if part is None:
            return False
        self.part, self.dragging = part, True
        held = (self.middle, self.tilt_knob, self.arrow[1])[part]
        self._grip = held[0] - event.pos[0], held[1] - event.pos[1]
        return True

    def _drag_to(self, point: Point) -> None:
        (x, y), held = self.middle, (point[0] + self._grip[0], point[1] + self._grip[1])
        right, down = held[0] - x, held[1] - y
        if self.part == PLACE:
            self._put(place=self._lander.metres(held))
        elif self.part == TILT:
            self._put(angle=math.atan2(-right, -down))
        else:
            away = math.hypot(right, down)
            speed = min(max(0.0, away - self.radius - _ARROW) / _PER_SPEED, FASTEST)
            self._put(velocity=speed / max(away, 1e-6) * np.array([right, -down]))

    def _put(self, place: Doubles | None = None, velocity: Doubles | None = None, angle: float | None = None) -> None:
        """Put the lander into a state, inside the clear part of the view and above the ground.

        One that is tilted by hand does not turn afterwards.
        """
        x, y, across, up, lean, spin = self._lander.state.tolist()
        x, y = (x, y) if place is None else place
        across, up = (across, up) if velocity is None else velocity
        lean, spin = (lean, spin) if angle is None else (angle, 0.0)
        clear, env = self.box, self._lander.env
        (left, top), (right, _) = map(self._lander.metres, (clear.topleft, clear.bottomright))
        x = min(max(x, left, -env.limits.half_width), right, env.limits.half_width)
        y = max(min(y, top, env.limits.ceiling), env.lowest(x, lean))
        self._lander.touch(np.array([x, y, across, up, lean, spin]))

    # By keys and gamepad

    def press(self) -> None:
        """Take keys and gamepad, with their pointer on the lander."""
        self._lander.playback.stopped = True
        if self.box.collidepoint(self.middle):
            self.place.update(self.middle)
        super().press()

    def take(self, event: pygame.event.Event) -> bool:
        """Leave Space to the scene, which goes on with it."""
        return not (event.type == pygame.KEYDOWN and event.key == pygame.K_SPACE) and super().take(event)

    def hints(self, controls: Controls) -> list[Hint]:
        go_on = Hint(controls.key_word(None, pygame.K_SPACE), texts.HINT_GO, self._lander.playback.toggle)
        return [*super().hints(controls), go_on]

    def _point(self, event: pygame.event.Event) -> None:
        self._pointer = event.pos
        self.mouse(event)

    def ease(self, at_once: bool) -> None:
        super().ease(at_once)
        if not self._lander.playback.stopped:
            self.lay_aside()
            self.dragging = False

    def hover_point(self, hover_x: float, hover_y: float) -> bool:
        """Return False: the scene asks for the mouse itself, as what is touched lies under its words."""
        return False

    # The picture

    def paint(self, canvas: Canvas) -> None:
        """Draw nothing: the scene draws the hand before its panels."""

    def draw(self, canvas: Canvas) -> None:
        """Draw the ring, the dot and the arrow while the lander can be touched; or the focus around it."""
        if self.ringed and self.warmth > 0.02:
            canvas.outline(_around(self.middle, self.radius + 5), 8, INK, 1, 0.4 * self.warmth)
        if not self._lander.playback.stopped:
            return
        pointer = self._pointer if self.typing else canvas.pointer
        lit = self.part if self.dragging else self.part_at(pointer) if pointer is not None else None
        ring = _around(self.middle, self.radius)
        canvas.outline(ring, self.radius, HUMAN, 1, 0.9 if lit == PLACE else 0.45)
        self._draw_tilt(canvas, lit == TILT)
        self._draw_arrow(canvas, lit == SPEED)
        self.draw_pointer(canvas)

    def _draw_tilt(self, canvas: Canvas, lit: bool) -> None:
        x, y = self.tilt_knob
        canvas.dot((x, y), 7, NIGHT0, 0.8)
        canvas.dot((x, y), 5.5 if lit else 4.5, HUMAN)
        if lit:
            canvas.text(self._lander.tilt_words, (x + 12, y - 6), size=SMALL, colour=HUMAN, tabular=True)

    def _draw_arrow(self, canvas: Canvas, lit: bool) -> None:
        tail, tip = self.arrow
        width = 2.0 if lit else 1.5
        way = np.subtract(tip, self.middle) / max(math.dist(tip, self.middle), 1e-6)
        if math.dist(tail, tip) > 1:
            canvas.line(tail, tip, HUMAN, width)
        for side in (-1, 1):
            across, down = (np.array(tip) - 9 * way + side * 5 * np.array([-way[1], way[0]])).tolist()
            canvas.line(tip, (across, down), HUMAN, width)
        speed = math.hypot(*self._lander.state[2:4])
        place = (tip[0] + 10 * float(way[0]), min(tip[1] + 16 * float(way[1]) + 4, self.box.bottom - 4.0))
        align: Align = "centre" if abs(way[0]) < 0.4 else "left" if way[0] > 0 else "right"
        canvas.text(texts.TOUCH_SPEED.format(speed=speed), place, size=SMALL, colour=HUMAN, align=align, tabular=True)


def _around(place: Point, reach: float) -> tuple[float, float, float, float]:
    return place[0] - reach, place[1] - reach, 2 * reach, 2 * reach


def _distance(point: Point, start: Point, end: Point) -> float:
    """Return the distance of a point from a line between two others."""
    a, b, p = (np.array(each, float) for each in (start, end, point))
    along = np.clip(np.dot(p - a, b - a) / max(float(np.dot(b - a, b - a)), 1e-6), 0.0, 1.0)
    return math.dist(p, a + along * (b - a))
