from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.lander.environment import PARAMS, Outcome
from game.core import texts
from game.core.settings import SettingsFile
from game.flight import networks
from game.flight.logbook import Records
from game.scenes.play.help import HELP, word_of
from game.scenes.play.interventions import difference
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.game.cockpit.test_sharing import Wants
from tests.support.driver import Driver
from tests.support.flights import play
from tests.support.written import words_written

Open = Callable[..., Driver]
COAST, LEFT, RIGHT, MAIN = range(4)


@pytest.fixture(autouse=True)
def flown_by(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", Wants()))


def fly(open_game: Open, context: Context, **settings: object) -> Driver:
    for name, value in settings.items():
        setattr(context.settings, name, value)
    context.settings_file.save(context.settings)
    driver = open_game(PlayScene, seed=4)
    driver.frames(2)
    return driver


def down(driver: Driver, key: int) -> None:
    driver.post(pygame.KEYDOWN, key=key, mod=0, unicode="", scancode=0)


def up(driver: Driver, key: int) -> None:
    driver.post(pygame.KEYUP, key=key, mod=0, unicode="", scancode=0)


def start_at(driver: Driver, *start: float) -> None:
    play(driver).flown.waiting = False
    play(driver).flight.env.place(np.ones(1, bool), np.array([start]))


def test_help_is_chosen_by_keys_wheel_click_and_stick_and_kept(open_game: Open, context: Context):
    driver = fly(open_game, context)
    settings = driver.app.context.settings
    for key, word in ((pygame.K_PLUS, "guard"), (pygame.K_PLUS, "guide"), (pygame.K_PLUS, "guide"),
                      (pygame.K_MINUS, "guard"), (pygame.K_MINUS, "off"), (pygame.K_MINUS, "off")):  # fmt: skip
        driver.key(key)
        assert word_of(settings) == word
    driver.post(pygame.MOUSEWHEEL, x=0, y=3)
    assert word_of(settings) == "guard"
    for value in (30000, 0):
        driver.axis(pygame.CONTROLLER_AXIS_RIGHTX, value)
    assert word_of(settings) == "guide"
    boxes = play(driver)._head.help_boxes(driver.app.canvas.reading)
    driver.click(boxes["guard"].center)
    driver.key(pygame.K_ESCAPE)  # in the pause, it has been saved
    driver.app.settings_writer.wait()
    saved = SettingsFile(context.user_dir).load()
    assert (saved.assist, saved.copilot) == (HELP["guard"], "guardian")
    assert play_below(driver).waiting  # none of that has begun the flight


def play_below(driver: Driver) -> PlayScene:
    driver.key(pygame.K_ESCAPE)
    return play(driver)


def test_an_override_is_lit_said_and_marked_and_hands_off_is_none(open_game: Open, context: Context, monkeypatch):
    driver = fly(open_game, context, assist=0.5)
    start_at(driver, 0, 16, 0, 0, 0, 0)
    driver.frames(6)
    flight, shown = play(driver).flight, play(driver).flown.interventions
    assert flight.env.actions[0] == MAIN
    assert shown.lamp(flight)[0] == "ring"
    down(driver, pygame.K_LEFT)
    driver.frames(6)
    assert flight.env.actions[0] == LEFT
    assert shown.lamp(flight)[0] == "circle"
    assert not shown.moments
    up(driver, pygame.K_LEFT)
    words = words_written(monkeypatch)
    down(driver, pygame.K_RIGHT)
    driver.frames(6)
    assert flight.env.actions[0] == MAIN
    assert shown.lamp(flight)[0] == "diamond"
    assert len(shown.moments) == 1
    assert difference(RIGHT, MAIN) == "The network flies main, not right"
    assert difference(RIGHT, MAIN) in words
    assert texts.COPILOT_PANEL_WHY["COPILOT"] not in words  # the panel is for those who ask
    driver.key(pygame.K_F1)
    driver.frames(4)
    assert texts.COPILOT_PANEL_WHY["COPILOT"] in words


def test_without_assist_nothing_of_the_co_pilot_is_seen_or_felt(open_game: Open, context: Context, monkeypatch):
    driver = fly(open_game, context)
    start_at(driver, 0, 16, 0, 0, 0, 0)
    words = words_written(monkeypatch)
    driver.frames(20)
    assert set(play(driver).flight.recording.actions) == {COAST}
    assert play(driver).flight.share == 1.0
    assert texts.DECISION_TITLE not in words
    assert texts.YOU_FLY in words


def test_the_card_of_a_shared_flight_names_the_co_pilot_and_its_moments(open_game: Open, context: Context, monkeypatch):
    driver = fly(open_game, context, assist=0.5)
    start_at(driver, 0, 5, 0, -1.0, 0, 0)
    down(driver, pygame.K_RIGHT)
    driver.frames(3)
    driver.app.context.settings.assist = 0.0
    up(driver, pygame.K_RIGHT)
    start_at(driver, 0, PARAMS.pad_top + PARAMS.stand + 0.01, 0, 0, 0, 0)
    words = words_written(monkeypatch)
    driver.frames(140)
    assert play(driver).flight.outcome is Outcome.LANDED
    you = round(100 * play(driver).flight.share)
    assert 0 < you < 100
    assert texts.SHARE_YOU.format(percent=you) in words
    assert texts.SHARE_NETWORK.format(who=texts.THE_NETWORK, percent=100 - you) in words
    assert texts.CARD_SAVED[1] in words
    assert Records(context.user_dir).entries()[-1].alone is False


@pytest.mark.parametrize("device", ["keys", "pad", "mouse"])
def test_choices_are_made_with_any_device_and_the_waiting_flight_follows(
    open_game: Open, context: Context, device: str
):
    driver = fly(open_game, context)
    if device == "keys":
        driver.keys(
            pygame.K_c, pygame.K_RIGHT, pygame.K_DOWN, pygame.K_RIGHT, pygame.K_DOWN, pygame.K_DOWN, pygame.K_RIGHT
        )
        driver.key(pygame.K_ESCAPE)
    elif device == "pad":
        right, below = pygame.CONTROLLER_BUTTON_DPAD_RIGHT, pygame.CONTROLLER_BUTTON_DPAD_DOWN
        for button in (pygame.CONTROLLER_BUTTON_BACK, right, below, right, below, below, right):
            driver.button(button)
        driver.button(pygame.CONTROLLER_BUTTON_B)
    else:
        driver.key(pygame.K_c)
        for label in (texts.CHOICES_HELP, texts.CHOICES_PADS, texts.CHOICES_HANDS):
            driver.frames(2)
            driver.click(driver.widget(label)._places[1].center)
        driver.key(pygame.K_ESCAPE)
    settings = driver.app.context.settings
    assert word_of(settings) == "guard"
    assert settings.three_pads
    assert settings.hands == "laggy"
    assert play(driver).waiting
    assert len(play(driver).flight.env.ground.pads) == 3
    assert play(driver).challenge.hands == "laggy"


def test_pads_and_hands_do_not_change_under_a_flight_that_has_begun(open_game: Open, context: Context):
    driver = fly(open_game, context)
    start_at(driver, 0, 16, 0, 0, 0, 0)
    driver.frames(3)
    flight = play(driver).flight
    driver.keys(pygame.K_c, pygame.K_DOWN, pygame.K_RIGHT, pygame.K_c)
    assert play(driver).flight is flight
    driver.key(pygame.K_n)
    assert len(play(driver).flight.env.ground.pads) == 3


def test_nonsense_in_the_settings_flies_as_usual(open_game: Open, context: Context):
    driver = fly(open_game, context, hands="three", copilot="captain", assist=0.5)
    driver.key(pygame.K_UP)
    driver.frames(10)
    assert play(driver).challenge.hands == "own"
    assert driver.app.context.settings.copilot == "tolerance"
