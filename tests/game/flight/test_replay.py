from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pygame
import pytest

from ai.flights.recording import Easing
from ai.lander.environment import Outcome
from ai.lander.pilots import ScriptedPilot
from ai.lander.push import KEYS, Push
from game.core import texts
from game.flight.flight import Flight
from game.flight.flight_file import Record
from game.flight.logbook import Records
from game.flight.replay import FlightReplay, replayed
from game.input.analogue import pushed
from game.scenes.logbook.replay import ReplayScene
from game.scenes.logbook.scene import LogbookScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import NOON, begun, fly_out, kept, scripted
from tests.support.written import words_written

Open = Callable[..., Driver]


@pytest.fixture
def record(context: Context) -> Record:
    return kept(context, scripted(by_hand=40))


def state(flight_replay: FlightReplay) -> tuple:
    env = flight_replay.flight.env
    return (*env.position[0].tolist(), *env.velocity[0].tolist(), float(env.angle[0]), int(env.outcome[0]),
            int(env.main_steps[0]), flight_replay.flight.share)  # fmt: skip


def analogue() -> Flight:
    flight, rng = begun(3, pads=3, easing=Easing(wider_pads=True)), np.random.default_rng(1)
    for _ in range(200):
        flight.step(pushed(rng.uniform(0.3, 1.0), rng.uniform(-0.6, 0.6), Push()))
    return flight


def test_a_tape_can_be_wound_to_any_moment_and_shows_it_as_it_was(context: Context):
    for name, flight in {"by hand": scripted(by_hand=40), "analogue": analogue()}.items():
        flight_replay = FlightReplay(kept(context, flight))
        assert flight_replay.record.recording == flight.recording, name
        seen, last = [state(flight_replay)], flight_replay.length
        for _ in range(last):
            flight_replay.step()
            seen.append(state(flight_replay))
        assert flight_replay.flight.poses.now.tobytes() == flight.poses.now.tobytes(), name
        for step in (0, 1, 19, 20, 21, 77, last - 1, last, 51, 50, 49, 40, 39, 3, last):
            flight_replay.go_to(step)
            assert flight_replay.at == step
            assert state(flight_replay) == seen[step], (name, step)
        flight_replay.go_to(60)
        for step in range(61, 90):
            flight_replay.step()
            assert state(flight_replay) == seen[step], (name, step)


def test_read_outs_turn_to_the_pads_that_they_turned_to_in_flight():
    flight, pilot = begun(3, pads=3), ScriptedPilot()
    first = int(flight.env.target[0])
    flown, shown = [], []
    while not flight.over:
        flight.step(KEYS[int(pilot.act(flight.env.observe((first + 1) % 3))[0])])
        flown.append((int(flight.env.target[0]), float(flight.env.altitude[0])))
    assert flown[0][0] == first != flown[-1][0]
    again = replayed(flight.recording)
    while not again.over:
        again.step()
        shown.append((int(again.env.target[0]), float(again.env.altitude[0])))
    assert shown == flown


def test_a_tape_winds_no_further_than_was_looked_ahead_and_never_out_of_the_flight(record: Record):
    flight_replay: Any = FlightReplay(record)
    flight_replay.scout(30)
    flight_replay.go_to(500)
    assert flight_replay.at == 30
    flight_replay.go_to(-5)
    assert flight_replay.at == 0
    assert not flight_replay.touching
    flight_replay.scout(10_000)
    assert flight_replay.touching
    flight_replay.go_to(10_000)
    assert (flight_replay.at, flight_replay.complete, flight_replay.faithful) == (flight_replay.length, True, True)
    assert len(flight_replay.path) == flight_replay.length + 1
    flight_replay.step()
    assert flight_replay.at == flight_replay.length


def test_a_flight_that_goes_another_way_now_is_reported(open_game: Open, record: Record, written: list[str]):
    x, y, angle = record.end
    flight_replay = FlightReplay(replace(record, end=(x + 0.01, y, angle)))
    flight_replay.scout(10_000)
    assert not flight_replay.faithful
    driver = open_game(ReplayScene, replace(record, end=(x, y + 1, angle)))
    driver.skip(119)
    driver.frames(1)
    assert texts.REPLAY_OTHER_RULES in written


# The scene


@pytest.fixture
def replay(open_game: Open, record: Record) -> Driver:
    driver = open_game(ReplayScene, record)
    driver.frames(2)
    return driver


def scene(driver: Driver) -> ReplayScene:
    assert isinstance(driver.top, ReplayScene)
    return driver.top


