"""What players with fresh eyes stumbled over: words that disagreed, hid each other, or named the wrong pilot."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pygame
import pytest

from ai.lander.environment import LanderEnv
from ai.lander.missions import MISSIONS
from game.core import texts
from game.core.scene import Push
from game.core.settings import Settings
from game.explain import explained
from game.flight import networks
from game.flight.flight_file import Entry
from game.scenes.logbook.scene import LogbookScene
from game.scenes.menus.menu import FlightsScene
from game.scenes.play.challenge import FlownMission
from game.scenes.play.free import FreeFlight
from game.scenes.play.help import HELP
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from game.ui.tooltip import draw_tooltip
from game.world.lander import LANDER, WRECK, painted
from game.world.wreck import Wreck
from tests.support.driver import Driver
from tests.support.flights import play
from tests.support.reading import OnlyFlies, Weighs

Open = Callable[..., Driver]
TOO_FAST = (0.0, 4.0, 0.0, -6.0, 0.0, 0.0)
ON_PAD = (0.0, 2.6, 0.0, -0.4, 0.0, 0.0)


def end(driver: Driver, state: tuple[float, ...], key: int = pygame.K_UP) -> None:
    driver.frames(2)
    driver.key(key)
    play(driver).flight.env.place(np.ones(1, bool), np.array([state]))
    driver.skip(200)
    assert play(driver).ending.shown == 1


def test_the_page_of_play_names_the_rung_that_the_next_flight_begins_on(open_game: Open, context: Context):
    for landed, by_hand, rung in ((3, 1.0, 3), (3, 0.0, 0), (0, 1.0, 0)):
        entries = [Entry(0, "LANDED", 5, 1, 1, by_hand)] * landed
        settings = Settings()
        FreeFlight(settings).recall(entries)
        assert settings.rung == rung
    context.settings.rung = -1
    page = FlightsScene(context)
    assert page._figures["free"] == texts.FLIGHTS_RUNG.format(number=1)
    assert context.settings.rung == 0
    context.settings.three_pads = True
    page.enter()
    assert page._figures["free"] == texts.THREE_PADS.lower()


@pytest.mark.parametrize("size", [(1280, 720), (800, 600), (720, 1280)])
@pytest.mark.parametrize("letters", ["normal", "largest"])
def test_no_tooltip_of_help_covers_its_words(open_game: Open, monkeypatch: pytest.MonkeyPatch, size, letters: str):
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", Weighs()))
    boxes: list[pygame.FRect] = []
    monkeypatch.setattr(explained, "draw_tooltip", lambda *given: boxes.append(draw_tooltip(*given)))
    driver = open_game(PlayScene, 4)
    driver.resize(size)
    driver.write_in(letters)
    for word in HELP:
        driver.frames(3)
        canvas = driver.top.laid_on(driver.app.canvas)
        words = play(driver)._head.help_boxes(canvas)
        driver.click(words[word].center)
        driver.frames(2)
        words = play(driver)._head.help_boxes(canvas)  # what else is said may have moved them
        driver.move((words[word].centerx + 1, words[word].centery))
        boxes.clear()
        driver.frames(40)
        assert boxes, word
        assert boxes[-1].collidelist([*words.values()]) == -1, word


def test_a_wreck_has_lost_a_leg_and_leans():
    env = LanderEnv(1, 0, frame_skip=1)
    env.reset()
    env.place(np.ones(1, bool), np.array([[8.0, 3.0, 0.0, -5.0, 0.0, 0.0]]))
    while env.outcome[0] == 0:
        env.fly(np.zeros(1, np.intp))
    wreck = Wreck(env, 0, np.random.default_rng(2))
    while wreck.moves:
        wreck.step()
    assert abs(wreck.pose(1.0)[2]) > 0.15
    whole, broken = (pygame.mask.from_surface(painted(40.0, 0, (0, 0), image)) for image in (LANDER, WRECK))
    assert broken.count() < 0.95 * whole.count()


def test_escape_pauses_until_the_card_is_there(open_game: Open):
    driver = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["brake"]))
    driver.frames(2)
    assert texts.HINT_PAUSE in driver.hints()
    for _ in range(2):  # before the first key, and after it
        driver.key(pygame.K_ESCAPE)
        assert driver.top_name == "FlightPauseScene"
        driver.key(pygame.K_ESCAPE)
        driver.key(pygame.K_UP)
    end(driver, TOO_FAST)
    assert texts.HINT_LEAVE in driver.hints()
    assert texts.HINT_PAUSE not in driver.hints()


def test_points_and_medal_stand_behind_their_label(open_game: Open, written: list[str]):
    driver = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["brake"]))
    driver.resize((800, 600))
    end(driver, ON_PAD)
    written.clear()
    driver.frames(1)
    score = play(driver).ending.card.score
    assert texts.DIAL_JOIN in score
    assert abs(written.index(score) - written.index(texts.CARD_SCORE)) == 1


class Own(OnlyFlies):
    path = Path("mine.py")


def test_a_pilot_of_ones_own_is_called_by_its_name(
    open_game: Open, monkeypatch: pytest.MonkeyPatch, written: list[str]
):
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("mine.py", Own()))
    driver = open_game(PlayScene, 4)
    driver.frames(2)
    driver.key(pygame.K_UP)
    driver.frames(5)
    driver.key(pygame.K_TAB)
    driver.frames(5)
    assert any(words.startswith("mine.py flies.") for words in written)
    driver.key(pygame.K_ESCAPE)
    driver.frames(3)
    assert texts.PAUSE_PILOT.format(name="mine.py") in written
    driver.key(pygame.K_ESCAPE)
    end(driver, TOO_FAST)
    driver.frames(3)
    assert any(words.startswith("mine.py ") and words.endswith(" %") for words in written)
    driver.app.scenes.apply(Push(LogbookScene(driver.app.context)))
    driver.frames(3)
    assert texts.NOT_COUNTED["handed_over"].format(who="mine.py") in " ".join(written)
    named = {words for words in written if "network" in words.lower()}
    assert named <= {texts.PAUSE_TAKE_NETWORK, texts.SIX_FUTURES_WHY}, named


def test_every_word_of_play_and_its_pause_changes_with_the_language(
    open_game: Open, monkeypatch: pytest.MonkeyPatch, written: list[str]
):
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", Weighs()))
    same = {"Enter", "Esc", "Tab", "stand-in", "DRIFT", "Mission"}

    def words() -> set[str]:
        written.clear()
        driver.frames(2)
        return {each for each in written if sum(letter.isalpha() for letter in each) > 3} - same

    def speak(language: str) -> None:
        driver.app.context.settings.language = language
        driver.app.apply_settings()

    driver = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["brake"]))
    try:
        for pause in (True, False, False):  # waiting, and with its card
            before = words()
            if pause:
                driver.key(pygame.K_ESCAPE)
                before = words()
            for language in ("de", "es", "en"):
                speak(language)
                after = words()
                assert len(after) > 2
                assert not after & before, language
                before = after
            if pause:
                driver.key(pygame.K_ESCAPE)
            if not play(driver).flight.over and not pause:
                end(driver, ON_PAD)
    finally:
        speak("")
