"""Key bindings screen: press a row, then the new key or button for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

from game.core import texts
from game.core.scene import Pop, Transition
from game.drawing.canvas import Canvas
from game.drawing.sky import NightSky
from game.drawing.tokens import HUMAN, INK, LABEL, LINE, MARGIN, MUTE, SMALL, TEXT, VIEW_SIZE
from game.input.bindings import Bindings, Meaning
from game.input.controls import Command, Controls, key_name, names
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FormScene
from game.ui.widget import PointsManager, Widget, mix
from game.ui.widgets import TextButton

_FIRST: Final = 144
_ROW: Final = 28
_KEYS: Final = 400
_BUTTONS: Final = 800
_CELL: Final = 352
_WORDS: Final = 628


class BindingCell(Widget):
    """Cell with the keys or buttons of one command. A press waits for a new one; Escape or Start cancels."""

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        controls: Controls,
        bindings: Bindings,
        meaning: Meaning,
        on_change: Callable[[str], None],
    ) -> None:
        super().__init__(manager, box, texts.BINDINGS[meaning.name])
        self._controls, self._bindings, self._meaning, self._on_change = controls, bindings, meaning, on_change

    def press(self) -> None:
        """Wait for a key or a button; for a button only if there is a pad."""
        if self._for_pads and not self._controls.pads:
            self._on_change(texts.BINDINGS_NO_PAD)
            return
        self.typing = self._controls.listening = True
        self._on_change("")

    def stop(self) -> None:
        """Stop waiting for a key."""
        if self.typing:
            self.typing = self._controls.listening = False

    def cancel(self) -> None:
        """Stop waiting for a key, and leave the binding as it is."""
        self.stop()
        self._on_change("")

    def reset(self) -> None:
        """Restore the default binding."""
        self._bindings.reset(self._meaning)
        self._on_change(texts.BINDINGS_RESET.format(what=self.label))

    def take(self, event: pygame.event.Event) -> bool:
        """Bind the next key or button; events of the other device are ignored."""
        if not self.typing:
            if event.type == pygame.KEYDOWN and event.key == pygame.K_DELETE:
                self.reset()
                return True
            return False
        key, button = _pressed(event)
        if key == pygame.K_ESCAPE or button == pygame.CONTROLLER_BUTTON_START:
            self.cancel()
        elif (code := button if self._for_pads else key) is not None:
            self._bind(code)
        return True

    def _bind(self, code: int) -> None:
        """Bind a key, or say why it can't be bound, and wait for another."""
        what = self._controls.gamepad_sign(code) if self._for_pads else key_name(code)
        if not self._bindings.may(self._meaning, code):
            self._on_change(texts.BINDINGS_FIXED.format(key=what))
            return
        if poor := self._bindings.bereft(self._meaning, code):
            self._on_change(texts.BINDINGS_ONLY.format(key=what, other=texts.BINDINGS[poor.name]))
            return
        self.stop()
        loser = self._bindings.bind(self._meaning, code)
        left = names(self._words(loser)) if loser else ""
        self._on_change(texts.BINDINGS_TAKEN.format(other=texts.BINDINGS[loser.name], key=left) if loser else "")

    @property
    def _for_pads(self) -> bool:
        return self._bindings is self._controls.buttons

    def _words(self, meaning: Meaning) -> list[str]:
        return self._controls.gamepad_signs(meaning) if self._for_pads else self._controls.key_names(meaning)

    def ease(self, at_once: bool) -> None:
        """Stop waiting once the focus is elsewhere."""
        super().ease(at_once)
        if not self.focused:
            self.stop()

    def paint(self, canvas: Canvas) -> None:
        """Draw the keys, or the prompt for a new one."""
        if self.warmth > 0.02:
            colour = HUMAN if self.typing else INK
            canvas.outline(self.box.inflate(24, 0), 6, colour, 1, (0.9 if self.typing else 0.4) * self.warmth)
        left, baseline = self.box.left, self.box.centery + 5
        if self.typing:
            text = texts.BINDINGS_PRESS_BUTTON if self._for_pads else texts.BINDINGS_PRESS_KEY
            canvas.text(text, (left, baseline), size=TEXT, colour=HUMAN)
            return
        words = self._words(self._meaning)
        canvas.text(
            names(words) or texts.BINDINGS_NONE, (left, baseline), size=TEXT, colour=mix(MUTE, INK, self.warmth)
        )


