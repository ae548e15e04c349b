import pygame
import pytest

from game.core.settings import Settings
from game.drawing.glyphs import SIGN
from game.input.bindings import FIXED_KEYS, KEYBOARD, KEYS, PAD, Bindings, Command, Held
from game.input.controls import Controls, key_name, presses_main, translate
from game.input.signs import family_of, sign


def send(controls: Controls, event_type: int, **values) -> pygame.event.Event:
    event = pygame.event.Event(event_type, values)
    controls.process(event)
    return event


def hold(controls: Controls, *keys: int) -> None:
    for key in keys:
        send(controls, pygame.KEYDOWN, key=key, mod=0)


def held(controls: Controls) -> int:
    """What is held of the engines, as the action that flies so."""
    left, right = controls.holds(Held.LEFT), controls.holds(Held.RIGHT)
    return 3 * controls.main + (left - right) % 3


def test_held_keys_make_the_action_and_losing_focus_lets_go_of_everything():
    up, left, right = pygame.K_UP, pygame.K_LEFT, pygame.K_RIGHT
    for keys, action in (
        ((), 0), ((left,), 1), ((pygame.K_d,), 2), ((pygame.K_SPACE,), 3), ((pygame.K_w, pygame.K_a), 4),
        ((up, right), 5), ((pygame.K_a, pygame.K_d), 0),
    ):  # fmt: skip
        controls = Controls()
        hold(controls, *keys)
        assert held(controls) == action, keys
        for key in keys:
            send(controls, pygame.KEYUP, key=key, mod=0)
        assert held(controls) == 0
    hold(controls, pygame.K_SPACE, left)
    send(controls, pygame.CONTROLLERAXISMOTION, instance_id=3, axis=pygame.CONTROLLER_AXIS_LEFTX, value=-32768)
    send(controls, pygame.WINDOWFOCUSLOST)
    assert held(controls) == 0


def test_a_pad_pulled_out_lets_go_and_another_goes_on():
    controls = Controls()
    send(controls, pygame.CONTROLLERDEVICEADDED, device_index=7)  # there is none: must not raise
    send(controls, pygame.CONTROLLERBUTTONDOWN, instance_id=0, button=pygame.CONTROLLER_BUTTON_A)
    send(controls, pygame.CONTROLLERAXISMOTION, instance_id=1, axis=pygame.CONTROLLER_AXIS_LEFTX, value=30000)
    assert held(controls) == 5
    send(controls, pygame.CONTROLLERDEVICEREMOVED, instance_id=0)
    assert held(controls) == 2
    send(controls, pygame.CONTROLLERDEVICEREMOVED, instance_id=1)
    send(controls, pygame.CONTROLLERDEVICEREMOVED, instance_id=1)
    send(controls, pygame.CONTROLLERBUTTONUP, instance_id=1, button=pygame.CONTROLLER_BUTTON_A)
    assert held(controls) == 0


def test_a_stick_commands_once_a_push():
    controls = Controls()
    axis = {"instance_id": 0, "axis": pygame.CONTROLLER_AXIS_LEFTY}
    pushes = [
        translate(send(controls, pygame.CONTROLLERAXISMOTION, **axis, value=value))
        for value in (9000, 24000, 32000, 16000, 24000, 3000, 24000, -24000)
    ]
    assert pushes == [None, Command.DOWN, None, None, None, None, Command.DOWN, Command.UP]


def test_hints_name_the_device_in_use():
    controls = Controls()
    assert controls.word(Command.HANDOVER) == "Tab"
    send(controls, pygame.CONTROLLERBUTTONDOWN, instance_id=0, button=pygame.CONTROLLER_BUTTON_Y)
    assert controls.word(Command.HANDOVER) == sign("xbox", pygame.CONTROLLER_BUTTON_Y)
    assert controls.word(Command.FULLSCREEN) == "F11"
    hold(controls, pygame.K_TAB)
    assert controls.word(Command.HANDOVER) == "Tab"


def test_signs_go_with_the_pad_and_another_pads_release_does_not_matter():
    controls = Controls()
    send(controls, pygame.CONTROLLERBUTTONDOWN, instance_id=4, button=pygame.CONTROLLER_BUTTON_A)
    assert SIGN.fullmatch(controls.word(Command.CONFIRM))
    assert translate(send(controls, pygame.CONTROLLERDEVICEREMOVED, instance_id=9)) is None
    assert controls.gamepad_in_use
    assert translate(send(controls, pygame.CONTROLLERDEVICEREMOVED, instance_id=4)) is Command.UNPLUGGED
    assert controls.word(Command.CONFIRM) == "Enter"


def test_a_pad_has_the_signs_of_its_make():
    for name, family in (
        ("Xbox Wireless Controller", "xbox"), ("DualSense Wireless Controller", "playstation"),
        ("PS4 Controller", "playstation"), ("Nintendo Switch Pro Controller", "nintendo"),
        ("Generic USB Joystick", "xbox"),
    ):  # fmt: skip
        assert family_of(name) == family


def test_every_command_has_a_key():
    bound = {meaning for table in (KEYS, FIXED_KEYS) for meaning in table if isinstance(meaning, Command)}
    assert bound == set(Command) - {Command.UNPLUGGED}


