"""How a flight in Play feels: camera, slow motion, what is said on the spot; and that none of it changes a flight."""

from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.lander.environment import PARAMS, Outcome
from game.core import texts
from game.flight import networks
from game.flight.replay import replayed
from game.scenes.play.scene import PlayScene
from tests.support.driver import Driver
from tests.support.flights import actions

Open = Callable[..., Driver]
FALL = (8.0, 4.0, 1.0, -3.0, 0.3, 0.0)  # beside the pad
REST = (0.0, PARAMS.pad_top + PARAMS.stand + 0.3, 0.0, 0.0, 0.0, 0.0)


@pytest.fixture
def game(open_game: Open, monkeypatch: pytest.MonkeyPatch) -> Driver:
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("none", None))
    return open_game(PlayScene, seed=3)


def scene(driver: Driver) -> PlayScene:
    assert isinstance(driver.top, PlayScene)
    return driver.top


def place(driver: Driver, start: tuple[float, ...]) -> None:
    play = scene(driver)
    play.flown.waiting = False
    play.flight.env.place(np.ones(1, bool), np.array([start]))


def crash(driver: Driver) -> None:
    place(driver, FALL)
    while not scene(driver).flight.over:
        driver.skip(1)
    assert scene(driver).flight.outcome is Outcome.CRASHED


def frames_to_card(driver: Driver) -> int:
    frames = 0
    while scene(driver).ending.shown < 1:
        driver.skip(1)
        frames += 1
        assert frames < 300
    return frames


def test_a_crash_is_slow_for_under_a_second_more_and_adds_nothing_to_the_flight(game: Driver):
    crash(game)
    flight = scene(game).flight
    flown = flight.at
    assert scene(game).flown.pace.slow
    slowly = frames_to_card(game)
    assert flight.at == flown
    assert flight.env.steps[0] == flown
    game.key(pygame.K_r)
    game.app.context.settings.reduced_motion = True
    game.key(pygame.K_r)
    crash(game)
    assert not scene(game).flown.pace.slow
    assert 20 < slowly - frames_to_card(game) < 60


@pytest.mark.slow
def test_with_and_without_motion_the_same_hands_fly_the_same_flight(game: Driver):
    """Every effect on, and every effect off: the same, bit for bit, and so is the replay."""
    ends = []
    for reduced in (False, True):
        game.app.context.settings.reduced_motion = reduced
        game.key(pygame.K_r)
        game.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0, unicode="", scancode=0)
        game.frames(80)
        game.post(pygame.KEYUP, key=pygame.K_UP, mod=0, unicode="", scancode=0)
        flight = scene(game).flight
        game.wait(lambda flight=flight: flight.over)  # type: ignore[misc]
        again = replayed(flight.recording)
        while not again.over:
            again.step()
        assert np.array_equal(again.poses.now, flight.poses.now)
        ends.append((actions(flight), flight.poses.now.tolist()))
    assert ends[0] == ends[1]


def test_slow_motion_can_be_cut_short_and_loses_no_key(game: Driver):
    crash(game)
    game.frames(30)
    assert scene(game).flown.pace.slow
    game.key(pygame.K_RETURN)
    assert not scene(game).flown.pace.slow
    assert frames_to_card(game) < 20
    game.key(pygame.K_r)
    crash(game)
    game.frames(5)
    game.key(pygame.K_r)  # in the midst of it
    assert not scene(game).flight.over
    assert not scene(game).flown.pace.slow


@pytest.mark.parametrize("reduced", [False, True])
def test_a_crash_is_heard_as_it_is_seen_also_if_motion_was_reduced_on_the_way(game: Driver, reduced: bool, monkeypatch):
    heard: list[str] = []
    monkeypatch.setattr(game.app.context.sound, "play", lambda key, *_: heard.append(key))
    game.app.context.settings.reduced_motion = not reduced
    game.key(pygame.K_r)
    game.key(pygame.K_UP)
    game.key(pygame.K_ESCAPE)
    game.app.context.settings.reduced_motion = reduced
    game.key(pygame.K_ESCAPE)
    crash(game)
    assert scene(game).flown.pace.slow is not reduced
    assert [key for key in heard if "crash" in key] == ["crash"]


def test_contact_light_is_announced_when_both_feet_are_down_and_then_no_more(game: Driver, written: list[str]):
    game.key(pygame.K_r)
    place(game, REST)
    game.frames(5)
    assert texts.CONTACT_LIGHT not in written
    game.frames(60)
    assert scene(game).flight.env.feet_down.all()
    assert texts.CONTACT_LIGHT in written
    game.frames(200)
    written.clear()
    game.frames(30)
    assert texts.CONTACT_LIGHT not in written


def test_with_reduced_motion_nothing_zooms_pans_or_shakes(game: Driver):
    game.app.context.settings.reduced_motion = True
    game.key(pygame.K_r)
    still = scene(game).flown.scenery.view(1.5)
    place(game, FALL)
    for _ in range(80):
        game.skip(1)
        assert scene(game).flown.scenery.view(1.5, 0.3) == still


@pytest.mark.parametrize("reduced", [False, True])
def test_a_craft_that_waits_high_up_hangs_below_the_words(game: Driver, reduced: bool):
    game.app.context.settings.reduced_motion = reduced
    game.key(pygame.K_r)
    place(game, (3.0, 16.0, 0.0, 0.0, 0.0, 0.0))
    scenery = scene(game).flown.scenery
    scenery.cut()
    _, y = scenery.view(1.0).points((3.0, 16.0 + PARAMS.stand))
    assert y > scene(game).flown.clear.head > 104
    assert scenery.view(1.0).centre[0] == 0 or not reduced


def test_nothing_is_heard_of_a_craft_that_hangs_and_waits(game: Driver, monkeypatch: pytest.MonkeyPatch):
    heard: list[str] = []
    monkeypatch.setattr(game.app.context.sound, "play", lambda key, *_: heard.append(key))
    game.frames(200)
    assert scene(game).waiting
    assert heard == []
