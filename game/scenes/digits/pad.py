"""Drawing pad: a square to draw a digit on with the mouse, keys or a gamepad, as MNIST digits are drawn."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt
import pygame

from ai.digits.strokes import Canvas as Cover
from ai.digits.strokes import draw_segments, draw_strokes
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, LINE, NIGHT0
from game.ui.virtual_pointer import PictureRow

SIDE: Final = 520  # units along a side of every pad, whatever its size on the screen
_LARGEST: Final = 480.0
_RADIUS: Final = 12.0
_PACE: Final = 4.5  # points in a step of 1/60 s: slow enough for a digit
PEN_WIDTH: Final = 26.0  # units
_CHORD: Final = 7.0  # units: longer segments between two events are curved

Point = tuple[float, float]


class DrawingPad:
    """Drawing pad of SIDE by SIDE units. Pass it events with `handle_event`; it ignores those outside `rect`.

    Attributes:
        rect: box of the pad, in points of the canvas.
        revision: counter, raised by every change of the drawing.
        drawing: whether the pen is down.

    """

    def __init__(self) -> None:
        self.rect = pygame.FRect(0, 0, SIDE, SIDE)
        self.revision = 0
        self.drawing = False
        self._outside = False
        self._strokes: tuple[Stroke, ...] = ()
        self._ink = _Ink(1)

    @property
    def strokes(self) -> list[npt.NDArray[np.float64]]:
        """The strokes, each as (n, 2) units from the pad's upper left corner, y down."""
        return [np.array(stroke.path) for stroke in self._strokes]

    def ink(self) -> Cover:
        """Return the drawing as an image (height, width), 0 to 1, ink bright, two units a pixel."""
        return draw_strokes([stroke / 2 for stroke in self.strokes], (SIDE // 2, SIDE // 2), PEN_WIDTH / 2)

    def handle_event(self, event: pygame.event.Event) -> bool:
        """Handle an event, its position in points; return False if it means nothing to the pad."""
        match event.type:
            case pygame.MOUSEBUTTONDOWN if event.button == 1 and self.rect.collidepoint(event.pos):
                self._begin(event.pos)
            case pygame.MOUSEMOTION if self.drawing:
                self._go_on(event.pos)
            case pygame.MOUSEBUTTONUP if event.button == 1 and self.drawing:
                self._go_on(event.pos)
                self.drawing = False
            case _:
                return False
        return True

    def undo(self) -> None:
        """Undo the last stroke, if there is one."""
        self._change(self._strokes[:-1])

    def clear(self) -> None:
        """Clear the drawing."""
        self._change(())

    def lift(self) -> None:
        """End the stroke, whatever the state of the mouse."""
        self.drawing = False

    def draw(self, canvas: Canvas) -> None:
        """Draw the pad and what is on it, in the window's own pixels."""
        area = canvas.rect(*self.rect)
        if self._ink.side != area.width or not self._ink.painted.keys() <= set(self._strokes):
            self._ink = _Ink(area.width)
        self._ink.follow(self._strokes)
        canvas.rounded(self.rect, _RADIUS, NIGHT0)
        canvas.outline(self.rect, _RADIUS, LINE)
        canvas.surface.blit(self._ink.surface, area)

    def _begin(self, position: Point) -> None:
        self._change((*self._strokes, Stroke(self._place(position))))
        self.drawing, self._outside = True, False

    def _go_on(self, position: Point) -> None:
        if not self.rect.inflate(*2 * [PEN_WIDTH * self.rect.width / SIDE]).collidepoint(position):
            self._outside = True
        elif self._outside:  # the pen is back inside; nothing is drawn for its way outside
            self._outside = False
            self._strokes = (*self._strokes, Stroke(self._place(position)))
            self.revision += 1
        elif self._strokes[-1].add(self._place(position)):
            self.revision += 1

    def _place(self, position: Point) -> Point:
        units = SIDE / self.rect.width
        return (position[0] - self.rect.left) * units, (position[1] - self.rect.top) * units

    def _change(self, strokes: tuple[Stroke, ...]) -> None:
        self.drawing = False
        self._strokes = strokes
        self.revision += 1


class Stroke:
    """Stroke that grows point by point; positions in units from the pad's upper left corner, at full precision.

    Attributes:
        path: the curve, as closely spaced points; it passes through every added point.
        fixed: index up to which the path is final.

    """

    def __init__(self, start: Point) -> None:
        self._added = [start]
        self.path: list[Point] = [start]
        self.fixed = 0

    def add(self, point: Point) -> bool:
        """Add a point: joined straight at first, curved once the next is known. Return False if it equals the last."""
        *before, last = self._added
        if point == last:
            return False
        if before:
            del self.path[self.fixed + 1 :]
            self.path += _curve(before[-2] if len(before) > 1 else before[-1], before[-1], last, point)
            self.fixed = len(self.path) - 1
        self._added.append(point)
        self.path.append(point)
        return True


def _curve(before: Point, start: Point, end: Point, after: Point) -> list[Point]:
    """Return points on the way from start to end, the end included: a cubic Hermite spline.

    Each of its tangents points along both neighbours, and is as long as the chord, so it never swings out far.
    """
    chord = math.dist(start, end)
    count = math.ceil(chord / _CHORD)
    first, last = chord * _direction(before, end), chord * _direction(start, after)
    t = np.arange(1, count + 1)[:, None] / count
    way = (1 + 2 * t) * (1 - t) ** 2 * start + t * t * (3 - 2 * t) * end
    return list(map(tuple, (way + t * (1 - t) ** 2 * first - t * t * (1 - t) * last).tolist()))


def _direction(start: Point, end: Point) -> npt.NDArray[np.float64]:
    return np.subtract(end, start) / (math.dist(start, end) or 1.0)


class _Ink:
    """Picture of strokes, so many pixels along a side, painted as they grow.

    Attributes:
        painted: of each stroke, up to which point of its path it is final there, and how many points were painted.

    """

    def __init__(self, side: int) -> None:
        self.side = side
        self.surface = pygame.Surface((side, side), pygame.SRCALPHA)
        self.surface.fill((*INK, 0))
        self.painted: dict[Stroke, tuple[int, int]] = {}
        self._cover = np.zeros((side, side), np.float32)

    def follow(self, strokes: tuple[Stroke, ...]) -> None:
        """Paint what is new."""
        for stroke in strokes:
            fixed, count = self.painted.get(stroke, (0, 0))
            if (stroke.fixed, len(stroke.path)) != (fixed, count):
                self.painted[stroke] = stroke.fixed, len(stroke.path)
                self._paint(np.array(stroke.path[fixed:]) * self.side / SIDE)

    def _paint(self, path: npt.NDArray[np.float64]) -> None:
        width = PEN_WIDTH * self.side / SIDE
        starts, ends = (path[:-1], path[1:]) if len(path) > 1 else (path, path)
        draw_segments(self._cover, starts, ends, np.full(len(starts), width))
        low, high = np.floor(path.min(axis=0) - width), np.ceil(path.max(axis=0) + width)
        (left, top), (right, bottom) = (np.clip(each, 0, self.side).astype(int).tolist() for each in (low, high))
        alpha = pygame.surfarray.pixels_alpha(self.surface)
        alpha[left:right, top:bottom] = (self._cover[top:bottom, left:right] * 255.5).astype(np.uint8).T


def pen_row(pad: DrawingPad) -> PictureRow:
    """Return the row of a pad, for the mouse and for a virtual pointer."""
    return PictureRow(
        texts.POINTER, lambda width: min(width, _LARGEST), pad.handle_event,
        lambda canvas, _: pad.draw(canvas), square=True, hold=texts.PEN_HOLD, leave=texts.PEN_LEAVE, pace=_PACE,
    )  # fmt: skip
