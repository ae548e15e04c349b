import pygame
import pytest

from game.controls import BUTTONS, KEYS, Command, Controls, Held, presses_main, translate


def send(controls: Controls, event_type: int, **values) -> pygame.event.Event:
    event = pygame.event.Event(event_type, values)
    controls.process(event)
    return event


def hold(controls: Controls, *keys: int) -> None:
    for key in keys:
        send(controls, pygame.KEYDOWN, key=key, mod=0)


@pytest.mark.parametrize(
    ("keys", "action"),
    [
        ((), 0),
        ((pygame.K_LEFT,), 1),
        ((pygame.K_d,), 2),
        ((pygame.K_SPACE,), 3),
        ((pygame.K_w, pygame.K_a), 4),
        ((pygame.K_UP, pygame.K_RIGHT), 5),
        ((pygame.K_a, pygame.K_d), 0),
    ],
)
def test_held_keys_make_the_action(keys, action):
    controls = Controls()
    hold(controls, *keys)
    assert controls.action == action
    for key in keys:
        send(controls, pygame.KEYUP, key=key, mod=0)
    assert controls.action == 0


def test_losing_focus_lets_go_of_everything():
    controls = Controls()
    hold(controls, pygame.K_SPACE, pygame.K_LEFT)
    send(controls, pygame.CONTROLLERAXISMOTION, instance_id=3, axis=pygame.CONTROLLER_AXIS_LEFTX, value=-32768)
    send(controls, pygame.WINDOWFOCUSLOST)
    assert controls.action == 0


def test_a_pad_pulled_out_lets_go_and_another_goes_on():
    controls = Controls()
    send(controls, pygame.CONTROLLERDEVICEADDED, device_index=7)  # there is none: must not raise
    send(controls, pygame.CONTROLLERBUTTONDOWN, instance_id=0, button=pygame.CONTROLLER_BUTTON_A)
    send(controls, pygame.CONTROLLERAXISMOTION, instance_id=1, axis=pygame.CONTROLLER_AXIS_LEFTX, value=30000)
    assert controls.action == 5
    send(controls, pygame.CONTROLLERDEVICEREMOVED, instance_id=0)
    assert controls.action == 2
    send(controls, pygame.CONTROLLERDEVICEREMOVED, instance_id=1)
    send(controls, pygame.CONTROLLERDEVICEREMOVED, instance_id=1)
    send(controls, pygame.CONTROLLERBUTTONUP, instance_id=1, button=pygame.CONTROLLER_BUTTON_A)
    assert controls.action == 0


def test_a_stick_commands_once_a_push():
    controls = Controls()
    pushes = [
        translate(
            send(
                controls,
                pygame.CONTROLLERAXISMOTION,
                instance_id=0,
                axis=pygame.CONTROLLER_AXIS_LEFTY,
                value=value,
            )
        )
        for value in (9000, 24000, 32000, 16000, 24000, 3000, 24000, -24000)
    ]
    assert pushes == [None, Command.DOWN, None, None, None, None, Command.DOWN, Command.UP]


def test_hints_name_the_device_in_use():
    controls = Controls()
    assert controls.word(Command.HANDOVER) == "Tab"
    send(controls, pygame.CONTROLLERBUTTONDOWN, instance_id=0, button=pygame.CONTROLLER_BUTTON_Y)
    assert controls.word(Command.HANDOVER) == "Y"
    assert controls.word(Command.FULLSCREEN) == "F11"
    hold(controls, pygame.K_TAB)
    assert controls.word(Command.HANDOVER) == "Tab"


@pytest.mark.parametrize("table", [KEYS, BUTTONS])
def test_no_key_has_two_meanings_of_one_kind(table):
    for kind in (Command, Held):
        bound = [key for meaning, keys in table.items() if isinstance(meaning, kind) for key in keys]
        assert len(bound) == len(set(bound))


def test_every_command_has_a_key():
    assert {meaning for meaning in KEYS if isinstance(meaning, Command)} == set(Command)


def test_space_confirms_as_the_main_engine_does():
    space = pygame.event.Event(pygame.KEYDOWN, key=pygame.K_SPACE, mod=0)
    assert presses_main(space)
    assert translate(space) is None
