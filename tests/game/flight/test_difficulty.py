from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pygame
import pytest

from ai.lander.environment import PARAMS
from ai.lander.missions import MISSIONS
from ai.lander.pilots import ScriptedPilot
from game.core import texts
from game.core.settings import Settings
from game.flight import flight_file
from game.flight.flight import Flight
from game.flight.flight_file import Record
from game.flight.logbook import Records, best, best_alone, describe
from game.flight.replay import ReplayedFlight
from game.scenes.play.challenge import FlownMission
from game.scenes.play.choices import ChoicesScene
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.player import Player

Open = Callable[..., Driver]
CHANGES = {0: 0.8, 50: 1.2, 51: 1.0, 90: 0.6}


def fly(changes: dict[int, float], steps: int = 3600) -> Flight:
    flight = Flight(3, ScriptedPilot())
    flight.hand_over()
    for step in range(steps):
        if flight.over:
            break
        if step in changes:
            flight.set_gravity(changes[step])
        flight.step(0)
    return flight


def record_of(flight: Flight) -> Record:
    x, y, angle = flight.poses.now[0].tolist()
    return Record(flight.recording, describe(flight, 1.0), (x, y, angle))


def test_all_of_it_is_no_change_bit_for_bit():
    plain, explicit = fly({}), fly({0: 1.0, 7: 1.0})
    assert explicit.recording.gravity == ()
    assert np.array_equal(plain.poses.now, explicit.poses.now)


def test_two_changes_between_two_steps_are_one():
    flight = Flight(3)
    for share in (0.6, 0.7, 1.4, 0.9):
        flight.set_gravity(share)
    assert flight.recording.gravity == ((0, 0.9),)
    flight.set_gravity(1.0)
    assert flight.recording.gravity == ()


def test_flights_kept_by_the_first_version_can_be_read():
    text = flight_file.to_text(record_of(fly({}, 200)))
    old = text.replace('"version": 2', '"version": 1').replace(' "gravity": [],\n', "").replace(' "pace": 1.0', "")
    old = old.replace('"gravity": 1.0,\n', "").replace('"file": "",\n', '"file": ""\n')
    record = flight_file.from_text(old)
    assert (record.recording.gravity, record.entry.practice) == ((), False)


def test_practice_is_not_among_the_best():
    entry = replace(describe(fly({}), 1.0), alone=True, file="a.json", score=90)
    easy, slow = replace(entry, gravity=0.8, score=100), replace(entry, pace=0.7, score=99)
    assert (easy.practice, slow.practice, entry.practice) == (True, True, False)
    assert best([easy, slow, entry]) == [entry]
    others = [replace(entry, score=95, **kind) for kind in ({"course": "night"}, {"alone": False}, {"spawn": "rung_3"})]
    assert best_alone([easy, slow, entry, *others]) == 90
    assert best_alone([]) == 0


@pytest.mark.parametrize("value", [0.5, 1.5, float("nan"), "1", 1, None])
def test_a_gravity_beyond_its_limits_is_defaulted(value):
    assert Settings.from_dict({"gravity": value, "pace": 0.8}) == Settings(pace=0.8)


def test_gravity_is_changed_in_flight_at_once_and_said(open_game: Open, context: Context):
    context.settings.tutored = context.settings.more_flights = True
    context.settings_file.save(context.settings)
    game = open_game(PlayScene, 3)
    play = game.top
    game.frames(2)
    game.key(pygame.K_UP)
    game.frames(20)
    assert play.flight.recording.gravity == ()
    game.keys(pygame.K_c)
    scene = game.top
    assert isinstance(scene, ChoicesScene)
    while scene.form.focused.label != texts.CHOICES_GRAVITY:
        game.key(pygame.K_DOWN)
    game.keys(pygame.K_LEFT, pygame.K_LEFT, pygame.K_c)
    game.key(pygame.K_UP)  # it hangs until it is touched
    game.frames(2)
    [(step, share)] = play.flight.recording.gravity
    assert (step > 10, share) == (True, pytest.approx(0.8))
    assert play.flight.env.gravity == pytest.approx(0.8 * PARAMS.gravity)
    assert "80" in play.credit.differs
    while not play.flight.over:
        game.frames(20)
    game.frames(5)
    [entry] = Records(context.user_dir).entries()
    assert (entry.practice, entry.alone, entry.gravity) == (True, False, pytest.approx(0.8))
    context.settings.gravity = 1.2  # for the flights to come
    game.frames(5)
    assert play.flight.recording.gravity == ((step, share),)


def test_a_mission_keeps_its_own_gravity(open_game: Open, context: Context):
    context.settings.gravity = 0.6
    context.settings_file.save(context.settings)
    game = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["fall"]))
    game.frames(2)
    game.key(pygame.K_UP)
    game.frames(10)
    assert len(game.top.flight.recording.actions) > 5
    assert game.top.flight.recording.gravity == ()
    assert not game.top.credit.practice


def test_nothing_but_help_and_the_pace_can_be_chosen_in_a_course(open_game: Open, context: Context):
    context.settings.more_flights = True
    context.settings_file.save(context.settings)
    game = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["fall"]))
    game.keys(pygame.K_UP, pygame.K_c)
    labels = [widget.label for widget in game.top.form.widgets]
    assert texts.PACE in labels
    assert texts.CHOICES_GRAVITY not in labels


def test_time_slowed_down_flies_the_same_flight_more_slowly_and_as_an_assist(open_game: Open, context: Context):
    context.settings.pace = 0.5
    context.settings_file.save(context.settings)
    player = Player(open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["fall"])), "keys")
    play = player.top
    player.frames(2)
    player.hold("main", down=True)
    player.frames(99)
    assert len(play.flight.recording.actions) == pytest.approx(50, abs=1)
    player.hold("main", down=False)
    play.retry()
    player.frames(2)
    player.fly(most=7200)
    player.frames(150)
    [entry] = Records(context.user_dir).entries()
    assert entry.landed
    assert (entry.pace, entry.practice, entry.alone, entry.medal) == (0.5, True, False, 0)
    assert entry.bar == "assists"
    assert texts.ASSIST_HALF_SPEED in play.ending.card.assists
    record = Records(context.user_dir).read(entry.file)
    again = ReplayedFlight(record.recording)
    while not again.over:
        again.step(0)
    assert np.array_equal(again.poses.now, play.flight.poses.now)
