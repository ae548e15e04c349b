"""The first ten flights: the ladder, the offer of help, a craft that hangs after every interruption, and the rescue."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

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
from game.flight.logbook import Goals, ladder_rung
from game.scenes.menus.menu import FlightsScene
from game.scenes.play.ending import FlownPath
from game.scenes.play.free import FreeFlight
from game.scenes.play.scene import PlayScene
from game.scenes.play.sitting import CRASHES
from game.scenes.play.tutorial import Tutorial
from game.ui.context import Context
from tests.game.play.ends import BESIDE, ON_PAD, TOO_FAST, end, place
from tests.support.driver import Driver
from tests.support.flights import begun, challenge_of, concluded, fly_out, play
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
    assert not play(driver).ending.card.climb


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
    assert (settings.rung, card.climb) == (0, texts.LADDER_LOWEST)


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


# The last lesson


def test_a_guard_is_called_by_the_player_and_a_landing_with_it_ends_the_first_flight(open_game: Open):
    driver = open_game(PlayScene, 0, challenge=Tutorial())
    for _ in range(6):
        driver.key(pygame.K_n)
    driver.key(pygame.K_UP)
    driver.frames(2)
    challenge, controls = challenge_of(driver), driver.app.context.controls
    called, crash = (words.split("{")[0] for words in texts.TUTORIAL["guard"])
    assert challenge.sentence(play(driver).flight, controls).startswith(called)
    driver.key(pygame.K_PLUS)
    driver.frames(2)
    assert play(driver).flight.chooser.shared
    assert challenge.sentence(play(driver).flight, controls).startswith(crash)
    play(driver).flown.interventions.moments.append(np.zeros(2))
    end(driver, ON_PAD)
    assert (play(driver).ending.card.title, challenge.rules.through) == (texts.TUTORIAL_SAVED_TITLE, True)
    assert driver.app.context.settings.help == "off"


# After the ladder


def test_goals_grow_with_ones_own_landings_and_the_best_of_day_and_week_is_told():
    landing = Entry(1e9, "LANDED", 20.0, 8.0, 1.0, 1.0, alone=True, score=80)
    goals = Goals([landing, *(replace(landing, score=99, **other) for other in OTHERS)])
    assert goals.next == texts.GOALS["fuel"].format(value=4.5)
    assert not goals.add(replace(landing, outcome="CRASHED", fuel=1.0))
    assert goals.add(replace(landing, fuel=4.5, score=70))
    assert goals.next == texts.GOALS["seconds"].format(value=12)
    assert goals.bests(1e9) == {name: texts.SCORE.format(count=80) for name in (texts.CARD_TODAY, texts.CARD_WEEK)}
    assert goals.bests(1e9 + 364 * 86400) == {}
    assert not Goals([replace(landing, score=99, fuel=1.0, seconds=5.0)]).next


OTHERS: list[dict[str, Any]] = [{"alone": False}, {"course": "wind"}, {"spawn": "rung_3"}]


@pytest.mark.parametrize("calm", [False, True])
def test_a_goal_is_said_before_the_flight_and_on_the_card_whose_path_is_drawn_once_more(
    open_game: Open, written: list[str], monkeypatch: pytest.MonkeyPatch, calm: bool
):
    shares: list[float] = []
    draw = FlownPath.draw
    monkeypatch.setattr(FlownPath, "draw", lambda *given: (shares.append(given[-1]), draw(*given)))
    driver = open_game(PlayScene, 4)
    driver.app.context.settings.reduced_motion = calm
    driver.key(pygame.K_r)
    driver.frames(2)
    assert texts.GOALS["score"].format(value=80) in written
    end(driver, ON_PAD)
    card = play(driver).ending.card
    assert card.climb == texts.GOAL_REACHED.format(goal=play(driver)._goals.next)
    assert {texts.CARD_TODAY, texts.CARD_WEEK} <= set(card.compared)
    shares.clear()
    driver.frames(100)
    again = [share for share in shares if share < 1]
    assert again == sorted(again)
    assert (not again, shares[-1]) == (calm, 1)
    assert texts.CARD_WATCH in driver.hints()
    driver.key(pygame.K_t)
    assert driver.top_name == "ReplayScene"


@pytest.mark.parametrize("x", [-6.0, 6.0])
def test_with_reduced_motion_the_card_stands_beside_the_craft(open_game: Open, x: float):
    driver = open_game(PlayScene, 4)
    driver.app.context.settings.reduced_motion = True
    driver.key(pygame.K_r)
    end(driver, (x, *BESIDE[1:]))
    shown = play(driver)
    box, across = shown._card.box(driver.app.canvas.reading), shown._across
    assert not box.left <= across <= box.right
