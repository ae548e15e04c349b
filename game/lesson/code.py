"""Our own code beside a frame: the lines that ran for it, one of them lit, with the values that it set below."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
import pygame

from ai.explain.learning_step import Value
from ai.explain.recorder import Function, Line
from game.core import texts
from game.core.source import Source, source_of
from game.drawing import typeface
from game.drawing.canvas import Canvas, Point
from game.drawing.paint_cache import PaintCache
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import INK, LABEL, LINE, MUTE, NET
from game.lesson.frame import WITHIN
from game.panels.code_listing import draw_listing
from game.panels.figures import number
from game.ui.tooltip import TooltipRow, draw_tooltip

CODE: Final = pygame.Rect(824, 216, 416, 448)
_HEAD: Final = 12.0  # baseline of the heading
_LISTING: Final = 24.0
_VALUES: Final = 308.0  # below the corner of the box
_ROW: Final = 18.0
_MOST: Final = 6  # values of a line that are shown
_LISTED: Final = 12  # numbers of a value that are listed under the pointer
_NAME, _SHAPE, _APART = 200.0, 110.0, 16.0  # points of a name and a shape at most, and between columns
_FEW: Final = 6  # numbers of an array that are written out


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
    """Walk through the lines that ran for one frame.

    Of the lines that ran, those of `functions` are walked through; where there are none, the first function is shown,
    with no line lit. The walk begins at the last line that sets `begin`, a variable as it is recorded.

    Attributes:
        lines: the lines, in the order in which they ran.
        index: number of the current one.
        pointed: the value that is pointed at, and where to explain it.

    """

    def __init__(
        self,
        lines: Iterable[Line],
        functions: Sequence[Function],
        begin: str = "",
    ) -> None:
        self._functions = {function.__qualname__: function for function in functions}
        self.lines = tuple(line for line in lines if line.function in self._functions)
        # Without such a line, begin where numbers are set, past the head of the function.
        sets = [number for number, line in enumerate(self.lines[:-1]) if number and line.values]
        named = (number for number in reversed(sets) if begin in self.lines[number].values)
        self.index = next(named, next(iter(sets), 0))
        self.pointed: tuple[Value, Point] | None = None
        self._cache = PaintCache()

    @property
    def line(self) -> Line | None:
        """The current line; None where no line was recorded."""
        return self.lines[self.index] if self.lines else None

    @property
    def source(self) -> Source | None:
        """Source of the current line's function; None where the program was installed without it."""
        return source_of(self._functions[self.line.function] if self.line else next(iter(self._functions.values())))

    def step(self, direction: int) -> None:
        """Go to the line before or after."""
        self.index = min(max(self.index + direction, 0), max(len(self.lines) - 1, 0))
        self.pointed = None

    def follow(self, point: Point | None) -> None:
        """Point at a place of the view; None for none."""
        self.pointed = None
        values = _values(self.line)[:_MOST] if self.line else []
        for row, value in enumerate(values):
            box = pygame.FRect(CODE.left, CODE.top + _VALUES + _ROW * row + 17, CODE.width, _ROW)
            if point is not None and box.collidepoint(point) and value.case is not None:
                self.pointed = value, (box.left + 90, box.centery)

    def draw_explanation(self, canvas: Canvas) -> None:
        """Draw the numbers of the value that is pointed at: all of a few, of many the largest, with their places."""
        if self.pointed is None:
            return
        value, place = self.pointed
        numbers = np.asarray(value.case).ravel()
        sizes = np.abs(np.nan_to_num(numbers.astype(float)))
        shown = np.sort(np.argsort(-sizes, kind="stable")[:_LISTED]).tolist()
        rows = [TooltipRow(f"[{index}]", number(float(numbers[index]))) for index in shown]
        some = texts.LESSON_LARGEST.format(shown=len(shown), count=len(numbers))
        lines = (value.name,) if len(shown) == len(numbers) else (value.name, some)
        draw_tooltip(canvas, place, WITHIN, lines, rows)

    def draw(self, canvas: Canvas) -> None:
        """Draw the listing and the values."""
        self._cache.draw(canvas, CODE, self.index, self._paint)

    def _paint(self, sheet: Canvas) -> None:
        sheet.text(texts.LESSON_CODE, (0, _HEAD), size=LABEL, colour=MUTE, room=220)
        source, line = self.source, self.line
        if self.lines:
            place = texts.LESSON_LINE.format(number=self.index + 1, count=len(self.lines))
            sheet.text(place, (CODE.width, _HEAD), size=LABEL, colour=MUTE, align="right", tabular=True, room=180)
        if source is None:
            draw_wrapped(sheet, texts.LESSON_NO_SOURCE, (0, _LISTING + 20), CODE.width, colour=MUTE, size=LABEL)
        else:
            box = (0, _LISTING, CODE.width, (_VALUES if self.lines else CODE.height) - _LISTING - 14)
            draw_listing(sheet, box, source, line.number if line else None, self._notes(source))
        if line:
            self._paint_values(sheet, line)

    def _notes(self, source: Source) -> dict[int, str]:
        """Return what the lines of this call have set so far, by their numbers: shapes, or numbers of this case."""
        notes: dict[int, str] = {}
        for line in reversed(self.lines[: self.index + 1]):
            if not self.line or line.function != self.line.function:
                continue
            if line.number == source.lines[0][0]:
                break  # the head of the call
            if line.values:
                notes.setdefault(line.number, _note(_values(line)))
        return notes

    def _paint_values(self, sheet: Canvas, line: Line) -> None:
        """Write the name, the shape and the numbers of what the current line has set."""
        sheet.line((0, _VALUES - 8), (CODE.width, _VALUES - 8), LINE)
        words = texts.LESSON_SETS if line.values else texts.LESSON_SETS_NOTHING
        sheet.text(words, (0, _VALUES + 10), size=LABEL, colour=MUTE, room=CODE.width)
        values = _values(line)[:_MOST]
        names = min(max((typeface.width(each.name, LABEL, "code") for each in values), default=0.0), _NAME)
        for row, value in enumerate(values):
            y = _VALUES + 12 + _ROW * (row + 1)
            sheet.text(value.name, (0, y), size=LABEL, weight="code", colour=INK, room=names)
            left = names + _APART
            if shape := shape_of(value):
                left = sheet.text(shape, (left, y), size=LABEL, colour=MUTE, room=_SHAPE).right + _APART
            room = CODE.width - left
            fits = (case_of(value, few) for few in range(_FEW, 1, -1))
            case = next((text for text in fits if typeface.width(text, LABEL, "code") <= room), case_of(value, 1))
            right = (CODE.width, y)
            sheet.text(case, right, size=LABEL, weight="code", colour=NET, align="right", room=room)
        more = len(line.values) - _MOST
        if more > 0:
            y = _VALUES + 12 + _ROW * (_MOST + 1)
            sheet.text(texts.LESSON_MORE.format(count=more), (0, y), size=LABEL, colour=MUTE, room=CODE.width)


def _values(line: Line) -> list[Value]:
    return list(line.values.values())


def shape_of(value: Value) -> str:
    """Write the shape of an array: 256 × 9; nothing for a number."""
    return " × ".join(map(str, value.shape))


def _note(values: Sequence[Value]) -> str:
    """Write the first of some values: this case's number, or the shape of an array that has several for it."""
    note = case_of(values[0]) if np.size(values[0].case) == 1 and values[0].case is not None else shape_of(values[0])
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