def test_a_key_that_is_bound_means_that_alone():
    controls = Controls()
    controls.keys.bind(Held.MAIN, pygame.K_f)
    hold(controls, pygame.K_UP)
    assert held(controls) == 0
    hold(controls, pygame.K_f)
    assert held(controls) == 3
    assert controls.word(Held.MAIN) == "F"
    assert presses_main(send(controls, pygame.KEYDOWN, key=pygame.K_f, mod=0))
    assert not presses_main(send(controls, pygame.KEYDOWN, key=pygame.K_w, mod=0))
    assert presses_main(send(controls, pygame.KEYDOWN, key=pygame.K_SPACE, mod=0))


def test_a_key_is_taken_from_what_had_it_and_goes_back():
    keys = Bindings(KEYBOARD)
    keys.bind(Command.CHOICES, pygame.K_n)
    assert keys.command(pygame.K_n) is Command.CHOICES
    assert keys.codes(Command.NEXT) == (pygame.K_PAGEDOWN,)
    assert keys.owner(pygame.K_PAGEDOWN) is Command.NEXT
    assert keys.owner(pygame.K_c) is None
    keys.reset()
    assert keys.table == KEYS
    assert keys.to_dict() == {}


@pytest.mark.parametrize("device", [KEYBOARD, PAD])
def test_nobody_can_lock_themselves_out(device):
    """Bind everything that can be bound to everything: menus can still be walked and left."""
    bindings = Bindings(device)
    for meaning in device.standard:
        for code in set(device.names.values()):
            if bindings.may(meaning, code):
                bindings.bind(meaning, code)
            for command, codes in device.fixed.items():
                assert all(bindings.command(each) is command for each in codes)
    owners = [code for codes in bindings.table.values() for code in codes]
    assert len(owners) == len(set(owners))


def test_bindings_survive_the_settings_file():
    controls, settings = Controls(), Settings()
    controls.keys.bind(Held.LEFT, pygame.K_j)
    controls.keys.bind(Command.NEXT, 0xE9)  # a letter that only some keyboards have
    controls.buttons.bind(Command.RETRY, pygame.CONTROLLER_BUTTON_LEFTSHOULDER)
    settings.keys, settings.buttons = controls.keys.to_dict(), controls.buttons.to_dict()
    again = Controls()
    again.follow(Settings.from_dict(settings.to_dict()))
    assert again.keys.table == controls.keys.table
    assert again.buttons.table == controls.buttons.table
    assert again.word(Command.NEXT) == "\xc9"
    assert [key_name(code) for code in (0x85, 0xD800, 0x110000)] == ["#133", "#55296", "#1114112"]


def test_damaged_bindings_are_passed_over():
    for damaged in (
        {"keys": {"main": "space", "left": 5, "retry": ["no such key", None, 7, "#x", "#-1"]}},
        {"keys": {"retry": ["escape", "return", "up"], "unheard": ["a"], "7": []}},
        {"keys": [1], "buttons": "a"},
        {"keys": {"retry": ["c"], "next": ["c"], "choices": ["c", "c"]}},
        {"buttons": {"retry": ["start", "#99999999999999999999"], "main": [["a"]]}},
    ):
        controls = Controls()
        controls.follow(Settings.from_dict(damaged))
        for bindings in (controls.keys, controls.buttons):
            codes = [code for codes in bindings.table.values() for code in codes]
            assert len(codes) == len(set(codes)), damaged
        assert translate(send(controls, pygame.KEYDOWN, key=pygame.K_ESCAPE, mod=0)) is Command.PAUSE
        assert translate(send(controls, pygame.KEYDOWN, key=pygame.K_RETURN, mod=0)) is Command.CONFIRM


def test_triggers_are_buttons_like_others():
    controls = Controls()

    def pull(value: int) -> pygame.event.Event:
        axis = pygame.CONTROLLER_AXIS_TRIGGERRIGHT
        return send(controls, pygame.CONTROLLERAXISMOTION, instance_id=0, axis=axis, value=value)

    pull(20000)
    assert held(controls) == 3
    pull(0)
    assert held(controls) == 0
    controls.buttons.bind(Command.RETRY, 33)
    assert [translate(pull(value)) for value in (9000, 30000, 7000, 9000, 0, 9000)] == [
        Command.RETRY,
        None,
        None,
        None,
        None,
        Command.RETRY,
    ]
    assert held(controls) == 0


def test_new_keys_give_way_to_those_a_player_has_chosen_before_they_existed():
    keys, pad = Bindings(KEYBOARD), Bindings(PAD)
    keys.follow({"main": ["lshift"], "retry": ["rshift"], "next": ["f10"]})
    pad.follow({"left": ["triggerleft"]})
    assert (keys.codes(Held.MAIN), keys.codes(Held.FINE)) == ((pygame.K_LSHIFT,), ())
    assert (keys.command(pygame.K_F10), keys.codes(Command.MUTE)) == (Command.NEXT, ())
    assert pad.codes(Held.LEFT) == (32,)
    assert pad.codes(Held.FINE) == ()
