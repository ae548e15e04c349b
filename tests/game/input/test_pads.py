"""A real gamepad, as far as SDL can tell: plugged in, pressed and pulled out while the game runs."""

import ctypes
import gc
from collections.abc import Callable, Iterator
from pathlib import Path

import pygame
import pytest

from game.core import texts
from game.drawing.glyphs import SIGN
from game.input.controls import Command
from game.scenes.play.scene import PlayScene
from tests.support.driver import Driver

GAME_CONTROLLER, AXES, BUTTONS = 1, 6, 15


class VirtualPads:
    """SDL's own virtual devices, in the very library that pygame has loaded."""

    def __init__(self, library: ctypes.CDLL) -> None:
        self._sdl = library
        self._sdl.SDL_JoystickOpen.restype = ctypes.c_void_p
        self._sdl.SDL_JoystickSetVirtualButton.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_uint8]
        self._sdl.SDL_JoystickSetVirtualAxis.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_int16]
        self._handle: int | None = None

    def plug_in(self) -> None:
        index = self._sdl.SDL_JoystickAttachVirtual(GAME_CONTROLLER, AXES, BUTTONS, 0)
        assert index >= 0
        self._handle = self._sdl.SDL_JoystickOpen(index)

    def press(self, button: int, down: bool = True) -> None:
        self._sdl.SDL_JoystickSetVirtualButton(self._handle, button, int(down))

    def push(self, axis: int, value: int) -> None:
        self._sdl.SDL_JoystickSetVirtualAxis(self._handle, axis, value)

    def pull_out_all(self) -> None:
        for index in reversed(range(self._sdl.SDL_NumJoysticks())):
            self._sdl.SDL_JoystickDetachVirtual(index)


@pytest.fixture
def pads(game: Driver) -> Iterator[VirtualPads]:
    folder = Path(pygame.__file__).parent.parent / "pygame_ce.libs"
    found = sorted(folder.glob("libSDL2-2*"))
    if not found:
        pytest.skip("this build of pygame has no SDL library of its own beside it")
    pads = VirtualPads(ctypes.CDLL(str(found[0])))
    yield pads
    pads.pull_out_all()


def test_a_pad_is_plugged_in_flown_with_and_pulled_out(game: Driver, pads: VirtualPads):
    controls = game.app.context.controls
    for _ in range(3):
        pads.plug_in()
        game.frames(2)
        gc.collect()  # a pad that nobody holds on to would fall silent here
        pads.press(pygame.CONTROLLER_BUTTON_A)
        pads.push(pygame.CONTROLLER_AXIS_LEFTX, -30000)
        game.frames(2)
        assert (controls.main, controls.steer) == (True, 1)
        assert controls.gamepad_in_use
        pads.pull_out_all()
        assert game.frames(2)
        assert (controls.main, controls.steer) == (False, 0)


def test_a_pad_leads_from_the_menu_to_settings_and_back(game: Driver, pads: VirtualPads):
    pads.plug_in()
    game.frames(2)

    def tap(button: int) -> None:
        for down in (True, False):
            pads.press(button, down)
            game.frames(2)

    for _ in range(5):
        tap(pygame.CONTROLLER_BUTTON_DPAD_DOWN)
    tap(pygame.CONTROLLER_BUTTON_A)
    assert game.top_name == "SettingsScene"
    tap(pygame.CONTROLLER_BUTTON_B)
    assert game.top_name == "MenuScene"


def test_two_games_one_after_the_other_hear_the_same_pad(open_game: Callable[..., Driver], pads: VirtualPads):
    pads.plug_in()
    again = open_game()
    again.frames(2)
    pads.press(pygame.CONTROLLER_BUTTON_A)
    again.frames(2)
    assert again.app.context.controls.main


def test_a_pad_pulled_out_in_flight_pauses_and_another_flies_on(
    open_game: Callable[..., Driver], game: Driver, pads: VirtualPads
):
    game.app.close()  # one window at a time keeps the settings
    game = open_game(PlayScene, 3)
    play = game.top
    pads.plug_in()
    game.frames(3)
    pads.press(pygame.CONTROLLER_BUTTON_A)
    pads.push(pygame.CONTROLLER_AXIS_TRIGGERRIGHT, 32000)
    game.frames(10)
    assert play.flight.recording.actions[-1] == 3
    flown = len(play.flight.recording.actions)
    pads.pull_out_all()
    game.frames(3)
    assert "PauseScene" in game.top_name
    assert game.said == texts.PAD_LOST
    assert not SIGN.search(game.app.context.controls.word(Command.CONFIRM))
    game.key(pygame.K_ESCAPE)
    game.frames(10)
    assert set(play.flight.recording.actions[flown + 2 :]) <= {0}  # no engine sticks
    assert play.waiting  # it hangs until it is touched
    pads.plug_in()
    game.frames(3)
    pads.press(pygame.CONTROLLER_BUTTON_A)
    game.frames(3)
    assert play.flight.recording.actions[-1] == 3
    assert SIGN.search(game.app.context.controls.word(Command.CONFIRM))


def test_a_pad_pulled_out_before_its_turn_is_not_reported_by_the_name_of_another(game: Driver, pads: VirtualPads):
    pads.plug_in()
    game.frames(2)
    assert "Virtual" in game.said
    game.app.context.note("said since")
    game.post(pygame.CONTROLLERDEVICEADDED, device_index=7, guid="")
    assert game.said == "said since"
    assert game.app.context.controls.pads == 1


def test_a_pad_pulled_out_that_nobody_uses_disturbs_nobody(open_game: Callable[..., Driver], pads: VirtualPads):
    game = open_game(PlayScene, 3)
    pads.plug_in()
    game.frames(3)
    game.key(pygame.K_UP)
    game.frames(5)
    pads.pull_out_all()
    game.frames(5)
    assert game.top_name == "PlayScene"
