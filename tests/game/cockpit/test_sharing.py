from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.lander.environment import PARAMS, Outcome
from ai.lander.push import KEYS
from game.core import texts
from game.core.settings import Settings, SettingsFile
from game.flight import networks
from game.flight.credit import ASSISTS, Credit
from game.flight.flight import Flight, StickHolder
from game.flight.logbook import Records
from game.flight.networks import DECISION_STEPS
from game.scenes.play.challenge import Rules
from game.scenes.play.interventions import difference
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import begun, play
from tests.support.reading import Weighs
from tests.support.screens import opened, save_settings
from tests.support.written import words_written

COAST, LEFT, RIGHT, MAIN = range(4)


class Wants(Weighs):
    """A network that thinks one action is worth 10, another one a bit less, and the others nothing."""

    def __init__(self, best: int = MAIN, good: int = LEFT, worth: float = 9.99) -> None:
        self.values = np.zeros(6, np.float32)
        self.values[[best, good]] = 10.0, worth
        self.asked = 0

    def q_values(self, observation: np.ndarray) -> np.ndarray:
        self.asked += 1
        return np.tile(self.values, (len(observation), 1))


def shared(network: Wants | None = None, assist: float = 0.5, **kinds: object) -> Flight:
    flight = begun(1, network or Wants(), **kinds)
    flight.chooser.help(assist)
    return flight


def keys(seed: int, steps: int) -> list[int]:
    rng = np.random.default_rng(seed)
    return np.repeat(rng.integers(6, size=steps), rng.integers(1, 9, size=steps))[:steps].tolist()


def test_who_flies_is_said_by_the_word_of_the_help():
    flight = begun(1, Wants())
    credit = Credit(flight, Settings(), Rules())
    for word, assist in (("guard", ASSISTS["guard"]), ("guard", 0.3), ("guide", ASSISTS["guide"])):
        flight.chooser.help(assist)
        assert credit.header == texts.YOU_SHARE[word]


def test_the_slowest_pace_of_a_flight_counts():
    settings = Settings(pace=0.5)
    credit = Credit(begun(1, Wants()), settings, Rules())
    for settings.pace in (0.5, 1.0):
        credit.prepare()
    assert (credit.pace, credit.bar) == (0.5, "assists")
    assert texts.ASSIST_WORDS["pace"].format(percent=50) in credit.assists


def test_without_assist_every_action_is_the_persons_and_with_it_bad_ones_are_changed():
    flight = shared(assist=0.0)
    for held in keys(1, 60):
        flight.step(KEYS[held])
        assert flight.env.actions[0] == held
        assert flight.flown_by is StickHolder.HUMAN
        assert not flight.choice.overridden
    flight.chooser.help(0.5)
    flight.step(KEYS[LEFT])  # worth hardly less than the best
    assert (flight.env.actions[0], flight.choice.overridden, flight.flown_by) == (LEFT, False, StickHolder.HUMAN)
    flight.step(KEYS[RIGHT])
    assert (flight.env.actions[0], flight.choice.overridden, flight.flown_by) == (MAIN, True, StickHolder.NETWORK)


def test_hands_off_is_the_networks_and_no_override_and_a_tap_of_one_step_is_heard_and_let_go_at_once():
    flight = shared(assist=0.1)
    for _ in range(2 * DECISION_STEPS + 1):
        flight.step()
    assert (flight.env.actions[0], flight.choice.overridden, flight.flown_by) == (MAIN, False, StickHolder.NETWORK)
    assert flight.share == 0.0
    flight.step(KEYS[LEFT])
    assert flight.env.actions[0] == LEFT
    flight.step()
    assert flight.env.actions[0] == MAIN


