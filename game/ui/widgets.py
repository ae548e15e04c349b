"""Words and choices with a place of their own, for screens over a world; rows of panels are in `game.ui.rows`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import pygame

from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, INK, MUTE, NET, TEXT, Colour
from game.drawing.typeface import Weight
from game.ui.widget import OnPress, PointsManager, Widget, mix
from game.ui.words import GAP as CHOICE_GAP
from game.ui.words import TextButtonRow

_SWITCH: Final = 46  # points that a switch takes of its box


class TextButton(Widget):
    """Text button; a short line under the word shows the focus."""

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        label: str,
        on_press: OnPress,
        *,
        size: float = TEXT,
        weight: Weight = "regular",
        colour: Colour = MUTE,
    ) -> None:
        super().__init__(manager, box, label)
        self._on_press, self._size, self._weight, self._colour = on_press, size, weight, colour

    @property
    def baseline(self) -> float:
        """The y of the word's baseline, in points."""
        return self.box.centery + 0.36 * self._size

    def press(self) -> Transition | None:
        return self._on_press()

    def tint(self) -> Colour:
        return mix(self._colour, INK, self.warmth)

    def paint(self, canvas: Canvas) -> None:
        left, baseline = self.box.left, self.baseline
        box = canvas.text(
            self.label, (left, baseline), size=self._size, weight=self._weight, colour=self.tint(), room=self.box.width
        )
        length = box.width * self.warmth
        if length > 1:
            y = baseline + 0.42 * self._size
            canvas.line((left, y), (left + length, y), NET, 2, self.warmth)


class Choice(Widget):
    """Choice of one word in a row, with a line under the chosen one.

    Words that do not fit into the box go on further pages, one of which is shown at a time, between arrows.
    """

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        label: str,
        options: Sequence[str],
        index: int,
        on_change: Callable[[int], None],
        *,
        label_width: float = 0,
        size: float = TEXT,
        gap: float = CHOICE_GAP,
    ) -> None:
        super().__init__(manager, box, label)
        self.options, self.index, self._on_change, self._size = options, index, on_change, size
        self._label_room = max(label_width - 10, 0)
        self.row = TextButtonRow(options, self.box.left + label_width, self.box.right, size, gap)

    def choose(self, index: int) -> None:
        """Choose an option by its number."""
        index = min(max(index, 0), len(self.options) - 1)
        if index != self.index:
            self.index = index
            self._on_change(index)

    def press(self) -> Transition | None:
        self.choose(self.row.pressed(self.mouse_x, self.index))
        return None

    def shift(self, direction: int) -> bool:
        before = self.index
        self.choose(self.index + direction)
        return self.index != before

    def paint(self, canvas: Canvas) -> None:
        super().paint(canvas)
        baseline = self.box.centery + 0.36 * self._size
        canvas.text(self.label, (self.box.left, baseline), size=self._size, colour=self.tint(), room=self._label_room)
        self.row.paint(canvas, baseline, self.index)


def draw_switch(canvas: Canvas, rect: tuple[float, float, float, float], slid: float, colour: Colour = NET) -> None:
    """Draw a switch; `slid` is the position of its knob, from 0, off, to 1, on."""
    left, top, width, height = rect
    canvas.pill(rect, mix(FAINT, colour, slid))
    half = height / 2
    canvas.dot((left + half + (width - height) * slid, top + half), half - 2.5, INK)
