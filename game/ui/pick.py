"""Choice in a row of words that can also be made from a full list."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import pygame

from game.core.scene import Transition
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import SMALL
from game.ui.widget import OnPress, PointsManager
from game.ui.widgets import Choice
from game.ui.words import TextButtonRow

_GAP: Final = 20.0  # points between the row and the word that opens the list


class ChoiceOrList(Choice):
    """Choice that can also be made from a list: Enter, a gamepad's A or a click on `all_word` calls `on_open`.

    The word is shown at the right end if not all options fit into the row.
    """

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        label: str,
        options: Sequence[str],
        index: int,
        on_change: Callable[[int], None],
        on_open: OnPress,
        all_word: str,
        *,
        label_width: float = 0,
        size: float = SMALL,
    ) -> None:
        super().__init__(manager, box, label, options, index, on_change, label_width=label_width, size=size)
        self._on_open, self._all_word = on_open, all_word
        self._open_left = float(self.box.right)
        if len(self.row.pages) > 1:
            self._open_left -= typeface.width(all_word, size, "regular")
            self.row = TextButtonRow(options, self.box.left + label_width, self._open_left - _GAP, size)

    def press(self) -> Transition | None:
        x = self.mouse_x
        return self._on_open() if x is None or x >= self._open_left - 4 else super().press()

    def paint(self, canvas: Canvas) -> None:
        super().paint(canvas)
        if len(self.row.pages) > 1:
            baseline = self.box.centery + 0.36 * self._size
            canvas.text(self._all_word, (self._open_left, baseline), size=self._size, colour=self.tint())
