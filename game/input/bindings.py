"""Key and button bindings: the defaults, and the player's changes.

Enter, Escape and the arrows, and a gamepad's A, B, Start and D-pad, always keep their meaning in menus, so that
players cannot lock themselves out.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass
from enum import Enum, auto
from typing import Any, Final

import pygame


class Command(Enum):
    """Command given by one press, on any device."""

    CONFIRM = auto()
    BACK = auto()
    UP = auto()
    DOWN = auto()
    LEFT = auto()
    RIGHT = auto()
    HANDOVER = auto()
    PAUSE = auto()
    RETRY = auto()
    STEP = auto()
    SLOWER = auto()
    FASTER = auto()
    NEXT = auto()
    PREVIOUS = auto()
    CHOICES = auto()
    MODE = auto()
    FULLSCREEN = auto()
    SCREENSHOT = auto()
    MUTE = auto()
    UNPLUGGED = auto()  # not a press: the gamepad in use was unplugged


class Held(Enum):
    """Flight control that a pilot holds down."""

    MAIN = auto()
    LEFT = auto()
    RIGHT = auto()
    FINE = auto()  # not an engine: while it is held, jets give a part of their thrust


Meaning = Command | Held
Table = Mapping[Meaning, tuple[int, ...]]

# A gamepad's triggers are axes; they are treated as further buttons, pressed or not.
TRIGGER_LEFT, TRIGGER_RIGHT = 32, 33
TRIGGERS: Final = {pygame.CONTROLLER_AXIS_TRIGGERLEFT: TRIGGER_LEFT, pygame.CONTROLLER_AXIS_TRIGGERRIGHT: TRIGGER_RIGHT}

# Bindings of keys, and of a gamepad's buttons: those that are fixed.
_FIXED: Final[Mapping[Meaning, tuple[tuple[int, ...], tuple[int, ...]]]] = {
    Command.CONFIRM: ((pygame.K_RETURN, pygame.K_KP_ENTER), (pygame.CONTROLLER_BUTTON_A,)),
    Command.BACK: ((pygame.K_BACKSPACE, pygame.K_AC_BACK), (pygame.CONTROLLER_BUTTON_B,)),
    Command.PAUSE: ((pygame.K_ESCAPE,), (pygame.CONTROLLER_BUTTON_START,)),
    Command.UP: ((pygame.K_UP,), (pygame.CONTROLLER_BUTTON_DPAD_UP,)),
    Command.DOWN: ((pygame.K_DOWN,), (pygame.CONTROLLER_BUTTON_DPAD_DOWN,)),
    Command.LEFT: ((pygame.K_LEFT,), (pygame.CONTROLLER_BUTTON_DPAD_LEFT,)),
    Command.RIGHT: ((pygame.K_RIGHT,), (pygame.CONTROLLER_BUTTON_DPAD_RIGHT,)),
}
# And the defaults of those that the player can change, in the order of the list. An engine may share a key with the
# menus: Up thrusts in flight and moves in a menu.
_CHANGEABLE: Final[Mapping[Meaning, tuple[tuple[int, ...], tuple[int, ...]]]] = {
    Held.MAIN: (
        (pygame.K_UP, pygame.K_SPACE, pygame.K_w),
        (pygame.CONTROLLER_BUTTON_A, TRIGGER_RIGHT, pygame.CONTROLLER_BUTTON_DPAD_UP),
    ),
    Held.LEFT: ((pygame.K_LEFT, pygame.K_a), (pygame.CONTROLLER_BUTTON_DPAD_LEFT,)),
    Held.RIGHT: ((pygame.K_RIGHT, pygame.K_d), (pygame.CONTROLLER_BUTTON_DPAD_RIGHT,)),
    Held.FINE: ((pygame.K_LSHIFT, pygame.K_RSHIFT), (TRIGGER_LEFT,)),
    Command.HANDOVER: ((pygame.K_TAB,), (pygame.CONTROLLER_BUTTON_Y,)),
    Command.RETRY: ((pygame.K_r,), (pygame.CONTROLLER_BUTTON_X,)),
    Command.PAUSE: ((pygame.K_p,), ()),
    Command.CHOICES: ((pygame.K_c,), (pygame.CONTROLLER_BUTTON_BACK,)),
    Command.SLOWER: ((pygame.K_MINUS, pygame.K_KP_MINUS, pygame.K_LEFTBRACKET), ()),
    Command.FASTER: ((pygame.K_PLUS, pygame.K_EQUALS, pygame.K_KP_PLUS, pygame.K_RIGHTBRACKET), ()),
    Command.MODE: ((pygame.K_g,), (pygame.CONTROLLER_BUTTON_LEFTSTICK,)),
    Command.STEP: ((pygame.K_PERIOD,), (pygame.CONTROLLER_BUTTON_RIGHTSTICK,)),
    Command.NEXT: ((pygame.K_n, pygame.K_PAGEDOWN), (pygame.CONTROLLER_BUTTON_RIGHTSHOULDER,)),
    Command.PREVIOUS: ((pygame.K_b, pygame.K_PAGEUP), (pygame.CONTROLLER_BUTTON_LEFTSHOULDER,)),
    Command.FULLSCREEN: ((pygame.K_F11,), ()),
    Command.SCREENSHOT: ((pygame.K_F12,), ()),
    Command.MUTE: ((pygame.K_F10,), ()),
}
FIXED_KEYS, FIXED_BUTTONS = ({meaning: codes[device] for meaning, codes in _FIXED.items()} for device in (0, 1))
KEYS, BUTTONS = ({meaning: codes[device] for meaning, codes in _CHANGEABLE.items()} for device in (0, 1))
# Letters that move in menus unless they are bound to something else.
_SPARE_KEYS: Final[Mapping[int, Command]] = {
    pygame.K_w: Command.UP, pygame.K_s: Command.DOWN, pygame.K_a: Command.LEFT, pygame.K_d: Command.RIGHT
}  # fmt: skip
# Keys that screens, lists and text lines use themselves, and modifier keys.
_TAKEN_KEYS: Final = frozenset({
    pygame.K_SPACE, pygame.K_TAB, pygame.K_DELETE, pygame.K_HOME, pygame.K_END, pygame.K_F1, pygame.K_F2,
    pygame.K_k, pygame.K_t, pygame.K_z,
    *range(pygame.K_0, pygame.K_9 + 1), *range(pygame.K_KP1, pygame.K_KP0 + 1),
    pygame.K_LALT, pygame.K_RALT, pygame.K_LGUI, pygame.K_RGUI, pygame.K_CAPSLOCK, pygame.K_NUMLOCK
})  # fmt: skip
_ENGINE_KEYS: Final = frozenset({pygame.K_UP, pygame.K_DOWN, pygame.K_LEFT, pygame.K_RIGHT, pygame.K_SPACE})
_ENGINE_BUTTONS: Final = frozenset({
    pygame.CONTROLLER_BUTTON_A, pygame.CONTROLLER_BUTTON_B, pygame.CONTROLLER_BUTTON_DPAD_UP,
    pygame.CONTROLLER_BUTTON_DPAD_DOWN, pygame.CONTROLLER_BUTTON_DPAD_LEFT, pygame.CONTROLLER_BUTTON_DPAD_RIGHT
})  # fmt: skip


def _named(prefix: str) -> dict[str, int]:
    """Return pygame's codes with this prefix by their names, for the settings file."""
    return {name.removeprefix(prefix).lower(): code for name, code in vars(pygame).items() if name.startswith(prefix)}


