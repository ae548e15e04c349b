"""Few knobs with all there is to say about them: an experiment at a press, too low, too high, and what to watch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final

import pygame

from ai.training.experiments import Experiment
from game.core import texts
from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped, wrapped
from game.drawing.tokens import FAINT, LABEL, MUTE, NET, SMALL, Colour
from game.panels.knob import MARGIN, Knob
from game.panels.knob_words import Word, word_width
from game.training.knob_descriptions import KnobDescription
from game.ui.widget import PointsManager, Widget
from game.ui.widgets import TextButton

PITCH: Final = 52  # of the knobs, with their experiments below them
TRY_LEFT: Final = 142.0  # from the left of a row to its experiments: below the track
MORE: Final = "›"  # opens the page of a knob
_TRY: Final = 18  # points of their height
_LEADING: Final = 16.0

Try = Callable[[Experiment, KnobDescription], Transition | None]


class TryButton(TextButton):
    """An experiment on a knob, at a press; it explains the knob as well."""

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        word: str,
        press: Callable[[], Any],
        knob: Knob,
        colour: Colour = NET,
    ) -> None:
        super().__init__(manager, box, word, press, size=SMALL, colour=colour)
        self.knob = knob


def more_button(manager: PointsManager, knob: Knob) -> TryButton:
    """Make the sign that opens a knob's page, to the right of its row."""
    box = (knob.box.right + 6, knob.box.top, 18, knob.box.height)
    return TryButton(manager, box, MORE, knob.more or (lambda: None), knob, colour=FAINT)


def try_buttons(manager: PointsManager, knob: Knob, words: Sequence[Word]) -> list[Widget]:
    """Make the experiments on a knob, below its track."""
    found: list[Widget] = []
    x = knob.box.left + MARGIN + TRY_LEFT
    for word, press in words:
        width = word_width(word, SMALL)
        found.append(TryButton(manager, (x, knob.box.bottom, width, _TRY), word, press, knob))
        x += width + 18
    return found


def draw_try(canvas: Canvas, buttons: list[Widget]) -> None:
    """Write what the experiments are, before the first of each knob."""
    for button, before in zip(buttons, [None, *buttons], strict=False):
        if (
            isinstance(button, TryButton)
            and button.label != MORE
            and not (isinstance(before, TryButton) and before.knob is button.knob)
        ):
            box = button.box
            left = button.knob.box.left + MARGIN
            canvas.text(texts.LAB_TRY, (left, button.baseline), size=LABEL, colour=MUTE, room=box.left - left - 12)


def draw_advice(canvas: Canvas, description: KnobDescription, said: str, box: pygame.Rect) -> None:
    """Write what a knob does, what comes of too little and too much of it, and what to watch, within a box.

    Each has lines of its own; where there is no room for that, all of it is one small paragraph.
    """
    named = zip(texts.KNOB_ADVICE_NAMES, description.advice, strict=False)
    parts = [said, *(f"{name}: {told}" for name, told in named if told)]
    lines = sum(len(wrapped(canvas, part, SMALL, box.width)) for part in parts)
    if (lines - 1) * _LEADING <= box.height:
        y = float(box.top)
        for number, part in enumerate(parts):
            y = draw_wrapped(canvas, part, (box.left, y), box.width, colour=MUTE if number == 0 else _TOLD,
                             leading=_LEADING)  # fmt: skip
        return
    draw_wrapped(canvas, " ".join(parts), (box.left, box.top), box.width, size=LABEL, colour=MUTE,
                 leading=14.0, most=int(box.height // 14.0) + 1)  # fmt: skip


_TOLD: Final = (186, 194, 210)  # between ink and mute
