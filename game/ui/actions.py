"""Actions: one table per scene says which key does what, and so what its hints say and what a click on them runs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial

import pygame

from game.core.scene import Transition
from game.input.controls import Command, Controls, code_of, translate
from game.ui.hints import Hint

Run = Callable[[], Transition | None]


@dataclass(frozen=True)
class Action:
    """What a key does in a scene.

    Attributes:
        key: the command whose keys and buttons run it, or the code of a key that cannot be bound.
        run: does it.
        hint: what it does, in a word or two; no hint is shown if empty.
        gamepad: command whose buttons run it from a gamepad, in place of `key`.

    """

    key: Command | int
    run: Run
    hint: str = ""
    gamepad: Command | None = None

    def answers(self, event: pygame.event.Event) -> bool:
        """Whether the event is a press of its key or button."""
        command = translate(event)
        if self.gamepad is not None and event.type != pygame.KEYDOWN:
            return command is self.gamepad
        if isinstance(self.key, Command):
            # In a menu the pause keys go back too.
            return command is self.key or (self.key is Command.BACK and command is Command.PAUSE)
        return event.type == pygame.KEYDOWN and code_of(event) == self.key

    def key_word(self, controls: Controls) -> str:
        """Return the name of its key, or the sign of its button while a gamepad is in use."""
        if self.gamepad is not None and controls.gamepad_in_use:
            return controls.word(self.gamepad)
        return controls.word(self.key) if isinstance(self.key, Command) else controls.key_word(None, self.key)

    def hint_for(self, controls: Controls) -> Hint:
        """Return its hint."""
        return Hint(self.key_word(controls), self.hint, self.run)


# An entry that is only a hint tells of keys that no single press stands for, such as the arrows.
Table = Sequence[Action | Hint]


def answering(table: Table, event: pygame.event.Event) -> Action | None:
    """Return the first action of a table that an event runs, if any."""
    return next((action for action in table if isinstance(action, Action) and action.answers(event)), None)


def hints_of(table: Table, controls: Controls) -> list[Hint]:
    """Return the hints of a table, for the device in use."""
    return [
        entry.hint_for(controls) if isinstance(entry, Action) else entry
        for entry in table
        if (entry.hint if isinstance(entry, Action) else entry.meaning)
    ]


def digit_actions(run: Callable[[int], Transition | None]) -> Iterable[Action]:
    """Return an action for the keys of each digit, on the keypad too."""
    keys = [(key, digit) for digit in range(10) for key in (pygame.K_0 + digit, pygame.K_KP1 + (digit - 1) % 10)]
    return [Action(key, partial(run, digit)) for key, digit in keys]
