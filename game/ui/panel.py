"""Panel: rows, one below the other, that lay themselves out and know where they stand.

A row is whatever writes with a cursor: words, a figure, a bar, a widget, columns side by side. A panel lays its rows
out in every step, for whatever they say, the window's size and the size of text; it scrolls where they are higher than
the room that there is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Concatenate, Final, ParamSpec, TypeVar

import pygame

from game.drawing.cursor import Cursor
from game.drawing.tokens import FAINT, INK, MUTE, NET, SMALL, STEP, TEXT, Colour
from game.drawing.typeface import Weight
from game.ui.entry import EntryRow
from game.ui.listing import ListRow
from game.ui.rows import ButtonRow, ChoiceRow, SliderRow, ToggleRow, Words, said
from game.ui.widget import RowWidget, Widget

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas, Now
    from game.ui.form import Form
    from game.ui.widget import OnPress

W = TypeVar("W", bound=RowWidget)
F = TypeVar("F", bound=ButtonRow | ChoiceRow)
P = ParamSpec("P")
Write = Callable[[Cursor], object]
_ABOVE: Final = 24.0  # points kept above and below the widget in focus while the panel scrolls
_WORDS: Final = 28.0  # points between two words side by side
_LOW: Final = 5.0  # points above and below words side by side
_WHEEL: Final = 48.0  # points for one notch of the mouse's wheel


@dataclass
class Row:
    """One row: what writes it, its name and present meaning for whoever asks, and where it stands, in points."""

    write: Write
    what: str = ""
    now: Now = str
    box: pygame.FRect = field(default_factory=lambda: pygame.FRect(0, 0, 0, 0))


def _adding(kind: Callable[P, W]) -> Callable[Concatenate[Column, P], W]:
    """Return a method that makes a widget of a kind, and adds it."""

    def add(column: Column, /, *given: P.args, **more: P.kwargs) -> W:
        return column.widget(kind(*given, **more))

    return add


class Column:
    """Rows that are described one after another; each call adds one, and returns its widget if it has one.

    Attributes:
        widgets: all of the panel that the column is a part of.

    """

    def __init__(self, form: Form, widgets: list[Widget]) -> None:
        self.rows: list[Row] = []
        self._form, self.widgets = form, widgets

    def add(self, write: Write, what: str = "", now: Now = str) -> Row:
        """Add a row of one's own."""
        self.rows.append(Row(write, what, now))
        return self.rows[-1]

    def explain(self, what: str) -> None:
        """Say what the last row is, for whoever asks."""
        self.rows[-1].what = what

    # Words and figures

    def title(self, words: Words, size: float = 34.0, weight: Weight = "light") -> None:
        self.text(words, size=size, weight=weight)

    def text(
        self,
        words: Words,
        *,
        size: float = TEXT,
        colour: Colour = INK,
        weight: Weight = "regular",
        tabular: bool = False,
    ) -> None:
        """Add a paragraph; `tabular` if its figures change."""
        self.add(lambda cursor: cursor.styled(said(words), size, colour, weight, tabular=tabular))

    def aside(self, words: Words) -> None:
        """Add small muted words that explain what stands above."""
        self.text(words, size=SMALL, colour=MUTE)

    def caption(self, words: str) -> None:
        self.add(lambda cursor: cursor.caption(words))

    def pair(self, words: str, figure: Words, colour: Colour | None = None) -> None:
        """Add words, and a figure at the right end."""
        self.add(lambda cursor: cursor.pair(words, said(figure), colour))

    def bar(self, share: Callable[[], float], colour: Colour = NET) -> None:
        self.add(lambda cursor: cursor.bar(share(), colour))

    def picture(self, height: float | Callable[[float], float], draw: Callable[[Canvas, pygame.FRect], None]) -> Row:
        """Add a drawing of its own, over the whole column; its height may follow from the width."""

        def write(cursor: Cursor) -> None:
            box = cursor.take(height(cursor.width) if callable(height) else height)
            if cursor.canvas:
                draw(cursor.canvas, box)

        return self.add(write)

    def gap(self, points: float = 2 * STEP) -> None:
        self.add(lambda cursor: cursor.gap(points))

    def line(self) -> None:
        self.add(Cursor.line)

    # Widgets

    def widget(self, widget: W) -> W:
        """Add a widget, as the next one of the form."""
        self.add(widget.lay)
        return self._take(widget)

    def _take(self, widget: W) -> W:
        self.widgets.append(widget)
        return self._form.add(widget)

    button, toggle, choice = _adding(ButtonRow), _adding(ToggleRow), _adding(ChoiceRow)
    slider, entry, listing = _adding(SliderRow), _adding(EntryRow), _adding(ListRow)

    def words(self, words: Sequence[tuple[str, OnPress]], size: float = TEXT, colour: Colour = MUTE) -> list[ButtonRow]:
        """Add words to press, side by side on as many lines as they need."""
        return self.flow([ButtonRow(label, press, size=size, colour=colour) for label, press in words])

    def flow(self, widgets: Sequence[F]) -> list[F]:
        """Add widgets side by side, each as wide as its words, on as many lines as they need."""
        added = [self._take(widget) for widget in widgets]
        for widget in added:
            widget.pad = _LOW
        self.add(partial(_write_words, added))
        return added

    # Columns

    def beside(self, shares: Sequence[float], least: float, apart: float = 64.0) -> list[Column]:
        """Add columns side by side, each as wide as its share; below each other where one would lack `least`."""
        columns = [Column(self._form, self.widgets) for _ in shares]
        self.add(lambda cursor: cursor.beside([column.write for column in columns], shares, least, apart))
        return columns

    def write(self, cursor: Cursor) -> None:
        """Write the rows, or lay them out."""
        for row in self.rows:
            top, seen = cursor.y, cursor.seen
            if cursor.canvas and seen and (row.box.bottom < seen.top or row.box.top > seen.bottom):
                cursor.y += row.box.height
                continue
            row.write(cursor)
            if cursor.canvas is None:
                row.box = pygame.FRect(cursor.left, top, cursor.width, cursor.y - top)
            elif row.what:
                cursor.canvas.explain(row.box, row.what, row.now)


