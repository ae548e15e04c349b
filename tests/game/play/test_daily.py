"""Today's flight: the first attempt counts and is kept, later ones are practice beside a ghost."""

import time
from collections.abc import Callable
from dataclasses import replace
from datetime import date, timedelta
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from ai.lander.pilots import ScriptedPilot
from ai.lander.push import KEYS
from game.core import texts
from game.core.scene import Scene
from game.flight.days import FILE_NAME, Attempt, Days
from game.flight.flight import Flight
from game.flight.logbook import Records
from game.scenes.menus.menu import FlightsScene
from game.scenes.play.daily import DailyStart
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.game.play.ends import TOO_FAST, end
from tests.support.driver import Driver
from tests.support.flights import actions, begun, kept, play

Open = Callable[..., Driver]
TODAY = date.today()
YESTERDAY = TODAY - timedelta(days=1)


def page(context: Context) -> Scene:
    return FlightsScene(context, today=TODAY)


def today(context: Context) -> Scene:
    return PlayScene(context, 0, challenge=DailyStart(TODAY, Days(context.user_dir)))


def flown(day: date) -> Flight:
    """A flight of a day's start by the scripted pilot, as if by hand."""
    flight, pilot = begun(day.toordinal(), pads=3), ScriptedPilot()
    while not flight.over:
        flight.step(KEYS[int(pilot.act(flight.env.observe())[0])])
    return flight


def attempt(context: Context, day: date = TODAY) -> Attempt | None:
    return Days(context.user_dir).attempts.get(day.isoformat())


def note(context: Context, day: date) -> Attempt:
    """A first attempt of a day that was landed, as it is noted."""
    record = kept(context, flown(day), time.time() - (TODAY - day).total_seconds(), alone=True, course="daily")
    noted = Attempt(day.isoformat(), record.entry.outcome, record.entry.score, "", record.entry.file)
    Days(context.user_dir).note(noted)
    return noted


