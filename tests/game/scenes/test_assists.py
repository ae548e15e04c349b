"""Assists: chosen on their page, named on the card, kept apart in the logbook; and one switch for the whole game."""

from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.flights.recording import UNHURRIED
from ai.lander.environment import Outcome
from ai.lander.missions import MISSIONS
from game.core import texts
from game.flight.logbook import Records, best
from game.scenes.menus.menu import MenuScene
from game.scenes.menus.settings import SettingsScene
from game.scenes.play.challenge import FlownMission
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from game.ui.switch_scan import DWELL, HELD
from tests.support.driver import Driver
from tests.support.flights import actions
from tests.support.one_switch import SlowSwitch
from tests.support.player import Player
from tests.support.screens import save_settings

Open = Callable[..., Driver]


HANDS = ("analogue", "toggle_thrust", "one_switch")
ROOM = ("wider_pads", "untimed")


def test_every_assist_is_switched_and_saved(open_game: Open, context: Context):
    save_settings(context)
    before = {name: getattr(context.settings, name) for name in (*HANDS, *ROOM)}
    for group, names in (("flights", ROOM), ("controls", HANDS)):  # the last one makes the keys a switch
        player = Player(open_game(SettingsScene, group), "keys")
        for name in names:
            player.choose(texts.SETTINGS[name][0])
        saved = player.saved()
        player.app.close()  # one window at a time writes the settings
    assert {name: saved[name] for name in before} == {name: not value for name, value in before.items()}


def test_a_landing_with_assists_is_reported_kindly_and_kept_apart(open_game: Open, context: Context):
    save_settings(context, wider_pads=True, untimed=True, pace=0.5)
    player = Player(open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["fall"])), "keys")
    play = player.top
    assert play.flight.env.limits.time == UNHURRIED
    assert play.flight.env.ground.widths.tolist() == [9.0]
    player.frames(2)
    player.fly(most=7200)
    player.frames(200)
    card = play.ending.card
    assert card.good
    assert card.advice == texts.ASSISTS_USED.format(
        assists=", ".join(
            [
                texts.ASSIST_WORDS["wider_pads"],
                texts.ASSIST_WORDS["untimed"],
                texts.ASSIST_WORDS["pace"].format(percent=50),
            ]
        )
    )
    [entry] = Records(context.user_dir).entries()
    assert (entry.landed, entry.alone, entry.bar, entry.medal) == (True, False, "assists", 0)
    assert best([entry]) == []
    again = Records(context.user_dir).read(entry.file)
    assert again.recording == play.flight.recording
    assert again.recording.easing.wider_pads


def test_a_press_for_thrust_is_named_and_counts_like_any_other(open_game: Open, context: Context):
    save_settings(context, toggle_thrust=True)
    game = open_game(PlayScene, 3)
    game.frames(3)
    game.key(pygame.K_UP)
    play = game.top
    while not play.flight.over:
        game.skip(10)
    game.skip(200)
    assert set(actions(play.flight)[2:]) == {3}  # it stayed on
    assert texts.ASSIST_WORDS["toggle_thrust"] in play.credit.assists
    assert play.credit.counts


def test_wider_pads_chosen_before_the_first_touch_are_there_at_once(open_game: Open, context: Context):
    save_settings(context)
    game = open_game(PlayScene, 3)
    game.frames(3)
    play = game.top
    game.key(pygame.K_ESCAPE)
    context.settings.wider_pads = True
    game.key(pygame.K_ESCAPE)
    game.frames(2)
    assert game.top is play
    assert play.waiting
    assert play.flight.env.ground.widths.tolist() == [9.0]


# One switch


PRESSES = {
    "keys": (pygame.KEYDOWN, pygame.KEYUP, {"key": pygame.K_SPACE, "mod": 0}),
    "pad": (pygame.CONTROLLERBUTTONDOWN, pygame.CONTROLLERBUTTONUP,
            {"button": pygame.CONTROLLER_BUTTON_A, "instance_id": 0}),
    "mouse": (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP, {"button": 1, "pos": (640, 600)}),
}  # fmt: skip


class Switch:
    """The one thing the player can press, on one device or on another."""

    def __init__(self, game: Driver, device: str = "keys") -> None:
        self.game, self.device, self.down = game, device, False

    def hold(self, down: bool) -> None:
        if down != self.down:
            self.down = down
            *kinds, values = PRESSES[self.device]
            pygame.event.post(pygame.Event(kinds[not down], values))

    def press(self) -> None:
        self.hold(True)
        self.game.frames(2)
        self.hold(False)
        self.game.frames(2)

    def choose(self, words: str, most: int = 40) -> None:
        """Wait until that is marked, and press."""
        app = self.game.app
        for _ in range(most):
            stops = app.scan.stops(self.game.top, app.canvas)
            stop = stops[app.scan.index % len(stops)]
            if stop.widget.label == words:
                self.game.skip(14)  # a hand needs a moment
                self.press()
                return
            self.game.skip(DWELL)
        labels = [stop.widget.label for stop in app.scan.stops(self.game.top, app.canvas)]
        raise AssertionError(f"{words} is never marked in {self.game.top_name}, among {labels}, at {app.scan.index}")


@pytest.mark.slow
def test_the_whole_way_with_one_switch(open_game: Open, context: Context):
    """From the menu to a flight, a landing by a slow hand, the card, another start, the pause, and back to the menu."""
    save_settings(context, one_switch=True)
    game = open_game(MenuScene)
    game.frames(5)
    game.skip(100)
    switch = Switch(game, "mouse")
    switch.choose(texts.MENU["play"][0])
    game.skip(30)
    switch.device = "pad"
    switch.choose(texts.FLIGHTS["free"][0])
    play = game.top
    assert isinstance(play, PlayScene)
    game.skip(5)
    switch.device = "keys"
    hand, flight = SlowSwitch(), play.flight
    while not flight.over:
        switch.hold(hand.held(flight) or (play.waiting and not switch.down))
        game.skip(1)
    switch.hold(False)
    assert flight.outcome is Outcome.LANDED
    game.skip(200)
    assert texts.ASSIST_WORDS["one_switch"] in play.credit.assists
    switch.choose(texts.CARD_FIRST[True])
    assert play.flight is not flight
    play.flight.env.begin_at(0, np.array([0.0, 12.0, 0.0, -4.0, 0.0, 0.0]))
    for device in ("pad", "mouse"):
        switch.device = device
        switch.hold(True)
        game.skip(10)
        assert play.flight.env.actions[0] == 3, device
        if device == "mouse":
            game.skip(HELD)
        switch.hold(False)
        game.skip(3)
    assert "PauseScene" in game.top_name
    game.skip(30)
    switch.choose(texts.PAUSE_LEAVE)
    assert game.top_name == "FlightsScene"
    game.skip(30)
    switch.choose(texts.HINT_BACK)
    assert game.top_name == "MenuScene"


def test_one_switch_turns_a_slider_round_and_every_assist_off_again(open_game: Open, context: Context):
    save_settings(context, one_switch=True, pace=0.9)
    game = open_game(SettingsScene, "flights")
    game.skip(20)
    switch = Switch(game)
    for pace in (1.0, 0.2):
        switch.choose(texts.PACE)
        switch.press()  # a hand that trembles
        assert context.settings.pace == pytest.approx(pace)
    game = open_game(SettingsScene, "controls")
    game.skip(20)
    Switch(game).choose(texts.SETTINGS["one_switch"][0])
    assert not context.settings.one_switch
    game.key(pygame.K_SPACE)  # an ordinary press again
    assert context.settings.one_switch
