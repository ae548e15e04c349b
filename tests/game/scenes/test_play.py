import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.lander.environment import PARAMS, Outcome
from ai.lander.pilots import ScriptedPilot
from ai.training.config import Config
from game.core import texts
from game.core.assets import MODELS_DIR
from game.flight import networks
from game.flight.flight import StickHolder
from game.flight.logbook import Records
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import play

Open = Callable[..., Driver]
MAIN, LEFT, RIGHT = pygame.K_UP, pygame.K_LEFT, pygame.K_RIGHT
FALLING, STANDING = (8, 3, 0, -3, 0, 0), (0, PARAMS.pad_top + PARAMS.stand + 0.01, 0, 0, 0, 0)


class Steady:
    """A network that always steers left."""

    def act(self, observation: np.ndarray, *, held: np.ndarray | None = None) -> np.ndarray:
        return np.full(len(observation), 1)


@pytest.fixture
def begin(open_game: Open, monkeypatch: pytest.MonkeyPatch) -> Open:
    """Open a free flight with a network to hand over to, or with none."""

    def opened(policy: object = None, seed: int = 3) -> Driver:
        monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", policy))
        driver = open_game(PlayScene, seed=seed)
        driver.frames(1)
        return driver

    return opened


def press(driver: Driver, *keys: int) -> None:
    for key in keys:
        driver.post(pygame.KEYDOWN, key=key, mod=0, unicode="", scancode=0)


def let_go(driver: Driver, *keys: int) -> None:
    for key in keys:
        driver.post(pygame.KEYUP, key=key, mod=0, unicode="", scancode=0)


def start_at(driver: Driver, *start: float) -> None:
    play(driver).flown.waiting = False
    play(driver).flight.env.place(np.ones(1, bool), np.array([start]))


def steps(driver: Driver) -> int:
    return int(play(driver).flight.env.steps[0])


def test_keys_fly(begin: Open):
    driver = begin(seed=1)
    for keys, wanted in (((MAIN,), 3), ((LEFT,), 1), ((RIGHT, pygame.K_w), 5), ((LEFT, RIGHT), 0)):
        start_at(driver, 0, 12, 0, 0, 0, 0)
        press(driver, *keys)
        driver.frames(2)
        assert play(driver).flight.env.actions[0] == wanted, keys
        let_go(driver, *keys)
        driver.frames(1)
        assert play(driver).flight.env.actions[0] == 0, keys


@pytest.mark.parametrize("first", [LEFT, pygame.K_TAB])
def test_a_flight_waits_for_the_first_touch_even_through_a_pause(begin: Open, first: int):
    driver = begin(Steady())
    driver.frames(30)
    driver.keys(pygame.K_ESCAPE, pygame.K_ESCAPE)
    assert steps(driver) == 0
    press(driver, first)
    driver.frames(2)
    assert steps(driver) > 0


def test_the_key_that_opened_the_flight_does_not_also_begin_it(open_game: Open):
    driver = open_game()
    driver.key(pygame.K_RETURN)  # the page of Play
    press(driver, pygame.K_SPACE)  # chooses free flight, and is held on
    driver.frames(20)
    assert play(driver).waiting
    let_go(driver, pygame.K_SPACE)
    driver.frames(1)
    press(driver, pygame.K_SPACE)
    driver.frames(1)
    assert not play(driver).waiting


def test_a_key_that_is_held_through_a_pause_must_be_let_go_first(begin: Open):
    driver = begin(Steady())
    press(driver, pygame.K_SPACE)
    driver.frames(10)
    flown = steps(driver)
    assert flown > 0
    driver.keys(pygame.K_ESCAPE, pygame.K_ESCAPE)
    driver.frames(10)
    assert play(driver).waiting
    let_go(driver, pygame.K_SPACE)
    driver.frames(2)
    press(driver, pygame.K_SPACE)
    driver.frames(2)
    assert not play(driver).waiting


def test_after_a_crash_a_key_flies_the_same_start_again_and_after_a_landing_enter_a_new_one(begin: Open):
    driver = begin()
    began = play(driver).flight.poses.before.copy()
    for key, start, outcome, same in (
        (pygame.K_RETURN, FALLING, Outcome.CRASHED, True),
        (pygame.K_SPACE, FALLING, Outcome.CRASHED, True),
        (pygame.K_r, STANDING, Outcome.LANDED, True),
        (pygame.K_RETURN, STANDING, Outcome.LANDED, False),
    ):
        start_at(driver, *start)
        driver.skip(140)
        assert play(driver).flight.outcome is outcome
        driver.key(key)
        assert not play(driver).flight.over
        assert (play(driver).flight.recording.seed == 3) is same
        assert bool(np.abs(play(driver).flight.poses.now - began).max() < 0.3) is same


def test_a_thrust_held_through_the_end_does_not_dismiss_the_card(begin: Open):
    driver = begin()
    start_at(driver, 8, 3, 0, -4, 0, 0)
    press(driver, pygame.K_SPACE)
    driver.frames(20)
    let_go(driver, pygame.K_SPACE)
    press(driver, pygame.K_SPACE)
    driver.frames(10)
    assert play(driver).flight.over


