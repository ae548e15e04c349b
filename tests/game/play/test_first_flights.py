"""The first ten flights: the ladder, the offer of help, a craft that hangs after every interruption, and the rescue."""

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.pilots import ScriptedPilot
from ai.lander.spawns import LADDER
from game.core import texts
from game.core.assets import MODELS_DIR
from game.core.settings import TOP_RUNG, Settings
from game.flight import networks
from game.flight.flight import Flight, StickHolder
from game.flight.flight_file import Entry
from game.flight.logbook import ladder_rung
from game.flight.networks import sentence
from game.flight.outcomes import outcome_card
from game.scenes.menus.menu import FlightsScene
from game.scenes.play.free import FreeFlight
from game.scenes.play.scene import PlayScene
from game.scenes.play.sitting import CRASHES
from game.scenes.play.tutorial import Tutorial
from game.ui.context import Context
from tests.game.play.ends import BESIDE, ON_PAD, TOO_FAST, end, place
from tests.support.driver import Driver
from tests.support.flights import begun, challenge_of, concluded, fly_out, play
from tests.support.player import Player
from tests.support.reading import Weighs

Open = Callable[..., Driver]


@pytest.fixture(autouse=True)
def weighing_network(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", Weighs()))


# The ladder


def test_who_pushes_nothing_for_a_second_and_a_half_can_still_land_on_the_lowest_rungs():
    agent = DeepQAgent.load(MODELS_DIR / "lander" / "modern")
    for rung in (0, 1):
        env = LanderEnv(60, 1, LADDER.spawn(rung), frame_skip=1)
        env.reset()
        step, action = 0, np.zeros(60, np.intp)
        while (env.outcome == Outcome.FLYING).any():
            if step >= 90 and step % 4 == 2:
                action = agent.act(env.observe(), held=env.actions)
            env.fly(action)
            step += 1
        assert (env.outcome == Outcome.LANDED).all(), rung


def test_landings_lead_up_and_crashes_down_and_the_card_and_title_say_so(open_game: Open, written: list[str]):
    driver = open_game(PlayScene, ladder=True)
    settings = driver.app.context.settings
    driver.frames(2)
    assert texts.LADDER_TITLE.format(number=1, count=10) in written
    assert play(driver).flight.recording.spawn == "rung_1"
    end(driver, ON_PAD)
    assert settings.rung == 1
    assert play(driver).ending.card.title == texts.FIRST_LANDING
    assert play(driver).ending.card.climb == texts.LADDER_UP.format(number=2)
    driver.key(pygame.K_RETURN)
    seed = play(driver).flight.recording.seed
    for climb in (texts.LADDER_STAYS.format(number=2), texts.LADDER_DOWN.format(number=1)):
        assert play(driver).flight.recording.spawn == "rung_2"  # one miss changes nothing
        end(driver, TOO_FAST)
        assert play(driver).ending.card.climb == climb
        written.clear()
        driver.frames(2)
        driver.key(pygame.K_RETURN)  # the same start, nearer
    assert texts.LADDER_NEARER in written
    assert (play(driver).flight.recording.seed, play(driver).flight.recording.spawn) == (seed, "rung_1")
    end(driver, BESIDE)
    assert settings.rung == 0
    assert play(driver).ending.card.climb == texts.LADDER_LOWEST
    driver.app.close()
    assert driver.saved()["rung"] == 0


def test_another_try_is_the_very_same_start_and_the_top_is_flights_from_anywhere_for_good(open_game: Open):
    driver = open_game(PlayScene, ladder=True)
    settings = driver.app.context.settings
    settings.rung = TOP_RUNG - 1
    driver.key(pygame.K_n)
    before = play(driver).flight
    end(driver, TOO_FAST)
    driver.key(pygame.K_r)
    again = play(driver).flight
    assert again is not before
    assert (again.recording.seed, again.recording.spawn) == (before.recording.seed, f"rung_{TOP_RUNG}")
    end(driver, ON_PAD)
    assert play(driver).ending.card.climb == texts.LADDER_TOP
    driver.key(pygame.K_RETURN)
    assert play(driver).flight.recording.spawn == "random"
    end(driver, TOO_FAST)
    assert settings.rung == TOP_RUNG
    assert play(driver).ending.card.rung is None


def noted(rung: int, flight: Flight, *ends: Flight) -> Settings:
    settings = Settings(rung=rung)
    free = FreeFlight(settings)
    for each in (flight, *ends):
        concluded(free, each)
    return settings


def test_only_crashes_of_ones_own_lead_down_and_only_landings_of_ones_own_up():
    def ended(*state: float) -> Flight:
        flight = begun(7, ScriptedPilot(), LADDER.spawn(3))
        place(flight.env, *state)
        return fly_out(flight)

    crash, landing, beside = (ended(*state) for state in (TOO_FAST, ON_PAD, BESIDE))
    for flights, rung in (([crash, crash], 2), ([crash, landing, crash], 4), ([beside] * 3, 3)):
        assert noted(3, *flights).rung == rung
    flight = begun(7, ScriptedPilot(), LADDER.spawn(0))
    flight.chooser.hand_over()
    fly_out(flight)
    settings = Settings(rung=0)
    card = concluded(FreeFlight(settings), flight)
    assert flight.outcome is Outcome.LANDED
    assert (settings.rung, card.climb) == (0, sentence(texts.LADDER_NOT_FLOWN, texts.THE_NETWORK))


def test_who_has_landed_often_before_begins_high_up_and_the_page_of_play_says_where(context: Context):
    def entry(outcome: str, by_hand: float = 1.0) -> Entry:
        return Entry(0, outcome, 5, 1, 1, by_hand)

    for entries, rung in (
        ([], 0), ([entry("LANDED")] * 4, 4), ([entry("LANDED", 0.0)] * 4, 0), ([entry("LANDED")] * 60, TOP_RUNG)
    ):  # fmt: skip
        settings = Settings()
        ladder_rung(settings, [*entries, entry("CRASHED")])
        assert settings.rung == rung
    settings = Settings(rung=2)
    ladder_rung(settings, [entry("LANDED")] * 60)
    assert settings.rung == 2
    context.settings.rung = -1
    page = FlightsScene(context)
    assert page._figures["free"] == texts.FLIGHTS_RUNG.format(number=1)
    assert context.settings.rung == 0
    context.settings.three_pads = True
    page.enter()
    assert page._figures["free"] == texts.THREE_PADS.lower()


# Help after three crashes


def test_after_three_crashes_without_a_landing_between_one_key_or_a_click_turns_the_dial(
    open_game: Open, written: list[str]
):
    driver = open_game(PlayScene)
    for state in (TOO_FAST, TOO_FAST, ON_PAD, *[TOO_FAST] * CRASHES):
        if play(driver).ending.card:
            assert texts.HELP_HINT not in driver.hints()
            driver.key(pygame.K_RETURN)
        written.clear()
        end(driver, state)
    driver.frames(2)
    assert texts.HELP_OFFER in written
    driver.click(driver.hints()[texts.HELP_HINT])
    settings = driver.app.context.settings
    assert settings.help == "guard"
    driver.frames(2)
    assert not play(driver).flight.over
    assert play(driver).flight.chooser.shared
    assert play(driver).flight.chooser.hand is StickHolder.HUMAN


def test_a_flight_hangs_after_every_interruption_until_it_is_touched(open_game: Open, written: list[str]):
    driver = open_game(PlayScene, 4)
    driver.frames(2)
    driver.key(pygame.K_UP)
    for way, interrupt in {
        "pause": lambda: driver.keys(pygame.K_ESCAPE, pygame.K_ESCAPE),
        "choices": lambda: driver.keys(pygame.K_c, pygame.K_c),
        "focus": lambda: (driver.post(pygame.WINDOWFOCUSLOST), driver.post(pygame.WINDOWFOCUSGAINED)),
        "size": lambda: driver.post(pygame.WINDOWSIZECHANGED, x=1280, y=720),
    }.items():
        driver.frames(8)
        interrupt()
        driver.frames(2)
        steps = play(driver).flight.at
        written.clear()
        driver.frames(10)
        assert play(driver).waiting, way
        assert play(driver).flight.at == steps > 5, way
        assert texts.WAITS_AGAIN in written, way
        driver.key(pygame.K_LEFT)
        driver.frames(3)
        assert not play(driver).waiting, way
        assert play(driver).flight.at > steps, way


# The rescue


def at_lesson(open_game: Open, name: str) -> Driver:
    driver = open_game(PlayScene, 0, challenge=Tutorial())
    while challenge_of(driver).lesson.name != name:
        challenge_of(driver).skip()
    return driver


def test_a_rescue_that_does_not_come_down_is_landed_by_the_network(open_game: Open):
    driver = at_lesson(open_game, "dial")
    challenge, controls, flight = challenge_of(driver), driver.app.context.controls, play(driver).flight
    while challenge.lesson.name != "rescue":
        challenge.follow(flight)
    first, later = (words.split("{")[0] for words in texts.TUTORIAL["rescue"])
    assert challenge.sentence(flight, controls).startswith(first)
    for _ in range(1000):  # whatever it does up there
        challenge.follow(flight)
    assert flight.chooser.hand.name == "NETWORK"
    assert challenge.sentence(flight, controls) == texts.TUTORIAL_LONG.format(who=texts.THE_NETWORK)
    flight.choice = flight.choice._replace(overridden=True)  # only who was saved is said not to have crashed
    challenge.follow(flight)
    flight.choice = flight.choice._replace(overridden=False)
    assert challenge.sentence(flight, controls) == texts.TUTORIAL_BROUGHT.format(who=texts.THE_NETWORK)
    flight.chooser.hand_over()  # the player may still take it back
    challenge.follow(flight)
    assert flight.chooser.hand is StickHolder.HUMAN
    assert challenge.sentence(flight, controls).startswith(later)


def test_the_dial_is_turned_by_the_player_and_theirs_stays_as_it_was(open_game: Open, written: list[str]):
    player = Player(at_lesson(open_game, "dial"), "keys")
    play(player).retry()
    player.frames(2)
    player.hold("left", down=True)
    player.frames(10)
    player.hold("left", down=False)
    assert play(player).waiting  # until the dial is turned
    player.key(pygame.K_PLUS)
    written.clear()
    player.frames(3)
    assert any(word.startswith(texts.TUTORIAL_PATHS.split(".")[0]) for word in written)
    assert play(player).flight.chooser.shared
    assert play(player).flown.path_preview.asks
    player.hold("left", down=True)
    player.frames(60)
    assert challenge_of(player).lesson.name == "rescue"
    assert player.app.context.settings.help == "off"


def test_nobody_hands_over_where_a_guard_is_to_be_seen(open_game: Open):
    driver = at_lesson(open_game, "dial")
    play(driver).retry()
    driver.frames(2)
    assert texts.HINT_HAND_OVER not in driver.hints()
    driver.key(pygame.K_TAB)
    driver.frames(30)
    assert play(driver).waiting
    assert (play(driver).flight.chooser.hand, challenge_of(driver).lesson.name) == (StickHolder.HUMAN, "dial")
    driver.keys(pygame.K_PLUS, pygame.K_LEFT)
    while challenge_of(driver).lesson.name != "rescue":
        driver.skip()
    driver.key(pygame.K_TAB)
    driver.frames(2)
    assert (play(driver).flight.chooser.hand, challenge_of(driver).rules.through) == (StickHolder.HUMAN, False)


def test_the_last_card_praises_only_who_has_landed_alone(open_game: Open):
    driver = at_lesson(open_game, "dial")
    challenge, down = challenge_of(driver), begun(0)
    place(down.env, *ON_PAD)
    while not down.over:
        down.step()
    card = outcome_card(down.env, 1.0)
    for human, saved, title, reason in (
        (1.0, 0, texts.TUTORIAL_DONE, texts.TUTORIAL_NOT_NEEDED),
        (0.7, 0, texts.TUTORIAL_GOOD["land"], texts.TUTORIAL_HELPED.format(who=texts.THE_NETWORK, percent=30)),
        (0.7, 1, texts.TUTORIAL_SAVED_TITLE, texts.TUTORIAL_SAVED),
    ):
        landed = SimpleNamespace(share=human, chooser=play(driver).flight.chooser)
        shown = replace(card, stepped_in=saved)
        challenge._add_to(SimpleNamespace(flight=landed), shown)
        assert (shown.title, shown.reason) == (title, reason), (human, saved)


def test_who_skips_the_dial_skips_the_rescue(open_game: Open):
    driver = at_lesson(open_game, "dial")
    driver.key(pygame.K_n)
    assert play(driver).challenge.rules.free
