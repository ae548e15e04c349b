"""The chance to be saved in the cockpit: ring, words of the dial, panel and card, and what is said without a critic."""

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.copilot.copilot import CoPilot, Mode
from ai.copilot.guardian import required_chance
from ai.lander.environment import Outcome
from game.cockpit.chance_meter import ChanceMeter, depth
from game.cockpit.guardian_words import dial_words
from game.core import texts
from game.core.settings import Settings
from game.drawing.canvas import Canvas
from game.flight.flight import Flight
from game.flight.outcomes import outcome_card
from game.panels.chance_values import of_hundred, told_apart
from game.scenes.play import PlayScene
from game.scenes.watch import WatchScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import fly_out, play
from tests.support.written import words_written

MODELS = Path(__file__).parents[3] / "models"
MODERN = MODELS / "lander" / "modern"
LEFT, MAIN = 1, 3
Open = Callable[..., Driver]


@pytest.fixture(scope="module")
def agent() -> DeepQAgent:
    return DeepQAgent.load(MODERN)


def metered(agent: DeepQAgent, settings: Settings, assist: float = 0.4, mode: Mode = Mode.GUARDIAN):
    flight = Flight(12, agent)
    flight.help(assist, mode)
    return flight, ChanceMeter(flight, settings, wishes=True)


def test_the_ring_shows_what_the_guardian_has_decided_by(agent: DeepQAgent):
    flight, meter = metered(agent, Settings(reduced_motion=True))
    low = set()
    while not flight.over and len(flight.recording.actions) < 400:
        flight.step(LEFT)
        meter.follow()
        decision = flight.decision
        assert decision is not None
        assert decision.chance is not None
        if not flight.over:
            assert (meter.chance, meter.required) == (float(decision.chance[0]), decision.required)
            low.add(meter.low)
            assert not flight.overridden or meter.low or flight.copilot is not None
            assert of_hundred(float(decision.required[0])) in meter.said() or "." in meter.said()
    assert low == {True, False}
    canvas = Canvas(pygame.Surface((1280, 720)))
    meter.ease()
    meter.draw(canvas, (600.0, 36.0))
    assert canvas.explained[-1].what == texts.EXPLAIN_RING[1]


def test_alone_the_ring_is_there_on_wish_and_asks_the_critic_once_for_each_decision(
    agent: DeepQAgent, monkeypatch: pytest.MonkeyPatch
):
    settings = Settings()
    flight, meter = metered(agent, settings, assist=0.0)
    flight.step(MAIN)
    meter.follow()
    assert (meter.wished, meter.chance) == (False, None)
    settings.edge = True
    assert meter.wished
    asked = []
    chances = type(meter.critic).chances
    monkeypatch.setattr(type(meter.critic), "chances", lambda *a: asked.append(1) or chances(*a))
    for _ in range(41):
        flight.step(MAIN)
        meter.follow()
        assert meter.chance is not None
        assert meter.required is None
    assert len(asked) <= 12
    assert meter.said() == texts.EXPLAIN_RING_NOW.format(chance=of_hundred(meter.chance))


def test_a_mission_elsewhere_says_that_the_chance_is_not_known(agent: DeepQAgent):
    flight = Flight(1, agent, mission="mars")
    meter = ChanceMeter(flight, Settings(edge=True), wishes=True)
    assert (meter.wished, meter.problem) == (False, texts.CHANCE_MOON_ONLY)


def test_the_dial_says_in_figures_when_a_guardian_steps_in(agent: DeepQAgent):
    copilot = CoPilot(agent, 0.4, Mode.GUARDIAN)
    assert "40 %" in dial_words(0.4, copilot)
    assert "fewer than 99 of 100" in dial_words(0.4, copilot)
    assert float(required_chance(0.4)) == pytest.approx(0.99)
    assert "fewer than 99 of 100" in dial_words(0.4, copilot, among_hills=True)
    assert "another action is clearly safer" in dial_words(0.4, copilot, among_hills=True)
    assert dial_words(0.0, copilot) == texts.DIAL_NEVER
    assert dial_words(0.4, CoPilot(agent, 0.4, Mode.TOLERANCE)) == ""
    assert dial_words(0.4, None) == ""
    without = dial_words(0.4, CoPilot(agent, 0.4, Mode.GUARDIAN, critic=None))
    assert "safety critic" in without
    assert "points" in without


