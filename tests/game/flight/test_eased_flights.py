"""Flights under other rules, flown again bit for bit: shares of thrust, wider pads, no time limit, gravity and pace."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pygame
import pytest

from ai.flights.recording import STEPS, UNHURRIED, WIDER, Easing, full
from ai.lander.environment import PARAMS, Outcome
from ai.lander.missions import MISSIONS
from ai.lander.pilots import ScriptedPilot
from game.core import texts
from game.flight import flight_file
from game.flight.flight import Flight
from game.flight.flight_file import Record
from game.flight.logbook import Records, best, best_alone, describe
from game.flight.replay import ReplayedFlight
from game.input.analogue import pushed
from game.scenes.play.challenge import FlownMission
from game.scenes.play.choices import ChoicesScene
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.one_switch import one_switch


def record_of(flight: Flight) -> Record:
    x, y, angle = flight.poses.now[0].tolist()
    return Record(flight.recording, describe(flight, 1.0), (x, y, angle))


def analogue(flight: Flight, most: int = 500) -> Flight:
    """Fly with the scripted pilot's wishes, but throttle and stick between nothing and all."""
    pilot, rng = ScriptedPilot(), np.random.default_rng(1)
    for _ in range(most):
        if flight.over:
            break
        wish = int(pilot.act(flight.observation)[0])
        main, side = full(wish)
        stick = pushed(main / STEPS * rng.uniform(0.5, 1.0), side / STEPS * rng.uniform(0.1, 1.0))
        flight.step(*stick)
    return flight


@pytest.mark.parametrize(
    ("pads", "mission", "easing"),
    [(1, "", Easing()), (3, "", Easing(wider_pads=True)), (1, "wind", Easing(wider_pads=True, untimed=True))],
)
def test_an_analogue_flight_is_flown_again_bit_for_bit(pads: int, mission: str, easing: Easing):
    flight = analogue(Flight(3, pads=pads, mission=mission, easing=easing))
    assert len(set(flight.recording.shares.values())) > 20
    record = flight_file.from_text(flight_file.to_text(record_of(flight)))
    assert record.recording == flight.recording
    again = ReplayedFlight(record.recording)
    while not again.over and again.at < len(record.recording.actions):
        again.step(0)
    assert again.poses.now.tobytes() == flight.poses.now.tobytes()
    assert again.env.fuel == flight.env.fuel
    assert again.recording == flight.recording


def test_whole_thrust_leaves_no_trace_in_the_recording():
    flight, plain = Flight(3), Flight(3)
    for action in [3, 4, 0, 5, 2, 1] * 10:
        flight.step(*pushed(*(share / STEPS for share in full(action))))
        plain.step(action)
    assert flight.recording == plain.recording
    assert flight.recording.shares == {}


def test_a_co_pilot_that_steps_in_flies_its_own_action_in_full(monkeypatch: pytest.MonkeyPatch):
    flight = Flight(3)
    monkeypatch.setattr(Flight, "shared", property(lambda _: True))
    for own, flown in ((4, 4), (4, 3)):
        monkeypatch.setattr(flight, "_ask_copilot", lambda flown=flown: flown)
        flight.step(own, (9, -5))
        step = len(flight.recording.actions) - 1
        assert flight.env.shares.tolist() == ([[9 / STEPS, -5 / STEPS]] if own == flown else [[1.0, 0.0]])
        assert (step in flight.recording.shares) is (own == flown)


def test_a_file_of_the_version_before_is_read_unchanged():
    flight = Flight(3)
    for _ in range(60):
        flight.step(3)
    text = (
        flight_file.to_text(record_of(flight)).replace('"version": 5', '"version": 4').replace(' "shares": "",\n', "")
    )
    begin = text.index(' "easing"')
    old = text[:begin] + text[text.index("},", begin) + 3 :]
    assert "easing" not in old
    assert flight_file.from_text(old).recording == flight.recording


def test_wider_pads_are_half_as_wide_again_and_nothing_else_moves():
    for pads in (1, 3):
        plain, wide = Flight(3, pads=pads), Flight(3, pads=pads, easing=Easing(wider_pads=True))
        assert wide.env.ground.widths == pytest.approx(WIDER * plain.env.ground.widths)
        assert np.array_equal(wide.env.ground.middles, plain.env.ground.middles)
        assert np.array_equal(wide.env.position, plain.env.position)
    for name, mission in MISSIONS.items():
        env = Flight(0, mission=name, easing=Easing(True, True)).env
        assert env.ground.widths[0] == pytest.approx(WIDER * mission.pad.width), name
        assert (env.limits.time, env.limits.touch_speed) == (UNHURRIED, mission.limits.touch_speed), name