@dataclass(frozen=True)
class Device:
    """Bindings and rules of one kind of device, keyboards or gamepads."""

    standard: Table  # default bindings that can be changed
    fixed: Table  # bindings that cannot be changed
    spare: Mapping[int, Command]  # meaning of a key in menus while it is bound to nothing else
    taken: frozenset[int]  # keys that no command may be bound to
    engines: frozenset[int]  # keys that an engine may have although menus or screens use them
    names: Mapping[str, int]  # codes by name


KEYBOARD: Final = Device(KEYS, FIXED_KEYS, _SPARE_KEYS, _TAKEN_KEYS, _ENGINE_KEYS, _named("K_"))
PAD: Final = Device(
    BUTTONS, FIXED_BUTTONS, {}, frozenset(), _ENGINE_BUTTONS,
    {**_named("CONTROLLER_BUTTON_"), "triggerleft": TRIGGER_LEFT, "triggerright": TRIGGER_RIGHT}
)  # fmt: skip


class Bindings:
    """Bindings of one device: the player's changes over the defaults.

    Attributes:
        device: the keyboard or gamepad rules.
        table: keys of every meaning that can be changed; the first key is the one that is named.

    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self.reset()

    def reset(self) -> None:
        """Restore the defaults."""
        self.table: dict[Meaning, tuple[int, ...]] = dict(self.device.standard)
        self._index()

    def codes(self, meaning: Meaning) -> tuple[int, ...]:
        """Return every key of a meaning."""
        return self.device.fixed.get(meaning, ()) + self.table.get(meaning, ())

    def command(self, code: int, place: int | None = None) -> Command | None:
        """Return the command a key gives, if any; letters that nothing is bound to move in menus by their `place`."""
        return self._commands.get(code) or self.device.spare.get(code if place is None else place)

    def owner(self, code: int) -> Meaning | None:
        """Return the meaning that a key is bound to, if any."""
        return next((meaning for meaning, codes in self.table.items() if code in codes), None)

    def may(self, meaning: Meaning, code: int) -> bool:
        """Whether a key may be bound to that meaning."""
        device = self.device
        if code in device.standard[meaning] or (isinstance(meaning, Held) and code in device.engines):
            return True
        return code not in device.taken and not any(code in codes for codes in device.fixed.values())

    def bind(self, meaning: Meaning, code: int) -> None:
        """Bind a key to a meaning, and unbind it from any other."""
        self.table = {other: _without(codes, {code}) for other, codes in self.table.items()}
        self.table[meaning] = (code,)
        self._index()

    def to_dict(self) -> dict[str, list[str]]:
        """Return the changes from the defaults, as names for the settings file."""
        names = {code: name for name, code in self.device.names.items()}
        return {
            meaning.name.lower(): [names.get(code, f"#{code}") for code in codes]
            for meaning, codes in self.table.items()
            if codes != self.device.standard[meaning]
        }

    def follow(self, saved: Mapping[str, Any]) -> None:
        """Apply what `to_dict` returned; invalid entries are ignored, and the first owner of a key keeps it.

        A default key that the player has bound to something else is not the default's any more.
        """
        standard, taken = self.device.standard, set[int]()
        chosen = {meaning: self._chosen(meaning, saved.get(meaning.name.lower())) for meaning in standard}
        for meaning in sorted(standard, key=lambda meaning: not chosen[meaning]):
            self.table[meaning] = _without(chosen[meaning], taken) or _without(standard[meaning], taken)
            taken.update(self.table[meaning])
        self._index()

    def _chosen(self, meaning: Meaning, words: object) -> list[int]:
        codes = map(self._code, words if isinstance(words, list) else ())
        return list(dict.fromkeys(code for code in codes if code is not None and self.may(meaning, code)))

    def _code(self, word: object) -> int | None:
        if not isinstance(word, str):
            return None
        if word[:1] == "#" and word[1:].isdecimal() and len(word) < 12:
            return int(word[1:])
        return self.device.names.get(word)

    def _index(self) -> None:
        """Rebuild the lookup by key: fixed bindings come first, then chosen ones."""
        self._commands: dict[int, Command] = {}
        for table in (self.table, self.device.fixed):
            for meaning, codes in table.items():
                if isinstance(meaning, Command):
                    self._commands.update(dict.fromkeys(codes, meaning))


def _without(codes: Iterable[int], others: Container[int]) -> tuple[int, ...]:
    return tuple(code for code in codes if code not in others)
