"""Pictures that are kept: those that change seldom, and those that take so long that they are painted in pieces."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Hashable
from typing import Any, Final, Generic, TypeVar
from weakref import ref

import pygame

from game.core import texts
from game.drawing.canvas import Canvas

T = TypeVar("T")
# What paints in steps: it yields how many pixels each step has painted, and returns the picture.
Steps = Generator[int, None, T]

A_FRAME: Final = 60_000  # pixels of a large picture to paint in one frame: some 2 ms
_ROUGH: Final = 0.16  # resolution of a picture that is shown until the whole one is painted


class PaintCache:
    """Paint cache: pictures, such as the text of a panel, repainted only when their contents change.

    The last `most` pictures are kept, by their contents.
    """

    def __init__(self, most: int = 1) -> None:
        self._most = most
        self._painted: dict[Hashable, Canvas] = {}

    def draw(
        self, canvas: Canvas, box: pygame.typing.RectLike, shows: Hashable, paint: Callable[[Canvas], None]
    ) -> None:
        """Draw a picture with its origin at the corner of `box`; call `paint` only for a new `shows`, its contents."""
        x, y, width, height = pygame.FRect(box)
        key = (canvas.scale, canvas.type, canvas.palette, texts.LANGUAGE, width, height, shows)
        painted = self._painted.get(key)
        if painted is None:
            if len(self._painted) >= self._most:
                del self._painted[next(iter(self._painted))]
            painted = self._painted[key] = canvas.sheet(width, height)
            paint(painted)
        canvas.lay(painted, x, y)


class InPieces(Generic[T]):
    """A picture that takes longer to paint than a frame may last: rough at once, and whole a few frames later.

    What it returns can be anything else that takes long, such as the numbers of a map.

    Only where somebody goes on with it by `paint_on`, after `spread` said so: elsewhere it is painted at once, for
    films and stills are no better with a rough picture.

    Args:
        paint: paints it, at a share of its resolution.

    """

    def __init__(self, paint: Callable[[float], Steps[T]]) -> None:
        self._paint = paint
        self._picture: T | None = None
        self._steps: Steps[T] | None = paint(1.0)
        if _Spread.pixels:
            _unfinished.append(ref(self))

    @property
    def whole(self) -> bool:
        """Whether it is painted in full."""
        return self._steps is None

    @property
    def picture(self) -> T:
        """The picture, rough until it is whole."""
        if self._steps is not None and not _Spread.pixels:
            self.paint_on()
        if self._picture is None:
            self._picture = at_once(self._paint(_ROUGH))
        return self._picture

    def paint_on(self, pixels: float = float("inf")) -> int:
        """Paint at least so many pixels, as far as there are any, and return how many were painted."""
        done = 0
        while self._steps is not None and done < pixels:
            try:
                done += next(self._steps)
            except StopIteration as end:
                self._picture, self._steps = end.value, None
        _Spread.painted += done
        return done


def at_once(steps: Steps[T]) -> T:
    """Paint all steps, and return the picture."""
    while True:
        try:
            _Spread.painted += next(steps)
        except StopIteration as end:
            picture: T = end.value
            return picture


class _Spread:
    """How many pixels of large pictures a frame paints, 0 where each is painted at once; and how many there were.

    And how many there were `before` this frame, and how many could have been painted in the time that this frame has
    given to `other` work.
    """

    pixels = painted = before = other = 0


_unfinished: deque[ref[InPieces[Any]]] = deque()


def spread(pixels: int) -> None:
    """Paint large pictures in pieces from now on, some `pixels` in each call of `paint_on`; 0 paints each at once."""
    _Spread.pixels = pixels


def painted() -> int:
    """Return how many pixels of large pictures were painted since the start, rough ones too."""
    return _Spread.painted


def spend(pixels: int) -> None:
    """Count other work of this frame against its share, as long as it would take to paint so many pixels."""
    _Spread.other += pixels


def busy() -> bool:
    """Whether this frame has had other work already, so that what can wait had better wait; never in films."""
    done = _Spread.painted - _Spread.before + _Spread.other
    return done > _Spread.pixels // 8 > 0


def idle() -> bool:
    """Whether nothing is unfinished, so that there is time for what will only be seen later."""
    # What nobody wants any more is gone by itself.
    while _unfinished and ((latest := _unfinished[-1]()) is None or latest.whole):
        _unfinished.pop()
    return not _unfinished


def paint_on() -> int:
    """Paint what is left of a frame's share, what was begun last first; return how many pixels were painted."""
    already = _Spread.painted - _Spread.before + min(_Spread.other, _Spread.pixels // 2)  # in this frame, rough
    done = 0
    while already + done < _Spread.pixels and not idle() and (latest := _unfinished[-1]()):
        done += latest.paint_on(_Spread.pixels - already - done)
    _Spread.before, _Spread.other = _Spread.painted, 0
    return done
