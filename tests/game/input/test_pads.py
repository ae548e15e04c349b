"""A real gamepad, as far as SDL can tell: plugged in, pressed and pulled out while the game runs."""

import ctypes
import gc
from collections.abc import Callable, Iterator
from pathlib import Path

import pygame
import pytest

from ai.lander.push import KEYS, STEPS, Push
from game.core import texts
from game.core.settings import Settings
from game.drawing.glyphs import SIGN
from game.input.controls import Command, Controls
from game.scenes.play.flight_controls import FINE, FlightControls
from game.scenes.play.scene import PlayScene
from tests.support.driver import Driver
from tests.support.flights import actions

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


def test_a_pad_pulled_out_in_flight_pauses_and_another_flies_on(
    open_game: Callable[..., Driver], game: Driver, pads: VirtualPads
):
    game.app.close()  # one window at a time keeps the settings
    game = open_game(PlayScene, 3)
    play = game.top
    pads.plug_in()
    game.frames(3)
    gc.collect()  # a pad that nobody holds on to would fall silent here
    pads.press(pygame.CONTROLLER_BUTTON_A)
    pads.push(pygame.CONTROLLER_AXIS_TRIGGERRIGHT, 32000)
    game.frames(10)
    assert play.flight.recording.pushes[-1].action == 3
    flown = play.flight.at
    pads.pull_out_all()
    game.frames(3)
    assert "PauseScene" in game.top_name
    assert game.said == texts.PAD_LOST
    assert not SIGN.search(game.app.context.controls.word(Command.CONFIRM))
    game.key(pygame.K_ESCAPE)
    game.frames(10)
    assert set(actions(play.flight)[flown + 2 :]) <= {0}  # no engine sticks
    assert play.waiting  # it hangs until it is touched
    pads.plug_in()
    game.frames(3)
    pads.press(pygame.CONTROLLER_BUTTON_A)
    game.frames(3)
    assert play.flight.recording.pushes[-1].action == 3
    assert SIGN.search(game.app.context.controls.word(Command.CONFIRM))


def test_a_pad_pulled_out_before_its_turn_is_not_reported_by_the_name_of_another(game: Driver, pads: VirtualPads):
    pads.plug_in()
    game.frames(2)
    assert "Virtual" in game.said
    game.app.context.note("said since")
    game.post(pygame.CONTROLLERDEVICEADDED, device_index=7, guid="")
    assert game.said == "said since"
    assert game.app.context.controls.pads == 1


# Sticks and triggers as shares of thrust, from the events of a real pad as far as SDL can tell.

TURN, RISE = pygame.CONTROLLER_AXIS_LEFTX, pygame.CONTROLLER_AXIS_RIGHTY
PULL, PULL_LEFT = pygame.CONTROLLER_AXIS_TRIGGERRIGHT, pygame.CONTROLLER_AXIS_TRIGGERLEFT


@pytest.fixture
def controls() -> Controls:
    return Controls()


def push(controls: Controls, axis: int, value: int, pad: int = 0) -> None:
    controls.process(pygame.Event(pygame.CONTROLLERAXISMOTION, instance_id=pad, axis=axis, value=value))


def stick(controls: Controls, **settings: bool) -> Push:
    return FlightControls(controls, Settings(**settings)).read(640.0)


def test_a_pad_at_rest_asks_for_nothing(controls: Controls):
    assert stick(controls) == Push()
    for axis, value in ((TURN, 4000), (RISE, -4000), (PULL, 900), (PULL, 0), (TURN, -4500)):
        push(controls, axis, value)
        assert stick(controls) == Push(), (axis, value)


@pytest.mark.parametrize("axis", [PULL, RISE])
def test_a_throttle_gives_more_the_farther_it_goes_and_all_before_its_end(controls: Controls, axis: int):
    way = -1 if axis == RISE else 1
    thrusts = []
    for value in range(0, 32768, 1024):
        push(controls, axis, way * value)
        thrusts.append(stick(controls).main)
    assert thrusts == sorted(thrusts)
    assert set(thrusts) == set(range(STEPS + 1))
    assert thrusts[-2:] == [STEPS, STEPS]


