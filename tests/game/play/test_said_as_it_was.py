"""What is said after a flight is what happened in it."""

from types import SimpleNamespace

import pygame
import pytest

from ai.lander.descent import LegStart, leg_of
from ai.lander.environment import Cause, Outcome
from ai.lander.missions import MISSIONS
from ai.lander.push import KEYS
from game.core import texts
from game.core.settings import Settings
from game.flight.credit import Credit
from game.flight.outcomes import cause_of, crash_reason, outcome_card
from game.scenes.play.challenge import FlownMission, Rules
from game.scenes.play.scene import PlayScene
from game.scenes.play.sitting import CRASHES, Sitting
from tests.support.flights import begun, concluded, play
from tests.support.landers import STAND, put


def down(driver) -> None:
    """Let the craft of the flight on the screen come down on its pad, and wait for its card."""
    driver.key(pygame.K_UP)
    driver.frames(10)
    put(play(driver).flight.env, (0.0, STAND + 0.05))
    driver.wait(lambda: play(driver).ending.shown == 1)


def test_the_best_from_a_start_is_that_of_this_mission_alone(open_game):
    following = lambda: FlownMission(MISSIONS["aside"])  # noqa: E731
    driver = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["fall"], following=following))
    driver.frames(2)
    down(driver)
    driver.key(pygame.K_r)
    driver.frames(2)
    down(driver)
    assert texts.CARD_BEST_HERE in play(driver).ending.card.compared
    driver.key(pygame.K_RETURN)
    driver.frames(2)
    assert play(driver).challenge.name == "aside"
    down(driver)
    assert texts.CARD_BEST_HERE not in play(driver).ending.card.compared


def test_the_wheel_changes_no_help_unseen_on_the_card_and_time_left_is_seen_before_and_in_flight(open_game):
    driver = open_game(PlayScene, 3)
    driver.frames(3)
    assert "time" in play(driver).flown._shown(whole=False)
    down(driver)
    assert "time" in play(driver).flown._shown(whole=False)
    driver.post(pygame.MOUSEWHEEL, y=1, x=0, precise_x=0.0, precise_y=1.0, flipped=False, which=0)
    driver.frames(2)
    assert driver.app.context.settings.help == "off"
    keys = [hint.key for row in play(driver).hint_rows(driver.app.canvas) for hint in row.hints]
    assert len(keys) == len(set(keys))


@pytest.mark.parametrize(("changed", "own"), [(0, True), (6, True), (7, False)])
def test_a_landing_is_ones_own_where_help_flew_a_tenth_at_most(changed, own):
    flight = begun(3)
    credit = Credit(flight, Settings(), Rules())
    for _ in range(60):
        flight.step()
        credit.follow()
    credit._shared, flight._yours = True, 60 - changed
    assert (credit.own, credit.bar) == (own, "" if own else "helped")


def test_no_bronze_is_called_perfect(monkeypatch):
    flight = begun(0, mission="fall")
    put(flight.env, (0.0, STAND + 0.02))
    while not flight.over:
        flight.step()
    assert outcome_card(flight.env).title == texts.PERFECT
    for medal, title in ((3, texts.PERFECT), (1, texts.OUTCOMES["LANDED"][0])):
        monkeypatch.setattr(Credit, "medal", medal)
        assert concluded(FlownMission(MISSIONS["fall"]), flight).title == title


def test_time_outs_are_no_crashes(monkeypatch):
    flight = begun(3)
    flight.env.steps[:] = round(60 * float(flight.env.limits.time)) - 1
    flight.step(KEYS[0])
    assert flight.outcome is Outcome.TIMED_OUT
    monkeypatch.setattr(flight.chooser, "copilot", SimpleNamespace(assist=0.0))
    credit = Credit(flight, Settings(), Rules())
    challenge = SimpleNamespace(rules=Rules())
    flown = SimpleNamespace(flight=flight, credit=credit, challenge=challenge, helped=Settings(help="off"))
    sitting = Sitting([])
    for _ in range(CRASHES):
        sitting.add(flown)
    assert not sitting.offers


def test_a_craft_that_touches_rock_overhead_is_not_down():
    number = next(number for number in range(1, 40) if leg_of(3, LegStart(number)).ground.roofs)
    flight = begun(3, leg=LegStart(number))
    env = flight.env
    height = float(env.ground.height(env.position[:, 0])[0])
    put(env, (float(env.position[0, 0]), height + STAND + 7.4))
    env.outcome[:] = Outcome.CRASHED
    assert not flight.intact
    env.cause[:] = Cause.TERRAIN
    assert cause_of(env)
    assert crash_reason(env) == texts.STRUCK_ABOVE
