"""Frame of a lesson: a heading, a sentence, and rows with numbers of the step, each of which explains itself."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ai.explain.recorder import Function
from game.core import texts
from game.panels.figures import points

if TYPE_CHECKING:
    from game.drawing.canvas import Point
    from game.ui.panel import Column


class Frame:
    """One of the frames of a lesson; a subclass adds its rows.

    Attributes:
        name: its name, on its card.
        sentence: the field's term for what happens here, then plain words for it.
        figure: the one figure that stands for it on its card.
        functions: the functions whose lines are shown beside it.
        begin: variable that the line sets which is lit at first; empty for any.

    """

    def __init__(
        self, words: Sequence[str], figure: str, functions: Sequence[Function], begin: str = "", sentence: str = ""
    ) -> None:
        self.name, self.sentence = words[0], sentence or words[1]
        self.figure, self.functions, self.begin = figure, tuple(functions), begin

    def describe(self, column: Column) -> None:
        """Add the rows."""

    def point(self, place: Point | None) -> None:
        """Follow the pointer, in points; None while it is nowhere."""

    def update(self, still: bool) -> None:
        """Advance by 1/60 s; `still` with reduced motion."""


def in_points(value: float) -> str:
    """Write a number of points with its unit."""
    return texts.LESSON_POINTS.format(points=points(value))
