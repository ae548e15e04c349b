"""Base of the scenes with a list on the left and, on the right, the item chosen in it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Generic, TypeVar

import pygame

from game.core import texts
from game.core.scene import Pop, Transition
from game.drawing.canvas import Canvas
from game.drawing.sky import NightSky
from game.drawing.tokens import LABEL, LINE, MARGIN, MUTE, SMALL, TEXT
from game.ui.actions import Table
from game.ui.context import Context
from game.ui.form_scene import FormScene
from game.ui.listing import Listing, Row, shortened
from game.ui.widget import OnPress, Widget
from game.ui.widgets import TextButton

Item = TypeVar("Item")

VERB_LINE: Final = 36.0  # points from one button to the next
VERB_SIZE: Final = 18.0
_LINE_ROOM: Final = 700.0


@dataclass(frozen=True)
class ListLayout:
    """Where the parts of such a scene are, in points.

    Attributes:
        box: the list.
        columns: how far from the list's right end each cell after the first ends.
        headings: returns the heading of each column, the first included.
        pitch: height of a row.
        verbs: left end and top of the first button for the chosen item.
        foot: top of the button that goes back.
        size: size of a row's first cell.
        rise: height of the headings above the list.
        numbered: width of a column of the rows' numbers; 0 for none.

    """

    box: pygame.Rect
    columns: tuple[float, ...]
    headings: Callable[[], Sequence[str]]
    pitch: float
    verbs: tuple[float, float]
    foot: float
    size: float = TEXT
    rise: float = 14.0
    numbered: float = 0.0


class ListScene(FormScene, ABC, Generic[Item]):
    """List on the left; on the right the chosen item, and buttons for what can be done with it.

    A subclass says what there is (`_reload`, which ends in `_show`), what a row says of an item, and what can be done
    with the chosen one. It calls `_reload` at the end of its constructor.

    Attributes:
        items: what the list shows, in its order.

    """

    def __init__(
        self, context: Context, title: str, layout: ListLayout, on_back: OnPress = Pop, empty: str = ""
    ) -> None:
        super().__init__(context, on_back)
        self._title, self._layout, self._line = title, layout, ""
        self._sky = NightSky(context.rng, ember=0.5, stars=70)
        manager = self.form.manager
        self._list = self.form.add(Listing(
            manager, layout.box, [], on_choose=lambda _: self._choose_row(), on_press=lambda _: self._press_row(),
            empty=empty, columns=layout.columns, pitch=layout.pitch, size=layout.size,
            numbered=layout.numbered,
        ))  # fmt: skip
        self._back_button = TextButton(
            manager, (MARGIN, layout.foot, 72, VERB_LINE), texts.BACK, on_back, size=VERB_SIZE
        )
        self.items: list[Item] = []
        self._verbs: list[Widget] = []
        self._beside: list[Widget] = []  # the verbs, and what is below the list

    def enter(self) -> None:
        """Read again what there is, which the scene above may have changed."""
        self._reload()

    def actions(self) -> Table:
        """Move, choose, go back."""
        return [self.form.moves, *super().actions()]

    @property
    def chosen(self) -> Item | None:
        """The chosen item; None if there is none."""
        return self.items[self._list.index] if self.items else None

    # What a subclass says

    @abstractmethod
    def _reload(self) -> None:
        """Read what there is and `_show` it, with the chosen item as before."""

    @abstractmethod
    def _row(self, item: Item) -> Row:
        """Return the cells of an item's row."""

    @abstractmethod
    def _make_verbs(self) -> list[Widget]:
        """Return the widgets for what can be done with the chosen item."""

    def _identity(self, item: Item) -> object:
        """Return what stays the same of an item when it is read again."""
        return item

    def _choose_row(self) -> None:
        """Take note that another item has been chosen."""
        self._offer()

    @abstractmethod
    def _press_row(self) -> Transition | None:
        """Answer a press on the chosen row."""

    def _below_list(self) -> list[Widget]:
        """Return the widgets below the list."""
        return [self._back_button]

    def _draw_behind(self, canvas: Canvas) -> None:
        """Draw what is behind the widgets."""

    @abstractmethod
    def _draw_chosen(self, canvas: Canvas) -> None:
        """Draw what there is to say of the chosen item."""

    # What they share

    def _show(self, items: Sequence[Item], wanted: object, otherwise: int = 0) -> None:
        """List the items, and choose the one with an identity; if there is none, the one at an index."""
        self.items = list(items)
        identities = [self._identity(item) for item in items]
        index = identities.index(wanted) if wanted in identities else otherwise
        self._list.set_rows([self._row(item) for item in items], index)
        self._offer()

    def _offer(self) -> None:
        """Offer what can be done now."""
        self._verbs = self._make_verbs()
        new = [*self._verbs, *self._below_list()]
        self.form.replace(self._beside, new)
        self._beside = new

    def _buttons(self, rows: Sequence[tuple[str, OnPress]]) -> list[Widget]:
        """Return a column of buttons for the chosen item, given their labels and actions."""
        left, top = self._layout.verbs
        return [
            TextButton(
                self.form.manager, (left, top + number * VERB_LINE, 220, VERB_LINE), label, press, size=VERB_SIZE
            )
            for number, (label, press) in enumerate(rows)
        ]

    def _report(self, note: str) -> None:
        """Tell the player what has been done to an item, and show the list as it is now."""
        self.context.note(note)
        self._reload()
        self.form.focus(self._list)

    def draw(self, canvas: Canvas, alpha: float) -> None:  # noqa: ARG002
        """Draw the list, and the chosen item beside it."""
        self._sky.draw(canvas)
        canvas.text(self._title, (MARGIN, 84), size=34, weight="light")
        line = shortened(canvas, self._line, SMALL, _LINE_ROOM)
        canvas.text(line, (MARGIN, 110), size=SMALL, colour=MUTE, room=_LINE_ROOM)
        self._draw_headings(canvas)
        self._draw_behind(canvas)
        self.form.draw(canvas)
        self._draw_chosen(canvas)
        self.draw_hints(canvas)

    def _draw_headings(self, canvas: Canvas) -> None:
        box, right, y = self._layout.box, self._list.right, self._layout.box.top - self._layout.rise
        name, *others = self._layout.headings()
        canvas.text(name, (box.left, y), size=LABEL, weight="medium", colour=MUTE)
        for label, column in zip(others, self._layout.columns, strict=True):
            canvas.text(label, (right - column, y), size=LABEL, weight="medium", colour=MUTE, align="right")
        canvas.line((box.left, box.top), (right, box.top), LINE)
