"""Card of a lesson: a sentence, and rows with numbers that explain themselves; and the code beside it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from ai.explain.learning_step import Value
from ai.explain.recorder import Function, Line
from game.core import texts
from game.core.source import Source, source_of
from game.drawing.canvas import Point
from game.explain.code_listing import add_listing
from game.explain.figures import number, points, signed
from game.ui.panel import Column


class Card:
    """One of the cards of a lesson; what has a state of its own is a subclass.

    Attributes:
        name: its name.
        sentence: what happens here: the field's term, then plain words for it.
        figure: the one figure that stands for it.
        functions: the functions whose lines are shown beside it.
        begin: variable that the line sets which is lit at first; empty for any.
        changed: set when there are other rows than before; the scene describes them anew.

    """

    def __init__(
        self,
        name: str,
        sentence: str,
        figure: str,
        functions: Sequence[Function],
        begin: str = "",
        describe: Callable[[Column], None] | None = None,
    ) -> None:
        self.name, self.sentence, self.figure, self._describe = name, sentence, figure, describe
        self.functions, self.begin, self.changed = tuple(functions), begin, False

    def describe(self, column: Column) -> None:
        """Add the rows."""
        if self._describe:
            self._describe(column)

    def point(self, place: Point | None) -> None:
        """Follow the pointer, in points; None while it is nowhere."""

    def update(self, still: bool) -> None:
        """Advance by 1/60 s while it is shown; `still` with reduced motion."""


def in_points(value: float) -> str:
    """Write a number of points with its unit."""
    return texts.LESSON_POINTS.format(points=points(value))


def pulled(value: float) -> str:
    """Write how far something moved a value, in points, with digits that tell it from 0."""
    return points(value) if abs(value) >= 0.1 else signed(value)


_LISTING: Final = 300.0  # height
_FEW: Final = 4  # numbers of an array that are written out, at most
# Variables of the agent's code that are rewards, values or differences of these.
_REWARDS: Final = frozenset((
    "reward", "transitions.reward", "return.0.reward", "self._returns", "value", "targets", "errors", "chosen",
    "predicted", "prediction", "target",
))  # fmt: skip
_VALUES_OF: Final = ("DeepQAgent._next_value", "DeepQAgent._learn_from")  # functions whose `values` are such, too


def in_points_of_reward(line: Line, scale: float) -> Line:
    """Return a line of the agent's code with its rewards and values in points, as all else on the screen has them."""
    names = _REWARDS | {"values"} if line.function in _VALUES_OF else _REWARDS
    return replace(line, values={
        name: replace(value, case=np.asarray(value.case, float) / scale)
        if name in names and value.case is not None else value
        for name, value in line.values.items()
    })  # fmt: skip


class LitCode:
    """The code of one card: the lines that ran of its functions, and the one that made what the card shows.

    Where none ran, its first function is shown, with no line lit.

    Attributes:
        line: the lit line, the last that set the card's `begin`, a variable as it is recorded; None where none ran.

    """

    def __init__(self, lines: Iterable[Line], card: Card) -> None:
        self._functions = {function.__qualname__: function for function in card.functions}
        ran = [line for line in lines if line.function in self._functions]
        # Without such a line, it is where numbers are set first, past the head of the function.
        sets = [place for place, line in enumerate(ran[:-1]) if place and line.values]
        named = (place for place in reversed(sets) if card.begin in ran[place].values)
        index = next(named, next(iter(sets), 0))
        self.line = ran[index] if ran else None
        self._before = ran[: index + 1]

    @property
    def source(self) -> Source | None:
        """Source of the lit line's function; None where the program was installed without it."""
        return source_of(self._functions[self.line.function] if self.line else next(iter(self._functions.values())))

    def describe(self, column: Column) -> None:
        """Add the listing."""
        if self.source is None:
            column.aside(texts.LESSON_NO_SOURCE)
        else:
            add_listing(column, _LISTING, self._shown)

    def _shown(self) -> tuple[Source, int | None, dict[int, str]]:
        """Return the source, the lit line, and beside lines what this call has set there so far, in a loop the last."""
        source, notes = self.source, dict[int, str]()
        assert source is not None
        for line in reversed(self._before):
            if self.line is None or line.function != self.line.function:
                continue
            if line.number == source.lines[0][0]:
                break  # the head of the call
            if line.values:
                notes.setdefault(line.number, _note(list(line.values.values())))
        return source, self.line.number if self.line else None, notes


def shape_of(value: Value) -> str:
    """Write the shape of an array: 256 × 9; nothing for a number."""
    return " × ".join(map(str, value.shape))


def _note(values: list[Value]) -> str:
    """Write the first of some values: this case's numbers, or the shape of an array that has many for it."""
    first = values[0]
    note = case_of(first) if first.case is not None and np.size(first.case) <= _FEW else shape_of(first)
    return note if len(values) == 1 else f"{note} ..."


def case_of(value: Value) -> str:
    """Write this case's numbers of a value."""
    if isinstance(value.case, bool | np.bool_):
        return str(bool(value.case))
    return " ".join(str(each) if isinstance(each, int) else number(each) for each in np.ravel(value.case).tolist())
