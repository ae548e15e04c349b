"""Row of a network's stages, each with what the followed unit gave there; one of them is looked at."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

from ai.explain.unit_sums import Kind, Stage
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, INK, LABEL, LINE, MUTE, NET, SMALL
from game.scenes.digits.patch_sums import figure
from game.scenes.digits.unit_walk import UnitWalk
from game.ui.widget import PointsManager, Widget, mix

_DOT: Final = 30.0  # from the top of the row to the line that joins the stages
_WIDEST: Final = 130.0


class StageRow(Widget):
    """Row of stages. A click chooses one, left and right the next."""

    def __init__(
        self, manager: PointsManager, box: pygame.typing.RectLike, walk: UnitWalk, on_choose: Callable[[int], None]
    ) -> None:
        super().__init__(manager, box, "")
        self._walk, self._on_choose = walk, on_choose
        self._names = [*map(name_of, walk.stages), texts.PATCH_STAGES["answer"]]
        self.pitch = min(self.box.width / len(self._names), _WIDEST)

    @property
    def index(self) -> int:
        """Number of the stage looked at."""
        return self._walk.number

    def press(self) -> None:
        """Choose the stage under the mouse; without a mouse, the next one."""
        count, x = len(self._names), self.mouse_x
        number = (self.index + 1) % count if x is None else int((x - self.box.left) / self.pitch)
        if number < count and number != self.index:
            self._on_choose(number)

    def shift(self, direction: int) -> bool:
        """Choose the next stage; false at either end."""
        number = self.index + direction
        if not 0 <= number < len(self._names):
            return False
        self._on_choose(number)
        return True

    def paint(self, canvas: Canvas) -> None:
        """Draw the names, the line that joins them, and the numbers below."""
        super().paint(canvas)
        left, y = self.box.left, self.box.top + _DOT
        canvas.line((left, y), (left + self.pitch * (len(self._names) - 1), y), LINE)
        for number, name in enumerate(self._names):
            x, chosen = left + number * self.pitch, number == self.index
            room = self.pitch - 10
            tone = INK if chosen else mix(MUTE, INK, 0.4 * self.warmth)
            canvas.text(name, (x, y - 14), size=LABEL, colour=tone, room=room)
            canvas.dot((x + 4, y), 4.5 if chosen else 3.0, NET if chosen else FAINT)
            value = self._walk.value(number)
            if value is not None:
                last = number == len(self._names) - 1
                words = f"{100 * value:.1f} %" if last else figure(value)
                canvas.text(words, (x, y + 19), size=SMALL, colour=NET if chosen else MUTE, tabular=True, room=room)


def name_of(stage: Stage) -> str:
    """Return the name of a kind of stage, in a word."""
    kind: Kind = stage.kind
    return texts.PATCH_STAGES[kind]
