"""Keys and gamepads, turned into what a pilot holds and what a player commands."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum, auto
from typing import Final

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


class Held(Enum):
    """What a pilot holds down."""

    MAIN = auto()
    LEFT = auto()
    RIGHT = auto()


# The one table of bindings. A key may stand in both halves: Up thrusts in flight and moves in a menu.
KEYS: Final[dict[Command | Held, tuple[int, ...]]] = {
    Held.MAIN: (pygame.K_SPACE, pygame.K_UP, pygame.K_w),
    Held.LEFT: (pygame.K_LEFT, pygame.K_a),
    Held.RIGHT: (pygame.K_RIGHT, pygame.K_d),
    Command.CONFIRM: (pygame.K_RETURN, pygame.K_KP_ENTER),
    Command.BACK: (pygame.K_BACKSPACE, pygame.K_AC_BACK),
    Command.UP: (pygame.K_UP, pygame.K_w),
    Command.DOWN: (pygame.K_DOWN, pygame.K_s),
    Command.LEFT: (pygame.K_LEFT, pygame.K_a),
    Command.RIGHT: (pygame.K_RIGHT, pygame.K_d),
    Command.HANDOVER: (pygame.K_TAB,),
    Command.PAUSE: (pygame.K_ESCAPE, pygame.K_p),
    Command.RETRY: (pygame.K_r,),
    Command.STEP: (pygame.K_PERIOD,),
    Command.SLOWER: (pygame.K_MINUS, pygame.K_KP_MINUS, pygame.K_LEFTBRACKET),
    Command.FASTER: (pygame.K_PLUS, pygame.K_EQUALS, pygame.K_KP_PLUS, pygame.K_RIGHTBRACKET),
    Command.NEXT: (pygame.K_n, pygame.K_PAGEDOWN),
    Command.PREVIOUS: (pygame.K_b, pygame.K_PAGEUP),
    Command.CHOICES: (pygame.K_c,),
    Command.MODE: (pygame.K_g,),
    Command.FULLSCREEN: (pygame.K_F11,),
    Command.SCREENSHOT: (pygame.K_F12,),
}
BUTTONS: Final[dict[Command | Held, tuple[int, ...]]] = {
    Held.MAIN: (pygame.CONTROLLER_BUTTON_A, pygame.CONTROLLER_BUTTON_DPAD_UP),
    Held.LEFT: (pygame.CONTROLLER_BUTTON_DPAD_LEFT,),
    Held.RIGHT: (pygame.CONTROLLER_BUTTON_DPAD_RIGHT,),
    Command.CONFIRM: (pygame.CONTROLLER_BUTTON_A,),
    Command.BACK: (pygame.CONTROLLER_BUTTON_B,),
    Command.UP: (pygame.CONTROLLER_BUTTON_DPAD_UP,),
    Command.DOWN: (pygame.CONTROLLER_BUTTON_DPAD_DOWN,),
    Command.LEFT: (pygame.CONTROLLER_BUTTON_DPAD_LEFT,),
    Command.RIGHT: (pygame.CONTROLLER_BUTTON_DPAD_RIGHT,),
    Command.HANDOVER: (pygame.CONTROLLER_BUTTON_Y,),
    Command.PAUSE: (pygame.CONTROLLER_BUTTON_START,),
    Command.RETRY: (pygame.CONTROLLER_BUTTON_X,),
    Command.STEP: (pygame.CONTROLLER_BUTTON_RIGHTSTICK,),
    Command.CHOICES: (pygame.CONTROLLER_BUTTON_BACK,),
    Command.MODE: (pygame.CONTROLLER_BUTTON_LEFTSTICK,),
    Command.PREVIOUS: (pygame.CONTROLLER_BUTTON_LEFTSHOULDER,),
    Command.NEXT: (pygame.CONTROLLER_BUTTON_RIGHTSHOULDER,),
}
# Axis, direction, how far out of 32767 it must be pushed.
AXES: Final[dict[Held, tuple[int, int, int]]] = {
    Held.MAIN: (pygame.CONTROLLER_AXIS_TRIGGERRIGHT, 1, 8000),
    Held.LEFT: (pygame.CONTROLLER_AXIS_LEFTX, -1, 11000),
    Held.RIGHT: (pygame.CONTROLLER_AXIS_LEFTX, 1, 11000),
}
STICK_COMMANDS: Final[dict[Command, tuple[int, int]]] = {
    Command.LEFT: (pygame.CONTROLLER_AXIS_LEFTX, -1),
    Command.RIGHT: (pygame.CONTROLLER_AXIS_LEFTX, 1),
    Command.UP: (pygame.CONTROLLER_AXIS_LEFTY, -1),
    Command.DOWN: (pygame.CONTROLLER_AXIS_LEFTY, 1),
    Command.SLOWER: (pygame.CONTROLLER_AXIS_RIGHTX, -1),
    Command.FASTER: (pygame.CONTROLLER_AXIS_RIGHTX, 1),
}
STICK_PUSHED: Final = 20000
STICK_RELEASED: Final = 12000

KEY_WORDS: Final[dict[Command, str]] = {
    Command.CONFIRM: "Enter",
    Command.BACK: "Esc",
    Command.PAUSE: "Esc",
    Command.HANDOVER: "Tab",
    Command.RETRY: "R",
    Command.STEP: ".",
    Command.SLOWER: "−",
    Command.FASTER: "+",
    Command.NEXT: "N",
    Command.PREVIOUS: "B",
    Command.CHOICES: "C",
    Command.MODE: "G",
    Command.FULLSCREEN: "F11",
    Command.SCREENSHOT: "F12",
}
BUTTON_WORDS: Final[dict[Command, str]] = {
    Command.CONFIRM: "A",
    Command.BACK: "B",
    Command.PAUSE: "Start",
    Command.HANDOVER: "Y",
    Command.RETRY: "X",
    Command.STEP: "R3",
    Command.NEXT: "RB",
    Command.PREVIOUS: "LB",
    Command.SLOWER: "R ←",
    Command.FASTER: "R →",
    Command.CHOICES: "View",
    Command.MODE: "L3",
}
_KEY_COMMANDS: Final = {key: c for c, keys in KEYS.items() if isinstance(c, Command) for key in keys}
_BUTTON_COMMANDS: Final = {b: c for c, buttons in BUTTONS.items() if isinstance(c, Command) for b in buttons}


def translate(event: pygame.event.Event) -> Command | None:
    """Return the command an event means, if any. A stick's push was marked by `Controls.process`."""
    if event.type == pygame.KEYDOWN:
        if event.key == pygame.K_RETURN and getattr(event, "mod", 0) & pygame.KMOD_ALT:
            return Command.FULLSCREEN
        return _KEY_COMMANDS.get(event.key)
    if event.type == pygame.CONTROLLERBUTTONDOWN:
        return _BUTTON_COMMANDS.get(event.button)
    return getattr(event, "command", None)