def test_without_a_time_limit_a_flight_outlasts_it_and_can_be_read_back():
    flight = Flight(3, easing=Easing(untimed=True))
    pilot = ScriptedPilot()
    for _ in range(60 * 40):  # hovering
        flight.step(3 * bool(flight.env.velocity[0, 1] < 0) + int(pilot.act(flight.observation)[0]) % 3)
    assert flight.outcome is Outcome.FLYING
    assert flight.env.time[0] > 39
    record = flight_file.from_text(flight_file.to_text(record_of(flight)))
    assert record.recording == flight.recording


def test_a_slow_hand_with_one_switch_lands():
    """A fifth of a second late, five decisions a second, and nothing but the engine: the jets steer by themselves."""
    for seed in range(6):
        assert one_switch(Flight(seed, easing=Easing(wider_pads=seed % 2 == 0))).outcome is Outcome.LANDED, seed


Open = Callable[..., Driver]


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


def test_all_of_it_is_no_change_bit_for_bit_and_two_changes_between_two_steps_are_one():
    flight = Flight(3)
    for shares, kept in (((0.6, 0.7, 1.4, 0.9), ((0, 0.9),)), ((0.7, 1.0), ())):
        for share in shares:
            flight.set_gravity(share)
        assert flight.recording.gravity == kept, shares
    plain, explicit = fly({}), fly({0: 1.0, 7: 1.0})
    assert explicit.recording.gravity == ()
    assert np.array_equal(plain.poses.now, explicit.poses.now)


def test_practice_is_not_among_the_best():
    entry = replace(describe(fly({}), 1.0), alone=True, file="a.json", score=90)
    easy, slow = replace(entry, gravity=0.8, score=100), replace(entry, pace=0.7, score=99)
    assert (easy.practice, slow.practice, entry.practice) == (True, True, False)
    assert best([easy, slow, entry]) == [entry]
    others = [replace(entry, score=95, **kind) for kind in ({"course": "night"}, {"alone": False}, {"spawn": "rung_3"})]
    assert best_alone([easy, slow, entry, *others]) == 90
    assert best_alone([]) == 0


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
    play.flight.env.place(np.ones(1, bool), np.array([[0.0, 4.0, 0.0, -6.0, 0.0, 0.0]]))
    while not play.flight.over:
        game.frames(5)
    game.frames(5)
    [entry] = Records(context.user_dir).entries()
    assert (entry.practice, entry.alone, entry.gravity) == (True, False, pytest.approx(0.8))
    context.settings.gravity = 1.2  # for the flights to come
    game.frames(5)
    assert play.flight.recording.gravity == ((step, share),)


def test_a_mission_keeps_its_own_gravity_and_offers_but_help_and_the_pace(open_game: Open, context: Context):
    context.settings.gravity, context.settings.more_flights = 0.6, True
    context.settings_file.save(context.settings)
    game = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["fall"]))
    game.frames(2)
    game.key(pygame.K_UP)
    game.frames(10)
    assert len(game.top.flight.recording.actions) > 5
    assert game.top.flight.recording.gravity == ()
    assert not game.top.credit.practice
    game.key(pygame.K_c)
    labels = [widget.label for widget in game.top.form.widgets]
    assert texts.PACE in labels
    assert texts.CHOICES_GRAVITY not in labels


def test_time_slowed_down_flies_the_same_flight_more_slowly_and_as_an_assist(open_game: Open, context: Context):
    context.settings.pace = 0.5
    context.settings_file.save(context.settings)
    driver = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["fall"]))
    play = driver.top
    driver.frames(2)
    driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0)
    driver.frames(59)
    assert len(play.flight.recording.actions) == pytest.approx(30, abs=1)
    driver.app.context.settings.pace = 1.0  # the slowest counts
    driver.post(pygame.KEYUP, key=pygame.K_UP, mod=0)
    while not play.ending.card:
        driver.skip()
    [entry] = Records(context.user_dir).entries()
    assert (entry.pace, entry.practice, entry.alone, entry.medal) == (0.5, True, False, 0)
    assert entry.bar == "assists"
    assert texts.ASSIST_HALF_SPEED in play.ending.card.assists
    again = ReplayedFlight(Records(context.user_dir).read(entry.file).recording)
    while not again.over:
        again.step(0)
    assert np.array_equal(again.poses.now, play.flight.poses.now)
