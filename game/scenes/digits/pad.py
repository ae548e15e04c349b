"""Drawing pad: a square to draw a digit on with the mouse, keys or a gamepad, as MNIST digits are drawn."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt
import pygame

from ai.digits.strokes import Canvas as Ink
from ai.digits.strokes import draw_segments
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, LINE, NIGHT0
from game.ui.virtual_pointer import PictureRow

SIDE: Final = 520  # units along a side of every pad, whatever its size on the screen
_LARGEST: Final = 480.0
_RADIUS: Final = 12.0
_PACE: Final = 4.5  # points in a step of 1/60 s: slow enough for a digit
_MOST_UNDONE: Final = 100


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
        self._history: list[tuple[Stroke, ...]] = []
        self._ink = _Layer((SIDE // 2, SIDE // 2), 0.5)
        self._layer: _Layer | None = None
        self._sheet = pygame.Surface((1, 1), pygame.SRCALPHA)
        self._paper: Canvas

    @property
    def empty(self) -> bool:
        """Whether nothing is drawn."""
        return not self._strokes

    @property
    def strokes(self) -> list[npt.NDArray[np.float64]]:
        """The strokes, each as (n, 2) units from the pad's upper left corner, y down. Cached: do not modify."""
        return [stroke.points for stroke in self._strokes]

    @property
    def ink(self) -> Ink:
        """The drawing as an image (height, width), 0 to 1, ink bright, two units a pixel. Cached: do not modify."""
        self._ink.follow(self._strokes)
        return self._ink.cover

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
            case pygame.WINDOWFOCUSLOST:
                self.drawing = False
                return False
            case _:
                return False
        return True

    def undo(self) -> None:
        """Undo the last stroke, or the last clearing, if there is one."""
        if self._history:
            self._change(self._history.pop())

    def clear(self) -> None:
        """Clear the drawing; `undo` restores it."""
        if self._strokes:
            self._remember()
            self._change(())

    def lift(self) -> None:
        """End the stroke, whatever the state of the mouse."""
        self.drawing = False

    def draw(self, canvas: Canvas) -> None:
        """Draw the pad and what is on it, in the window's own pixels."""
        area = canvas.rect(*self.rect)
        if self._layer is None or self._sheet.get_size() != area.size:
            self._layer = _Layer(area.size, area.width / SIDE)
            self._sheet = pygame.Surface(area.size, pygame.SRCALPHA)
            self._sheet.fill((*INK, 0))
            self._paper = canvas.sheet(*self.rect.size)
            self._lay_ink(self._paper.surface.get_rect())
        changed = self._layer.follow(self._strokes)
        if changed:
            rows, columns = changed
            alpha = pygame.surfarray.pixels_alpha(self._sheet)
            alpha[columns, rows] = (self._layer.cover[rows, columns] * 255.5).astype(np.uint8).T
            del alpha  # the array locks the surface
            (left, right, _), (top, bottom, _) = columns.indices(area.width), rows.indices(area.height)
            self._lay_ink(pygame.Rect(left, top, right - left, bottom - top))
        canvas.surface.blit(self._paper.surface, area)

    def _lay_ink(self, part: pygame.Rect) -> None:
        """Repaint part of the picture of box, edge and ink, combined so that a frame draws one picture, not three."""
        paper, box = self._paper, (0, 0, *self.rect.size)
        paper.surface.set_clip(part)
        paper.surface.fill((0, 0, 0, 0))
        paper.rounded(box, _RADIUS, NIGHT0)
        paper.outline(box, _RADIUS, LINE)
        paper.surface.blit(self._sheet, (0, 0))
        paper.surface.set_clip(None)

    def _begin(self, position: Point) -> None:
        self._remember()
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

    def _remember(self) -> None:
        self._history = [*self._history[1 - _MOST_UNDONE :], self._strokes]

    def _change(self, strokes: tuple[Stroke, ...]) -> None:
        self.drawing = False
        self._strokes = strokes
        self.revision += 1


class _Layer:
    """Raster image of strokes, with `scale` pixels to a unit, painted incrementally as they grow.

    Attributes:
        cover: ink coverage of each pixel, 0 to 1, (height, width).

    """

    def __init__(self, size: tuple[int, int], scale: float) -> None:
        self.scale = scale
        self.cover = np.zeros(size[::-1], np.float32)
        self._painted: dict[Stroke, tuple[int, int]] = {}  # of each stroke: fixed points, and all points

    def follow(self, strokes: tuple[Stroke, ...]) -> tuple[slice, slice] | None:
        """Paint what is new; return the rows and columns that changed, if any."""
        anew = any(stroke not in strokes for stroke in self._painted)
        if anew:
            self.cover[...] = 0.0
            self._painted.clear()
        pieces = [piece for stroke in strokes for piece in self._pieces(stroke)]
        if pieces:
            draw_segments(self.cover, *zip(*pieces, strict=True))
        if anew:
            return slice(None), slice(None)
        if not pieces:
            return None
        reach = max(width for *_, width in pieces) / 2 + 2
        ends = [end for piece in pieces for end in piece[:2]]
        across, down = (
            slice(max(0, math.floor(min(axis) - reach)), max(0, math.ceil(max(axis) + reach)))
            for axis in zip(*ends, strict=True)
        )
        return down, across

    def _pieces(self, stroke: Stroke) -> list[tuple[Point, Point, float]]:
        """Return the segments not painted yet: start, end and width, in pixels."""
        scale, path = self.scale, stroke.path
        fixed, count = self._painted.get(stroke, (0, 0))
        if count == len(path) and fixed == stroke.fixed:
            return []
        self._painted[stroke] = (stroke.fixed, len(path))
        points = [(x * scale, y * scale) for x, y in path[fixed:]]
        widths = [width * scale for width in stroke.widths[fixed:]]
        if len(points) == 1:
            return [(points[0], points[0], widths[0])]
        return list(zip(points, points[1:], widths[1:], strict=False))


