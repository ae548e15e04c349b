"""Descent as it is played: one leg after another, what it counts, and how it ends."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pygame
import pytest

from ai.lander.descent import LegStart
from game.core import texts
from game.flight.flight import StickHolder
from game.flight.logbook import Records, best_descent, longest_descent
from game.flight.replay import FlightReplay
from game.scenes.play.descent import Descent
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.support.descent import stand_on
from tests.support.driver import Driver
from tests.support.flights import actions, play

Open = Callable[..., Driver]


@pytest.fixture
def game(open_game: Open) -> Driver:
    return open_game(PlayScene, 3, challenge=Descent())


def descent(driver: Driver) -> Descent:
    challenge = play(driver).challenge
    assert isinstance(challenge, Descent)
    return challenge


def land(driver: Driver, pad: int = 0) -> None:
    """Stand on a pad until the next leg hangs there."""
    scene, number = play(driver), descent(driver).begins.number
    scene.flown.waiting = False
    stand_on(scene.flight.env, pad)
    while descent(driver).begins.number == number:
        driver.skip()


def crash(driver: Driver) -> None:
    """Fall from high up, on the head, until the card is there."""
    scene = play(driver)
    scene.flown.waiting = False
    scene.flight.env.place(np.ones(1, bool), np.array([[0.0, 20.0, 0.0, -6.0, 3.0, 0.0]]))
    while scene.ending.shown < 1:
        driver.skip(5)


def test_a_landing_leads_to_the_next_leg_which_hangs_on_its_feet_with_what_is_in_the_tank(game: Driver):
    land(game)
    scene = play(game)
    assert scene.waiting
    assert descent(game).begins == scene.flight.recording.leg
    assert (descent(game).begins.number, descent(game).legs, descent(game).streak) == (2, 1, 1)
    place = scene.flight.env.position.copy()
    game.frames(10)
    assert (scene.flight.env.position == place).all()
    assert scene.flight.env.feet_down.sum() == 0  # not a step has been flown
    game.key(pygame.K_ESCAPE)
    assert "PauseScene" in game.top_name


def test_points_grow_with_the_row_of_landings_and_are_in_the_logbook(game: Driver, context: Context):
    totals = []
    for _ in range(3):
        land(game)
        totals.append(descent(game).total)
    entries = Records(context.user_dir).entries()
    assert [(entry.course, entry.leg, entry.total) for entry in entries] == [
        ("descent", leg, total) for leg, total in enumerate(totals, 1)
    ]
    assert [entry.score * factor for factor, entry in enumerate(entries, 1)] == np.diff([0, *totals]).tolist()
    assert best_descent(entries) == (3, totals[-1])
    assert [entry.leg for entry in longest_descent(entries)] == [1, 2, 3]


def test_every_leg_can_be_watched_again_to_the_bit(game: Driver, context: Context):
    land(game)
    game.frames(2)  # a key that is down already when a leg begins must be let go first
    for kind in (pygame.KEYDOWN, pygame.KEYUP):  # up and over, so that it comes down on its head
        for key in (pygame.K_UP, pygame.K_RIGHT):
            game.post(kind, key=key, mod=0)
        game.frames(90)
    while not play(game).ending.card:
        game.skip(10)
    records = Records(context.user_dir)
    record = records.read(records.entries()[-1].file)
    assert record.recording.leg == LegStart(2, descent(game).begins.tank)
    again = FlightReplay(record)
    again.scout(10_000)
    assert again.complete
    assert again.faithful


def test_a_crash_ends_the_run_with_how_far_it_came_and_a_key_flies_the_same_ground_beside_ones_ghost(game: Driver):
    land(game)
    crash(game)
    card = play(game).ending.card
    assert not card.good
    assert card.figures[0][1] == card.figures[2][1] == "1"
    assert card.advice == texts.DESCENT_NEW_BEST
    ground = play(game).flight.recording.seed
    game.key(pygame.K_RETURN)
    assert (descent(game).begins, descent(game).best[0]) == (LegStart(), 1)
    assert play(game).flight.recording.seed == ground
    assert play(game).flown.ghost.name == texts.GHOST_BEFORE
    land(game)
    land(game)
    assert play(game).flown.ghost.name == texts.THE_NETWORK  # so far it has not come before


def test_a_leg_that_the_network_has_flown_brings_fuel_but_no_points_and_the_run_counts_no_more(
    game: Driver, context: Context
):
    land(game)
    total = descent(game).total
    game.key(pygame.K_TAB)
    game.frames(5)
    assert play(game).flight.chooser.hand is StickHolder.NETWORK
    land(game)
    assert (descent(game).total, descent(game).streak, descent(game).legs) == (total, 0, 2)
    assert play(game).flight.chooser.hand is StickHolder.HUMAN  # a relief, for one leg
    land(game)
    entries = Records(context.user_dir).entries()
    assert [entry.bar for entry in entries] == ["", "relieved", "relieved"]
    assert best_descent(entries)[0] == 1


def test_another_start_asks_before_it_ends_a_run_and_comes_at_once_where_none_is_lost(game: Driver):
    play(game).flown.waiting = False
    game.frames(3)
    for key in (pygame.K_r, pygame.K_n):
        game.keys(key)
        assert (game.top_name, descent(game).begins.number) == ("PlayScene", 1)
        land(game)
        game.keys(key)
        assert game.top_name == "QuestionDialog"
        assert "1 leg landed" in game.top.more
        game.keys(pygame.K_RETURN)  # the answer in focus is the harmless one
        assert (game.top_name, descent(game).begins.number) == ("PlayScene", 2)
        game.keys(key, pygame.K_ESCAPE)
        assert (game.top_name, descent(game).begins.number) == ("PlayScene", 2)
        game.keys(key, pygame.K_RIGHT, pygame.K_RETURN)
        assert (game.top_name, descent(game).begins.number, descent(game).total) == ("PlayScene", 1, 0)
    land(game)
    game.keys(pygame.K_ESCAPE)
    game.press_on(texts.PAUSE_RETRY)
    assert game.top_name == "QuestionDialog"
    game.keys(pygame.K_RETURN)
    assert (game.top_name, descent(game).begins.number) == ("PlayScene", 2)
    land(game)
    crash(game)
    game.key(pygame.K_n)
    assert (game.top_name, descent(game).begins.number) == ("PlayScene", 1), "a run that has ended is not lost"


# A tap counts, even if a slow frame brings the press and the release at once.

pytestmark = pytest.mark.usefixtures("scripted_network")
PAIRS: dict[str, list[tuple[int, dict[str, Any]]]] = {
    "key": [(pygame.KEYDOWN, {"key": pygame.K_UP, "mod": 0}), (pygame.KEYUP, {"key": pygame.K_UP, "mod": 0})],
    "pad": [
        (pygame.CONTROLLERBUTTONDOWN, {"button": pygame.CONTROLLER_BUTTON_A, "instance_id": 0}),
        (pygame.CONTROLLERBUTTONUP, {"button": pygame.CONTROLLER_BUTTON_A, "instance_id": 0}),
    ],
    "mouse": [
        (pygame.MOUSEBUTTONDOWN, {"button": 1, "pos": (640, 300)}),
        (pygame.MOUSEBUTTONUP, {"button": 1, "pos": (640, 300)}),
    ],
}


def tap(driver: Driver, device: str) -> None:
    """Press and let go within one frame."""
    for kind, values in PAIRS[device]:
        pygame.event.post(pygame.event.Event(kind, values))
    driver.frames(1)


@pytest.mark.parametrize(("device", "one_switch"), [("key", False), ("pad", True), ("mouse", False), ("mouse", True)])
def test_a_tap_within_one_frame_begins_a_flight_that_waits(open_game: Open, device: str, one_switch: bool):
    driver = open_game(PlayScene, 4)
    driver.app.context.settings.one_switch = one_switch
    driver.frames(3)
    assert play(driver).waiting
    tap(driver, device)
    assert not play(driver).waiting
    driver.frames(3)
    flown = actions(play(driver).flight)
    assert flown[0] >= 3  # it fires for the step of the press, and no longer
    assert all(action < 3 for action in flown[1:])
