"""A helped flight that is lost says why it was not saved, and what would have; and how well others were landed."""

import numpy as np
import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.copilot.copilot import Mode
from ai.copilot.futures import KEYS, Lookahead
from ai.lander.environment import PARAMS, Outcome
from ai.lander.missions import MISSIONS
from ai.lander.moment import Moment
from game.core import texts
from game.core.assets import MODELS_DIR
from game.flight.flight import Flight
from game.flight.foresight import HELD, LastChance, SixFutures
from game.flight.outcomes import outcome_card, qualities
from game.scenes.play.challenge import FlownMission
from game.scenes.play.scene import PlayScene
from game.scenes.play.tutorial import Tutorial
from game.scenes.play.words import why_not_saved
from tests.support.flights import challenge_of, play


@pytest.fixture(scope="module")
def agent() -> DeepQAgent:
    return DeepQAgent.load(MODELS_DIR / "lander" / "modern")


def lost(agent: DeepQAgent, mode: Mode, assist: float) -> tuple[Flight, LastChance]:
    """Turn all the way with noisy hands and a help that cannot keep it upright."""
    flight, chance = Flight(2, agent, hands="noisy"), LastChance(agent)
    flight.help(assist, mode)
    while not flight.over:
        chance.note(flight.env)
        flight.step(1)
    while not chance.known:
        chance.look(50)
    return flight, chance


@pytest.mark.parametrize("mode", list(Mode))
def test_a_flight_that_help_did_not_save_says_why_and_what_would_have(agent: DeepQAgent, mode: Mode):
    flight, chance = lost(agent, mode, 0.01)
    assert flight.wrecked
    by_rule = {Mode.TOLERANCE: texts.NOT_SAVED_TOLERANCE, Mode.GUARDIAN: texts.NOT_SAVED_BY_VALUES}
    assert chance.seconds is not None
    sentence = texts.LAST_CHANCE.format(seconds=f"{chance.seconds:.1f}")
    assert why_not_saved(flight, chance) == f"{by_rule[mode]} {sentence}"


def test_what_would_have_saved_it_does(agent: DeepQAgent):
    _, chance = lost(agent, Mode.GUARDIAN, 0.01)
    assert chance.seconds is not None
    again = Flight(2, agent, hands="noisy")
    again.help(0.01, Mode.GUARDIAN)
    while float(again.env.time[0]) < chance.seconds:
        again.step(1)
    [plan] = Lookahead(agent).plans(Moment.of(again.env), [(0, (KEYS[0],))])
    assert plan is not None


def test_six_futures_end_where_the_flight_ends_after_that_action(agent: DeepQAgent):
    flight = Flight(4, agent)
    futures = SixFutures(agent)
    futures.begin(Flight(9, agent).env)  # of another moment, left at once
    futures.follow(3)
    futures.begin(flight.env)
    before = flight.env.snapshot()
    while futures.under_way:
        futures.follow(10)
    assert all(lands is not None for lands in futures.lands)
    for action, (path, lands) in enumerate(zip(futures.paths, futures.lands, strict=True)):
        flown = Flight(4, agent)
        for _ in range(round(60 * HELD / 4) * 4):
            flown.step(action)
        flown.hand_over()
        while not flown.over:
            flown.step(0)
        assert (flown.outcome is Outcome.LANDED) is lands
        assert path[-1] == pytest.approx(flown.env.position[0], abs=0.6)
    assert (flight.env.snapshot()["bodies"]["pose"] == before["bodies"]["pose"]).all()


def test_a_landing_that_is_soft_centred_and_upright_is_perfect():
    for start, met in (((0.0, 0.02, 0.0), ["soft", "centred", "upright"]), ((1.6, 0.02, 0.0), ["soft", "upright"])):
        aside, above, angle = start
        flight = Flight(0)
        x, y = flight.env.pad[0].tolist()
        state = [x + aside, y + PARAMS.stand + above, 0, 0, angle, 0]
        flight.env.place(np.ones(1, bool), np.array([state]))
        while not flight.over:
            flight.step(0)
        assert qualities(flight.env) == met
        assert (outcome_card(flight.env, 1.0).title == texts.PERFECT) is (len(met) == 3)


def test_help_of_free_flights_does_not_follow_into_a_mission_which_says_so_and_can_be_given_it(
    open_game, context, written: list[str]
):
    context.settings.assist, context.settings.copilot = 0.6, "guardian"
    context.settings_file.save(context.settings)
    driver = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["brake"]))
    driver.frames(2)
    assert not play(driver).flight.shared
    assert texts.HELP_NOT_HERE in written
    driver.key(pygame.K_PLUS)
    driver.frames(2)
    assert play(driver).flight.shared
    assert driver.app.context.settings.assist == 0.6
    driver.key(pygame.K_r)
    assert play(driver).flight.shared  # for this mission it stays


def test_the_key_that_skips_a_lesson_skips_them_all_when_held(open_game):
    driver = open_game(PlayScene, 0, challenge=Tutorial(), tutored=False)
    first = challenge_of(driver).lesson
    driver.key(pygame.K_n)
    assert challenge_of(driver).lesson is not first
    driver.post(pygame.KEYDOWN, key=pygame.K_n, mod=0, unicode="", scancode=0)
    driver.frames(70)
    assert play(driver).challenge.free
    assert driver.app.context.settings.tutored
