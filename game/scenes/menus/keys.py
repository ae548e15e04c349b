"""Keys: press a row, then the new key or button for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import pygame

from game.core import texts
from game.core.scene import Transition
from game.drawing.tokens import HUMAN, INK, MUTE, TEXT
from game.input.bindings import Bindings, Meaning
from game.input.controls import Command, Controls, Held, code_of
from game.input.layout import place_of
from game.ui.actions import Action, Table
from game.ui.panel_scene import PanelScene
from game.ui.widget import RowWidget, mix

if TYPE_CHECKING:
    from game.drawing.cursor import Cursor
    from game.ui.context import Context
    from game.ui.panel import Panel

# What flies; everything else is in the other half of the table.
FLYING: Final[tuple[Meaning, ...]] = (Held.MAIN, Held.LEFT, Held.RIGHT, Held.FINE, Command.HANDOVER)
_LEAST: Final = 108.0  # points of a column
_BETWEEN: Final = "  ·  "


class BindingCell(RowWidget):
    """Cell with the keys or buttons of one command. A press waits for a new one; Escape or Start cancels."""

    pad = 4.0

    def __init__(
        self, controls: Controls, bindings: Bindings, meaning: Meaning, on_change: Callable[[str], None]
    ) -> None:
        super().__init__((0, 0, 1, 1), texts.BINDINGS[meaning.name])
        self._controls, self._bindings, self._meaning, self._on_change = controls, bindings, meaning, on_change
        self._for_pads = bindings is controls.buttons

    def press(self) -> None:
        waits = bool(self._controls.pads) or not self._for_pads
        self.typing = self._controls.listening = waits
        self._on_change("" if waits else texts.BINDINGS_NO_PAD)

    def stop(self) -> None:
        if self.typing:
            self.typing = self._controls.listening = False

    def cancel(self) -> None:
        self.stop()
        self._on_change("")

    def take(self, event: pygame.event.Event) -> bool:
        """Bind the next key or button; events of the other device are ignored."""
        key = self._code(event) if event.type == pygame.KEYDOWN else None
        button = event.button if event.type == pygame.CONTROLLERBUTTONDOWN else getattr(event, "trigger", None)
        if not self.typing:
            return False
        if key == pygame.K_ESCAPE or button == pygame.CONTROLLER_BUTTON_START:
            self.cancel()
        elif (code := button if self._for_pads else key) is not None:
            self._bind(code)
        return True

    def _code(self, event: pygame.event.Event) -> int:
        """Return the code to bind: a flight control goes by the key's place, a command by what is printed on it."""
        return place_of(event) if isinstance(self._meaning, Held) else code_of(event)

    def _bind(self, code: int) -> None:
        what, table, owner = self._word(code), self._bindings.table, self._bindings.owner(code)
        loser = owner if owner is not self._meaning else None
        if not self._bindings.may(self._meaning, code):
            self._on_change(texts.BINDINGS_FIXED.format(key=what))
        elif loser and table[loser] == (code,):
            self._on_change(texts.BINDINGS_ONLY.format(key=what, other=texts.BINDINGS[loser.name]))
        else:
            self.stop()
            gone = _BETWEEN.join(self._word(other) for other in table[self._meaning] if other != code)
            said = [texts.BINDINGS_NOW.format(key=what, gone=gone)] if gone else []
            said += [texts.BINDINGS_TAKEN.format(key=what, other=texts.BINDINGS[loser.name])] if loser else []
            self._bindings.bind(self._meaning, code)
            self._on_change(" ".join(said))

    def _word(self, code: int) -> str:
        return self._controls.gamepad_sign(code) if self._for_pads else self._controls.key_word(self._meaning, code)

    def ease(self, at_once: bool) -> None:
        super().ease(at_once)
        if not self.focused:
            self.stop()

    def write(self, cursor: Cursor) -> None:
        if self.typing:
            words, colour = texts.BINDINGS_PRESS_BUTTON if self._for_pads else texts.BINDINGS_PRESS_KEY, HUMAN
        else:
            names = self._controls.gamepad_signs if self._for_pads else self._controls.key_names
            words, colour = _BETWEEN.join(names(self._meaning)) or texts.BINDINGS_NONE, mix(MUTE, INK, self.warmth)
        cursor.styled(words, colour=colour)


class BindingsScene(PanelScene):
    """Table of commands with their keys and gamepad buttons. Each change is saved at once.

    Attributes:
        said: what came of the last change, in words.

    """

    most = 880.0

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._controls = context.controls
        self.said = ""
        self._half = 0
        self.build()
        self.form.focus(self.form.widgets[1])  # the first key

    def describe(self, panel: Panel) -> None:
        controls = self._controls
        panel.title(texts.BINDINGS_TITLE)
        panel.gap(4)
        panel.choice("", texts.BINDINGS_HALVES, self._half, self._show, size=18.0)
        panel.text(lambda: self.said, size=TEXT, colour=HUMAN)
        panel.gap(4)
        for column, words in zip(
            panel.beside((1.1, 1, 1), _LEAST, 24.0), (" ", texts.KEYS_KEYBOARD, texts.KEYS_PAD), strict=True
        ):
            column.caption(words)
        for meaning in FLYING if self._half == 0 else [each for each in controls.keys.table if each not in FLYING]:
            panel.line()
            name, *cells = panel.beside((1.1, 1, 1), _LEAST, 24.0)
            name.gap(BindingCell.pad)
            name.text(texts.BINDINGS[meaning.name])
            for cell, bindings in zip(cells, (controls.keys, controls.buttons), strict=True):
                cell.widget(BindingCell(controls, bindings, meaning, self._changed))
        panel.line()
        panel.gap(8)
        panel.button(texts.BINDINGS_ALL, self._reset_all)

    def exit(self) -> None:
        self._controls.listening = False

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        if event.type == pygame.CONTROLLERDEVICEREMOVED:
            for widget in self.form.widgets:
                if isinstance(widget, BindingCell):
                    widget.stop()
        return super().handle_event(event)

    def actions(self) -> Table:
        """Change a binding; while a key is awaited, cancel."""
        cell = self.form.focused
        if not isinstance(cell, BindingCell):
            return super().actions()
        if self._controls.listening:
            return [Action(Command.PAUSE, cell.cancel, texts.HINT_LEAVE_KEY)]
        return [self.form.confirms(texts.HINT_CHANGE), self.form.goes_back(texts.HINT_BACK)]

    def _show(self, half: int) -> None:
        self._half = half
        self.build()

    def _changed(self, said: str) -> None:
        self.said = said
        settings = self.context.settings
        settings.keys, settings.buttons = self._controls.keys.to_dict(), self._controls.buttons.to_dict()
        self.context.apply_settings()

    def _reset_all(self) -> None:
        self._controls.keys.reset()
        self._controls.buttons.reset()
        self._changed("")