def test_figures_never_claim_certainty_and_tell_different_chances_apart():
    assert of_hundred(0.97) == "97"
    assert of_hundred(1.0) == "100"
    assert of_hundred(0.0) == "0"
    assert of_hundred(0.9999999) == "99.999"
    assert of_hundred(0.9978) == "99.8"
    assert of_hundred(float("nan")) == "–"
    assert told_apart(0.887, 0.886, 0.97) == ("88.7", "88.6", "97.0")
    assert told_apart(0.887, 0.8866) == ("88.70", "88.66")
    assert told_apart(0.5, 0.5) == ("50", "50")
    assert 0 == depth(1.0) < depth(0.97) < depth(0.5) < depth(0.0) == 1


def test_the_card_says_how_often_it_saved_and_never_after_a_crash():
    card = outcome_card(fly_out(Flight(1)).env, 0.94)
    assert card.told == ""
    said = [replace(card, stepped_in=5, saved=saved).told for saved in (None, 0, 1, 2, 3)]
    assert said == [
        texts.SHARE_MOMENTS.format(times=5),
        *texts.CARD_SAVED,
        texts.CARD_SAVED_OFTEN.format(times=3),
    ]


def test_a_guarded_landing_ends_with_a_card_that_names_the_rescues(open_game: Open, context: Context, monkeypatch):
    context.settings.assist, context.settings.copilot, context.settings.tutored = 0.5, "guardian", True
    context.settings_file.save(context.settings)
    driver = open_game(PlayScene, seed=12)
    driver.frames(2)
    driver.post(pygame.KEYDOWN, key=pygame.K_LEFT, mod=0, unicode="", scancode=0)
    driver.frames(100)
    driver.post(pygame.KEYUP, key=pygame.K_LEFT, mod=0, unicode="", scancode=0)
    play(driver).flight.hand_over()
    for _ in range(40):
        driver.frames(60)
        if play(driver).ending.shown >= 1:
            break
    flight = play(driver).flight
    assert flight.outcome is Outcome.LANDED
    words = words_written(monkeypatch)
    driver.frames(2)
    times = play(driver).flown.cockpit.rescues.times
    assert (texts.CARD_SAVED[times] if times < 3 else texts.CARD_SAVED_OFTEN.format(times=times)) in words


def test_m_shows_the_edge_of_no_return_and_the_choices_do_so_without_keys(open_game: Open, context: Context):
    context.settings.tutored = True
    context.settings_file.save(context.settings)
    driver: Any = open_game(PlayScene, seed=12)
    driver.key(pygame.K_m)
    driver.frames(12)
    assert driver.app.context.settings.edge
    assert play(driver).flown.chance_map.cells is not None
    driver.key(pygame.K_m)
    assert not driver.app.context.settings.edge
    driver.key(pygame.K_c)
    driver.frames(2)
    driver.press_on(texts.CHOICES_EDGE[0])
    assert driver.app.context.settings.edge


@pytest.mark.parametrize("how", ["missing", "damaged", "of another network"])
def test_without_a_sound_critic_all_says_so_and_goes_on(open_game: Open, tmp_path: Path, how: str):
    models = tmp_path / "models"
    shutil.copytree(MODERN, models / "lander" / "modern")
    guardian = models / "lander" / "modern" / "guardian"
    if how == "missing":
        shutil.rmtree(guardian)
    elif how == "damaged":
        next((guardian / "network").glob("*.npy")).write_bytes(b"nonsense")
    else:
        config = guardian / "config.json"
        config.write_text(config.read_text().replace('"agent": "', '"agent": "not'))
    settings = Settings(tutored=True, assist=0.4, copilot="guardian", edge=True)
    context = Context(tmp_path / "user", settings, models_dir=models)
    flight = Flight(1, DeepQAgent.load(models / "lander" / "modern"))
    assert flight.copilot is not None
    assert flight.copilot.critic is None
    meter = ChanceMeter(flight, settings, wishes=True)
    assert not meter.wished
    assert flight.copilot.critic_problem in meter.problem
    scene = PlayScene(context, seed=1)
    scene.flight.help(0.4, "guardian")
    for _ in range(30):
        scene.flown.prepare()
        scene.flight.step(LEFT)
        scene.flown.follow()
        scene.flown.breathe()
    assert scene.flown.cockpit.chance_meter.chance is None
    assert scene.flown.cockpit.lacks
    scene.draw(Canvas(pygame.Surface((1280, 720))), 0.5)
    watch = WatchScene(context, 1, seed=1)
    watch.world.policy_map.kind = 3
    for _ in range(4):
        watch.update()
    canvas = Canvas(pygame.Surface((1280, 720)))
    watch.draw(canvas, 0.5)
    assert watch.world.critic_problem
    assert watch.world.chance_map.cells is None
