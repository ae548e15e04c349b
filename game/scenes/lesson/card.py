"""Card of a lesson: a sentence, and rows with numbers that explain themselves; and the code beside it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Final

import numpy as np

from ai.explain.learning_step import Value
from ai.explain.recorder import Function, Line
from game.core import texts
from game.core.source import Source, source_of
from game.drawing.canvas import Point
from game.explain.code_listing import add_listing
from game.explain.figures import number
from game.ui.panel import Column


class Card:
    """One of the cards of a lesson; what has a state of its own is a subclass.

    Attributes:
        name: its name.
        sentence: what happens here: the field's term, then plain words for it.
        function: the one whose lines are shown beside it.
        begin: variable that the line sets which is lit at first; empty for any.

    """

    def __init__(
        self,
        name: str,
        sentence: str,
        function: Function,
        begin: str = "",
        describe: Callable[[Column], None] = lambda _: None,
    ) -> None:
        self.name, self.sentence, self.function, self.begin, self._describe = name, sentence, function, begin, describe

    def describe(self, column: Column) -> None:
        """Add the rows."""
        self._describe(column)

    def point(self, place: Point | None) -> None:
        """Follow the pointer, in points; None while it is nowhere."""

    def update(self, still: bool) -> None:
        """Advance by 1/60 s while it is shown; `still` with reduced motion."""


_LISTING: Final = 300.0  # height
_FEW: Final = 4  # numbers of an array that are written out, at most


class LitCode:
    """The code of one card: the lines that ran of its function, and the one that made what the card shows.

    Attributes:
        line: the lit line, the last that set the card's `begin`, a variable as it is recorded; None where none ran.
        source: of the function; None where the program was installed without it.

    """

    def __init__(self, lines: Iterable[Line], card: Card) -> None:
        ran = [line for line in lines if line.function == card.function.__qualname__]
        # Without such a line, it is where numbers are set first, past the head of the function.
        sets = [place for place, line in enumerate(ran[:-1]) if place and line.values]
        named = (place for place in reversed(sets) if card.begin in ran[place].values)
        index = next(named, next(iter(sets), 0))
        self.line, self.source = ran[index] if ran else None, source_of(card.function)
        self._before = ran[: index + 1]

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
            if line.number == source.lines[0][0]:
                break  # the head of the call
            if line.values:
                notes.setdefault(line.number, _note(list(line.values.values())))
        return source, self.line.number if self.line else None, notes


def _note(values: list[Value]) -> str:
    """Write the first of some values: this case's numbers, or the shape of an array that has many for it: 256 × 9."""
    first, more = values[0], " ..." * (len(values) > 1)
    few = first.case is not None and np.size(first.case) <= _FEW
    return (case_of(first) if few else " × ".join(map(str, first.shape))) + more


def case_of(value: Value) -> str:
    """Write this case's numbers of a value."""
    if isinstance(value.case, bool | np.bool_):
        return str(bool(value.case))
    return " ".join(str(each) if isinstance(each, int) else number(each) for each in np.ravel(value.case).tolist())