def test_it_plays_stops_steps_winds_slows_and_begins_anew(replay: Driver):
    def at() -> int:
        return scene(replay).flight_replay.at

    before = at()
    replay.frames(20)
    assert at() == before + 20
    replay.app.context.unfold("replay")
    replay.frames(1)
    replay.keys(pygame.K_MINUS, pygame.K_MINUS)
    assert replay.choice("×¼").index == 0
    before = at()
    replay.frames(40)
    assert at() == pytest.approx(before + 10, abs=1)
    replay.keys(pygame.K_PLUS, pygame.K_PLUS, pygame.K_SPACE)
    before = at()
    replay.frames(10)
    assert at() == before
    replay.key(pygame.K_PERIOD)
    assert at() == before + 1
    replay.key(pygame.K_LEFT)
    assert at() == before - 5
    scene(replay).go_to(10_000)
    replay.key(pygame.K_SPACE)
    replay.wait(lambda: scene(replay).ended)
    replay.frames(20)
    assert scene(replay).ended
    assert at() == scene(replay).flight_replay.length, "there it stays"
    replay.key(pygame.K_SPACE)
    replay.frames(3)
    assert 0 < at() < 10


def test_at_the_end_only_what_can_be_done_is_offered(replay: Driver):
    def offers() -> tuple[bool, set[str]]:
        replay.frames(2)
        hints = replay.hints().keys() & {texts.HINT_GO, texts.HINT_STOP, texts.HINT_STEP, texts.CARD_WATCH}
        return texts.REPLAY_TAKE_OVER in {widget.label for widget in replay.form.widgets}, hints

    assert offers() == (True, {texts.HINT_STOP, texts.HINT_STEP})
    replay.wait(lambda: scene(replay).flight_replay.complete)
    scene(replay).go_to(replay.top.flight_replay.length - 1)
    before = scene(replay)._readouts
    scene(replay).go_to(0)
    scene(replay).go_to(10_000)
    assert scene(replay)._readouts["altitude"] == before["altitude"], "the moment before, from wherever one jumps"
    assert offers() == (False, {texts.CARD_WATCH})
    replay.key(pygame.K_LEFT)
    assert scene(replay).flight_replay.at == scene(replay).flight_replay.length - 4, "six back, and two frames on"
    assert offers()[0]
    replay.wait(lambda: scene(replay).ended)
    replay.click(replay.hints()[texts.CARD_WATCH])
    assert offers() == (True, {texts.HINT_STOP, texts.HINT_STEP})


@pytest.mark.parametrize(("reduced", "faster", "slow"), [(False, 0, True), (False, 1, False), (True, 0, False)])
def test_a_crash_is_slow_at_its_own_pace(open_game: Open, context: Context, reduced: bool, faster: int, slow: bool):
    context.settings_file.save(replace(context.settings, reduced_motion=reduced))
    driver = open_game(ReplayScene, kept(context, fly_out(begun(5))))
    driver.frames(2)
    driver.keys(*[pygame.K_PLUS] * faster)
    driver.wait(lambda: scene(driver).ended)
    assert scene(driver).flight_replay.flight.outcome is Outcome.CRASHED
    assert scene(driver)._pace.slow is slow
    driver.key(pygame.K_r)
    assert not scene(driver)._pace.slow
    before = scene(driver).flight_replay.at
    driver.frames(10)
    assert scene(driver).flight_replay.at == before + 10 * (1 + faster)


# The logbook


@pytest.fixture
def book(open_game: Open, context: Context) -> Driver:
    records = Records(context.user_dir)
    fall, landing = fly_out(begun(5)), scripted()
    records.keep(landing, NOON, alone=True)
    records.keep(fall, NOON + 60, alone=True)
    driver = open_game(LogbookScene)
    driver.frames(3)
    return driver


def page(driver: Driver) -> LogbookScene:
    assert isinstance(driver.top, LogbookScene)
    return driver.top


def test_flights_are_listed_newest_first_and_filtered(book: Driver):
    assert [entry.outcome for entry in page(book).items] == ["CRASHED", "LANDED"]
    book.form.focus(book.choice(texts.LOGBOOK_FILTERS[0]))
    book.key(pygame.K_RIGHT)
    assert [entry.alone for entry in page(book).items] == [True]


def test_a_flight_whose_file_is_gone_keeps_its_line_and_says_why(book: Driver, monkeypatch):
    entry = page(book).chosen
    assert entry
    (page(book)._records.folder / entry.file).unlink()
    page(book).enter()
    written = words_written(monkeypatch)
    book.frames(1)
    assert len(page(book).items) == 2
    assert texts.FLIGHT_GONE in written
    assert texts.LOGBOOK_WATCH not in [word.label for word in book.form.widgets]
    book.key(pygame.K_RETURN)
    assert book.top_name == "LogbookScene"


def test_a_damaged_flight_is_named_and_left_alone(book: Driver):
    entry = page(book).chosen
    assert entry
    path = page(book)._records.folder / entry.file
    path.write_text("{")
    book.key(pygame.K_RETURN)
    assert book.top_name == "LogbookScene"
    assert "damaged" in book.said
    assert path.read_text() == "{"
