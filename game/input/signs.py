"""Signs of gamepad and mouse buttons, as characters of text.

Each is one character of Unicode's private use area, so a sign can stand in a hint as well as in a sentence.
`game.drawing.glyphs` draws them.
"""

from __future__ import annotations

from typing import Final, Literal

import pygame

Family = Literal["xbox", "playstation", "nintendo"]
FAMILIES: Final[tuple[Family, ...]] = ("xbox", "playstation", "nintendo")
# Numbers after the buttons, which have SDL's, and the triggers, 32 and 33 (see `game.input.bindings`).
TURN, STICK_LEFT, STICK_RIGHT, CROSS, MOUSE_LEFT, MOUSE_RIGHT, MOUSE_MIDDLE = 40, 41, 42, 43, 44, 45, 46

FIRST: Final = 0xE000
FAMILY: Final = 0x100

# A sign's outline, and its content: letters, or the name of a mark.
_XBOX: Final[dict[int, tuple[str, str]]] = {
    pygame.CONTROLLER_BUTTON_A: ("round", "A"),
    pygame.CONTROLLER_BUTTON_B: ("round", "B"),
    pygame.CONTROLLER_BUTTON_X: ("round", "X"),
    pygame.CONTROLLER_BUTTON_Y: ("round", "Y"),
    pygame.CONTROLLER_BUTTON_BACK: ("round", "windows"),
    pygame.CONTROLLER_BUTTON_START: ("round", "lines"),
    pygame.CONTROLLER_BUTTON_LEFTSTICK: ("stick", "L"),
    pygame.CONTROLLER_BUTTON_RIGHTSTICK: ("stick", "R"),
    pygame.CONTROLLER_BUTTON_LEFTSHOULDER: ("wide", "LB"),
    pygame.CONTROLLER_BUTTON_RIGHTSHOULDER: ("wide", "RB"),
    pygame.CONTROLLER_BUTTON_DPAD_UP: ("cross", "up"),
    pygame.CONTROLLER_BUTTON_DPAD_DOWN: ("cross", "down"),
    pygame.CONTROLLER_BUTTON_DPAD_LEFT: ("cross", "left"),
    pygame.CONTROLLER_BUTTON_DPAD_RIGHT: ("cross", "right"),
    32: ("wide", "LT"),
    33: ("wide", "RT"),
    TURN: ("stick", "turn"),
    STICK_LEFT: ("stick", "left"),
    STICK_RIGHT: ("stick", "right"),
    CROSS: ("cross", "all"),
    MOUSE_LEFT: ("mouse", "left"),
    MOUSE_RIGHT: ("mouse", "right"),
    MOUSE_MIDDLE: ("mouse", "middle"),
}
SIGNS: Final[dict[Family, dict[int, tuple[str, str]]]] = {
    "xbox": _XBOX,
    "playstation": {
        **_XBOX,
        pygame.CONTROLLER_BUTTON_A: ("round", "saltire"),
        pygame.CONTROLLER_BUTTON_B: ("round", "ring"),
        pygame.CONTROLLER_BUTTON_X: ("round", "square"),
        pygame.CONTROLLER_BUTTON_Y: ("round", "triangle"),
        pygame.CONTROLLER_BUTTON_LEFTSHOULDER: ("wide", "L1"),
        pygame.CONTROLLER_BUTTON_RIGHTSHOULDER: ("wide", "R1"),
        32: ("wide", "L2"),
        33: ("wide", "R2"),
    },
    "nintendo": {
        **_XBOX,
        pygame.CONTROLLER_BUTTON_BACK: ("round", "minus"),
        pygame.CONTROLLER_BUTTON_START: ("round", "plus"),
        pygame.CONTROLLER_BUTTON_LEFTSHOULDER: ("wide", "L"),
        pygame.CONTROLLER_BUTTON_RIGHTSHOULDER: ("wide", "R"),
        32: ("wide", "ZL"),
        33: ("wide", "ZR"),
    },
}
_FAMILY_WORDS: Final[dict[Family, tuple[str, ...]]] = {
    "playstation": ("playstation", "dualshock", "dualsense", "ps3", "ps4", "ps5", "sony", "wireless controller"),
    "nintendo": ("nintendo", "switch", "joy-con", "joycon", "pro controller"),
}


def family_of(name: str) -> Family:
    """Return the family of signs for a gamepad, from the name it reports; Xbox letters for an unknown one."""
    name = name.lower()
    if "xbox" in name:
        return "xbox"
    return next((family for family, words in _FAMILY_WORDS.items() if any(word in name for word in words)), "xbox")


def sign(family: Family, button: int) -> str:
    """Return the character for a gamepad button, or for one of the further signs above."""
    return chr(FIRST + FAMILIES.index(family) * FAMILY + button)
