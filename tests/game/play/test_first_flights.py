"""The first ten flights: the ladder, the offer of help, a craft that hangs after every interruption, and the rescue."""

from collections.abc import Callable

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
from game.flight.credit import Credit
from game.flight.flight import Flight, StickHolder
from game.flight.flight_file import Entry
from game.flight.outcomes import outcome_card
from game.scenes.play.free import FreeFlight
from game.scenes.play.help import HELP
from game.scenes.play.scene import PlayScene
from game.scenes.play.sitting import CRASHES
from game.scenes.play.tutorial import Tutorial
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import challenge_of, fly_out, play
from tests.support.player import DEVICES, Player
from tests.support.reading import Weighs

Open = Callable[..., Driver]
ON_PAD = (0.0, 2.6, 0.0, -0.4, 0.0, 0.0)
TOO_FAST = (0.0, 4.0, 0.0, -6.0, 0.0, 0.0)
BESIDE = (8.0, 2.2, 0.0, -0.4, 0.0, 0.0)


@pytest.fixture(autouse=True)
def weighing_network(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", Weighs()))


def end(driver: Driver, state: tuple[float, ...]) -> None:
    """Bring the flight to its end from a state, and to its card."""
    driver.frames(2)
    driver.key(pygame.K_UP)
    play(driver).flight.env.place(np.ones(1, bool), np.array([state]))
    for _ in range(200):
        driver.skip()
        if play(driver).ending.shown == 1:
            return
    raise AssertionError("no card came")


# The ladder


def test_who_pushes_nothing_for_a_second_and_a_half_can_still_land_on_the_lowest_rungs():
    agent = DeepQAgent.load(MODELS_DIR / "lander" / "modern")
    for rung in (0, 1):
        env = LanderEnv(200, 1, LADDER.spawn(rung), frame_skip=1)
        env.reset()
        for step in range(90 + 60 * 30):
            if step < 90:
                action = np.zeros(200, np.intp)
            elif step % 4 == 2:
                action = agent.act(env.observe(), held=env.actions)
            env.fly(action)
        assert (env.outcome == Outcome.LANDED).all(), rung


def test_landings_lead_up_and_crashes_down_and_the_card_and_title_say_so(open_game: Open, written: list[str]):
    driver = open_game(PlayScene, ladder=True)
    settings = driver.app.context.settings
    driver.frames(2)
    assert texts.LADDER_TITLE.format(number=1, count=10) in written
    assert texts.LADDER_BEGIN in written
    assert play(driver).flight.recording.spawn == "rung_1"
    end(driver, ON_PAD)
    assert settings.rung == 1
    assert play(driver).ending.card.title == texts.FIRST_LANDING
    assert play(driver).ending.card.climb == texts.LADDER_UP.format(number=2)
    driver.key(pygame.K_RETURN)
    assert play(driver).flight.recording.spawn == "rung_2"
    seed = play(driver).flight.recording.seed
    end(driver, TOO_FAST)
    assert play(driver).ending.card.climb == texts.LADDER_STAYS.format(number=2)
    driver.key(pygame.K_RETURN)
    assert play(driver).flight.recording.spawn == "rung_2"  # one miss changes nothing
    end(driver, TOO_FAST)
    written.clear()
    driver.frames(2)
    assert texts.LADDER_DOWN.format(number=1) in written
    assert texts.LADDER_NEARER in written
    driver.key(pygame.K_RETURN)  # the same start, nearer
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


def test_who_has_landed_often_before_begins_at_the_top(context: Context):
    def entry(outcome: str) -> Entry:
        return Entry(0, outcome, 5, 1, 1, 1)

    for landings, rung in ((0, 0), (4, 4), (60, TOP_RUNG)):
        settings = Settings()
        FreeFlight(settings).recall([entry("LANDED")] * landings + [entry("CRASHED")] * 3)
        assert settings.rung == rung
    settings = Settings(rung=2)
    FreeFlight(settings).recall([entry("LANDED")] * 60)
    assert settings.rung == 2


def test_the_choices_move_on_the_ladder_and_off_it(open_game: Open):
    driver = open_game(PlayScene, ladder=True)
    for direction, spawn in ((pygame.K_RIGHT, "random"), (pygame.K_LEFT, "rung_1")):
        driver.frames(2)
        driver.key(pygame.K_c)
        while driver.form.focused.label != texts.CHOICES_LADDER:
            driver.key(pygame.K_DOWN)
        driver.keys(*[direction] * 12)
        driver.key(pygame.K_ESCAPE)
        assert play(driver).flight.recording.spawn == spawn


def test_a_landing_that_the_network_flew_leads_no_rung_up_and_the_card_says_which_do():
    settings, flight = Settings(rung=0), Flight(7, ScriptedPilot(), LADDER.spawn(0))
    flight.hand_over()
    fly_out(flight)
    free = FreeFlight(settings)
    card = free.card(outcome_card(flight.env, flight.share), flight, Credit(flight, settings, free))
    assert flight.outcome is Outcome.LANDED
    assert (settings.rung, card.climb) == (0, texts.LADDER_NOT_FLOWN)


# Help after three crashes


@pytest.mark.parametrize("device", DEVICES)
def test_after_three_crashes_one_key_turns_the_dial(open_game: Open, written: list[str], device: str):
    driver = player = Player(open_game(PlayScene), device)
    for number in range(CRASHES):
        written.clear()
        end(driver, TOO_FAST)
        driver.frames(2)
        assert (texts.HELP_OFFER in written) == (texts.HELP_HINT in written) == (number == CRASHES - 1)
        if number < CRASHES - 1:
            driver.key(pygame.K_RETURN)
    player.press("hand over")
    settings = driver.app.context.settings
    assert (settings.assist, settings.copilot) == (HELP["guard"], "guardian")
    driver.frames(2)
    assert not play(driver).flight.over
    assert play(driver).flight.shared
    assert play(driver).flight.hand is StickHolder.HUMAN


def test_a_click_takes_the_help_and_a_landing_counts_anew(open_game: Open):
    driver = open_game(PlayScene)
    for state in (TOO_FAST, TOO_FAST, ON_PAD, TOO_FAST, TOO_FAST):
        end(driver, state)
        assert texts.HELP_HINT not in driver.hints()
        driver.key(pygame.K_RETURN)
    end(driver, TOO_FAST)
    driver.frames(2)
    driver.click(driver.hints()[texts.HELP_HINT])
    assert driver.app.context.settings.assist == HELP["guard"]


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
        steps = len(play(driver).flight.recording.actions)
        written.clear()
        driver.frames(20)
        assert play(driver).waiting, way
        assert len(play(driver).flight.recording.actions) == steps > 5, way
        assert texts.WAITS_AGAIN in written, way
        driver.key(pygame.K_LEFT)
        driver.frames(3)
        assert not play(driver).waiting, way
        assert len(play(driver).flight.recording.actions) > steps, way


# The rescue


def test_a_rescue_that_does_not_come_down_is_landed_by_the_network(open_game: Open):
    driver = open_game(PlayScene, 0, challenge=Tutorial())
    challenge, controls = challenge_of(driver), driver.app.context.controls
    while challenge.lesson.name != "rescue":
        challenge.skip() if challenge.lesson.name != "dial" else challenge.follow(play(driver).flight)
    flight = play(driver).flight
    first, later = (words.split("{")[0] for words in texts.TUTORIAL["rescue"])
    assert challenge.sentence(flight, controls).startswith(first)
    for _ in range(1000):  # whatever it does up there
        challenge.follow(flight)
    assert flight.hand.name == "NETWORK"
    assert challenge.sentence(flight, controls) == texts.TUTORIAL_BROUGHT.format(who=texts.THE_NETWORK)
    flight.hand_over()  # the player may still take it back
    challenge.follow(flight)
    assert flight.hand is StickHolder.HUMAN
    assert challenge.sentence(flight, controls).startswith(later)


@pytest.mark.parametrize("device", DEVICES)
def test_the_dial_is_turned_by_the_player_and_theirs_stays_as_it_was(open_game: Open, written: list[str], device: str):
    driver = player = Player(open_game(PlayScene, 0, challenge=Tutorial()), device)
    while (challenge := challenge_of(driver)).lesson.name != "dial":
        challenge.skip()
    play(driver).retry()
    driver.frames(2)
    player.hold("left", down=True)
    driver.frames(20)
    player.hold("left", down=False)
    assert play(driver).waiting  # until the dial is turned
    for _ in range(5):
        if device == "keys":
            driver.key(pygame.K_PLUS)
        else:
            driver.axis(pygame.CONTROLLER_AXIS_RIGHTX, 32000)
            driver.axis(pygame.CONTROLLER_AXIS_RIGHTX, 0)
    written.clear()
    driver.frames(3)
    assert any(word.startswith(texts.TUTORIAL_PATHS.split("{")[0]) for word in written)
    assert play(driver).flight.shared
    assert play(driver).flown.path_preview.asks
    player.hold("left", down=True)
    driver.frames(60)
    assert challenge.lesson.name == "rescue"
    assert driver.app.context.settings.assist == 0


def test_who_skips_the_dial_skips_the_rescue(open_game: Open):
    driver = open_game(PlayScene, 0, challenge=Tutorial())
    while play(driver).challenge and challenge_of(driver).lesson.name != "dial":
        driver.key(pygame.K_n)
    driver.key(pygame.K_n)
    assert play(driver).challenge.free
