"""What the player's doings sound like, in every part of the game that sounds."""

import pygame
import pytest

from game.core import texts
from game.flight.flight import StickHolder
from game.scenes.menus.menu import MenuScene
from game.scenes.menus.settings import SettingsScene
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.landers import put
from tests.support.listener import Listener

DOWN, UP, LEFT, RIGHT, ENTER = pygame.K_DOWN, pygame.K_UP, pygame.K_LEFT, pygame.K_RIGHT, pygame.K_RETURN


@pytest.fixture
def sound(context: Context) -> Listener:
    context.sound = Listener()
    return context.sound


def focus(game: Driver, label: str) -> None:
    (widget,) = [widget for widget in game.form.widgets if widget.label == label]
    game.form.focus(widget)


def test_menus_toggles_sliders_and_the_mouse_are_heard(sound: Listener, open_game):
    game: Driver = open_game(MenuScene)
    for key, heard in ((DOWN, "move"), (UP, "move"), (ENTER, "choose"), (pygame.K_ESCAPE, "back")):
        sound.heard()
        game.key(key)
        assert sound.heard() == [heard]
    game = open_game(SettingsScene)
    focus(game, texts.SETTINGS["reduced_motion"][0])
    sound.heard()
    game.key(ENTER)
    assert sound.heard() == ["adjust"]
    game.key(RIGHT)  # it is on already, so the arrow leads on
    assert sound.heard() == ["move"]
    first, second = (game.widget(texts.SETTINGS[name][0]).box.center for name in ("full_screen", "show_hints"))
    game.move(first)
    game.move(second)
    assert sound.heard() == [], "a mouse that passes"
    game.click(second)
    assert sound.heard() == ["adjust"]
    game.click((1100, 600))  # nothing is there
    assert sound.heard() == []
    game = open_game(SettingsScene, "sound")
    focus(game, texts.SOUND_GROUPS["interface"])
    sound.heard()
    for adjusted in (True, True, True, False):  # clicks, from 70 % up to all there is
        game.key(RIGHT)
        assert sound.heard() == ["adjust"] * adjusted


def test_a_volume_is_heard_as_it_changes_is_kept_and_reaches_nothing_at_all(sound: Listener, context, open_game):
    game: Driver = open_game(SettingsScene, "sound")
    focus(game, texts.SOUND_GROUPS["effects"])
    game.keys(*[LEFT] * 12)
    assert "touchdown" in sound.heard()
    game.app.settings_writer.wait()
    assert context.settings_file.load().effects_volume == 0


def test_flying_and_handing_over_are_heard(sound: Listener, open_game):
    game: Driver = open_game(PlayScene, seed=4)
    scene = game.top
    game.frames(2)
    game.post(pygame.KEYDOWN, key=UP, mod=0)
    game.post(pygame.KEYUP, key=UP, mod=0)
    sound.heard()
    game.key(pygame.K_TAB)
    assert scene.flight.chooser.hand is StickHolder.NETWORK
    assert sound.heard()[0] == "to_network"
    game.key(pygame.K_TAB)
    assert "to_human" in sound.heard()


def test_a_flight_to_its_end_is_heard_and_a_pause_is_silent(sound: Listener, open_game, monkeypatch):
    asked: list[dict[str, float]] = []
    monkeypatch.setattr(sound, "update", lambda: (asked.append(dict(sound.loops)), sound.loops.clear()))
    game: Driver = open_game(PlayScene, seed=4)
    game.post(pygame.WINDOWMINIMIZED)  # nothing need be drawn
    put(game.top.flight.env, (0, 6, 0, -2, 0, 0))
    game.key(pygame.K_TAB)
    for _ in range(1500):
        game.frames(1)
        if {"landed", "crash"} & set(sound.played):
            break
    assert {"landed", "crash"} & set(sound.played)
    assert max(loops.get("engine", 0.0) for loops in asked) > 0.5
    game.key(pygame.K_ESCAPE)
    asked.clear()
    game.frames(3)
    assert asked == [{}, {}, {}]
