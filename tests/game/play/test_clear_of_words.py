"""Words of a flight: clear of the craft and of each other, in one language, and of the right pilot."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pygame
import pytest

from ai.environment import Doubles
from ai.lander.missions import MISSIONS
from game.core import texts
from game.core.scene import Push
from game.core.settings import HELP
from game.drawing.canvas import Canvas
from game.explain import explained
from game.flight import networks
from game.scenes.logbook.scene import LogbookScene
from game.scenes.play.challenge import FlownMission
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from game.ui.tooltip import draw_tooltip
from game.world.camera import View
from game.world.stage import Stage
from tests.game.play import ends
from tests.game.play.ends import ON_PAD, TOO_FAST, end
from tests.support.driver import Driver
from tests.support.flights import play
from tests.support.reading import OnlyFlies, Weighs
from tests.support.screens import save_settings

Open = Callable[..., Driver]


@pytest.mark.parametrize(("size", "letters"), [((1280, 720), "normal"), ((800, 600), "largest")])
def test_no_tooltip_of_help_covers_its_words(open_game: Open, monkeypatch: pytest.MonkeyPatch, size, letters: str):
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", Weighs()))
    boxes: list[pygame.FRect] = []
    monkeypatch.setattr(explained, "draw_tooltip", lambda *given: boxes.append(draw_tooltip(*given)))
    driver = open_game(PlayScene, 4)
    driver.resize(size)
    driver.write_in(letters)
    for word in HELP:
        driver.frames(3)
        canvas = driver.app.canvas.reading
        driver.click(play(driver)._head.help_boxes(canvas)[word].center)
        driver.frames(2)
        words = play(driver)._head.help_boxes(canvas)  # what else is said may have moved them
        driver.move((words[word].centerx + 1, words[word].centery))
        boxes.clear()
        driver.frames(40)
        assert boxes, word
        assert boxes[-1].collidelist([*words.values()]) == -1, word


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
    assert texts.PAUSE_NETWORK.format(name="mine.py") in written
    driver.key(pygame.K_ESCAPE)
    end(driver, TOO_FAST)
    driver.frames(3)
    driver.app.scenes.apply(Push(LogbookScene(driver.app.context)))
    driver.frames(3)
    assert texts.NOT_COUNTED["handed_over"].format(who="mine.py") in " ".join(written)
    assert not [words for words in written if "network" in words.lower()]


def test_every_word_of_play_and_its_pause_changes_with_the_language(
    open_game: Open, monkeypatch: pytest.MonkeyPatch, written: list[str]
):
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", Weighs()))
    same = {"Enter", "Esc", "Tab", "stand-in", "Pilot: stand-in", "DRIFT", "Mission"}

    def words() -> set[str]:
        written.clear()
        driver.frames(2)
        return {each for each in written if sum(letter.isalpha() for letter in each) > 3} - same

    driver = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["brake"]))
    for state in ("pause", "waiting", "card"):
        if state == "pause":
            driver.key(pygame.K_ESCAPE)
        if state == "card":
            end(driver, ON_PAD)
        before = words()
        with driver.speaking("de"):
            german = words()
            assert len(german) > 2
            assert not german & before, state
        assert not words() & german, state
        if state == "pause":
            driver.key(pygame.K_ESCAPE)


# What flies and what is said keep clear of each other: paths, panels, read-outs, hints.


def test_the_six_paths_are_shown_before_the_start_where_their_key_is_named(open_game: Open, context: Context):
    def sky() -> Any:
        driver.frames(150)
        assert play(driver).flown.waiting
        return pygame.surfarray.array3d(driver.app.canvas.surface)

    save_settings(context)
    driver = open_game(PlayScene, 4)
    without = sky()
    assert texts.HINT_THINKS in driver.hints()
    driver.key(pygame.K_F1)
    assert (sky() != without).any()
    driver.key(pygame.K_F1)
    assert (sky() == without).all()


@pytest.fixture
def shared(open_game: Open, context: Context, monkeypatch: pytest.MonkeyPatch) -> Driver:
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", Weighs()))
    context.settings.help, context.settings.reduced_motion = "guide", True
    context.settings.show_thinking = True
    context.settings_file.save(context.settings)
    driver = open_game(PlayScene, 4)
    driver.frames(2)
    return driver


def place(driver: Driver, *state: float) -> None:
    play(driver).flown.waiting = False
    ends.place(play(driver).flight.env, *state)


def test_the_panel_gives_way_to_a_craft_that_the_camera_can_not_keep_clear(shared: Driver, monkeypatch):
    panels: list[bool] = []
    copilot_panel = play(shared).flown.copilot_panel
    monkeypatch.setattr(copilot_panel, "draw", lambda *_: panels.append(True))
    place(shared, 0, 12, 0, 0, 0, 0)
    shared.frames(4)
    assert panels
    box = play(shared).flown.copilot_panel.box(shared.app.canvas.reading)
    x, y = play(shared).flown.scenery.view(1.0).metres(box.center).tolist()
    place(shared, x, y, 0, 0, 0, 0)
    shared.frames(2)  # it leaps there between two steps
    panels.clear()
    shared.frames(3)
    assert not panels


@pytest.mark.parametrize("size", [(1280, 720), (1920, 1080)])
def test_the_sentence_of_a_flight_keeps_clear_of_the_panel(shared: Driver, monkeypatch: pytest.MonkeyPatch, size):
    drawn: list[tuple[str, pygame.FRect]] = []
    text = Canvas.text

    def noted(self: Canvas, words: str, *args, **options):
        box = text(self, words, *args, **options)
        drawn.append((words, pygame.FRect(box)))
        return box

    shared.resize(size)
    shared.write_in("largest")
    place(shared, 0, 12, 0, 0, 0, 0)
    shared.frames(4)
    monkeypatch.setattr(Canvas, "text", noted)
    shared.app.draw()
    head, canvas = play(shared)._head, shared.app.canvas.reading
    assert head.panel == play(shared).flown.copilot_panel.box(canvas)
    lines = [box for words, box in drawn if words and words in head.sentence and box.top < 60]
    assert lines
    assert all(not box.colliderect(head.panel) for box in lines)


@pytest.mark.parametrize("calm", [False, True])
@pytest.mark.parametrize("size", [(800, 450), (800, 600), (1280, 720)])
def test_a_craft_is_seen_below_the_words_wherever_it_flies(
    open_game: Open, context: Context, monkeypatch: pytest.MonkeyPatch, size: tuple[int, int], *, calm: bool
):
    def noted(_: Stage, canvas: Canvas, view: View, pose: Doubles, **__: object) -> None:
        tops.append(canvas.reading.points(view.pixel(float(pose[0]), float(pose[1]) + 1))[1])

    tops: list[float] = []
    monkeypatch.setattr(Stage, "draw_lander", noted)
    save_settings(context, reduced_motion=calm)
    driver = open_game(PlayScene, 4)
    driver.resize(size)
    driver.write_in("largest")
    assert tops[-1] > play(driver)._head.write(driver.app.canvas.reading, drawn=False)
    for height in (3, 12, 19, 25):
        place(driver, 0, height, 0, 0, 0, 0)
        driver.frames(2)
        play(driver).flown.scenery.cut()  # as for a craft that did not leap there
        driver.frames()
        assert tops[-1] > play(driver)._head.write(driver.app.canvas.reading, drawn=False), height


def test_the_pause_after_a_flight_shows_nothing_that_the_network_thinks(
    open_game: Open, context: Context, written: list[str]
):
    save_settings(context, help="guard")
    driver = open_game(PlayScene, 4)
    driver.key(pygame.K_UP)
    driver.frames(20)
    end(driver, TOO_FAST)
    driver.frames(90)
    written.clear()
    assert {texts.HINT_MENU, texts.HINT_PAUSE} & driver.hints().keys() == {texts.HINT_MENU}
    driver.key(pygame.K_ESCAPE)
    driver.frames(20)
    assert driver.top_name == "FlightPauseScene"
    assert texts.OUTCOMES["CRASHED"][0] in written
    assert not {texts.LANDINGS_TITLE, texts.DECISION_TITLE, texts.PAUSE_RESUME, texts.HINT_RESUME} & set(written)
