"""The drawing surface of every scene: laid out in points, drawn in the window's own pixels, up to its edges."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from copy import copy
from typing import Final, Literal, NamedTuple

import pygame

from game.core import texts
from game.core.catalogue import ENGLISH
from game.drawing import shapes, typeface
from game.drawing.tokens import FAINT, INK, LABEL, NIGHT0, PALETTE, PANEL, PANEL_ALPHA, TEXT, VIEW_SIZE, Colour, Palette
from game.drawing.typeface import Weight

_LEAST: Final = 0.7  # share of a size
_MOST_EXPLAINED: Final = 256  # areas of a frame, at most

Align = Literal["left", "centre", "right"]
SHIFT: Final[dict[Align, float]] = {"left": 0.0, "centre": 0.5, "right": 1.0}
PAGE: Final = pygame.FRect((0, 0), VIEW_SIZE)  # of the world, in points
GROUND: Final = 40.0  # points at the foot of that page that are ground below any pad, and free for words

Point = tuple[float, float]
Stamp = tuple[pygame.Surface, tuple[int, int]]  # a picture, and the corner where it is drawn, in pixels
Now = Callable[[], str]


class Explanation(NamedTuple):
    """Area of the window, in points of what is read, with what stands there, and what that means now."""

    box: pygame.FRect
    what: str
    now: Now


class Canvas:
    """Drawing surface of a window, for words, or for the world behind them.

    Positions and lengths are points unless a name says pixels. What is read flows: its corner (0, 0) is the window's,
    a point is never less than a pixel, and larger text is a larger point, so that in a small window, or for large text,
    there are fewer points, and what is laid out in them takes more lines. The world fills the window: its page of
    1280 × 720 points, as large as fits, stands in the middle, and `view` reaches beyond it on two sides. Text has the
    same size on both. Nothing is scaled after drawing: another window size is drawn anew, and shapes and strings are
    cached per size.

    Attributes:
        surface: what is drawn on, in the window's pixels; what lies outside it is clipped.
        scale: pixels per point.
        type: pixels per point of text.
        view: all that is seen, in points.
        origin: where the point (0, 0) lies on the surface, in pixels.
        size: the width and height in pixels of the page, or of all that is seen.
        message: box in points of what is read that a message covers now; empty while there is none.
        palette: the player's colours for within and beyond limits.
        zoom: factor by which the player wants text enlarged.
        pointer: position of the mouse in points; None while it is not in use.
        explained: areas of this frame that can be explained, in the order in which they were drawn.

    """

    def __init__(self, window: pygame.Surface, palette: Palette = PALETTE) -> None:
        self.palette = palette
        self.scale, self.zoom, self.message = 0.0, 1.0, pygame.FRect()
        self._whole: Canvas | None = None
        self._type = 0.0  # of a canvas that is no part of a window
        self.pointer: Point | None = None
        self.explained: deque[Explanation] = deque(maxlen=_MOST_EXPLAINED)
        self.attach(window)

    def attach(self, window: pygame.Surface) -> None:
        """Draw into this window from now on."""
        width, height = window.get_size()
        scale = max(min(width / VIEW_SIZE[0], height / VIEW_SIZE[1]), 0.01)
        self.size = (max(1, round(VIEW_SIZE[0] * scale)), max(1, round(VIEW_SIZE[1] * scale)))
        if self.scale and scale != self.scale:  # a window of another size: what was kept for the last one is in the way
            typeface.forget()
            shapes.forget()
        self.scale = scale
        window.fill(NIGHT0)
        self.surface, self.origin = window, ((width - self.size[0]) // 2, (height - self.size[1]) // 2)
        self.view = pygame.FRect(-self.origin[0] / scale, -self.origin[1] / scale, width / scale, height / scale)

    @property
    def type(self) -> float:
        """Pixels per point of text, which is alike on all canvases of a window."""
        return self._type or max(self.whole.scale, 1.0) * self.zoom

    @property
    def whole(self) -> Canvas:
        """The canvas of the world, of which this one may be what is read before it."""
        return self._whole or self

    @property
    def reading(self) -> Canvas:
        """The whole window as a canvas for what is read."""
        whole = self.whole
        reading = copy(whole)
        reading._whole, reading.scale = whole, whole.type
        reading.size, reading.origin = whole.surface.get_size(), (0, 0)
        width, height = reading.size
        reading.view = pygame.FRect(0, 0, width / reading.scale, height / reading.scale)
        reading.pointer = None if whole.pointer is None else reading.points(whole.pixels(whole.pointer))
        return reading

    def above(self, foot: float) -> Canvas:
        """Return the canvas of the world as it is seen above rows at the foot of the window, which are so high.

        `foot` is in points of text. As much of the rows as `GROUND` stands on the ground itself.
        """
        world = copy(self.whole)
        world._whole, world.view = self.whole, self.whole.view.copy()
        world.view.height -= max(0.0, foot * self.type / world.scale - GROUND)
        return world

    def px(self, points: float) -> int:
        """Return a length in whole pixels."""
        return round(points * self.scale)

    def rect(self, x: float, y: float, width: float, height: float) -> pygame.Rect:
        """Return a rectangle in pixels; rectangles adjacent in points stay adjacent in pixels."""
        scale, origin = self.scale, self.origin
        left, top = round(x * scale), round(y * scale)
        right, bottom = round((x + width) * scale), round((y + height) * scale)
        return pygame.Rect(left + origin[0], top + origin[1], right - left, bottom - top)

    def pixels(self, point: Point) -> Point:
        """Return the place of a point on the surface, in pixels."""
        return self.origin[0] + point[0] * self.scale, self.origin[1] + point[1] * self.scale

    def points(self, place: Point) -> Point:
        """Return the point at a place on the surface, in pixels."""
        return (place[0] - self.origin[0]) / self.scale, (place[1] - self.origin[1]) / self.scale

    def sheet(self, width: float, height: float) -> Canvas:
        """Return a canvas of that size on its own transparent surface, to be drawn once and copied often.

        Glows and translucent lines need a background, and do not show on it.
        """
        size = (max(1, math.ceil(width * self.scale)), max(1, math.ceil(height * self.scale)))
        sheet = self._on(pygame.Surface(size, pygame.SRCALPHA))
        sheet.size = size
        return sheet

    def picture(self, width: float, height: float) -> Canvas:
        """Return a canvas at the same scale on its own opaque surface, to be copied as often as it is drawn."""
        return self._on(pygame.Surface(self.rect(0, 0, width, height).size))

    def _on(self, surface: pygame.Surface) -> Canvas:
        """Return a canvas on a surface of its own, which is no part of the window; of it nothing is explained."""
        own = copy(self)
        own.surface, own.origin, own.view = surface, (0, 0), PAGE.copy()
        own._whole, own._type = None, self.type
        own.explained = deque(maxlen=0)
        return own

    def lay(self, sheet: Canvas, x: float, y: float) -> None:
        """Copy a sheet onto the canvas, with its top left corner at (x, y) in points."""
        self.surface.blit(sheet.surface, self.rect(x, y, 0, 0))

    @contextmanager
    def clipped(self, box: pygame.typing.RectLike) -> Iterator[None]:
        """Draw within a box alone, in points; a context manager."""
        before = self.surface.get_clip()
        self.surface.set_clip(self.rect(*pygame.FRect(box)).clip(before))
        try:
            yield
        finally:
            self.surface.set_clip(before)

    def explain(self, box: pygame.typing.RectLike, what: str, now: Now = str) -> None:
        """Note what stands in a box, in points, and a function that says what it means now, for those who ask.

        Of what is scrolled away nothing is explained.
        """
        x, y, width, height = pygame.FRect(box)
        area = pygame.FRect(*self.pixels((x, y)), width * self.scale, height * self.scale)
        seen = area.clip(pygame.FRect(self.surface.get_clip()))
        if seen.height > area.height / 2:
            corner = seen.left / self.type, seen.top / self.type
            self.explained.append(
                Explanation(pygame.FRect(corner, (seen.width / self.type, seen.height / self.type)), what, now)
            )

    # Text

    def text(
        self,
        string: str,
        position: Point,
        *,
        size: float = TEXT,
        colour: Colour = INK,
        weight: Weight = "regular",
        align: Align = "left",
        tabular: bool = False,
        alpha: float = 1.0,
        room: float = math.inf,
    ) -> pygame.FRect:
        """Write a string on one line and return its box, ascent to descent.

        `position` is on the *baseline*: its left end, middle or right end as `align` says, so that texts
        of different sizes stand on one line when given the same y. `tabular` gives every digit the same
        width and takes digits from a cache one by one: use it for every figure that changes. A translation that is
        longer than the English shrinks to `room`, in points, but never below the smallest text of the game.
        """
        scale, (left, top) = self.scale, self.origin
        parts, width, above, below = typeface.line(
            string, size, weight, colour, tabular, self.type, room * scale / self.type, least(size)
        )
        x, y = left + position[0] * scale - SHIFT[align] * width, top + round(position[1] * scale)
        if alpha >= 1:
            self.surface.fblits([(surface, (round(x + across), y - baseline)) for surface, across, baseline in parts])
        else:
            for surface, across, baseline in parts:
                self._blit(surface, (round(x + across), y - baseline), alpha)
        return pygame.FRect((x - left) / scale, (y - above - top) / scale, width / scale, (above + below) / scale)

    def text_width(
        self, string: str, *, size: float = TEXT, weight: Weight = "regular", tabular: bool = False
    ) -> float:
        """Return the width in points of `text` with the same arguments."""
        return typeface.span(string, round(size * self.type, 2), weight, tabular) / self.scale

    def _blit(self, surface: pygame.Surface, position: tuple[int, int], alpha: float = 1.0) -> None:
        if alpha >= 1:  # as it is kept
            self.surface.blit(surface, position)
        elif alpha > 0:
            surface.set_alpha(round(255 * alpha))
            self.surface.blit(surface, position)
            surface.set_alpha(255)

    # Shapes

    def line(self, a: Point, b: Point, colour: Colour, width: float = 1.0, alpha: float = 1.0) -> None:
        """Draw an anti-aliased line; vertical and horizontal ones are sharp."""
        thickness = max(1, self.px(width))
        start, end = self.pixels(a), self.pixels(b)
        left, top = round(min(start[0], end[0])), round(min(start[1], end[1]))
        if a[1] == b[1]:
            across = pygame.Rect(left, top - thickness // 2, round(abs(end[0] - start[0])), thickness)
            self.fill(across, colour, alpha)
        elif a[0] == b[0]:
            down = pygame.Rect(left - thickness // 2, top, thickness, round(abs(end[1] - start[1])))
            self.fill(down, colour, alpha)
        elif alpha >= 1:
            pygame.draw.aaline(self.surface, colour, start, end, thickness)
        else:
            self._blit(*shapes.slanted(start, end, colour, thickness), alpha)

    def fill(self, area: pygame.Rect, colour: Colour, alpha: float = 1.0) -> None:
        """Fill an area given in pixels."""
        if alpha >= 1:
            self.surface.fill(colour, area)
        elif area.width > 0 and area.height > 0:
            self._blit(shapes.plain(area.size, colour), area.topleft, alpha)

    def dot(self, centre: Point, radius: float, colour: Colour, alpha: float = 1.0) -> None:
        """Draw a filled anti-aliased circle, positioned to a quarter of a pixel."""
        self._blit(*self.stamp("circle", centre, radius, colour), alpha)

    def marker(self, shape: shapes.Shape, centre: Point, size: float, colour: Colour, alpha: float = 1.0) -> None:
        """Draw a small shape, `size` points across, so that meaning never depends on colour alone."""
        self._blit(*self.stamp(shape, centre, size / 2, colour), alpha)

    def stamp(self, shape: shapes.Shape, centre: Point, radius: float, colour: Colour) -> Stamp:
        """Return a shape, positioned to a quarter of a pixel, and the corner where it is drawn on the surface."""
        x, y = self.pixels(centre)
        column, row = math.floor(x), math.floor(y)
        quarters = (int(4 * (x - column)), int(4 * (y - row)))
        surface = shapes.shape(shape, round(4 * radius * self.scale) / 4, colour, quarters)
        middle = surface.get_width() // 2
        return surface, (column - middle, row - middle)

    def _area(self, rect: pygame.typing.RectLike) -> pygame.Rect:
        """Return a rectangle in pixels, of which nothing is too small to be seen."""
        area = self.rect(*(rect if isinstance(rect, tuple) else pygame.FRect(rect)))
        area.size = (max(1, area.width), max(1, area.height))
        return area

    def bar(self, rect: pygame.typing.RectLike, fraction: float, colour: Colour, track: Colour = FAINT) -> None:
        """Draw a thin rounded track, filled to a fraction from 0 to 1."""
        self.pill(rect, track, 0.6)
        if fraction <= 0:
            return
        area, (_, _, width, height) = self._area(rect), rect if isinstance(rect, tuple) else pygame.FRect(rect)
        whole = shapes.rounded(area.size, min(width, height) / 2 * self.scale, colour)
        end = (area.height + 1) // 2  # cut from the whole bar, or each length would be painted anew
        length = max(self.px(max(width * min(fraction, 1.0), height)), end)
        self.surface.blit(whole, area.topleft, (0, 0, length - end, area.height))
        self.surface.blit(whole, (area.left + length - end, area.top), (area.width - end, 0, end, area.height))

    def pill(self, rect: pygame.typing.RectLike, colour: Colour, alpha: float = 1.0) -> None:
        """Fill a rectangle whose shorter sides are round."""
        x, y, width, height = rect if isinstance(rect, tuple) else pygame.FRect(rect)
        self.rounded((x, y, width, height), min(width, height) / 2, colour, alpha)

    def rounded(self, rect: pygame.typing.RectLike, radius: float, colour: Colour, alpha: float = 1.0) -> None:
        """Fill a rectangle with round corners."""
        area = self._area(rect)
        self._blit(shapes.rounded(area.size, radius * self.scale, colour), area.topleft, alpha)

    def outline(
        self, rect: pygame.typing.RectLike, radius: float, colour: Colour, width: float = 1.0, alpha: float = 1.0
    ) -> None:
        """Draw the edge of a rectangle with round corners, inside it."""
        area = self._area(rect)
        edge = shapes.rounded(area.size, radius * self.scale, colour, max(1, self.px(width)))
        self._blit(edge, area.topleft, alpha)

    def panel(self, rect: pygame.typing.RectLike, alpha: float = PANEL_ALPHA) -> None:
        """Draw a translucent panel; all panels of the game look like this."""
        area = self._area(rect)
        opaque = not self.surface.get_flags() & pygame.SRCALPHA
        surface = shapes.rounded(area.size, 8 * self.scale, PANEL, cover=alpha, premultiplied=opaque)
        self.surface.blit(surface, area.topleft, None, pygame.BLEND_PREMULTIPLIED if opaque else 0)

    def glow(self, centre: Point, radius: float, colour: Colour, strength: float = 1.0) -> None:
        """Add light around a point, fading out towards the radius."""
        if (pixels := self.px(radius)) >= shapes.HUGE_GLOW:
            x, y = self.pixels(centre)
            shapes.add_huge_glow(self.surface, (round(x), round(y)), pixels, colour, min(strength, 4.0))
        elif light := self.light(centre, radius, colour, strength):
            self.surface.blit(*light, None, pygame.BLEND_RGB_ADD)

    def light(self, centre: Point, radius: float, colour: Colour, strength: float) -> Stamp | None:
        """Return the light that `glow` adds, and the corner where on the surface; None if there is none."""
        pixels = self.px(radius)
        level = round(32 * min(max(strength, 0.0), 4.0))
        if pixels <= 0 or level <= 0:
            return None
        surface = shapes.glow(pixels if pixels < 24 else 4 * round(pixels / 4), colour, level)
        (x, y), half = self.pixels(centre), surface.width // 2
        return surface, (round(x) - half, round(y) - half)


def least(size: float) -> float:
    """Return the least size of a text with too little room, in points: English always fits, others are longer."""
    return size if texts.LANGUAGE == ENGLISH else max(_LEAST * size, min(size, LABEL))
