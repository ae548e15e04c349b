"""Main menu: a title and a column of entries, with the moon behind them."""

from __future__ import annotations

from functools import partial
from typing import Final

import pygame

from game.core import texts
from game.core.scene import Quit, Scene, Transition, push
from game.drawing.canvas import Canvas
from game.drawing.tokens import MARGIN, MUTE, TEXT, VIEW_SIZE
from game.input.controls import Command
from game.scenes.menu_background import MenuBackground
from game.ui.context import Context
from game.ui.form import Form
from game.ui.hints import draw_hints
from game.ui.widgets import TextButton

_TITLE_SIZE: Final = 88.0
_WORD_SIZE: Final = 22.0
_FIRST_WORD: Final = 300
_LINE: Final = 38


# Entries: the route of a screen and its key in `texts.MENU`; the last one closes the game.
ROWS: Final = ("play", "missions", "watch", "train", "digits", "physics", "logbook", "settings", "quit")


class MenuScene(Scene):
    """Main menu, the first screen."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._background = MenuBackground(context)
        self._controls = context.controls
        self._form = Form(context, on_back=self._back)
        self._lines: list[tuple[TextButton, str]] = []
        for number, name in enumerate(ROWS):
            label, line = texts.MENU[name]
            box = (MARGIN, _FIRST_WORD + number * _LINE, 160, _LINE)
            word = TextButton(self._form.manager, box, label, partial(_open, name), size=_WORD_SIZE, weight="light")
            self._lines.append((self._form.add(word), line))

    def resume(self) -> None:
        """Follow a change of the settings; the focus stays where it was."""
        self._background.resume()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Pass the event to the column."""
        return self._form.handle_event(event)

    def update(self) -> Transition | None:
        """Animate the column and the background."""
        self._background.update()
        return self._form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the moon, the title, the column and the hints."""
        self._background.draw(canvas, alpha)
        canvas.text(texts.GAME, (MARGIN - 2, 208), size=_TITLE_SIZE, weight="extralight")
        canvas.text(texts.MENU_LINE, (MARGIN, 248), size=TEXT, colour=MUTE)
        self._form.draw(canvas)
        for word, line in self._lines:
            if word.warmth > 0.02:
                place = (MARGIN + 176, word.baseline)
                canvas.text(line, place, size=TEXT, alpha=word.warmth)  # in ink: the dawn is bright
        self._draw_hints(canvas)

    def _draw_hints(self, canvas: Canvas) -> None:
        arrows = self._controls.arrows
        hints = [
            (arrows, texts.HINT_MOVE),
            (self._controls.word(Command.CONFIRM), texts.HINT_CHOOSE),
            (self._controls.word(Command.FULLSCREEN), texts.HINT_FULL_SCREEN),
        ]
        draw_hints(canvas, hints, (MARGIN, VIEW_SIZE[1] - 40))

    def _back(self) -> Transition | None:
        """Move the focus to Quit; if it is there already, leave the game."""
        last = self._form.widgets[-1]
        if self._form.focused is last:
            return Quit()
        self._form.focus(last)
        return None


def _open(name: str) -> Transition:
    return Quit() if name == "quit" else push(name)