def test_pause_by_key_and_by_looking_away_but_not_by_a_glance_keeps_the_flight(begin: Open):
    driver = begin()
    flight = play(driver).flight
    driver.post(pygame.WINDOWFOCUSLOST)
    driver.frames(3)
    driver.post(pygame.WINDOWFOCUSGAINED)
    driver.frames(30)
    assert driver.top_name == "PlayScene"
    for leave in (lambda: driver.post(pygame.WINDOWFOCUSLOST), lambda: driver.key(pygame.K_ESCAPE)):
        leave()
        driver.frames(12)
        assert "PauseScene" in driver.top_name
        before = flight.env.steps[0]
        driver.frames(10)
        assert flight.env.steps[0] == before
        driver.key(pygame.K_ESCAPE)
        assert play(driver).flight is flight
    driver.keys(pygame.K_ESCAPE, pygame.K_DOWN, pygame.K_RETURN)  # Retry
    assert play(driver).flight is not flight


def test_a_damaged_network_is_named_and_the_game_goes_on(open_game: Open, context: Context, tmp_path: Path):
    shutil.copytree(MODELS_DIR / "lander" / "modern", tmp_path / "lander" / "modern")
    for path in (tmp_path / "lander" / "modern").rglob("*weights.npy"):
        weights = np.load(path)
        weights.flat[-1] = np.nan
        np.save(path, weights)
    context.models_dir = tmp_path
    driver = open_game(PlayScene, seed=1)
    driver.key(pygame.K_TAB)
    driver.frames(30)
    assert play(driver).flight.chooser.hand is StickHolder.HUMAN
    assert "weights" in play(driver).network.problem
    assert play(driver).network.problem[:18] in driver.said  # a long one is shortened in its middle


def test_a_disk_that_is_full_at_the_end_of_a_flight_is_reported_and_harms_no_other_flight(open_game: Open, context):
    resource = pytest.importorskip("resource")
    driver = open_game(PlayScene, seed=1)
    crash(driver)
    before = files(context)
    assert len(before) == 2  # the logbook, and the flight
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, limits[1]))
    try:
        driver.key(pygame.K_r)
        crash(driver)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert "could not be kept: " in driver.said
    assert files(context) == before
    driver.key(pygame.K_r)
    crash(driver)
    assert len(Records(context.user_dir).entries()) == 2


def files(context) -> dict[str, bytes]:
    """What the player has, without locks."""
    files = (path for path in context.user_dir.rglob("*.json*") if path.suffix != ".lock")
    return {path.name: path.read_bytes() for path in files}


def crash(driver: Driver) -> None:
    start_at(driver, 8.0, 2.2, 0.0, -3.0, 0.0, 0.0)
    while play(driver).ending.card is None:
        driver.skip(1)


@pytest.mark.parametrize("hand", [StickHolder.HUMAN, StickHolder.NETWORK])
def test_the_pause_changes_the_network_in_mid_flight_and_one_that_breaks_gives_the_stick_back(
    open_game: Open, context: Context, tmp_path: Path, hand: StickHolder
):
    context.models_dir = tmp_path / "shipped"
    for name in ("a", "hurt", "modern"):
        DeepQAgent(config=Config(hidden=(4,))).save(context.user_dir / "models" / name)
    (context.user_dir / "models" / "hurt" / "online" / "config.json").write_text("{")
    driver = open_game(PlayScene, seed=4)
    assert play(driver).network.name == "modern"
    driver.keys(*[pygame.K_TAB] * (1 + (hand is StickHolder.HUMAN)))
    driver.frames(20)
    flight, before = play(driver).flight, play(driver).flight.chooser.network
    driver.keys(pygame.K_ESCAPE)
    driver.press_on(texts.PAUSE_NETWORK.format(name="modern"))
    assert driver.top_name == "NetworksScene"
    driver.keys(pygame.K_END, pygame.K_RETURN)  # the one that was saved first
    assert "PauseScene" in driver.top_name
    driver.keys(pygame.K_ESCAPE)
    assert play(driver).flight is flight
    assert flight.chooser.hand is hand
    assert flight.chooser.network is not before
    assert play(driver).network.name == context.settings.model == "a"
    driver.frames(20)
    play(driver).choose_network("hurt")
    driver.frames(5)
    assert flight.chooser.hand is StickHolder.HUMAN
    assert "No network" in driver.said


@pytest.mark.parametrize("hints", [True, False])
def test_hints_come_with_the_setting_and_go_with_it(begin: Open, written: list[str], hints: bool):
    driver = begin(ScriptedPilot())
    driver.app.context.settings.show_hints = hints
    written.clear()
    driver.frames(1)
    assert texts.MAIN_ENGINE in written  # the keys that fly are shown on the first screen in any case
    assert (texts.HINT_HAND_OVER in written) is hints
    start_at(driver, 0.0, 2.6, 0.0, -6.0, 0.0, 0.0)
    driver.frames(120)
    assert texts.OUTCOMES["CRASHED"][0] in written
    assert (texts.ADVICE["HARD"] in written) is hints


def test_the_networks_way_is_drawn_if_there_is_one(begin: Open):
    driver = begin(ScriptedPilot(), 4)
    driver.frames(200)
    assert len(play(driver).flown.path_preview.forecast.path) > 5
    assert play(begin(None, 4)).flown.path_preview.forecast is None