def test_the_stick_turns_to_both_sides_alike_and_finely_near_its_rest(controls: Controls):
    for value in (8000, 16000, 24000, 32000):
        sides = []
        for way in (-1, 1):
            push(controls, TURN, way * value)
            asked = stick(controls)
            assert asked.action == (1 if way < 0 else 2)
            sides.append(asked.side)
        assert sides[0] == -sides[1]
    push(controls, TURN, 16000)
    assert 0 < stick(controls).side < STEPS / 3  # the curve: half of the way is less than a third


def test_a_hand_that_trembles_does_not_move_the_throttle_but_both_ends_are_reached(controls: Controls):
    reader = FlightControls(controls, Settings())

    def at(value: int) -> Push:
        push(controls, PULL, value)
        return reader.read(640.0)

    rest = at(16384)
    assert rest == Push(8, 0)
    assert at(16384 + 1100) == at(16384 - 1100) == rest  # a little more than half of a step
    assert at(16384 + 2200) == Push(9, 0)
    assert at(32767) == KEYS[3]
    assert at(0) == Push()


def test_a_trigger_that_rests_below_zero_is_learnt_from_its_first_value(controls: Controls):
    push(controls, PULL, -32767)
    assert stick(controls) == Push()
    push(controls, PULL, 0)  # half of its way
    assert stick(controls) == (8, 0)
    push(controls, PULL, 32767)
    assert stick(controls) == KEYS[3]
    push(controls, PULL, -32000)
    assert stick(controls) == Push()
    push(controls, PULL, 16384, pad=1)  # another pad, whose trigger rests at 0
    assert stick(controls) == (8, 0)


def test_without_analogue_it_is_all_or_nothing(controls: Controls):
    push(controls, PULL, 12000)
    push(controls, TURN, -12000)
    assert stick(controls) not in KEYS
    assert stick(controls, analogue=False) == KEYS[4]


def test_fine_turning_takes_a_part_of_the_jets_and_nothing_of_the_engine(controls: Controls):
    for key in (pygame.K_LEFT, pygame.K_UP):
        controls.process(pygame.Event(pygame.KEYDOWN, key=key, mod=0))
    assert stick(controls) == KEYS[4]
    controls.process(pygame.Event(pygame.KEYDOWN, key=pygame.K_LSHIFT, mod=0))
    assert stick(controls) == Push(STEPS, -round(FINE * STEPS))
    controls.process(pygame.Event(pygame.KEYUP, key=pygame.K_LSHIFT, mod=0))
    push(controls, PULL_LEFT, 30000)  # the same with a pad
    assert stick(controls) == (STEPS, -round(FINE * STEPS))


def test_the_mouse_turns_finely_while_its_middle_button_is_held(controls: Controls):
    hands = FlightControls(controls, Settings())
    for button in (3, 2):
        hands.take(pygame.Event(pygame.MOUSEBUTTONDOWN, pos=(900, 300), button=button))
    assert hands.read(640.0) == Push(0, round(FINE * STEPS))
    hands.take(pygame.Event(pygame.MOUSEBUTTONUP, pos=(900, 300), button=2))
    assert hands.read(640.0) == KEYS[2]


@pytest.mark.parametrize("device", ["trigger", "mouse"])
def test_a_press_switches_the_engine_on_and_the_next_one_off(controls: Controls, device: str):
    hands = FlightControls(controls, Settings(toggle_thrust=True))

    def press(down: bool) -> None:
        if device == "trigger":
            push(controls, PULL, 30000 * down)
        else:
            kind = pygame.MOUSEBUTTONDOWN if down else pygame.MOUSEBUTTONUP
            hands.take(pygame.Event(kind, pos=(640, 300), button=1))

    burns = []
    for down in (True, True, False, False, True, False):
        press(down)
        burns.append(hands.read(640.0).action == 3)
    assert burns == [True, True, True, True, False, False]
    press(True)
    hands.read(640.0)
    hands.begin()  # another flight
    assert hands.read(640.0) == Push()
