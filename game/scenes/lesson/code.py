"""Our own code beside a frame: the lines that ran for it, one of them lit, with the values that it set below."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.explain.learning_step import Value
from ai.explain.recorder import Line
from game.core import texts
from game.core.source import Source, source_of
from game.drawing.cursor import Cursor
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import CAPTION, INK, NET
from game.panels.code_listing import draw_listing
from game.panels.figures import number
from game.panels.tables import told
from game.scenes.lesson.frame import Frame

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.ui.panel import Column

_LISTING: Final = 300.0  # height
_MOST: Final = 6  # values of a line that are shown
_LISTED: Final = 12  # numbers of a value that are listed for who asks
_FEW: Final = 6  # numbers of an array that are written out, at most
# Variables of the agent's code that are rewards, values or differences of these.
_REWARDS: Final = frozenset((
    "reward", "transitions.reward", "return.0.reward", "self._returns", "value", "targets", "errors", "chosen",
    "predicted", "prediction", "target",
))  # fmt: skip
_VALUES_OF: Final = ("DeepQAgent._next_value", "DeepQAgent._learn_from")  # functions whose `values` are such, too


def in_points_of_reward(line: Line, scale: float) -> Line:
    """Return a line of the agent's code with its rewards and values in points, as all else on the screen has them."""

    def shown(name: str, value: Value) -> Value:
        rewards = name in _REWARDS or (name == "values" and line.function in _VALUES_OF)
        if not rewards or value.case is None:
            return value
        return replace(value, case=np.asarray(value.case, float) / scale)

    return replace(line, values={name: shown(name, value) for name, value in line.values.items()})


class CodeWalk:
    """Walk through the lines that ran for one frame, those of its functions.

    Where there are none, its first function is shown, with no line lit. The walk begins at the last line that sets the
    frame's `begin`, a variable as it is recorded.

    Attributes:
        lines: the lines, in the order in which they ran.
        index: number of the current one.

    """

    def __init__(self, lines: Iterable[Line], frame: Frame) -> None:
        self._functions = {function.__qualname__: function for function in frame.functions}
        self.lines = tuple(line for line in lines if line.function in self._functions)
        # Without such a line, begin where numbers are set, past the head of the function.
        sets = [place for place, line in enumerate(self.lines[:-1]) if place and line.values]
        named = (place for place in reversed(sets) if frame.begin in self.lines[place].values)
        self.index = next(named, next(iter(sets), 0))
        self._cache = PaintCache()

    @property
    def line(self) -> Line | None:
        """The current line; None where no line was recorded."""
        return self.lines[self.index] if self.lines else None

    @property
    def source(self) -> Source | None:
        """Source of the current line's function; None where the program was installed without it."""
        return source_of(self._functions[self.line.function] if self.line else next(iter(self._functions.values())))

    def describe(self, column: Column) -> None:
        """Add the listing, what goes from line to line, and what the line sets."""
        last = len(self.lines) - 1
        if self.source is None:
            column.aside(texts.LESSON_NO_SOURCE)
        column.picture(_LISTING, self._draw_listing)
        if last > 0:
            column.slider(
                texts.LESSON_LINE, self.index, (0, last), self._go, step=1,
                figure=lambda value: texts.LESSON_LINE_OF.format(number=round(value) + 1, count=last + 1),
            )  # fmt: skip
        column.add(self._write_values)

    def _go(self, index: float) -> None:
        self.index = round(index)

    def _draw_listing(self, canvas: Canvas, box: pygame.FRect) -> None:
        if source := self.source:
            number, sheet = self.line.number if self.line else None, (0, 0, *box.size)
            self._cache.draw(
                canvas, box, self.index,
                lambda picture: draw_listing(picture, sheet, source, number, dict(self._notes(source))),
            )  # fmt: skip

    def _notes(self, source: Source) -> Iterator[tuple[int, str]]:
        """Yield what the lines of this call have set so far, by their numbers, the last of a loop last."""
        call = []
        for line in reversed(self.lines[: self.index + 1]):
            if self.line is None or line.function != self.line.function:
                continue
            if line.number == source.lines[0][0]:
                break  # the head of the call
            call.append(line)
        return ((line.number, _note(list(line.values.values()))) for line in reversed(call) if line.values)

    def _write_values(self, cursor: Cursor) -> None:
        """Write the name and the shape of what the current line has set, and the numbers of this case."""
        if self.line is None:
            return
        cursor.aside(texts.LESSON_SETS if self.line.values else texts.LESSON_SETS_NOTHING)
        values = list(self.line.values.values())
        for value in values[:_MOST]:
            top, row = cursor.y, cursor.in_style(CAPTION, INK, "code")
            name = f"{value.name}  {shape_of(value)}".rstrip()
            room = cursor.width - row.measured(name) - 40
            cases = (case_of(value, few) for few in range(_FEW, 0, -1))
            row.pair(name, next((case for case in cases if row.measured(case) <= room), case_of(value, 1)), NET)
            cursor.y = row.y + 2
            if cursor.canvas and value.case is not None:
                box = (cursor.left, top, cursor.width, cursor.y - top)
                cursor.canvas.explain(box, value.name, partial(_numbers, value))
        if len(values) > _MOST:
            cursor.aside(texts.LESSON_MORE.format(count=len(values) - _MOST))


def _numbers(value: Value) -> str:
    """Return the numbers of a value: all of a few, of many the largest, with their places."""
    numbers = np.asarray(value.case).ravel()
    sizes = np.abs(np.nan_to_num(numbers.astype(float)))
    shown = np.sort(np.argsort(-sizes, kind="stable")[:_LISTED]).tolist()
    rows = told(*((f"[{index}]", number(float(numbers[index]))) for index in shown))
    some = texts.LESSON_LARGEST.format(shown=len(shown), count=len(numbers))
    return rows if len(shown) == len(numbers) else f"{some}\n{rows}"


def shape_of(value: Value) -> str:
    """Write the shape of an array: 256 × 9; nothing for a number."""
    return " × ".join(map(str, value.shape))


def _note(values: list[Value]) -> str:
    """Write the first of some values: this case's number, or the shape of an array that has several for it."""
    first = values[0]
    note = case_of(first) if np.size(first.case) == 1 and first.case is not None else shape_of(first)
    return note if len(values) == 1 else f"{note} ..."


def case_of(value: Value, few: int = _FEW) -> str:
    """Write this case's numbers of a value, the first few of many."""
    if value.case is None:
        return ""
    if isinstance(value.case, bool | np.bool_):
        return str(bool(value.case))
    numbers = np.asarray(value.case).ravel()
    shown = " ".join(str(each) if isinstance(each, int) else number(each) for each in numbers[:few].tolist())
    return shown if len(numbers) <= few else f"{shown} ..."
