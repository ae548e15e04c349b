from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.flights.verification import landing_score
from ai.lander.environment import PARAMS, Cause, Outcome
from ai.lander.missions import MISSIONS, Mission
from game.core import texts
from game.core.assets import ASSETS_DIR, MODELS_DIR
from game.core.scene import Pop
from game.explain.readouts import flight_readouts
from game.flight import flight_file
from game.flight.choosers import Recorded
from game.flight.foresight import surface_height
from game.flight.logbook import Records
from game.flight.outcomes import OutcomeCard, flight_figures, qualities
from game.scenes.logbook.scene import LogbookScene
from game.scenes.play.challenge import FlownMission, Wanted
from game.scenes.play.missions import MissionsScene
from game.scenes.play.wind import wind
from game.scenes.play.words import surroundings
from game.ui.context import Context
from game.ui.listing import ListRow
from tests.game.play.ends import end
from tests.support.driver import Driver
from tests.support.flights import actions, begun, concluded, kept, play, scripted
from tests.support.missions import fly, pilots

Open = Callable[..., Driver]
pytestmark = pytest.mark.usefixtures("scripted_network")


def land(driver: Driver) -> None:
    """Bring the flight to a landing by hand."""
    x, y = play(driver).flight.env.pad[0].tolist()
    end(driver, (x, y + PARAMS.stand + 0.002, 0, 0, 0, 0))


def test_every_mission_has_words_and_can_be_begun():
    assert MISSIONS.keys() == texts.MISSIONS.keys()
    for mission in MISSIONS.values():
        env = mission.begin(2)
        env.step(np.zeros(2, int))
        assert (env.outcome == Outcome.FLYING).all(), mission.name
        assert mission.gold[0] <= mission.silver[0] <= mission.conditions.tank
        assert mission.gold[1] <= mission.silver[1] <= mission.limits.time


def test_whoever_flies_the_printed_limit_has_kept_it_and_a_tenth_more_is_too_much(subtests: pytest.Subtests):
    for mission in MISSIONS.values():
        with subtests.test(name=mission.name):
            env = begun(0, None, mission=mission.name).env
            for medal, (most_fuel, longest) in ((3, mission.gold), (2, mission.silver)):
                for steps in range(round(600 * most_fuel) - 40, round(600 * most_fuel) + 41):  # of a jet, a 600th each
                    env.main_steps[:], env.side_steps[:], env.steps[:] = 0, steps, round(60 * (longest - 1))
                    figures = {label: float(value) for label, value, _ in flight_figures(env)}
                    won = mission.medal(float(env.fuel[0]), float(env.time[0])) >= medal
                    assert won == (figures[texts.FUEL] <= most_fuel)
                    if env.conditions.tank == np.inf:
                        assert float(flight_readouts(env)["fuel"].figure) == figures[texts.FUEL]
                env.side_steps[:] = 0
                for steps in range(round(60 * longest) - 4, round(60 * longest) + 5):
                    env.steps[:] = steps
                    figures = {label: float(value) for label, value, _ in flight_figures(env)}
                    assert (mission.medal(0.0, float(env.time[0])) >= medal) == (figures[texts.TIME] <= longest)


def test_every_mission_has_a_recorded_flight_that_earns_gold():
    for name in MISSIONS:  # that they earn what they claim is a test of `verify`
        entry = flight_file.read(ASSETS_DIR / "flights" / f"{name}.json").entry
        assert (entry.course, entry.outcome, entry.medal) == (name, Outcome.LANDED.name, 3)


@pytest.mark.slow
def test_the_network_lands_where_its_page_says_so():
    flyers = pilots(MODELS_DIR / "lander")
    for mission in MISSIONS.values():
        landed = int((fly(flyers[mission.elsewhere], mission, 20)[0] == Outcome.LANDED).sum())
        assert abs(landed - mission.landed) <= 2, mission.name  # another processor may round otherwise


def rows(driver: Driver) -> dict[str, tuple[str, ...]]:
    """The list of missions, by name."""
    listed = driver.the(ListRow).rows
    return {name: row for name, (title, _) in texts.MISSIONS.items() for row in listed if row[0].endswith(title)}


def test_the_campaign_is_walked_through_by_keys_and_a_landing_is_remembered(open_game: Open):
    driver = open_game()
    driver.key(pygame.K_RETURN)
    driver.press_on(texts.FLIGHTS["missions"][0])
    driver.keys(pygame.K_DOWN, pygame.K_RETURN)
    assert play(driver).challenge.name == "brake"
    for ghost in (texts.THE_NETWORK, texts.GHOST_BEFORE):  # the landing just flown is there to be beaten
        assert play(driver).flown.ghost.name == ghost
        land(driver)
        assert play(driver).ending.card.score.endswith(f"points{texts.DIAL_JOIN}gold")
        driver.key(pygame.K_r)
    land(driver)
    driver.key(pygame.K_RETURN)
    assert play(driver).challenge.name == "aside"  # the next one
    assert play(driver).flown.ghost.name == texts.THE_NETWORK
    driver.key(pygame.K_ESCAPE)
    driver.press_on(texts.PAUSE_LEAVE)
    assert driver.top_name == "MissionsScene"
    assert driver.top.chosen == "aside"
    driver.key(pygame.K_UP)
    assert rows(driver)["brake"][1] == texts.MEDALS[3]


