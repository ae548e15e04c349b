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
PAGE: Final = pygame.FRect((0, 0), VIEW_SIZE)  # in points

Point = tuple[float, float]
Stamp = tuple[pygame.Surface, tuple[int, int]]  # a picture, and the corner where it is drawn, in pixels
Now = Callable[[], str]


class Explanation(NamedTuple):
    """Area of the screen, in points, with what stands there, and what that means now."""

    box: pygame.FRect
    what: str
    now: Now


class Canvas:
    """Drawing surface of a window, with a page of 1280 × 720 points, as large as fits, in its middle.

    Positions and lengths are points unless a name says pixels. The page's top left corner is (0, 0); a window of
    another shape than the page's shows more on two sides, as far as `view` reaches: points there are negative, or
    beyond 1280 × 720. Nothing is scaled after drawing: another window size is drawn anew, and shapes and strings are
    cached per size.

    Attributes:
        surface: what is drawn on, in the window's pixels; what lies outside it is clipped.
        scale: pixels per point.
        view: all that is seen, in points: the page, and what the window shows beside or above and below it.
        origin: where the page's top left corner lies on the surface, in pixels.
        moved: how far the page was moved to an edge of the view by `at`, in points.
        size: the page's width and height in pixels.
        palette: the player's colours for within and beyond limits.
        zoom: factor by which the player wants text enlarged; `reading` follows it.
        grows: whether small text is enlarged by `typeface.grow`, instead of everything by `zoom`.
        pointer: position of the mouse in points; None while it is not in use.
        explained: areas of this frame that can be explained, in the order in which they were drawn.

    """

    def __init__(self, window: pygame.Surface, palette: Palette = PALETTE) -> None:
        self.palette = palette
        self.scale, self.zoom, self.grows = 0.0, 1.0, True
        self.view = PAGE.copy()
        self._whole: Canvas | None = None
        self.moved: Point = (0.0, 0.0)
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
        self.view.update(-self.origin[0] / scale, -self.origin[1] / scale, width / scale, height / scale)

    @property
    def whole(self) -> Canvas:
        """The canvas of the whole window, of which this one may be a view."""
        return self._whole or self

    @property
    def reading(self) -> Canvas:
        """The whole window as a canvas for text that flows, with the window's own corner as the point (0, 0).

        A point is never less than a pixel, so text of 12 points can be read in any window: in a small or narrow one
        there are fewer points, and what is laid out in them takes more lines. Larger text is a larger point.
        """
        whole = self.whole
        reading = copy(whole)
        reading._whole, reading.grows = whole, False
        reading.scale = max(whole.scale, 1.0) * self.zoom
        reading.size, reading.origin = whole.surface.get_size(), (0, 0)
        width, height = reading.size
        reading.view = pygame.FRect(0, 0, width / reading.scale, height / reading.scale)
        reading.pointer = None if whole.pointer is None else reading.points(whole.pixels(whole.pointer))
        return reading

    def at(self, across: int, down: int) -> Canvas:
        """Return this canvas with its page moved to an edge of the view: -1 left or top, 1 right or bottom, 0 neither.

        What is laid out beside an edge of the page is drawn on it, and stands beside that edge of the window.
        """
        if self.view == PAGE:
            return self
        x, y = moved(self.view, across, down)
        canvas = copy(self)
        canvas.origin = self.origin[0] + self.px(x), self.origin[1] + self.px(y)
        canvas.view = self.view.move(-x, -y)
        canvas._whole, canvas.moved = self.whole, (self.moved[0] + x, self.moved[1] + y)
        canvas.pointer = None if self.pointer is None else (self.pointer[0] - x, self.pointer[1] - y)
        return canvas

    @property
    def ungrown(self) -> Canvas:
        """This canvas, on which text has the size that is said: for rows, which measure it with its growth."""
        canvas = copy(self)
        canvas.grows, canvas._whole = False, self.whole
        return canvas

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
        own.surface, own.origin, own.moved = surface, (0, 0), (0.0, 0.0)
        own.view, own._whole = PAGE.copy(), None
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
        """Note what stands in a box, in points, and a function that says what it means now, for those who ask."""
        self.explained.append(Explanation(pygame.FRect(box).move(self.moved), what, now))

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
        width and takes digits from a cache one by one: use it for every figure that changes. Text that is
        made larger for those who want it grows no further than `room`, in points; a translation that is longer than
        the English shrinks to it, but never below the smallest text of the game.
        """
        scale, (left, top) = self.scale, self.origin
        parts, width, above, below = typeface.line(
            string, self.grown(size), weight, colour, tabular, scale, room, self.least(size)
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
        pixels = typeface.fitting(string, self.grown(size), weight, tabular, self.scale, math.inf, size)
        return typeface.span(string, pixels, weight, tabular) / self.scale

    def least(self, size: float) -> float:
        """Return the least size of a text with too little room, in points: English always fits, others are longer."""
        return size if texts.LANGUAGE == ENGLISH else max(_LEAST * size, min(size, LABEL / max(self.scale, 1.0)))

    def grown(self, size: float) -> float:
        """Return the size at which a text of this size is written here, both in points."""
        return typeface.grown(size) if self.grows else size

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

    def panel(self, rect: pygame.typing.RectLike, alpha: float = PANEL_ALPHA, shown: float = 1.0) -> None:
        """Draw a translucent panel; all panels of the game look like this. `shown` is how far it has come, 0 to 1."""
        if shown >= 1:
            area = self._area(rect)
            opaque = not self.surface.get_flags() & pygame.SRCALPHA
            surface = shapes.rounded(area.size, 8 * self.scale, PANEL, cover=alpha, premultiplied=opaque)
            flags = pygame.BLEND_PREMULTIPLIED if opaque else 0
            self.surface.blit(surface, area.topleft, None, flags)
        else:
            self.rounded(rect, 8, PANEL, alpha * shown)

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


def moved(view: pygame.FRect, across: int, down: int) -> Point:
    """Return how far a page is moved to an edge of the view, or two, in points; see `Canvas.at`."""
    return ((0.0, view.right - VIEW_SIZE[0], view.left)[across], (0.0, view.bottom - VIEW_SIZE[1], view.top)[down])