def test_a_hundred_handovers_under_a_shared_stick_lose_no_input_and_stick_no_engine():
    flight = shared(assist=0.5, pads=3)
    for turn in range(100):
        if turn % 10 == 0:
            flight.env.place(np.ones(1, bool), np.array([[0.0, 20.0, 0.0, 0.0, 0.0, 0.0]]))
        assert flight.chooser.hand_over()
        held = (LEFT, COAST, RIGHT)[turn % 3]
        flight.step(KEYS[held])
        if flight.chooser.hand is StickHolder.NETWORK:
            assert flight.env.actions[0] == MAIN
        else:
            assert flight.choice.asked.action == held
            assert flight.env.actions[0] == (LEFT if held == LEFT else MAIN)
    assert flight.chooser.hand is StickHolder.HUMAN
    flight.chooser.help(0.0)
    flight.step()
    assert flight.env.actions[0] == COAST
    assert flight.at == len(flight.recording.hands) == 101


def test_the_network_flies_to_the_nearest_pad_when_nothing_says_another():
    flight = begun(4, Wants(), pads=3)
    pads = flight.env.ground.pads
    for number, pad in enumerate(pads):
        flight.env.place(np.ones(1, bool), np.array([[pad.x + 1.0, 12.0, 0.0, 0.0, 0.0, 0.0]]))
        for _ in range(DECISION_STEPS):
            flight.step()
        assert flight.env.target[0] == number


Open = Callable[..., Driver]


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
        assert settings.help == word
    driver.post(pygame.MOUSEWHEEL, x=0, y=3)
    assert settings.help == "guard"
    for value in (30000, 0):
        driver.axis(pygame.CONTROLLER_AXIS_RIGHTX, value)
    assert settings.help == "guide"
    boxes = play(driver)._head.help_boxes(driver.app.canvas.reading)
    driver.click(boxes["guard"].center)
    driver.key(pygame.K_ESCAPE)  # in the pause, it has been saved
    driver.app.settings_writer.wait()
    saved = SettingsFile(context.user_dir).load()
    assert saved.help == "guard"
    driver.key(pygame.K_ESCAPE)
    assert play(driver).waiting  # none of that has begun the flight


def test_an_override_is_lit_said_and_marked_and_hands_off_is_none(open_game: Open, context: Context, monkeypatch):
    driver = fly(open_game, context, help="guide")
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
    assert texts.LANDINGS_TITLE not in words  # the panel is for those who ask
    driver.key(pygame.K_F1)
    driver.frames(4)
    assert texts.LANDINGS_TITLE in words


def test_the_card_of_a_shared_flight_names_the_co_pilot_and_its_moments(open_game: Open, context: Context, monkeypatch):
    driver = fly(open_game, context, help="guide")
    start_at(driver, 0, 5, 0, -1.0, 0, 0)
    down(driver, pygame.K_RIGHT)
    driver.frames(12)
    driver.app.context.settings.help = "off"
    up(driver, pygame.K_RIGHT)
    start_at(driver, 0, PARAMS.pad_top + PARAMS.stand + 0.01, 0, 0, 0, 0)
    words = words_written(monkeypatch)
    driver.frames(140)
    assert play(driver).flight.outcome is Outcome.LANDED
    you = round(100 * play(driver).flight.share)
    assert 0 < you < 100
    assert texts.DIAL_JOIN.join((f"{100 - you} %", texts.CARD_SAVED.format(count=1))) in words
    assert Records(context.user_dir).entries()[-1].alone is False


def test_choices_are_made_and_the_waiting_flight_follows(open_game: Open, context: Context):
    driver = fly(open_game, context)
    driver.key(pygame.K_c)
    for label in (texts.CHOICES_HELP, texts.CHOICES_PADS):
        driver.frames(2)
        driver.click(driver.widget(label)._places[1].center)
    driver.key(pygame.K_ESCAPE)
    settings = driver.app.context.settings
    assert settings.help == "guard"
    assert settings.three_pads
    assert play(driver).waiting
    assert len(play(driver).flight.env.ground.pads) == 3


def test_words_that_nobody_knows_in_the_settings_fly_as_usual(open_game: Open, context: Context):
    save_settings(context, help="captain", text_size="enormous")
    driver = opened(open_game, "Play")
    driver.key(pygame.K_UP)
    driver.frames(10)
    assert not play(driver).flight.chooser.shared
    assert driver.app.canvas.zoom == 1.0
    driver.key(pygame.K_c)
    assert driver.top_name == "FlightPauseScene"
