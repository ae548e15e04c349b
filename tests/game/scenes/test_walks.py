"""Ways through several screens, by a gamepad alone and by the keyboard alone: real events, no window."""

from collections.abc import Callable

import pygame
import pytest

from ai.lander.environment import Outcome
from game.core import texts
from game.core.scene import Scene
from game.flight.flight import StickHolder
from game.scenes.menus.menu import MenuScene
from game.scenes.menus.settings import GROUPS_OF_SETTINGS
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from game.ui.listing import ListRow
from tests.support.driver import Driver
from tests.support.player import DEVICES, Player
from tests.support.screens import OVER_OTHERS, SCREENS, flown, save_settings
from tests.support.tour import scene_types

# Flown rather than walked, shown once something has failed, or a part of others.
NO_SCREENS = {"PlayScene", "ErrorScene"}


@pytest.fixture
def open_screen(open_game: Callable[..., Driver], context: Context) -> Callable[..., Player]:
    def open_it(make: Callable[[Context], Scene], device: str) -> Player:
        save_settings(context)
        player = Player(open_game(make), device)
        player.frames(3)
        return player

    return open_it


def test_every_screen_there_is_will_be_walked():
    assert {each.__name__ for each in scene_types()} - NO_SCREENS == SCREENS.keys() | OVER_OTHERS.keys()


def test_a_mission_is_found_flown_and_left(open_screen):
    player = open_screen(SCREENS["MenuScene"], "pad")
    player.choose(texts.MENU["play"][0])
    player.choose(texts.FLIGHTS["missions"][0])
    assert player.top_name == "MissionsScene"
    player.press("confirm")  # the list is where it begins
    player.frames(2)
    player.press("pause")
    player.choose(texts.PAUSE_LEAVE)
    assert player.top_name == "MissionsScene"
    player.press("confirm")
    player.fly()
    assert player.top.flight.outcome is Outcome.LANDED
    player.skip(90)
    player.press("pause")  # Enter leads on to the next one
    assert player.top_name == "MissionsScene"
    assert player.the(ListRow).rows[0][1] in texts.MEDALS[1:]
    player.press("back", "back")
    assert player.top_name == "MenuScene"


@pytest.mark.parametrize("device", DEVICES)
def test_a_flight_is_flown_paused_handed_over_and_left(open_screen, device: str):
    player = open_screen(SCREENS["MenuScene"], device)
    player.choose(texts.MENU["play"][0])
    player.choose(texts.FLIGHTS["free"][0])
    player.press("main", "hand over")
    assert player.top.flight.chooser.hand is StickHolder.NETWORK
    player.press("hand over", "pause")
    assert "PauseScene" in player.top_name
    player.choose(texts.PAUSE_LEAVE)
    assert player.top_name == "FlightsScene"


def test_a_replay_is_watched_wound_and_flown_on(open_screen):
    player = open_screen(lambda context: [flown(context), MenuScene(context)][1], "keys")
    player.choose(texts.MENU["play"][0])
    player.choose(texts.FLIGHTS["logbook"][0])
    player.press("confirm")
    replay = player.top
    assert player.top_name == "ReplayScene"
    player.frames(60)
    player.press("step")
    assert replay.playback.stopped
    at = replay.flight_replay.at
    player.press("left")  # the strip of what was done is where it begins
    assert replay.flight_replay.at < at
    player.press("hand over")
    assert player.top_name == "PlayScene"
    player.press("main")
    player.press("pause")
    player.choose(texts.PAUSE_LEAVE)
    assert player.top is replay
    player.press("back", "back", "back")
    assert player.top_name == "MenuScene"


@pytest.mark.parametrize("device", DEVICES)
def test_settings_are_changed_and_kept(open_screen, device: str):
    player = open_screen(SCREENS["MenuScene"], device)
    player.choose(texts.MENU["settings"][0])
    player.choose(texts.SETTINGS["colour_safe"][0])
    assert player.saved()["colour_safe"] is True
    player.press("left")  # an arrow that was meant to move on changes nothing
    assert player.saved()["colour_safe"] is True
    player.choose(texts.SETTINGS["colour_safe"][0])
    assert player.saved()["colour_safe"] is False
    group(player, "sound")
    while player.form.focused.label != texts.SOUND_GROUPS["effects"]:
        player.press("down")
    player.press("left", "left")
    assert player.saved()["effects_volume"] == pytest.approx(0.7)
    group(player, "controls")
    player.choose(texts.BINDINGS_OPEN)
    assert player.top_name == "BindingsScene"
    player.press("up", "right", "down")  # everything else
    kind = "keys" if player.device == "keys" else "buttons"
    while player.form.focused.label != texts.BINDINGS["PREVIOUS"]:
        player.press("down")
    if player.device == "pad":
        player.press("right")
    player.press("confirm", "another")
    assert player.saved()[kind].keys() == {"previous"}
    player.choose(texts.BINDINGS_ALL)
    assert player.saved()[kind] == {}
    player.press("back", "back")
    assert player.top_name == "MenuScene"


def group(player: Player, name: str) -> None:
    """Show a group of the settings."""
    player.form.focus(player.form.widgets[0])
    for _ in GROUPS_OF_SETTINGS:
        player.press("left")
    for _ in range(GROUPS_OF_SETTINGS.index(name)):
        player.press("right")
    assert player.top.group == name


def test_a_flight_is_flown_with_the_mouse_alone(open_game, context: Context):
    context.settings.tutored, context.settings.show_hints = True, False
    context.settings_file.save(context.settings)
    game: Driver = open_game(PlayScene, 3)
    play = game.top
    game.move((640, 400))
    game.frames(3)
    left, right = 1, 3
    game.post(pygame.MOUSEBUTTONDOWN, pos=game.to_window((20, 400)), button=left)
    game.frames(5)
    assert play.flight.recording.pushes[-1].action == 3
    game.post(pygame.MOUSEBUTTONDOWN, pos=game.to_window((20, 400)), button=right)
    game.frames(2)
    assert play.flight.recording.pushes[-1].action == 4
    game.move((1260, 400))
    assert play.flight.recording.pushes[-1].action == 5
    for button in (left, right):
        game.post(pygame.MOUSEBUTTONUP, pos=game.to_window((1260, 400)), button=button)
    assert play.flight.recording.pushes[-1].action == 0
    game.click(game.hints()[texts.HINT_HAND_OVER])
    assert play.flight.chooser.hand is StickHolder.NETWORK
    game.click(game.hints()[texts.HINT_PAUSE])
    assert "PauseScene" in game.top_name
    game.frames(2)
    game.click(next(word for word in game.top.form.widgets if word.label == texts.PAUSE_LEAVE).box.center)
    assert not game.app.scenes.running or game.top_name != "PlayScene"
