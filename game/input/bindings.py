"""Which keys and buttons mean what, as the game comes and as the player changes it.

Enter, Escape and the arrows, and a pad's A, B, Start and D-pad, keep what they mean in menus whatever is changed:
nobody can lock themselves out.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass
from enum import Enum, auto
from typing import Any, Final

import pygame


class Command(Enum):
    """One press, whatever device it came from."""

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
    UNPLUGGED = auto()  # no press: the pad in use was pulled out


class Held(Enum):
    """What a pilot holds down."""

    MAIN = auto()
    LEFT = auto()
    RIGHT = auto()


Meaning = Command | Held
Table = Mapping[Meaning, tuple[int, ...]]

# A pad's triggers are axes; they are numbered as further buttons, pressed or not.
TRIGGER_LEFT, TRIGGER_RIGHT = 32, 33
TRIGGERS: Final = {
    pygame.CONTROLLER_AXIS_TRIGGERLEFT: TRIGGER_LEFT,
    pygame.CONTROLLER_AXIS_TRIGGERRIGHT: TRIGGER_RIGHT,
}

# What always holds.
FIXED_KEYS: Final[Table] = {
    Command.CONFIRM: (pygame.K_RETURN, pygame.K_KP_ENTER),
    Command.BACK: (pygame.K_BACKSPACE, pygame.K_AC_BACK),
    Command.PAUSE: (pygame.K_ESCAPE,),
    Command.UP: (pygame.K_UP,),
    Command.DOWN: (pygame.K_DOWN,),
    Command.LEFT: (pygame.K_LEFT,),
    Command.RIGHT: (pygame.K_RIGHT,),
}
FIXED_BUTTONS: Final[Table] = {
    Command.CONFIRM: (pygame.CONTROLLER_BUTTON_A,),
    Command.BACK: (pygame.CONTROLLER_BUTTON_B,),
    Command.PAUSE: (pygame.CONTROLLER_BUTTON_START,),
    Command.UP: (pygame.CONTROLLER_BUTTON_DPAD_UP,),
    Command.DOWN: (pygame.CONTROLLER_BUTTON_DPAD_DOWN,),
    Command.LEFT: (pygame.CONTROLLER_BUTTON_DPAD_LEFT,),
    Command.RIGHT: (pygame.CONTROLLER_BUTTON_DPAD_RIGHT,),
}
# What the player can change, in the order in which it is listed. A key of an engine may be one of the menus' as well:
# Up thrusts in flight and moves in a menu.
KEYS: Final[Table] = {
    Held.MAIN: (pygame.K_UP, pygame.K_SPACE, pygame.K_w),
    Held.LEFT: (pygame.K_LEFT, pygame.K_a),
    Held.RIGHT: (pygame.K_RIGHT, pygame.K_d),
    Command.HANDOVER: (pygame.K_TAB,),
    Command.RETRY: (pygame.K_r,),
    Command.PAUSE: (pygame.K_p,),
    Command.CHOICES: (pygame.K_c,),
    Command.SLOWER: (pygame.K_MINUS, pygame.K_KP_MINUS, pygame.K_LEFTBRACKET),
    Command.FASTER: (pygame.K_PLUS, pygame.K_EQUALS, pygame.K_KP_PLUS, pygame.K_RIGHTBRACKET),
    Command.MODE: (pygame.K_g,),
    Command.STEP: (pygame.K_PERIOD,),
    Command.NEXT: (pygame.K_n, pygame.K_PAGEDOWN),
    Command.PREVIOUS: (pygame.K_b, pygame.K_PAGEUP),
    Command.FULLSCREEN: (pygame.K_F11,),
    Command.SCREENSHOT: (pygame.K_F12,),
}
BUTTONS: Final[Table] = {
    Held.MAIN: (pygame.CONTROLLER_BUTTON_A, TRIGGER_RIGHT, pygame.CONTROLLER_BUTTON_DPAD_UP),
    Held.LEFT: (pygame.CONTROLLER_BUTTON_DPAD_LEFT,),
    Held.RIGHT: (pygame.CONTROLLER_BUTTON_DPAD_RIGHT,),
    Command.HANDOVER: (pygame.CONTROLLER_BUTTON_Y,),
    Command.RETRY: (pygame.CONTROLLER_BUTTON_X,),
    Command.PAUSE: (),
    Command.CHOICES: (pygame.CONTROLLER_BUTTON_BACK,),
    Command.SLOWER: (),
    Command.FASTER: (),
    Command.MODE: (pygame.CONTROLLER_BUTTON_LEFTSTICK,),
    Command.STEP: (pygame.CONTROLLER_BUTTON_RIGHTSTICK,),
    Command.NEXT: (pygame.CONTROLLER_BUTTON_RIGHTSHOULDER,),
    Command.PREVIOUS: (pygame.CONTROLLER_BUTTON_LEFTSHOULDER,),
    Command.FULLSCREEN: (),
    Command.SCREENSHOT: (),
}
# Letters that move in menus as long as they mean nothing else.
_SPARE_KEYS: Final[Mapping[int, Command]] = {
    pygame.K_w: Command.UP,
    pygame.K_s: Command.DOWN,
    pygame.K_a: Command.LEFT,
    pygame.K_d: Command.RIGHT,
}
# Keys that screens, lists and text lines have a use of their own for, and those that only go with others.
_TAKEN_KEYS: Final = frozenset({
    pygame.K_SPACE, pygame.K_TAB, pygame.K_DELETE, pygame.K_HOME, pygame.K_END, pygame.K_F2, pygame.K_z,
    *range(pygame.K_0, pygame.K_9 + 1), *range(pygame.K_KP1, pygame.K_KP0 + 1),
    pygame.K_LALT, pygame.K_RALT, pygame.K_LGUI, pygame.K_RGUI, pygame.K_CAPSLOCK, pygame.K_NUMLOCK,
})  # fmt: skip
_ENGINE_KEYS: Final = frozenset({pygame.K_UP, pygame.K_DOWN, pygame.K_LEFT, pygame.K_RIGHT, pygame.K_SPACE})
_ENGINE_BUTTONS: Final = frozenset({
    pygame.CONTROLLER_BUTTON_A, pygame.CONTROLLER_BUTTON_B, pygame.CONTROLLER_BUTTON_DPAD_UP,
    pygame.CONTROLLER_BUTTON_DPAD_DOWN, pygame.CONTROLLER_BUTTON_DPAD_LEFT, pygame.CONTROLLER_BUTTON_DPAD_RIGHT,
})  # fmt: skip


def _named(prefix: str) -> dict[str, int]:
    """Return codes by the names that pygame has for them, for the settings file."""
    return {name.removeprefix(prefix).lower(): code for name, code in vars(pygame).items() if name.startswith(prefix)}


@dataclass(frozen=True)
class Device:
    """What is special to keyboards, or to pads.

    Attributes:
        standard: what the game comes with, of all that can be changed.
        fixed: what always holds.
        spare: what a key means in menus as long as nothing else wants it.
        taken: keys that no command may have.
        engines: keys that an engine may have, although menus or screens have a use for them.
        names: codes by name.

    """

    standard: Table
    fixed: Table
    spare: Mapping[int, Command]
    taken: frozenset[int]
    engines: frozenset[int]
    names: Mapping[str, int]


KEYBOARD: Final = Device(KEYS, FIXED_KEYS, _SPARE_KEYS, _TAKEN_KEYS, _ENGINE_KEYS, _named("K_"))
PAD: Final = Device(
    BUTTONS, FIXED_BUTTONS, {}, frozenset(), _ENGINE_BUTTONS,
    {**_named("CONTROLLER_BUTTON_"), "triggerleft": TRIGGER_LEFT, "triggerright": TRIGGER_RIGHT},
)  # fmt: skip


class Bindings:
    """What keys, or buttons, mean: what the player has changed, over what the game comes with.

    Attributes:
        device: keyboard or pad.
        table: every meaning that can be changed, with its keys; the first is the one to name.

    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self.table: dict[Meaning, tuple[int, ...]] = dict(device.standard)
        self._index()

    def codes(self, meaning: Meaning) -> tuple[int, ...]:
        """Return every key of a meaning."""
        return self.device.fixed.get(meaning, ()) + self.table.get(meaning, ())

    def command(self, code: int) -> Command | None:
        """Return what a press means."""
        return self._commands.get(code)

    def may(self, meaning: Meaning, code: int) -> bool:
        """Whether a key can be given that meaning at all."""
        device = self.device
        if code in device.standard[meaning] or (isinstance(meaning, Held) and code in device.engines):
            return True
        return code not in device.taken and not any(code in codes for codes in device.fixed.values())

    def bereft(self, meaning: Meaning, code: int) -> Meaning | None:
        """Return what would be left without any key if this one meant `meaning`; None if nothing would."""
        owner = self._owner(meaning, code)
        if owner is None or owner in self.device.fixed or self._left(owner, meaning, code):
            return None
        return owner

    def bind(self, meaning: Meaning, code: int) -> Meaning | None:
        """Let a key mean this, and nothing else that can be changed. Returns what has lost it, if anything has.

        What has lost its only key gets those that are given up here, as far as it may have them. Raises ValueError
        where it may have none of them: nothing is ever left without a key.
        """
        if (poor := self.bereft(meaning, code)) is not None:
            raise ValueError(f"{poor.name} would be left without any key")
        loser = self._owner(meaning, code)
        if loser is not None:
            self.table[loser] = self._left(loser, meaning, code)
        self.table[meaning] = (code,)
        self._index()
        return loser

    def _owner(self, meaning: Meaning, code: int) -> Meaning | None:
        """Return what else has that key, of all that can be changed."""
        return next((other for other, codes in self.table.items() if code in codes and other is not meaning), None)

    def _left(self, loser: Meaning, meaning: Meaning, code: int) -> tuple[int, ...]:
        """Return the keys of `loser` once `meaning` has taken one from it, and given up its own."""
        left = _without(self.table[loser], {code})
        return left or tuple(each for each in self.table[meaning] if each != code and self.may(loser, each))

    def reset(self, meaning: Meaning | None = None) -> None:
        """Give one meaning, or all of them, back what the game comes with.

        Others let go of those keys; what would be left without any gets its own back, too.
        """
        if meaning is None:
            self.table = dict(self.device.standard)
        else:
            self._restore([meaning])
        self._index()

    def _restore(self, meanings: list[Meaning]) -> None:
        """Reset meanings, and whatever is left without a key by that: at most once each, for their own keys differ."""
        for meaning in meanings:
            own = self.device.standard[meaning]
            for other, codes in self.table.items():
                if other is not meaning and not set(codes).isdisjoint(own):
                    self.table[other] = _without(codes, own)
                    meanings += [other] * self._lacks(other)
            self.table[meaning] = own

    def _lacks(self, meaning: Meaning) -> bool:
        """Whether something that comes with a key is left without any."""
        return bool(self.device.standard[meaning]) and not self.codes(meaning)

    def to_dict(self) -> dict[str, list[str]]:
        """Return what differs from what the game comes with, in words for the settings file."""
        names = {code: name for name, code in self.device.names.items()}
        return {
            meaning.name.lower(): [names.get(code, f"#{code}") for code in codes]
            for meaning, codes in self.table.items()
            if codes != self.device.standard[meaning]
        }

    def follow(self, saved: Mapping[str, Any]) -> None:
        """Take what `to_dict` returned; what makes no sense is passed over, and the first owner of a key keeps it."""
        self.table, taken = dict(self.device.standard), set[int]()
        changed = [meaning for meaning in self.table if isinstance(saved.get(meaning.name.lower()), list)]
        for meaning in changed:
            codes = [self._code(word) for word in saved[meaning.name.lower()]]
            fit = dict.fromkeys(code for code in codes if code is not None and self.may(meaning, code))
            self.table[meaning] = _without(fit, taken)
            taken.update(self.table[meaning])
        for meaning in self.table.keys() - changed:
            self.table[meaning] = _without(self.table[meaning], taken)
        self._restore([meaning for meaning in self.table if self._lacks(meaning)])
        self._index()

    def _code(self, word: object) -> int | None:
        if not isinstance(word, str):
            return None
        if word[:1] == "#" and word[1:].isdecimal() and len(word) < 12:
            return int(word[1:])
        return self.device.names.get(word)

    def _index(self) -> None:
        """Look up by key: what is fixed comes before what was chosen, and that before a spare letter."""
        self._commands = dict(self.device.spare)
        for table in (self.table, self.device.fixed):
            for meaning, codes in table.items():
                if isinstance(meaning, Command):
                    self._commands.update(dict.fromkeys(codes, meaning))


def _without(codes: Iterable[int], others: Container[int]) -> tuple[int, ...]:
    return tuple(code for code in codes if code not in others)