class BindingsScene(FormScene):
    """Table of all commands with their keys and gamepad buttons. Each change is saved at once.

    Attributes:
        said: what came of the last change, in words.

    """

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._controls = context.controls
        self._sky = NightSky(context.rng, ember=0.4, stars=60)
        form = self.form
        self.said = ""
        for row, meaning in enumerate(self._controls.keys.table):
            for left, bindings in ((_KEYS, self._controls.keys), (_BUTTONS, self._controls.buttons)):
                box = (left, _FIRST + row * _ROW + 2, _CELL, _ROW - 3)
                form.add(BindingCell(form.manager, box, self._controls, bindings, meaning, self._changed))
        form.add(TextButton(form.manager, (MARGIN, _WORDS, 96, 32), texts.BACK, Pop, size=18))
        form.add(TextButton(form.manager, (_KEYS, _WORDS, 240, 32), texts.BINDINGS_ALL, self._reset_all, size=18))

    def exit(self) -> None:
        """Stop waiting for a key; every change is saved already."""
        self._controls.listening = False

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Pass the event to the cells."""
        if event.type == pygame.CONTROLLERDEVICEREMOVED:
            for widget in self.form.widgets:
                if isinstance(widget, BindingCell):
                    widget.stop()
        return super().handle_event(event)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the table, and the result of the last change."""
        self._sky.draw(canvas)
        canvas.text(texts.BINDINGS_TITLE, (MARGIN, 88), size=34, weight="light")
        for text, left in ((texts.KEYS_KEYBOARD, _KEYS), (texts.KEYS_PAD, _BUTTONS)):
            canvas.text(text, (left, _FIRST - 14), size=LABEL, weight="medium", colour=MUTE)
        for row, meaning in enumerate(self._controls.keys.table):
            y = _FIRST + row * _ROW
            canvas.line((MARGIN, y), (VIEW_SIZE[0] - MARGIN, y), LINE, 1)
            canvas.text(texts.BINDINGS[meaning.name], (MARGIN, y + _ROW / 2 + 5), size=TEXT, colour=INK)
        self.form.draw(canvas)
        if self.said:
            canvas.text(self.said, (_BUTTONS - 120, _WORDS + 21), size=SMALL, colour=HUMAN)
        self.draw_hints(canvas)

    def actions(self) -> Table:
        """Change a binding, or restore it; while a key is awaited, cancel."""
        cell = self.form.focused
        if not isinstance(cell, BindingCell):
            return super().actions()
        if self._controls.listening:
            return [Action(Command.PAUSE, cell.cancel, texts.HINT_LEAVE_KEY)]
        return [
            self.form.confirms(texts.HINT_CHANGE),
            Action(Command.RETRY, cell.reset, texts.HINT_AS_IT_WAS),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def _changed(self, said: str) -> None:
        self.said = said
        settings = self.context.settings
        settings.keys, settings.buttons = self._controls.keys.to_dict(), self._controls.buttons.to_dict()
        self.context.apply_settings()

    def _reset_all(self) -> None:
        self._controls.keys.reset()
        self._controls.buttons.reset()
        self._changed(texts.BINDINGS_ALL_RESET)


def _pressed(event: pygame.event.Event) -> tuple[int | None, int | None]:
    """Return the key, or the pad's button or trigger, that an event presses."""
    key = event.key if event.type == pygame.KEYDOWN else None
    button = event.button if event.type == pygame.CONTROLLERBUTTONDOWN else getattr(event, "trigger", None)
    return key, button