def presses_main(event: pygame.event.Event) -> bool:
    """Tell whether the event presses the main engine, which in a menu confirms as well."""
    return event.type == pygame.KEYDOWN and event.key in KEYS[Held.MAIN]


@dataclass
class _Pad:
    buttons: set[int] = field(default_factory=set)
    axes: dict[int, int] = field(default_factory=dict)
    pushed: set[Command] = field(default_factory=set)
    device: object = None  # SDL closes a pad that nobody holds on to


class Controls:
    """What is held down at the moment, on the keyboard and on every pad together.

    Attributes:
        pad_in_use: whether a pad was touched last, rather than the keyboard; hints name its buttons then.
        mouse_in_use: whether the mouse was touched last; no ring is drawn around what is in focus then.

    """

    def __init__(self) -> None:
        self._keys: set[int] = set()
        self._pads: dict[int, _Pad] = {}
        self.pad_in_use = False
        self.mouse_in_use = False

    @property
    def main(self) -> bool:
        """Whether the main engine is asked for."""
        return self._held(Held.MAIN)

    @property
    def steer(self) -> int:
        """0 for none (or both at once), 1 for left, 2 for right."""
        left, right = self._held(Held.LEFT), self._held(Held.RIGHT)
        return 0 if left == right else (1 if left else 2)

    @property
    def action(self) -> int:
        """The lander's action: 3 · main + steer."""
        return 3 * self.main + self.steer

    def word(self, command: Command) -> str:
        """Name the key for a command, or the button while a pad is in use."""
        return (BUTTON_WORDS if self.pad_in_use else KEY_WORDS).get(command) or KEY_WORDS.get(command, "")

    def release_all(self) -> None:
        """Let go of everything: the window no longer hears what is released."""
        self._keys.clear()
        for pad in self._pads.values():
            pad.buttons.clear()
            pad.axes.clear()
            pad.pushed.clear()

    def process(self, event: pygame.event.Event) -> None:
        """Follow one event. A stick pushed far enough marks its event with a `command`."""
        match event.type:
            case pygame.KEYDOWN:
                self._keys.add(event.key)
                self.pad_in_use = self.mouse_in_use = False
            case pygame.MOUSEMOTION | pygame.MOUSEBUTTONDOWN:
                self.mouse_in_use = True
            case pygame.KEYUP:
                self._keys.discard(event.key)
            case pygame.WINDOWFOCUSLOST:
                self.release_all()
            case pygame.CONTROLLERDEVICEADDED:
                self._open(event.device_index)
            case pygame.CONTROLLERDEVICEREMOVED:
                self._pads.pop(event.instance_id, None)
            case pygame.CONTROLLERBUTTONDOWN:
                self._pad(event).buttons.add(event.button)
                self._use_pad()
            case pygame.CONTROLLERBUTTONUP:
                self._pad(event).buttons.discard(event.button)
            case pygame.CONTROLLERAXISMOTION:
                self._move(event)

    def _held(self, held: Held) -> bool:
        if not self._keys.isdisjoint(KEYS[held]):
            return True
        axis, direction, threshold = AXES[held]
        return any(
            not pad.buttons.isdisjoint(BUTTONS[held]) or direction * pad.axes.get(axis, 0) > threshold
            for pad in self._pads.values()
        )

    def _use_pad(self) -> None:
        self.pad_in_use, self.mouse_in_use = True, False

    def _pad(self, event: pygame.event.Event) -> _Pad:
        return self._pads.setdefault(event.instance_id, _Pad())

    def _open(self, device_index: int) -> None:
        from pygame._sdl2 import controller

        try:
            device = controller.Controller(device_index)
            instance = device.as_joystick().get_instance_id()
        except pygame.error:
            return  # pulled out again before its turn came
        self._pads.setdefault(instance, _Pad()).device = device

    def _move(self, event: pygame.event.Event) -> None:
        pad = self._pad(event)
        pad.axes[event.axis] = event.value
        for command, (axis, direction) in STICK_COMMANDS.items():
            if axis != event.axis:
                continue
            push = direction * event.value
            if push > STICK_PUSHED and command not in pad.pushed:
                pad.pushed.add(command)
                event.command = command
                self._use_pad()
            elif push < STICK_RELEASED:
                pad.pushed.discard(command)
