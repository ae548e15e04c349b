"""Learn scene: the list of the path's chapters, in any order, with what has been done."""

from __future__ import annotations

from functools import partial
from typing import Final

import pygame

from game.core import texts
from game.core.scene import Transition, push
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, MARGIN, MUTE, SMALL, TEXT, TITLE, VIEW_SIZE
from game.learn.path import FIRST, PATH
from game.learn.progress import Progress
from game.ui.context import Context
from game.ui.list_scene import VERB_LINE, VERB_SIZE, ListLayout, ListScene
from game.ui.listing import Row
from game.ui.widget import Widget
from game.ui.widgets import TextButton

_LEFT: Final = 720
_WIDTH: Final = VIEW_SIZE[0] - MARGIN - _LEFT
_LAYOUT: Final = ListLayout(
    box=pygame.Rect(MARGIN, 164, 560, 400),
    columns=(112.0, 0.0),
    headings=lambda: texts.LEARN_COLUMNS,
    pitch=36,
    verbs=(_LEFT, 440),
    foot=608,
    numbered=32.0,
)


class LearnScene(ListScene[str]):
    """Learn scene: chapters on the left, the chosen one's question on the right."""

    def __init__(self, context: Context) -> None:
        super().__init__(context, texts.LEARN_TITLE, _LAYOUT)
        self._progress = Progress(context.settings)
        box = (MARGIN + 130, _LAYOUT.foot, 220, VERB_LINE)
        self._physics = TextButton(
            self.form.manager, box, texts.LEARN_PHYSICS, partial(push, "physics"), size=VERB_SIZE
        )
        self._reload()

    def enter(self) -> None:
        """Read again what has been done; the arrows lead on from the chapter that was left."""
        super().enter()
        self.form.focus(self._list)

    def _reload(self) -> None:
        done = sum(map(self._progress.done, PATH))
        self._line = texts.LEARN_LINE.format(done=done, count=len(PATH))
        last = self.context.settings.chapter
        self._show(list(PATH), last if last in PATH else self._next())

    def _next(self) -> str:
        """Return the first chapter that is not done."""
        return next((key for key in PATH if not self._progress.done(key)), FIRST)

    def _row(self, key: str) -> Row:
        minutes = texts.LEARN_MINUTES.format(count=PATH[key].minutes)
        return texts.LEARN[key]["title"], minutes, texts.LEARN_STATES[self._state(key)]

    def _state(self, key: str) -> int:
        return 2 if self._progress.done(key) else 1 if self._progress.begun(key) else 0

    def _make_verbs(self) -> list[Widget]:
        key = self.items[self._list.index]
        verb = texts.LEARN_VERBS[self._state(key)]
        return self._buttons([(verb, partial(self._open, key))])

    def _below_list(self) -> list[Widget]:
        """Return the way back, and beside it the way to the gallery of small worlds."""
        return [*super()._below_list(), self._physics]

    def _press_row(self) -> Transition | None:
        return self._open(self.items[self._list.index])

    def _open(self, key: str) -> Transition:
        return push("chapter", key)

    def _draw_chosen(self, canvas: Canvas) -> None:
        """Write the chosen chapter's title, its question and what there is to touch."""
        key = self.items[self._list.index]
        words, guess = texts.LEARN[key], self._progress.answer(key)
        canvas.text(words["title"], (_LEFT, 190), size=TITLE + 2, weight="light", room=_WIDTH)
        below = draw_wrapped(canvas, words["question"], (_LEFT, 228), _WIDTH, size=TEXT, leading=24)
        below = draw_wrapped(canvas, words["lead"], (_LEFT, below + 8), _WIDTH, size=SMALL + 1, colour=MUTE, leading=20)
        if guess:
            told = texts.LEARN_GUESSED.format(guess=guess)
            draw_wrapped(canvas, told, (_LEFT, below + 12), _WIDTH, size=SMALL + 1, colour=HUMAN, leading=20)
