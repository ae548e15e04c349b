"""Frame of a lesson: a sentence, and a picture of which every number can be pointed at."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import pygame

from ai.explain.recorder import Function
from game.drawing import typeface
from game.drawing.canvas import Align, Canvas, Point
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import FAINT, INK, LABEL, MUTE, SMALL, Colour
from game.ui.tooltip import TooltipRow, draw_tooltip

__all__ = ["PICTURE", "SMALL_PICTURE", "WITHIN", "Explanation", "Frame", "Label", "Spot", "rows_of"]

PICTURE: Final = pygame.Rect(40, 216, 752, 440)  # of the current frame, in points
WITHIN: Final = pygame.Rect(12, 160, 1256, 520)  # where explanations may stand
SMALL_PICTURE: Final = (30.0, 26.0)  # width and height of the picture in the strip
_LEADING: Final = 19.0
_DIGITS: Final = 12.0  # points by which figures of one width may be wider than plain ones
_AROUND: Final = 3.0  # points by which the pointer may miss a number


@dataclass(frozen=True)
class Explanation:
    """Words and figures beside the pointer: `lines` say the meaning, `rows` are a word and a figure each."""

    lines: tuple[str, ...]
    rows: tuple[TooltipRow, ...] = ()


@dataclass(frozen=True)
class Spot:
    """Part of a picture that can be pointed at, in points from the picture's corner; `press` answers a click on it."""

    box: pygame.FRect
    explanation: Explanation | None = None
    press: Callable[[], None] | None = None


@dataclass(frozen=True)
class Label:
    """Text in a picture; `place` is on the baseline, in points from the picture's corner."""

    text: str
    place: Point
    size: float = SMALL
    colour: Colour = INK
    align: Align = "left"
    explanation: Explanation | None = None
    press: Callable[[], None] | None = None
    room: float = math.inf

    @property
    def box(self) -> pygame.FRect:
        """The box of the text, as far as layout needs it."""
        width = min(typeface.width(self.text, self.size, "regular"), self.room)
        left = self.place[0] - {"left": 0.0, "centre": width / 2, "right": width}[self.align]
        size = typeface.grown(self.size)
        return pygame.FRect(left, self.place[1] - 0.85 * size, width, 1.1 * size)

    def draw(self, canvas: Canvas) -> None:
        """Write the text."""
        canvas.text(
            self.text, self.place, size=self.size, colour=self.colour, align=self.align, tabular=True, room=self.room
        )


class Frame:
    """One of the frames of a lesson. A subclass adds labels, spots and shapes in points from the picture's corner.

    Attributes:
        name: its name in the strip.
        figure: the one figure that stands for it in the strip.
        sentence: the field's term for what happens here, then plain words for it.
        functions: the functions whose lines are shown beside it.
        begin: variable that the line sets which is lit at first; empty for any.
        labels: the texts of the picture.
        spots: parts that can be pointed at, besides labels that explain themselves.

    """

    def __init__(self, name: str, figure: str, sentence: str, functions: Sequence[Function]) -> None:
        self.name, self.figure, self.sentence, self.functions = name, figure, sentence, tuple(functions)
        self.begin = ""
        self.labels: list[Label] = []
        self.spots: list[Spot] = []
        self.pointed: Spot | None = None
        self._cache = PaintCache()
        self._version = 0

    # What a subclass adds

    def paint(self, canvas: Canvas) -> None:
        """Paint what never moves and is no label, onto a sheet of the picture's size."""

    def paint_small(self, canvas: Canvas) -> None:
        """Paint the picture that stands for it in the strip, on a sheet of SMALL_PICTURE's size."""

    def draw_live(self, canvas: Canvas) -> None:
        """Draw what moves, or follows the pointer; in points of the view."""

    def spot_at(self, place: Point) -> Spot | None:  # noqa: ARG002
        """Return what is pointed at besides `spots`, by a place in points from the picture's corner."""
        return None

    def update(self, still: bool) -> None:
        """Advance by 1/60 s; `still` with reduced motion."""

    # What all have

    def changed(self) -> None:
        """Paint the picture again, because a label or a shape is another now."""
        self._version += 1

    def label(self, text: str, x: float, y: float, **options: object) -> Label:
        """Add a text to the picture and return it."""
        label = Label(text, (x, y), **options)  # type: ignore[arg-type]
        self.labels.append(label)
        return label

    def heading(self, text: str, x: float, y: float, room: float = math.inf) -> None:
        """Add a small heading in capitals' place: muted, above what it names."""
        self.label(text, x, y, size=LABEL, colour=MUTE, room=room)

    def prose(self, text: str, x: float, y: float, width: float, colour: Colour = MUTE) -> float:
        """Add a sentence on as many lines as it needs; return the baseline after the last one."""
        line = ""
        for word in text.split():
            longer = f"{line} {word}".strip()
            if line and typeface.width(longer, SMALL, "regular") > width - _DIGITS:
                self.label(line, x, y, colour=colour)
                line, y = word, y + _LEADING
            else:
                line = longer
        self.label(line, x, y, colour=colour)
        return y + _LEADING

    def follow(self, point: Point | None) -> None:
        """Point at a place of the view; None for none."""
        self.pointed = self._spot(point) if point else None

    def press(self, point: Point) -> bool:
        """Press on a place of the view; return whether something there answered."""
        spot = self._spot(point)
        if spot is None or spot.press is None:
            return False
        spot.press()
        return True

    def _spot(self, point: Point) -> Spot | None:
        place = (point[0] - PICTURE.x, point[1] - PICTURE.y)
        if not PICTURE.inflate(16, 16).collidepoint(point):
            return None
        found = [spot for spot in self._all() if spot.box.inflate(2 * _AROUND, 2 * _AROUND).collidepoint(place)]
        return min(found, key=lambda spot: spot.box.width * spot.box.height, default=None) or self.spot_at(place)

    def _all(self) -> Iterable[Spot]:
        yield from self.spots
        for label in self.labels:
            if label.explanation or label.press:
                yield Spot(label.box, label.explanation, label.press)

    def draw(self, canvas: Canvas) -> None:
        """Draw the picture, and what is pointed at."""
        self._cache.draw(canvas, PICTURE, (type(self).__name__, self._version), self._paint)
        self.draw_live(canvas)

    def draw_explanation(self, canvas: Canvas) -> None:
        """Draw the explanation of what is pointed at, over everything else."""
        spot = self.pointed
        if spot is None:
            return
        box = spot.box.move(PICTURE.topleft)
        if box.width * box.height > 0:
            canvas.outline(box.inflate(8, 6), 4, INK if spot.press else FAINT, alpha=0.7)
        if spot.explanation:
            anchor = (min(box.right, box.left + 220), box.centery)
            draw_tooltip(canvas, anchor, WITHIN, spot.explanation.lines, spot.explanation.rows)

    def _paint(self, sheet: Canvas) -> None:
        self.paint(sheet)
        for label in self.labels:
            label.draw(sheet)


def rows_of(*pairs: tuple[str, str]) -> tuple[TooltipRow, ...]:
    """Return the rows of an explanation from pairs of a word and a figure."""
    return tuple(TooltipRow(word, figure) for word, figure in pairs)