def carded(name: str, fuel: float, seconds: float, cause: Cause = Cause.NONE) -> OutcomeCard:
    """The card of a mission that ended in a landing, or was lost for a cause."""
    flight = begun(0, None, mission=name)
    env = flight.env
    env.outcome[:], env.cause[:] = Outcome.CRASHED if cause else Outcome.LANDED, cause
    env.main_steps[:], env.steps[:] = round(60 * fuel), round(60 * seconds)
    challenge = FlownMission(MISSIONS[name])
    card = OutcomeCard(not cause, "", "", (), advice="else")
    return concluded(challenge, flight, card)


def test_the_card_says_what_the_next_medal_asks_and_of_a_loss_what_the_missions_own_trouble_does():
    for fuel, seconds, reason in (
        (3.0, 7.0, texts.MEDAL_GOLD),
        (3.5, 7.0, "Gold asks for 0.4 s less fuel."),
        (3.0, 8.1, "Gold asks for 0.1 s less time."),
        (5.0, 13.5, "Silver asks for 0.8 s less fuel and 1.5 s less time."),
    ):
        assert carded("brake", fuel, seconds).reason == reason
    for name, cause, fuel, seconds, advice in (
        ("tank", Cause.HARD, 3.0, 9.0, texts.ADVICE_TANK),
        ("tank", Cause.HARD, 2.0, 9.0, "else"),
        ("outage", Cause.HARD, 0.0, 4.5, texts.ADVICE_OUTAGE),
        ("ferry", Cause.SLIDING, 0.0, 9.0, texts.ADVICE_MOVING),
        ("wind", Cause.TERRAIN, 0.0, 9.0, texts.ADVICE_WIND),
        ("fall", Cause.HARD, 0.0, 9.0, "else"),
    ):
        assert carded(name, fuel, seconds, cause).advice == advice, (name, cause)


def test_on_a_pad_that_moves_its_own_middle_and_speed_count_and_the_surface_moves_with_it():
    flight = begun(0, None, mission="ferry")
    env = flight.env
    env.steps[:] = 60 * 4
    shift, speed = float(env.pad_shift[0]), float(env.pad_velocity[0])
    env.place(np.ones(1, bool), np.array([[shift, PARAMS.pad_top + PARAMS.stand, speed, 0, 0, 0]]))
    env.steps[:] = 60 * 4
    env.outcome[:] = Outcome.LANDED
    assert landing_score(env) == 100
    assert "centred" in qualities(env)
    assert flight_readouts(env)["drift"].figure == "0.0"
    edge = env.ground.pads[0].right + shift
    assert abs(shift) > 0.5
    assert surface_height(env, edge - 0.1) == env.ground.pads[0].top > surface_height(env, edge + 0.1)


def test_what_surrounds_a_flight_is_said():
    for name, seconds, said in (
        ("fall", 0.0, []), ("outage", 1.0, ["The main engine fails in 1.0 s"]),
        ("outage", 3.0, ["No main engine for 1.0 s"]), ("outage", 5.0, []),
    ):  # fmt: skip
        env = begun(0, None, mission=name).env
        env.steps[:] = round(60 * seconds)
        assert list(surroundings(env)) == said, (name, seconds)
    mars = begun(0, None, mission="mars").env
    assert "2.3 times" in next(iter(surroundings(mars)))
    mars.steps[:] = 75
    assert wind(mars) == pytest.approx(0.1, abs=0.05)


def test_beside_the_player_flies_the_network_or_a_landing_that_was_recorded(open_game: Open, monkeypatch):
    driver = open_game(MissionsScene)
    for lands in (True, False):
        monkeypatch.setattr(Mission, "network_lands", lands)
        driver.key(pygame.K_RETURN)
        assert isinstance(play(driver).flown.ghost.flight.chooser, Recorded) is not lands
        driver.app.scenes.apply(Pop())


def test_a_landing_of_ones_own_is_the_ghost_of_the_next_try_and_a_networks_is_not():
    for by_hand in (1, 0):
        challenge = FlownMission(MISSIONS["brake"])
        concluded(challenge, scripted(mission="brake", by_hand=by_hand))
        assert bool(challenge.start(Wanted(0)).ghost) == by_hand


# Flights of one's own


def test_a_flight_is_flown_on_from_the_moment_that_is_shown(open_game: Open, context: Context):
    kept(context, scripted(by_hand=30))
    book = open_game(LogbookScene)
    book.frames(2)
    book.key(pygame.K_RETURN)
    book.frames(40)
    book.key(pygame.K_SPACE)
    flight_replay = book.top.flight_replay
    at, place = flight_replay.at, flight_replay.flight.env.position.copy()
    book.key(pygame.K_TAB)
    flight = play(book).flight
    assert np.array_equal(flight.env.position, place)
    assert actions(flight) == actions(flight_replay.record)[:at]
    book.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0, unicode="", scancode=0)
    book.frames(10)
    assert flight.at > at
    assert play(book).flown.ghost.flight.env.steps[0] == flight.env.steps[0]
    land(book)
    assert not Records(book.app.context.user_dir).entries()[-1].alone
