"""Every screen can be walked, seen and left by a gamepad alone and by the keyboard alone: real events, no window."""

from collections.abc import Callable, Iterator

import numpy as np
import pygame
import pytest

from ai.lander.environment import Outcome
from game.core import texts
from game.core.scene import Push, Scene
from game.flight.flight import StickHolder
from game.scenes.menu import MenuScene
from game.scenes.play import PlayScene
from game.ui.context import Context
from game.ui.listing import Listing
from game.ui.widget import Widget
from tests.support.driver import Driver
from tests.support.player import DEVICES, Player
from tests.support.screens import OVER_OTHERS, SCREENS, flown, settle
from tests.support.tour import scene_types

# Flown rather than walked, shown once something has failed, or a part of others.
NO_SCREENS = {"PlayScene", "ErrorScene", "Dialog", "MenuBackground"}


@pytest.fixture(params=DEVICES)
def open_screen(
    request: pytest.FixtureRequest, open_game: Callable[..., Driver], context: Context
) -> Iterator[Callable[..., Player]]:
    def open_it(make: Callable[[Context], Scene]) -> Player:
        settle(context)
        player = Player(open_game(make), request.param)
        player.frames(3)
        return player

    return open_it


def test_every_screen_there_is_will_be_walked():
    assert {each.__name__ for each in scene_types()} - NO_SCREENS == SCREENS.keys() | OVER_OTHERS.keys()


@pytest.mark.parametrize("name", SCREENS)
def test_every_widget_is_reached_and_seen_and_there_is_a_way_out(open_screen, name: str):
    player = open_screen(SCREENS[name])
    if name in ("WatchScene", "PhysicsScene", "ReplayScene"):
        player.press("step")
    walk(player)
    for _ in range(3):
        if player.app.scenes.running and player.top_name != "PauseScene":
            player.press("back")
    if player.top_name == "PauseScene":
        player.choose(texts.PAUSE_LEAVE)
    assert not player.app.scenes.running  # it was the only scene


@pytest.mark.parametrize("name", OVER_OTHERS)
def test_so_are_those_that_stand_over_another(open_screen, name: str):
    player = open_screen(SCREENS["MenuScene"])
    menu = player.top
    player.app.scenes.apply(Push(OVER_OTHERS[name](menu)))
    player.frames(3)
    if name == "NameDialog":
        player.press("down")  # out of the line, with what stands there
    walk(player)
    player.press("back")
    assert player.top is menu


def walk(player: Player) -> None:
    player.unseen = True
    found = player.ways()
    player.unseen, player.app.context.settings.reduced_motion = False, True
    widgets = list(player.form.widgets)  # what is chosen on the way may have changed them
    assert not [widget.label for index, widget in enumerate(widgets) if index not in found]
    for widget in widgets[:24]:
        if widget in player.form.widgets:
            assert is_seen(player, widget), f"no focus is seen on {widget.label}"


def is_seen(player: Player, widget: Widget) -> bool:
    """Whether the picture around a widget changes when the focus comes to it."""
    form, canvas = player.form, player.app.canvas
    pictures = []
    for focused in (next((each for each in form.widgets if each is not widget), widget), widget):
        form.focus(focused)
        player.frames(2)
        around = canvas.rect(*widget.box.inflate(28, 16)).clip(canvas.surface.get_rect())
        pictures.append(pygame.surfarray.array3d(canvas.surface.subsurface(around)).astype(int))
    return len(form.widgets) == 1 or int((np.abs(pictures[0] - pictures[1]).max(axis=2) > 40).sum()) >= 12


def test_a_mission_is_found_flown_and_left(open_screen):
    player = open_screen(SCREENS["MenuScene"])
    player.choose(texts.MENU["missions"][0])
    assert player.top_name == "MissionsScene"
    player.press("confirm")  # the list is where it begins
    player.frames(2)
    player.press("pause")  # nothing has begun: it leads back at once
    assert player.top_name == "MissionsScene"
    player.press("confirm")
    player.fly()
    assert player.top.flight.outcome is Outcome.LANDED
    player.skip(90)
    player.press("pause")  # Enter leads on to the next one
    assert player.top_name == "MissionsScene"
    assert player.the(Listing).rows[1][1] in texts.MEDALS[1:]
    player.press("back")
    assert player.top_name == "MenuScene"