PEN_WIDTH: Final = 28.0  # units, of a pen that moves at a middling speed
_SLOW, _FAST = 1.12, 0.72  # times that width
_FASTEST: Final = 40.0  # units from one event to the next
_EASE: Final = 0.2
_CHORD: Final = 7.0  # units: longer segments between two events are curved
_CORNER: Final = 0.3  # cosine of a turn from which it counts as a corner, and stays sharp

Point = tuple[float, float]


class Stroke:
    """Stroke that grows point by point; positions in units from the pad's upper left corner, at full precision.

    Attributes:
        path: the curve, as closely spaced points; it passes through every added point.
        widths: width of the pen at each point of the path.
        fixed: index up to which the path is final.

    """

    def __init__(self, start: Point) -> None:
        self._added = [start]
        self._pressure = 0.9
        self.path: list[Point] = [start]
        self.widths = [PEN_WIDTH * self._pressure]
        self.fixed = 0
        self._points: npt.NDArray[np.float64] | None = None

    @property
    def points(self) -> npt.NDArray[np.float64]:
        """The path as an array (n, 2). Cached: do not modify."""
        if self._points is None:
            self._points = np.array(self.path)
        return self._points

    def add(self, point: Point) -> bool:
        """Add a point: joined straight at first, curved once the next is known. Return False if it equals the last."""
        last = self._added[-1]
        if point == last:
            return False
        self._points = None
        if len(self._added) > 1:
            del self.path[self.fixed + 1 :], self.widths[self.fixed + 1 :]
            before = self._added[-3] if len(self._added) > 2 else None
            self._extend(_curve(before, self._added[-2], last, point))
            self.fixed = len(self.path) - 1
        self._added.append(point)
        speed = min(math.dist(last, point) / _FASTEST, 1.0)
        self._pressure += _EASE * (_SLOW + (_FAST - _SLOW) * speed - self._pressure)
        self._extend([point])
        return True

    def _extend(self, points: list[Point]) -> None:
        start, end = self.widths[-1], PEN_WIDTH * self._pressure
        self.path += points
        self.widths += [start + (end - start) * (number + 1) / len(points) for number in range(len(points))]


def _curve(before: Point | None, start: Point, end: Point, after: Point) -> list[Point]:
    """Return points on the way from start to end, the end included: a cubic Hermite spline.

    Its tangents halve the turns at both ends and are as long as the chord, so it never swings out far.
    """
    chord = math.dist(start, end)
    if chord < _CHORD:
        return [end]
    along = ((end[0] - start[0]) / chord, (end[1] - start[1]) / chord)
    first = _tangent(_direction(before, start), along) if before else along
    last = _tangent(along, _direction(end, after))
    count = math.ceil(chord / _CHORD) + 1
    points = []
    for number in range(1, count):
        t = number / count
        weights = (1 + 2 * t) * (1 - t) ** 2, t * t * (3 - 2 * t), chord * t * (1 - t) ** 2, chord * t * t * (t - 1)
        x, y = (sum(map(float.__mul__, weights, axis)) for axis in zip(start, end, first, last, strict=True))
        points.append((x, y))
    return [*points, end]


def _direction(start: Point, end: Point) -> Point:
    length = math.dist(start, end) or 1.0
    return ((end[0] - start[0]) / length, (end[1] - start[1]) / length)


def _tangent(arriving: Point, leaving: Point) -> Point:
    """Return the direction halfway between two; at a corner there is none, and each side ends straight."""
    if arriving[0] * leaving[0] + arriving[1] * leaving[1] < _CORNER:
        return (0.0, 0.0)
    return _direction((0.0, 0.0), (arriving[0] + leaving[0], arriving[1] + leaving[1]))


def side_in(width: float) -> float:
    """Return the side, in points, of a pad, or of a picture of one digit, in a column of that width."""
    return min(width, _LARGEST)


def pen_row(pad: DrawingPad) -> PictureRow:
    """Return the row of a pad, for the mouse and for a virtual pointer."""
    return PictureRow(
        texts.POINTER, side_in, pad.handle_event,
        lambda canvas, _: pad.draw(canvas), square=True, hold=texts.PEN_HOLD, leave=texts.PEN_LEAVE, pace=_PACE,
    )  # fmt: skip
