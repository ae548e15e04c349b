"""Hand on a lander: while Watch is stopped, the shown lander can be placed, tilted and thrown.

A ring around it is what to drag, a dot on the ring is its tilt, and an arrow its speed. By keys and gamepad the hand is
a widget: Enter or A takes hold of the place, then of the tilt, then of the speed, and the arrows change it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, Protocol

import numpy as np
import pygame

from ai.environment import Doubles
from ai.lander.environment import LanderEnv
from game.core import texts
from game.drawing.canvas import PAGE, Align, Canvas, Point
from game.drawing.tokens import HUMAN, INK, NIGHT0, SMALL
from game.input.controls import Command, Controls, translate
from game.ui.held_directions import HeldDirections
from game.ui.hints import Hint
from game.ui.widget import PointsManager, Widget
from game.world.camera import View

PLACE, TILT, SPEED = range(3)
FASTEST: Final = 8.0  # m/s
NOTCH: Final = math.radians(5.0)  # of the wheel, of Q and E, and of a shoulder button
_RING: Final = 1.5  # radius in metres of a lander of full size
_LEAST: Final = 36.0  # and at least, in points
_ARROW: Final = 12.0  # points between the ring and the arrow
_PER_SPEED: Final = 22.0  # points of the arrow for each m/s
_REACH: Final = 16.0  # points from a knob within which it is taken
_PACE: Final = (0.05, math.radians(1.0), 0.05)  # metres, radians and m/s in an update, while an arrow is held
_TURNS: Final = {pygame.K_q: 1, pygame.K_e: -1}
_SHOULDERS: Final = {Command.PREVIOUS: 1, Command.NEXT: -1}
_ASIDE, _HEAD, _FOOT = 40, 100, 110  # points from the edges of the view, within which the focus on it is seen


class Touched(Protocol):
    """What the hand is on: one lander of a scene that can be stopped."""

    @property
    def at_hand(self) -> bool:
        """Whether it can be touched now."""

    @property
    def env(self) -> LanderEnv:
        """Its environment."""

    shown: int

    def hand_view(self) -> View:
        """Return the view, in points."""

    @property
    def can_untouch(self) -> bool:
        """Whether there is a touch to undo."""

    def take_hold(self) -> None:
        """Stop, so that it can be touched."""

    def touch(self, start: Doubles) -> None:
        """Let it fly on from another state: x, y, vx, vy, angle, spin."""

    def untouch(self) -> None:
        """Undo the touch."""


class Hand(Widget):
    """The player's hand on a lander, by mouse, keys or gamepad.

    Attributes:
        part: what it holds: PLACE, TILT or SPEED.
        dragging: whether the mouse holds it.

    """

    def __init__(
        self,
        manager: PointsManager,
        lander: Touched,
        clear: pygame.Rect,
        size: Callable[[], float],
        view: pygame.FRect = PAGE,
    ) -> None:
        super().__init__(manager, clear, texts.TOUCH_LANDER)
        self._lander, self._clear, self._size, self._view = lander, clear, size, view
        self.part, self.dragging = PLACE, False
        self._grip: Point = (0.0, 0.0)  # from the mouse to what it holds, in points
        self._held = HeldDirections()

    # Where it is, in points

    @property
    def box(self) -> pygame.Rect:
        """The box of the ring, kept where it is seen, for the focus to find."""
        (x, y), size = self.middle, self.radius
        return pygame.Rect(x - size, y - size, 2 * size, 2 * size).clamp(self._sky)

    @property
    def _sky(self) -> pygame.Rect:
        """The sky that is seen between words and read-outs."""
        left, top, width, height = self._view
        return pygame.Rect(left + _ASIDE, top + _HEAD, width - 2 * _ASIDE, height - _HEAD - _FOOT)

    @property
    def middle(self) -> Point:
        """Middle of the ring."""
        x, y = self._lander.hand_view().points(self._lander.env.position[self._lander.shown]).tolist()
        return x, y

    @property
    def radius(self) -> float:
        """Radius of the ring."""
        return max(_LEAST, _RING * self._lander.hand_view().pixels_per_metre * self._size())

    @property
    def tilt_knob(self) -> Point:
        """The dot that tilts: on the ring, above the lander's cabin."""
        (x, y), angle = self.middle, float(self._lander.env.angle[self._lander.shown])
        return x - self.radius * math.sin(angle), y - self.radius * math.cos(angle)

    @property
    def arrow(self) -> tuple[Point, Point]:
        """Tail and tip of the arrow that throws; at rest it points down and has no length."""
        (x, y), (across, up) = self.middle, self._lander.env.velocity[self._lander.shown].tolist()
        speed = math.hypot(across, up)
        way = (across / speed, -up / speed) if speed > 1e-6 else (0.0, 1.0)
        tail = self.radius + _ARROW
        tip = tail + _PER_SPEED * min(speed, FASTEST)
        return (x + tail * way[0], y + tail * way[1]), (x + tip * way[0], y + tip * way[1])

    @property
    def busy(self) -> bool:
        """Whether it holds the lander, by mouse, keys or gamepad."""
        return self.dragging or self.typing

    def used(self, pointer: Point | None) -> bool:
        """Whether it holds the lander, or the mouse points at a part to take."""
        return self.busy or (pointer is not None and self.part_at(pointer) is not None)

    def part_at(self, point: Point) -> int | None:
        """Return the part that the mouse would take at a point, if any."""
        if not self._lander.at_hand:
            return None
        if math.dist(point, self.tilt_knob) <= _REACH:
            return TILT
        if _distance(point, *self.arrow) <= _REACH:
            return SPEED
        return PLACE if math.dist(point, self.middle) <= self.radius else None

    # What it does

    def turn(self, notches: float) -> None:
        """Tilt by so many notches counter-clockwise."""
        if self._lander.at_hand:
            self._put(angle=float(self._lander.env.angle[self._lander.shown]) + NOTCH * notches)

    def mouse(self, event: pygame.event.Event) -> bool:
        """Take a mouse event, its position in points; false leaves it to others."""
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == 1:
            part = self.part_at(event.pos)
            if part is None:
                return False
            self.part, self.dragging = part, True
            held = {PLACE: self.middle, TILT: self.tilt_knob, SPEED: self.arrow[1]}[part]
            self._grip = held[0] - event.pos[0], held[1] - event.pos[1]
            return True
        if event.type == pygame.MOUSEBUTTONUP and event.button == 1 and self.dragging:
            self.dragging = False
            return True
        if event.type == pygame.MOUSEMOTION and self.dragging:
            if self._lander.at_hand:
                self._drag_to(event.pos)
            return True
        return False

    def _drag_to(self, point: Point) -> None:
        (x, y), held = self.middle, (point[0] + self._grip[0], point[1] + self._grip[1])
        right, down = held[0] - x, held[1] - y
        if self.part == PLACE:
            self._put(place=self._lander.hand_view().metres(held))
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
        env, slot = self._lander.env, self._lander.shown
        spin = float(env.angular_velocity[slot]) if angle is None else 0.0
        x, y = (env.position[slot] if place is None else place).tolist()
        across, up = (env.velocity[slot] if velocity is None else velocity).tolist()
        lean = float(env.angle[slot]) if angle is None else angle
        clear, view = self._clear, self._lander.hand_view()
        (left, top), (right, _) = view.metres([clear.topleft, clear.bottomright]).tolist()
        limits = env.limits
        x = min(max(x, left, -limits.half_width), right, limits.half_width)
        y = max(min(y, top, limits.ceiling), env.lowest(x, lean))
        self._lander.touch(np.array([x, y, across, up, lean, spin]))

    # By keys and gamepad

    def press(self) -> None:
        """Take hold of the lander, unless a real mouse is in use."""
        if self.ringed:
            self.hold()

    def hold(self) -> None:
        """Stop, and let the arrows move the lander."""
        self._lander.take_hold()
        self.typing, self.part = True, PLACE

    def hints(self, controls: Controls) -> list[Hint]:
        """Return the hints while the hand holds the lander."""
        if controls.gamepad_in_use:
            back, turns = controls.word(Command.RETRY), " ".join(map(controls.word, _SHOULDERS))
        else:
            back, turns = "Z", "Q E"
        undo = [Hint(back, texts.HINT_UNTOUCH, self._lander.untouch)] if self._lander.can_untouch else []
        return [
            Hint(controls.arrows, texts.TOUCH_PARTS[self.part]),
            Hint(controls.word(Command.CONFIRM), texts.TOUCH_NEXT, self._next_part),
            Hint(turns, texts.TOUCH_PARTS[TILT]),
            *undo,
            Hint(controls.word(Command.BACK), texts.TOUCH_LEAVE, self._let_go),
        ]

    def take(self, event: pygame.event.Event) -> bool:
        """Change the lander while it is held; what is no business of the hand is left to the scene."""
        if not self.typing:
            return False
        code = getattr(event, "key", getattr(event, "button", None))
        if event.type in (pygame.KEYUP, pygame.CONTROLLERBUTTONUP):
            return self._held.release(code)
        if self._held.tilt(event):
            return True
        if event.type == pygame.WINDOWFOCUSLOST:  # releases will not be reported now
            self._let_go()
            return False
        return self._obey(event, code)

    def _obey(self, event: pygame.event.Event, code: int | None) -> bool:
        command, by_pad = translate(event), event.type == pygame.CONTROLLERBUTTONDOWN
        if self._held.press(code, command):
            pass
        elif command is Command.CONFIRM:
            self._next_part()
        elif by_pad and command in _SHOULDERS:
            self.turn(_SHOULDERS[command])
        elif by_pad and command is Command.RETRY:
            self._lander.untouch()
        elif command in (Command.BACK, Command.PAUSE, Command.UNPLUGGED):
            self._let_go()
        else:
            return False
        return True

    def _next_part(self) -> None:
        self.part = (self.part + 1) % 3

    def _let_go(self) -> None:
        self.typing = self.dragging = False
        self._held.clear()

    def ease(self, at_once: bool) -> None:
        """Change what is held by as much as the arrows, held down, do in 1/60 s."""
        super().ease(at_once)
        if (self.typing and not self.focused) or not self._lander.at_hand:
            self._let_go()
        if not self.typing:
            return
        held = self._held.stick + (self._held.arrows or (0, 0))
        way = np.array([held.x, -held.y])  # up is up in the world
        if not way.any():
            return
        env, slot, pace = self._lander.env, self._lander.shown, _PACE[self.part]
        if self.part == PLACE:
            self._put(place=env.position[slot] + pace * way)
        elif self.part == TILT:
            self._put(angle=float(env.angle[slot]) - pace * float(way[0] or way[1]))
        else:
            velocity = env.velocity[slot] + pace * way
            self._put(velocity=velocity * min(1.0, FASTEST / max(math.hypot(*velocity), 1e-6)))

    def hover_point(self, hover_x: float, hover_y: float) -> bool:
        """Return False: the scene asks for the mouse itself, as what is touched lies under its words."""
        return False

    def process_event(self, event: pygame.event.Event) -> bool:
        """Ignore the mouse events of the form."""
        return False

    # The picture

    def paint(self, canvas: Canvas) -> None:
        """Draw nothing: the scene draws the hand before its panel."""

    def draw(self, canvas: Canvas) -> None:
        """Draw the ring, the dot and the arrow while the lander can be touched; or the focus around it."""
        if self.ringed and self.warmth > 0.02:
            canvas.outline(self.box.inflate(10, 10), 8, INK, 1, 0.4 * self.warmth)
        if not self._lander.at_hand:
            return
        self._draw_ring(canvas, 0.9 if self._takes(canvas, PLACE) else 0.45)
        self._draw_tilt(canvas, self._takes(canvas, TILT))
        self._draw_arrow(canvas, self._takes(canvas, SPEED))
        canvas.explain(self._box_around(self.tilt_knob), texts.EXPLAIN_TOUCH[TILT])
        canvas.explain(self._box_around(self.arrow[1]), texts.EXPLAIN_TOUCH[SPEED])
        (x, y), size = self.middle, self.radius
        canvas.explain((x - size, y - size, 2 * size, 2 * size), texts.EXPLAIN_TOUCH[PLACE])

    def _takes(self, canvas: Canvas, part: int) -> bool:
        """Whether a part is held, or would be taken by the mouse."""
        if self.busy:
            return self.part == part
        return canvas.pointer is not None and self.part_at(canvas.pointer) == part

    def _box_around(self, place: Point) -> tuple[float, float, float, float]:
        return place[0] - _REACH, place[1] - _REACH, 2 * _REACH, 2 * _REACH

    def _draw_ring(self, canvas: Canvas, alpha: float) -> None:
        (x, y), size = self.middle, self.radius
        canvas.outline((x - size, y - size, 2 * size, 2 * size), size, HUMAN, 1, alpha)

    def _draw_tilt(self, canvas: Canvas, lit: bool) -> None:
        x, y = self.tilt_knob
        canvas.dot((x, y), 7, NIGHT0, 0.8)
        canvas.dot((x, y), 5.5 if lit else 4.5, HUMAN)
        if lit:
            degrees = math.degrees(float(self._lander.env.tilt[self._lander.shown]))
            canvas.text(texts.TOUCH_TILT.format(tilt=degrees), (x + 12, y - 6), size=SMALL, colour=HUMAN, tabular=True)

    def _draw_arrow(self, canvas: Canvas, lit: bool) -> None:
        tail, tip = self.arrow
        x, y = self.middle
        way = np.array([tip[0] - x, tip[1] - y]) / max(math.dist(tip, (x, y)), 1e-6)
        aside = np.array([-way[1], way[0]])
        if math.dist(tail, tip) > 1:
            canvas.line(tail, tip, HUMAN, 2.0 if lit else 1.5)
        for side in (-1, 1):
            end = np.array(tip) - 9 * way + side * 5 * aside
            canvas.line(tip, (float(end[0]), float(end[1])), HUMAN, 2.0 if lit else 1.5)
        speed = float(np.hypot(*self._lander.env.velocity[self._lander.shown]))
        place = (tip[0] + 10 * float(way[0]), tip[1] + 16 * float(way[1]) + 4)
        align: Align = "centre" if abs(way[0]) < 0.4 else "left" if way[0] > 0 else "right"
        canvas.text(texts.TOUCH_SPEED.format(speed=speed), place, size=SMALL, colour=HUMAN, align=align, tabular=True)


def _distance(point: Point, start: Point, end: Point) -> float:
    """Return the distance of a point from a line between two others."""
    a, b, p = (np.array(each, float) for each in (start, end, point))
    along = np.clip(np.dot(p - a, b - a) / max(float(np.dot(b - a, b - a)), 1e-6), 0.0, 1.0)
    return math.dist(p, a + along * (b - a))
