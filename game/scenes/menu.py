"""Main menu: a title and a column of entries, with the moon behind them."""

from __future__ import annotations

from functools import partial
from typing import Final

from game.core import texts
from game.core.scene import Quit, Transition, push
from game.drawing.canvas import Canvas
from game.drawing.tokens import MARGIN, MUTE, TEXT
from game.input.controls import Command
from game.scenes.menu_background import MenuBackground
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FormScene
from game.ui.widgets import TextButton

_TITLE_SIZE: Final = 88.0
_WORD_SIZE: Final = 22.0
_FIRST_WORD: Final = 260
_LINE: Final = 34
_HALVES: Final = 12  # points between the two halves of the column


# Entries: the route of a screen and its key in `texts.MENU`; the last one closes the game.
ROWS: Final = (
    "play", "descent", "missions", "watch", "train", "digits", "learn", "physics", "logbook", "settings", "quit",
)  # fmt: skip


class MenuScene(FormScene):
    """Main menu, the first screen."""

    fills = True

    def __init__(self, context: Context) -> None:
        super().__init__(context, self._back)
        self._background = MenuBackground(context)
        self._lines: list[tuple[TextButton, str]] = []
        for number, name in enumerate(ROWS):
            label, line = texts.MENU[name]
            lower = number >= ROWS.index("learn")
            box = (MARGIN, _FIRST_WORD + number * _LINE + lower * _HALVES, 160, _LINE)
            word = TextButton(self.form.manager, box, label, partial(_open, name), size=_WORD_SIZE, weight="light")
            self._lines.append((self.form.add(word), line))

    def enter(self) -> None:
        """Follow a change of the settings; the focus stays where it was."""
        self._background.enter()

    def update(self) -> Transition | None:
        """Animate the column and the background."""
        self._background.update()
        return self.form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the moon, the title, the column and the hints."""
        self._background.draw(canvas, alpha)
        canvas.text(texts.GAME, (MARGIN - 2, 184), size=_TITLE_SIZE, weight="extralight")
        canvas.text(texts.MENU_LINE, (MARGIN, 224), size=TEXT, colour=MUTE)
        self.form.draw(canvas)
        for word, line in self._lines:
            if word.warmth > 0.02:
                place = (MARGIN + 176, word.baseline)
                canvas.text(line, place, size=TEXT, alpha=word.warmth)  # in ink: the dawn is bright
        self.draw_hints(canvas)

    def actions(self) -> Table:
        """Move, choose, switch to the full screen; Escape leads to Quit."""
        return [
            self.form.moves,
            self.form.confirms(texts.HINT_CHOOSE),
            Action(Command.FULLSCREEN, self.context.toggle_full_screen, texts.HINT_FULL_SCREEN),
        ]

    def _back(self) -> Transition | None:
        """Move the focus to Quit; if it is there already, leave the game."""
        last = self.form.widgets[-1]
        if self.form.focused is last:
            return Quit()
        self.form.focus(last)
        return None


def _open(name: str) -> Transition:
    if name == "descent":
        from game.play.descent import Descent  # loaded when it is first flown: the menu shows at once

        return push("play", challenge=Descent())
    return Quit() if name == "quit" else push(name)