class Panel(Column):
    """Column that knows its room on the screen, and scrolls.

    Args:
        form: gets its widgets.
        before: the panel in whose place it comes; what was seen of that stays in sight.

    Attributes:
        box: its room, in points.
        height: of all rows, in points.
        scrolled: how far it is scrolled down, in points.

    """

    def __init__(self, form: Form, before: Panel | None = None) -> None:
        super().__init__(form, [])
        self.box = pygame.FRect(0, 0, 0, 0)
        self.height = self.scrolled = 0.0
        self._shown = ""  # key of the widget that was in focus when it was last laid out
        if before:
            self.box, self.scrolled, self._shown = before.box, before.scrolled, before._shown

    @property
    def overflows(self) -> bool:
        """Whether not all rows are seen at once."""
        return self.height > self.box.height + 1

    def lay_out(self, box: pygame.FRect, scale: float) -> None:
        same, self.box = box == self.box, box
        self._measure(scale)
        focused = self._form.focused if self._form.focused in self.widgets else None
        shown = focused.key if focused else ""
        if shown != self._shown or not same:
            self._shown = shown
            if focused and self.overflows and not self._form.controls.mouse_in_use:  # nothing moves below the mouse
                self._reveal(pygame.FRect(focused.box), focused)
                self._measure(scale)
        self.scroll(0.0)

    def _measure(self, scale: float) -> None:
        cursor = self._cursor(scale)
        self.write(cursor)
        self.height = cursor.y + self.scrolled - self.box.top

    def _cursor(self, scale: float, canvas: Canvas | None = None) -> Cursor:
        box = self.box
        return Cursor(box.left, box.top - self.scrolled, box.width, scale, canvas, pygame.FRect(box))

    def _reveal(self, widget: pygame.FRect, which: Widget) -> None:
        if which is self.widgets[0]:
            self.scrolled = 0.0  # with what stands above it
        elif which is self.widgets[-1]:
            self.scrolled = min(self.height, self.scrolled + widget.top - self.box.top - _ABOVE)  # with what is below
        elif widget.top < self.box.top + _ABOVE:
            self.scrolled += widget.top - self.box.top - _ABOVE
        elif widget.bottom > self.box.bottom - _ABOVE:
            self.scrolled += min(widget.bottom - self.box.bottom + _ABOVE, widget.top - self.box.top)
        self.scroll(0.0)

    def scroll(self, points: float) -> bool:
        before = self.scrolled
        self.scrolled = min(max(before + points, 0.0), max(0.0, self.height - self.box.height))
        return self.scrolled != before

    def turn_wheel(self, notches: float) -> bool:
        """Scroll by the mouse's wheel; up is positive."""
        return self.scroll(-_WHEEL * notches)

    def draw(self, canvas: Canvas) -> None:
        if not self.overflows:
            self.write(replace(self._cursor(canvas.scale, canvas), seen=None))
            return
        # Rings around widgets at its sides are seen.
        with canvas.clipped((0, self.box.top, canvas.view.width, self.box.height)):
            self.write(self._cursor(canvas.scale, canvas))
        share = self.box.height / self.height
        top = self.box.top + self.box.height * self.scrolled / self.height
        right = self.box.right + 12
        canvas.pill((right, self.box.top, 3, self.box.height), FAINT, 0.4)
        canvas.pill((right, top, 3, self.box.height * share), MUTE)


def _write_words(widgets: Sequence[ButtonRow | ChoiceRow], cursor: Cursor) -> None:
    left, below = cursor.left, cursor.y
    for widget in widgets:
        width = min(widget.measured(cursor), cursor.width)
        if left > cursor.left and left + width > cursor.right:
            left, cursor.y = cursor.left, below
        place = cursor.column(left, width)
        widget.lay(place)
        if cursor.canvas and widget.what:
            cursor.canvas.explain(widget.box, widget.what)
        left, below = left + width + _WORDS, max(below, place.y)
    cursor.y = below