def test_a_flight_is_flown_paused_handed_over_and_left(open_screen):
    player = open_screen(SCREENS["MenuScene"])
    player.choose(texts.MENU["play"][0])
    player.press("main", "hand over")
    assert player.top.flight.hand is StickHolder.NETWORK
    player.press("hand over", "pause")
    assert player.top_name == "PauseScene"
    player.choose(texts.PAUSE_LEAVE)
    assert player.top_name == "MenuScene"


def test_a_replay_is_watched_wound_and_flown_on(open_screen):
    player = open_screen(lambda context: [flown(context), MenuScene(context)][1])
    player.choose(texts.MENU["logbook"][0])
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
    player.press("back", "back")
    assert player.top_name == "MenuScene"


def test_settings_are_changed_and_kept(open_screen):
    player = open_screen(SCREENS["MenuScene"])
    player.choose(texts.MENU["settings"][0])
    player.press("down", "down", "confirm")
    assert player.saved()["colour_safe"] is True
    player.press("left")
    assert player.saved()["colour_safe"] is False
    while player.form.focused.label != texts.SOUND_GROUPS["effects"]:
        player.press("down")
    player.press("left", "left")
    assert player.saved()["effects_volume"] == pytest.approx(0.7)
    while player.form.focused.label != texts.BACK:
        player.press("down")
    player.press("right")
    while player.form.focused.label != texts.BINDINGS_OPEN:
        player.press("up")
    player.press("confirm")
    assert player.top_name == "BindingsScene"
    kind = "keys" if player.device == "keys" else "buttons"
    while player.form.focused.label != texts.BINDINGS["PREVIOUS"]:
        player.press("down")
    if player.device == "pad":
        player.press("right")
    player.press("confirm", "another")
    player.press("up")
    player.press("confirm", "another")  # the one above takes it away again
    assert player.saved()[kind].keys() == {"next", "previous"}
    player.choose(texts.BINDINGS_ALL)
    assert player.saved()[kind] == {}
    player.press("back", "back")
    assert player.top_name == "MenuScene"


@pytest.mark.parametrize("name", SCREENS)
def test_the_mouse_alone_finds_a_way_out(open_game, context: Context, name: str):
    game: Driver = open_game(SCREENS[name])
    game.move((640, 700))
    game.frames(3)
    for _ in range(3):
        if not game.app.scenes.running:
            break
        words = {word.label: word for word in game.top.form.widgets}
        exits = [label for label in (texts.BACK, texts.PAUSE_LEAVE, texts.MENU["quit"][0]) if label in words]
        if exits:
            game.click(words[exits[0]].box.center)
        else:
            hints = game.hints()
            game.click(hints.get(texts.HINT_BACK) or hints[texts.HINT_PAUSE])
        game.frames(3)
    assert not game.app.scenes.running


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
    assert play.flight.recording.actions[-1] == 3
    game.post(pygame.MOUSEBUTTONDOWN, pos=game.to_window((20, 400)), button=right)
    game.frames(2)
    assert play.flight.recording.actions[-1] == 4
    game.move((1260, 400))
    assert play.flight.recording.actions[-1] == 5
    for button in (left, right):
        game.post(pygame.MOUSEBUTTONUP, pos=game.to_window((1260, 400)), button=button)
    assert play.flight.recording.actions[-1] == 0
    game.click(game.hints()[texts.HINT_HAND_OVER])
    assert play.flight.hand is StickHolder.NETWORK
    game.click(game.hints()[texts.HINT_PAUSE])
    assert game.top_name == "PauseScene"
    game.frames(2)
    game.click(next(word for word in game.top.form.widgets if word.label == texts.PAUSE_LEAVE).box.center)
    assert not game.app.scenes.running or game.top_name != "PlayScene"
