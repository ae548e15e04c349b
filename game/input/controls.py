"""Keyboard and gamepad controls: held flight controls, and commands."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Final

import pygame

from game.core import texts
from game.core.settings import Settings
from game.input import analogue, signs
from game.input.bindings import KEYBOARD, PAD, TRIGGERS, Bindings, Command, Held, Meaning
from game.input.layout import Layout, place_of

__all__ = ["Command", "Controls", "Held", "code_of", "copies_or_pastes", "presses_main", "translate"]

# Signs of stick movements, in addition to the buttons.
_STICK_SIGNS: Final[dict[Meaning, int]] = {
    Held.LEFT: signs.TURN,
    Held.RIGHT: signs.TURN,
    Command.SLOWER: signs.STICK_LEFT,
    Command.FASTER: signs.STICK_RIGHT,
}
_DIRECTIONS: Final = (Command.UP, Command.DOWN, Command.LEFT, Command.RIGHT)
_MOUSE_SIGNS: Final = {Held.MAIN: signs.MOUSE_LEFT, Held.FINE: signs.MOUSE_MIDDLE}
# Keypad keys that type a character.
_KEYPAD: Final = frozenset({code for name, code in KEYBOARD.names.items() if name[:2] == "kp"} - {pygame.K_KP_ENTER})
# Keys with which others mean something to the system, or to a line of text.
_MODIFIERS: Final = {
    pygame.KMOD_CTRL: (pygame.K_LCTRL, pygame.K_RCTRL),
    pygame.KMOD_ALT: (pygame.K_LALT, pygame.K_RALT),
    pygame.KMOD_META: (pygame.K_LMETA, pygame.K_RMETA),
}
_KEY_NAMES: Final = {code: name for name, code in KEYBOARD.names.items()}
_STANDARD: Final = Bindings(KEYBOARD), Bindings(PAD)


def translate(event: pygame.event.Event) -> Command | None:
    """Return the command of an event, if any, as marked by `Controls.process`.

    An event that no `Controls` has processed has its default meaning.
    """
    if hasattr(event, "command"):
        command: Command | None = event.command
        return command
    return _command(event, *_STANDARD)


def presses_main(event: pygame.event.Event) -> bool:
    """Whether a key fires the main engine, and so confirms in a menu; Space always does."""
    return event.type == pygame.KEYDOWN and (
        event.key == pygame.K_SPACE or place_of(event) in getattr(event, "main_keys", KEYBOARD.standard[Held.MAIN])
    )


def code_of(event: pygame.event.Event) -> int:
    """Return the code of a key event as marked by `Controls.process`: what is printed on the key, or its place."""
    code: int = getattr(event, "code", event.key)
    return code


def copies_or_pastes(event: pygame.event.Event) -> str:
    """Return "c" for Ctrl+C and "v" for Ctrl+V, on any layout; "" for all other events."""
    if event.type != pygame.KEYDOWN or not getattr(event, "mod", 0) & (pygame.KMOD_CTRL | pygame.KMOD_META):
        return ""
    return {pygame.K_c: "c", pygame.K_v: "v"}.get(code_of(event), "")


def _is_chord(event: pygame.event.Event, keys: Bindings) -> bool:
    """Whether a key is pressed with Ctrl, Alt or the system key, which the player has bound to nothing."""
    if any(event.key in codes for codes in _MODIFIERS.values()):
        return False
    held = [codes for mask, codes in _MODIFIERS.items() if getattr(event, "mod", 0) & mask]
    return any(not any(map(keys.owner, codes)) for codes in held)


def _command(event: pygame.event.Event, keys: Bindings, buttons: Bindings) -> Command | None:
    if event.type == pygame.KEYDOWN:
        if event.key == pygame.K_RETURN and getattr(event, "mod", 0) & pygame.KMOD_ALT:
            return Command.FULLSCREEN
        return None if _is_chord(event, keys) else keys.command(code_of(event), place_of(event))
    return buttons.command(event.button) if event.type == pygame.CONTROLLERBUTTONDOWN else None


def _types(event: pygame.event.Event) -> bool:
    """Whether a press types a letter: SDL numbers such keys by their character, and others above all characters."""
    if event.type != pygame.KEYDOWN:
        return False
    held = getattr(event, "mod", 0) & (pygame.KMOD_CTRL | pygame.KMOD_ALT | pygame.KMOD_META)
    return not held and (event.key in _KEYPAD or (event.key < 0x110000 and chr(event.key).isprintable()))


@dataclass
class _Pad:
    buttons: set[int] = field(default_factory=set)
    axes: analogue.Axes = field(default_factory=analogue.Axes)
    pushed: set[Command] = field(default_factory=set)
    device: Any = None  # SDL closes a gamepad without references
    family: signs.Family = "xbox"


class Controls:
    """Combined state of the keyboard and all gamepads.

    Attributes:
        keys, buttons: bindings of the keyboard and of the gamepads.
        layout: the keyboard's layout.
        mouse_in_use: whether the mouse was used last; then no ring is drawn around the focused widget.
        listening: whether the next press is to be bound; it gives no command.
        spelling: whether text is being entered: a key that types a character gives no command.
        used_pad: number of the gamepad that was used last; None while the keyboard is in use.
        gamepad_name: reported name of the gamepad plugged in last; empty if it was unplugged at once.

    """

    def __init__(self) -> None:
        self.keys, self.buttons = Bindings(KEYBOARD), Bindings(PAD)
        self.layout = Layout()
        self._keys: set[int] = set()  # places
        self._pads: dict[int, _Pad] = {}
        self.used_pad: int | None = None
        self.mouse_in_use = self.listening = self.spelling = False
        self.gamepad_name = ""

    @property
    def gamepad_in_use(self) -> bool:
        """Whether a gamepad was used last, rather than the keyboard; then hints show its buttons."""
        return self.used_pad is not None

    @property
    def pads(self) -> int:
        """Number of gamepads connected."""
        return len(self._pads)

    @property
    def main(self) -> bool:
        """Whether the main engine's control is held."""
        return self.holds(Held.MAIN)

    @property
    def shares(self) -> tuple[float, float]:
        """Shares of thrust that sticks and triggers ask for: main engine 0 to 1, jets -1, left, to 1, right."""
        return analogue.shares([pad.axes for pad in self._pads.values()], self.buttons)

    @property
    def switch(self) -> bool:
        """Whether the one switch is held that flies and chooses: any key or button of the main engine, or Confirm's."""
        return self.main or self._down(self.keys.codes(Command.CONFIRM), self.buttons.codes(Command.CONFIRM))

    # Names

    def word(self, meaning: Meaning) -> str:
        """Return the name of a meaning's key, or the sign of its button if it has one and a gamepad is in use.

        While the mouse is in use, flight controls are shown as mouse buttons.
        """
        if isinstance(meaning, Held) and self.mouse_in_use:
            return self.gamepad_sign(_MOUSE_SIGNS.get(meaning, signs.MOUSE_RIGHT))
        buttons = self.gamepad_signs(meaning) if self.gamepad_in_use else []
        return next(iter(buttons or self.key_names(meaning)), texts.BINDINGS_NONE)

    @property
    def arrows(self) -> str:
        """Name of the keys that move the focus."""
        return self.gamepad_sign(signs.CROSS) if self.gamepad_in_use else texts.ARROWS

    @property
    def arrows_aside(self) -> str:
        """Name of the keys that move a slider."""
        return self.gamepad_sign(signs.CROSS) if self.gamepad_in_use else texts.ARROWS_ASIDE

    def key_names(self, meaning: Meaning) -> list[str]:
        """Return the name of every key of a meaning, as written on the keyboard."""
        if meaning is Command.BACK:  # in a form, the pause keys go back too; the keys of Back itself are less familiar
            meaning = Command.PAUSE
        return [self.key_word(meaning, code) for code in self.keys.codes(meaning)]

    def key_word(self, meaning: Meaning | None, code: int) -> str:
        """Return what is printed on a key of a meaning: a flight control has a place, a command what is written."""
        layout = self.layout
        return key_name(layout.printed(code) if isinstance(meaning, Held) else layout.key(code))

    def gamepad_signs(self, meaning: Meaning) -> list[str]:
        """Return the signs of a meaning's buttons and sticks, for the gamepad in use or the one plugged in last."""
        stick = [_STICK_SIGNS[meaning]] if meaning in _STICK_SIGNS else []
        signs = dict.fromkeys([*stick, *self.buttons.codes(meaning)])
        return [self.gamepad_sign(number) for number in signs]

    def gamepad_sign(self, number: int) -> str:
        """Return the sign of a button by its number, or one of the further signs of `game.input.signs`."""
        pads = [*self._pads.values()]
        pad = self._pads.get(-1 if self.used_pad is None else self.used_pad) or (pads[-1] if pads else _Pad())
        return signs.sign(pad.family, number)

    # Events

    def follow(self, settings: Settings) -> None:
        """Apply the player's bindings."""
        self.keys.follow(settings.keys)
        self.buttons.follow(settings.buttons)

    def release_all(self) -> None:
        """Release every control, because the window will not receive the release events."""
        self._keys.clear()
        for pad in self._pads.values():
            pad.buttons.clear()
            pad.axes.clear()
            pad.pushed.clear()

    def process(self, event: pygame.event.Event) -> None:
        """Process one event, and mark it with its `command`."""
        match event.type:
            case pygame.KEYMAPCHANGED:
                self.layout = Layout()
            case pygame.KEYDOWN:
                event.code, event.chord = self.layout.code_of(event), _is_chord(event, self.keys)
                if not event.chord:
                    self._keys.add(place_of(event))
                event.command = self._command(event)
                event.main_keys = self.keys.codes(Held.MAIN)
                self.used_pad, self.mouse_in_use = None, False
            case pygame.MOUSEMOTION | pygame.MOUSEBUTTONDOWN:
                self.mouse_in_use = True
            case pygame.KEYUP:
                self._keys.discard(place_of(event))
            case pygame.WINDOWFOCUSLOST:
                self.release_all()
            case pygame.CONTROLLERDEVICEADDED:
                self._open(event.device_index)
            case pygame.CONTROLLERDEVICEREMOVED:
                self._close(event)
            case pygame.CONTROLLERBUTTONDOWN:
                self._pad(event).buttons.add(event.button)
                event.command = self._command(event)
                self._use(event)
            case pygame.CONTROLLERBUTTONUP:
                self._pad(event).buttons.discard(event.button)
            case pygame.CONTROLLERAXISMOTION:
                self._move(event)

    def _command(self, event: pygame.event.Event) -> Command | None:
        if self.listening or (self.spelling and _types(event)):
            return None
        return _command(event, self.keys, self.buttons)

    @property
    def direction(self) -> Command | None:
        """The direction that is held as menus understand it; None for none."""
        return next((command for command in _DIRECTIONS if self._holds_command(command)), None)

    def _holds_command(self, command: Command) -> bool:
        if any(self.keys.command(self.layout.key(place), place) is command for place in self._keys):
            return True
        return any(
            command in pad.pushed or any(self.buttons.command(button) is command for button in pad.buttons)
            for pad in self._pads.values()
        )

    def holds(self, held: Held, *, axes: bool = True) -> bool:
        """Whether a control is held; without `axes`, by a key or a button, and not by a stick or trigger."""
        buttons = set(self.buttons.codes(held)) - (set() if axes else set(TRIGGERS.values()))
        if self._down(self.keys.codes(held), buttons):
            return True
        way = analogue.TURNS.get(held, 0)
        return axes and any(way * pad.axes.value(analogue.TURN) > analogue.STICK_USED for pad in self._pads.values())

    def _down(self, keys: Iterable[int], buttons: Iterable[int]) -> bool:
        return not self._keys.isdisjoint(keys) or any(
            not pad.buttons.isdisjoint(buttons) for pad in self._pads.values()
        )

    def _use(self, event: pygame.event.Event) -> None:
        self.used_pad, self.mouse_in_use = event.instance_id, False

    def _pad(self, event: pygame.event.Event) -> _Pad:
        return self._pads.setdefault(event.instance_id, _Pad())

    def _open(self, device_index: int) -> None:
        from pygame._sdl2 import controller

        self.gamepad_name = ""
        try:
            device = controller.Controller(device_index)
            instance = device.as_joystick().get_instance_id()
        except pygame.error:
            return  # unplugged again before this event was processed
        self.gamepad_name = device.name or ""
        pad = self._pads.setdefault(instance, _Pad())
        pad.device, pad.family = device, signs.family_of(self.gamepad_name)

    def _close(self, event: pygame.event.Event) -> None:
        self._pads.pop(event.instance_id, None)
        if event.instance_id == self.used_pad:
            self.used_pad = None
            event.command = Command.UNPLUGGED

    def _move(self, event: pygame.event.Event) -> None:
        pad = self._pad(event)
        pad.axes.move(event.axis, event.value)
        value = pad.axes.value(event.axis)
        if event.axis in TRIGGERS:
            self._pull(event, pad, TRIGGERS[event.axis], value)
        elif abs(value) > analogue.STICK_USED:
            self._use(event)
        for command, push in zip(analogue.STICK_COMMANDS.get(event.axis, ()), (-value, value), strict=False):
            if push > analogue.STICK_PUSHED and command not in pad.pushed:
                pad.pushed.add(command)
                event.command = command
            elif push < analogue.STICK_RELEASED:
                pad.pushed.discard(command)

    def _pull(self, event: pygame.event.Event, pad: _Pad, trigger: int, value: int) -> None:
        """Treat a trigger's axis as a button."""
        if value > analogue.TRIGGER_PRESSED and trigger not in pad.buttons:
            pad.buttons.add(trigger)
            event.command, event.trigger = None if self.listening else self.buttons.command(trigger), trigger
            self._use(event)
        elif value < analogue.TRIGGER_RELEASED:
            pad.buttons.discard(trigger)


def unmapped(device_index: int) -> bool:
    """Whether a device that was plugged in is a gamepad of which nobody knows what its buttons are."""
    from pygame._sdl2 import controller

    try:
        return not controller.is_controller(device_index)
    except pygame.error:
        return False  # unplugged again before this event was processed


def key_name(code: int) -> str:
    """Return the label of a key."""
    name = _KEY_NAMES.get(code)
    if name is None:
        return chr(code).upper() if 32 < code < 0x10000 and chr(code).isprintable() else f"#{code}"
    if name in texts.KEY_NAMES:
        return texts.KEY_NAMES[name]
    plain = name.removeprefix("kp").removeprefix("_").title()
    return texts.KEY_OF_PAD.format(name=plain) if name.startswith("kp") else plain
