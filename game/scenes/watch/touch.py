"""Hand on a lander: while Watch is stopped, the shown lander can be placed, tilted and thrown.

A ring around it is what to drag, a dot on the ring is its tilt, and an arrow its speed. By keys and gamepad the hand is
a widget: Enter or A takes hold of the place, then of the tilt, then of the speed, and the arrows change it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from game.core import texts
from game.drawing.canvas import PAGE, Align, Canvas, Point
from game.drawing.tokens import HUMAN, INK, NIGHT0, SMALL
from game.input.controls import Command, Controls, translate
from game.ui.hints import Hint
from game.ui.virtual_pointer import HeldDirections
from game.ui.widget import Widget

if TYPE_CHECKING:
    from ai.environment import Doubles
    from game.scenes.watch.watched import Watched

PLACE, TILT, SPEED = range(3)
FASTEST: Final = 8.0  # m/s
NOTCH: Final = math.radians(5.0)  # of the wheel, of Q and E, and of a shoulder button
_RING: Final = 1.5  # radius in metres of a lander of full size
_LEAST: Final = 36.0  # and at least, in points
_ARROW: Final = 12.0  # points between the ring and the arrow
_PER_SPEED: Final = 22.0  # points of the arrow for each m/s
_REACH: Final = 16.0  # points from a knob within which it is taken
_PACE: Final = (0.05, math.radians(1.0), 0.05)  # metres, radians and m/s in an update, while an arrow is held
_SHOULDERS: Final = {Command.PREVIOUS: 1, Command.NEXT: -1}
_LEAVE: Final = (Command.BACK, Command.PAUSE, Command.UNPLUGGED)
_ASIDE, _HEAD, _FOOT = 40, 100, 110  # points from the edges of the view, within which the focus on it is seen


class Hand(Widget):
    """The player's hand on the shown lander, by mouse, keys or gamepad.

    Attributes:
        part: what it holds: PLACE, TILT or SPEED.
        dragging: whether the mouse holds it.

    """

    def __init__(self, lander: Watched, clear: pygame.Rect, view: pygame.FRect = PAGE) -> None:
        super().__init__(clear, texts.TOUCH_LANDER)
        self._lander, self._clear, self._view = lander, clear, view
        self.part, self.dragging = PLACE, False
        self._grip: Point = (0.0, 0.0)  # from the mouse to what it holds, in points
        self._held = HeldDirections()

    # Where it is, in points

    @property
    def box(self) -> pygame.Rect:
        """The box of the ring, kept where it is seen between words and read-outs, for the focus to find."""
        left, top, width, height = self._view
        sky = pygame.Rect(left + _ASIDE, top + _HEAD, width - 2 * _ASIDE, height - _HEAD - _FOOT)
        return pygame.Rect(_around(self.middle, self.radius)).clamp(sky)

    @property
    def middle(self) -> Point:
        """Middle of the ring."""
        x, y = self._lander.hand_view().points(self._lander.state[:2]).tolist()
        return x, y

    @property
    def radius(self) -> float:
        """Radius of the ring."""
        return max(_LEAST, _RING * self._lander.hand_view().pixels_per_metre * self._lander.size)

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

    def used(self, pointer: Point | None) -> bool:
        """Whether it holds the lander, or the mouse points at a part to take."""
        return self.dragging or self.typing or (pointer is not None and self.part_at(pointer) is not None)

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
            self._put(angle=float(self._lander.state[4]) + NOTCH * notches)

    def mouse(self, event: pygame.event.Event) -> bool:
        """Take a mouse event, its position in points; false leaves it to others."""
        if event.type == pygame.MOUSEMOTION and self.dragging:
            if self._lander.at_hand:
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
        x, y, across, up, lean, spin = self._lander.state.tolist()
        x, y = (x, y) if place is None else place
        across, up = (across, up) if velocity is None else velocity
        lean, spin = (lean, spin) if angle is None else (angle, 0.0)
        clear, env = self._clear, self._lander.env
        (left, top), (right, _) = self._lander.hand_view().metres([clear.topleft, clear.bottomright]).tolist()
        x = min(max(x, left, -env.limits.half_width), right, env.limits.half_width)
        y = max(min(y, top, env.limits.ceiling), env.lowest(x, lean))
        self._lander.touch(np.array([x, y, across, up, lean, spin]))

    # By keys and gamepad

    def press(self) -> None:
        """Take hold of the lander, unless a real mouse is in use."""
        if self.ringed:
            self.hold()

    def hold(self) -> None:
        """Stop, and let the arrows move the lander."""
        self._lander.playback.stopped = True
        self.typing, self.part = True, PLACE

    def hints(self, controls: Controls) -> list[Hint]:
        """Return the hints while the hand holds the lander."""
        back, turns = "Z", "Q E"
        if controls.gamepad_in_use:
            back, turns = controls.word(Command.RETRY), " ".join(map(controls.word, _SHOULDERS))
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
        code, command = getattr(event, "key", getattr(event, "button", None)), translate(event)
        by_pad = event.type == pygame.CONTROLLERBUTTONDOWN
        if event.type in (pygame.KEYUP, pygame.CONTROLLERBUTTONUP):
            return self._held.release(code)
        if event.type == pygame.WINDOWFOCUSLOST:  # releases will not be reported now
            self._let_go()
            return False
        if self._held.tilt(event) or self._held.press(code, command):
            return True
        if command is Command.CONFIRM:
            self._next_part()
        elif by_pad and command in _SHOULDERS:
            self.turn(_SHOULDERS[command])
        elif by_pad and command is Command.RETRY:
            self._lander.untouch()
        elif command in _LEAVE:
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
        held = self._held.stick + (self._held.arrows or (0, 0))
        way, pace, state = np.array([held.x, -held.y]), _PACE[self.part], self._lander.state  # up is up in the world
        if not self.typing or not way.any():
            return
        if self.part == PLACE:
            self._put(place=state[:2] + pace * way)
        elif self.part == TILT:
            self._put(angle=float(state[4]) - pace * float(way[0] or way[1]))
        else:
            velocity = state[2:4] + pace * way
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
        held = self.part if self.dragging or self.typing else None
        lit = self.part_at(canvas.pointer) if held is None and canvas.pointer is not None else held
        ring = _around(self.middle, self.radius)
        canvas.outline(ring, self.radius, HUMAN, 1, 0.9 if lit == PLACE else 0.45)
        self._draw_tilt(canvas, lit == TILT)
        self._draw_arrow(canvas, lit == SPEED)

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
        lowest = self._view.bottom - _FOOT  # read-outs are below
        place = (tip[0] + 10 * float(way[0]), min(tip[1] + 16 * float(way[1]) + 4, lowest))
        align: Align = "centre" if abs(way[0]) < 0.4 else "left" if way[0] > 0 else "right"
        canvas.text(texts.TOUCH_SPEED.format(speed=speed), place, size=SMALL, colour=HUMAN, align=align, tabular=True)


def _around(place: Point, reach: float) -> tuple[float, float, float, float]:
    return place[0] - reach, place[1] - reach, 2 * reach, 2 * reach


def _distance(point: Point, start: Point, end: Point) -> float:
    """Return the distance of a point from a line between two others."""
    a, b, p = (np.array(each, float) for each in (start, end, point))
    along = np.clip(np.dot(p - a, b - a) / max(float(np.dot(b - a, b - a)), 1e-6), 0.0, 1.0)
    return math.dist(p, a + along * (b - a))