@pytest.fixture
def clipboard(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    held = [""]
    monkeypatch.setattr(pygame.scrap, "put_text", held.append)
    return held


def test_a_page_that_was_open_at_midnight_tells_of_the_new_day(
    open_game: Open, context: Context, written: list[str], monkeypatch: pytest.MonkeyPatch
):
    days = [YESTERDAY]
    monkeypatch.setattr("game.scenes.menus.menu.date", SimpleNamespace(today=lambda: days[-1]))
    driver = open_game(FlightsScene)
    days.append(TODAY)
    result = note(context, TODAY).result
    driver.top.enter()
    driver.frames(2)
    assert result in written


def test_the_first_attempt_counts_and_a_second_is_practice(open_game: Open, context: Context):
    driver = open_game(page)
    driver.frames(2)
    driver.press_on(texts.FLIGHTS["day"][0])
    driver.frames(10)
    assert play(driver).credit.counts
    assert attempt(context) is None  # it hangs, and nothing has begun
    end(driver, TOO_FAST)
    first, scene = attempt(context), play(driver)
    assert first
    assert (first.outcome, first.barred) == (scene.flight.outcome.name, "")
    assert Records(context.user_dir).read(first.file).recording == scene.flight.recording
    said = [scene.ending.card.compared[texts.DAILY]]
    driver.key(pygame.K_r)
    driver.frames(3)
    again = play(driver)
    assert again.credit.bar == "day_again"
    assert again.credit.notice == texts.NOT_COUNTED["day_again"]
    assert again.flown.ghost.name == texts.DAILY_GHOST
    end(driver, TOO_FAST)
    said.append(again.ending.card.compared[texts.DAILY])
    assert said == [texts.DAILY_ATTEMPTS["first"], texts.DAILY_ATTEMPTS["practice"]], "a crash says so, too"
    assert attempt(context) == first
    assert [entry.alone for entry in Records(context.user_dir).entries()] == [True, False]


def test_leaving_the_first_attempt_ends_it(open_game: Open, context: Context, written: list[str]):
    driver = open_game(page)
    driver.frames(2)
    driver.press_on(texts.FLIGHTS["day"][0])
    driver.frames(3)
    driver.key(pygame.K_UP)
    driver.frames(20)
    driver.key(pygame.K_r)
    assert driver.top_name == "QuestionDialog"  # which names the harmless answer first
    driver.keys(pygame.K_RIGHT, pygame.K_RETURN)
    driver.frames(3)
    assert play(driver).credit.bar == "day_again"
    end(driver, TOO_FAST)
    assert attempt(context) == Attempt(TODAY.isoformat())  # practice changes nothing
    driver = open_game(page)
    driver.frames(2)
    assert texts.DAYS_LEFT in written


def test_the_page_of_play_says_how_today_and_yesterday_went_and_the_ghost_is_the_best_of_the_day(
    open_game: Open, context: Context, written: list[str]
):
    yesterday, first = note(context, YESTERDAY), note(context, TODAY)
    driver = open_game(page)
    driver.frames(2)
    assert texts.DAILY_LANDED.format(points=first.score) in written
    assert texts.DAYS_YESTERDAY.format(result=yesterday.result) in " ".join(written)
    driver.press_on(texts.FLIGHTS["day"][0])
    driver.frames(2)
    scene = play(driver)
    assert scene.credit.bar == "day_again"
    assert scene.flight.recording.seed == TODAY.toordinal()
    assert actions(scene.flown.ghost.flight) == []
    assert Days(context.user_dir).best_flight(YESTERDAY).recording.seed == YESTERDAY.toordinal()
    assert Days(context.user_dir).best_flight(TODAY + timedelta(days=1)) is None, "which is of another day"


def test_the_line_to_paste_says_nothing_of_the_way(open_game: Open, context: Context, clipboard: list[str]):
    driver = open_game(today)
    for said in ("first attempt", "practice"):
        end(driver, TOO_FAST)
        driver.key(pygame.K_k)
        assert clipboard[-1] == f"Tranquility {TODAY} · crashed · {said}"
        assert driver.said == texts.CODE_LINE_COPIED.format(line=clipboard[-1])
        driver.key(pygame.K_r)
    landed = Attempt("2026-11-22", "LANDED", 84)
    assert landed.line == "Tranquility 2026-11-22 · landed · 84 points · first attempt"
    assert Attempt("2026-11-22", "LANDED", 84, "practice").line.endswith("first attempt, made easier")


def test_a_damaged_line_is_counted_the_rest_is_read_and_what_has_ended_is_never_replaced(
    open_game: Open, context: Context
):
    days = Days(context.user_dir)
    for each in (Attempt("2026-01-01"), Attempt("2026-01-01", "CRASHED"), Attempt("2026-01-01", "LANDED", 99)):
        days.note(each)
    with (context.user_dir / FILE_NAME).open("a") as file:
        file.write('{"day": "2026-99-99"}\nhello\n{"day": "2026-01-02", "outcome": "LANDED"}\n')
    again = Days(context.user_dir)
    assert [each.outcome for each in again.attempts.values()] == ["CRASHED", "LANDED"]
    assert again.problem == texts.FLIGHTS_DAMAGED.format(count=2, path=context.user_dir / FILE_NAME)
    driver = open_game(page)
    driver.frames(2)
    assert driver.said == again.problem


def test_a_disk_that_cannot_be_written_is_reported(open_game: Open, context: Context):
    context.user_dir.mkdir(parents=True, exist_ok=True)
    (context.user_dir / FILE_NAME).mkdir()
    driver = open_game(today)
    end(driver, TOO_FAST)
    assert texts.DAYS_NOT_KEPT.partition("{")[0] in driver.said


def test_card_list_and_line_agree_on_who_comes_down_softly_beside_the_pad(
    open_game: Open, context: Context, clipboard: list[str]
):
    day = date(2026, 11, 22)  # with level ground between two of its pads
    driver = open_game(lambda context: PlayScene(context, 0, challenge=DailyStart(day, Days(context.user_dir))))
    height = float(play(driver).flight.env.ground.height(np.array([-4.95]))[0])
    end(driver, (-4.95, height + 1.1, 0.0, -0.1, 0.0, 0.0))
    assert play(driver).flight.intact
    assert play(driver).ending.card.title == texts.BESIDE_TITLE
    driver.key(pygame.K_k)
    first_attempt = attempt(context, day)
    assert first_attempt
    assert clipboard[-1] == first_attempt.line == f"Tranquility {day} · {texts.BESIDE_RESULT} · first attempt"
    assert first_attempt.result == texts.BESIDE_RESULT
    assert replace(first_attempt, intact=False).result == texts.RIVAL_RESULTS["CRASHED"]
