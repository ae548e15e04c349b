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
from game.drawing.canvas import Canvas
from game.flight import networks
from game.flight.flight import StickHolder
from game.flight.logbook import Records
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.support.driver import Driver

Open = Callable[..., Driver]
MAIN, LEFT, RIGHT = pygame.K_UP, pygame.K_LEFT, pygame.K_RIGHT


class Steady:
    """A network that always steers left."""

    def act(self, observation: np.ndarray, *, held: np.ndarray | None = None) -> np.ndarray:
        return np.full(len(observation), 1)


@pytest.fixture
def flown_by(monkeypatch: pytest.MonkeyPatch) -> Callable[[object], None]:
    def use(policy: object) -> None:
        monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", policy))

    return use


def scene(driver: Driver) -> PlayScene:
    assert isinstance(driver.top, PlayScene)
    return driver.top


def press(driver: Driver, key: int) -> None:
    driver.post(pygame.KEYDOWN, key=key, mod=0, unicode="", scancode=0)


def let_go(driver: Driver, key: int) -> None:
    driver.post(pygame.KEYUP, key=key, mod=0, unicode="", scancode=0)


def start_at(play: PlayScene, *start: float) -> None:
    play.flown.waiting = False
    play.flight.env.place(np.ones(1, bool), np.array([start]))


def action(driver: Driver) -> int:
    return int(scene(driver).flight.env.actions[0])


@pytest.mark.parametrize(("keys", "wanted"), [((MAIN,), 3), ((LEFT,), 1), ((RIGHT, pygame.K_w), 5), ((LEFT, RIGHT), 0)])
def test_keys_fly(open_game: Open, flown_by, keys: tuple[int, ...], wanted: int):
    flown_by(None)
    driver = open_game(PlayScene, seed=1)
    driver.frames(1)
    for key in keys:
        press(driver, key)
    driver.frames(2)
    assert action(driver) == wanted
    for key in keys:
        let_go(driver, key)
    driver.frames(1)
    assert action(driver) == 0


@pytest.mark.parametrize("begin", [MAIN, LEFT, pygame.K_TAB])
def test_a_flight_waits_for_the_first_touch_even_through_a_pause(open_game: Open, flown_by, begin: int):
    flown_by(Steady())
    driver = open_game(PlayScene, seed=1)
    driver.frames(30)
    driver.keys(pygame.K_ESCAPE, pygame.K_ESCAPE)
    assert scene(driver).flight.env.steps[0] == 0
    press(driver, begin)
    driver.frames(2)
    assert scene(driver).flight.env.steps[0] > 0


def test_the_key_that_opened_the_flight_does_not_also_begin_it(open_game: Open, flown_by):
    flown_by(None)
    driver = open_game()
    driver.key(pygame.K_RETURN)  # the page of Play
    press(driver, pygame.K_SPACE)  # chooses free flight, and is held on
    driver.frames(20)
    assert scene(driver).waiting
    let_go(driver, pygame.K_SPACE)
    driver.frames(1)
    press(driver, pygame.K_SPACE)
    driver.frames(1)
    assert not scene(driver).waiting


def test_the_network_lands_what_was_handed_over_and_the_card_says_who_flew(open_game: Open, flown_by):
    flown_by(ScriptedPilot())
    driver = open_game(PlayScene, seed=12)
    driver.frames(1)
    driver.key(LEFT)
    driver.frames(20)
    driver.key(pygame.K_TAB)
    driver.skip(1400)
    play = scene(driver)
    assert play.flight.outcome is Outcome.LANDED
    assert play.ending.card is not None
    assert 0 < play.ending.card.human < 0.2


@pytest.mark.parametrize("key", [pygame.K_RETURN, pygame.K_SPACE, pygame.K_r])
def test_after_a_crash_one_key_flies_the_same_start_again(open_game: Open, flown_by, key: int):
    flown_by(None)
    driver = open_game(PlayScene, seed=3)
    began = scene(driver).flight.poses.before.copy()
    start_at(scene(driver), 8, 3, 0, -3, 0, 0)
    driver.frames(140)
    assert scene(driver).flight.outcome is Outcome.CRASHED
    driver.key(key)
    assert not scene(driver).flight.over
    assert scene(driver).flight.recording.seed == 3
    assert np.abs(scene(driver).flight.poses.now - began).max() < 0.3


def test_after_a_landing_enter_flies_a_new_start_and_r_the_same(open_game: Open, flown_by):
    flown_by(None)
    driver = open_game(PlayScene, seed=3)
    for key, same in ((pygame.K_r, True), (pygame.K_RETURN, False)):
        start_at(scene(driver), 0, PARAMS.pad_top + PARAMS.stand + 0.01, 0, 0, 0, 0)
        driver.frames(140)
        assert scene(driver).flight.outcome is Outcome.LANDED
        driver.key(key)
        assert (scene(driver).flight.recording.seed == 3) is same


def test_a_thrust_held_through_the_end_does_not_dismiss_the_card(open_game: Open, flown_by):
    flown_by(None)
    driver = open_game(PlayScene, seed=3)
    start_at(scene(driver), 8, 3, 0, -4, 0, 0)
    press(driver, pygame.K_SPACE)
    driver.frames(20)
    let_go(driver, pygame.K_SPACE)
    press(driver, pygame.K_SPACE)
    driver.frames(10)
    assert scene(driver).flight.over


def test_pause_by_key_and_by_looking_away_keeps_the_flight(open_game: Open, flown_by):
    flown_by(None)
    driver = open_game(PlayScene, seed=3)
    flight = scene(driver).flight
    for event in (pygame.WINDOWFOCUSLOST, None):
        if event is None:
            driver.key(pygame.K_ESCAPE)
        else:
            driver.post(event)
            driver.frames(12)
        assert "PauseScene" in driver.top_name
        steps = int(flight.env.steps[0])
        driver.frames(10)
        assert flight.env.steps[0] == steps
        driver.key(pygame.K_ESCAPE)
        assert scene(driver).flight is flight
    driver.key(pygame.K_ESCAPE)
    driver.keys(pygame.K_DOWN, pygame.K_RETURN)  # Retry
    assert scene(driver).flight is not flight


def test_a_glance_away_does_not_pause(open_game: Open, flown_by):
    flown_by(None)
    driver = open_game(PlayScene, seed=3)
    driver.post(pygame.WINDOWFOCUSLOST)
    driver.frames(3)
    driver.post(pygame.WINDOWFOCUSGAINED)
    driver.frames(30)
    assert driver.top_name == "PlayScene"


def cut_short(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:100])


def one_nan(path: Path) -> None:
    weights = np.load(path)
    weights.flat[-1] = np.nan
    np.save(path, weights)


@pytest.mark.skipif(not (MODELS_DIR / "lander" / "modern").exists(), reason="no trained network here")
@pytest.mark.parametrize("damage", [cut_short, one_nan])
def test_a_damaged_network_is_named_and_the_game_goes_on(
    open_game: Open, context: Context, tmp_path: Path, damage: Callable[[Path], None]
):
    shutil.copytree(MODELS_DIR / "lander" / "modern", tmp_path / "lander" / "modern")
    for path in (tmp_path / "lander" / "modern").rglob("*weights.npy"):
        damage(path)
    context.models_dir = tmp_path
    driver = open_game(PlayScene, seed=1)
    driver.key(pygame.K_TAB)
    driver.frames(30)
    assert scene(driver).flight.hand is StickHolder.HUMAN
    assert "weights" in scene(driver).network.problem
    begins = scene(driver).network.problem[:18]  # a long one is shortened in its middle
    assert begins in driver.said


def test_a_disk_that_is_full_at_the_end_of_a_flight_is_told_of_and_harms_no_other_flight(open_game: Open, context):
    resource = pytest.importorskip("resource")
    driver = open_game(PlayScene, seed=1)
    crash(driver)
    before = written(context)
    assert len(before) == 2  # the logbook, and the flight
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, limits[1]))
    try:
        driver.key(pygame.K_r)
        crash(driver)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert "could not be kept: " in driver.said
    assert written(context) == before
    driver.key(pygame.K_r)
    crash(driver)
    assert len(Records(context.user_dir).entries()) == 2


def written(context) -> dict[str, bytes]:
    """What the player has, without locks."""
    files = (path for path in context.user_dir.rglob("*.json*") if path.suffix != ".lock")
    return {path.name: path.read_bytes() for path in files}


def crash(driver: Driver) -> None:
    scene(driver).flown.waiting = False
    scene(driver).flight.env.place(np.ones(1, bool), np.array([[8.0, 2.2, 0.0, -3.0, 0.0, 0.0]]))
    while scene(driver).ending.card is None:
        driver.frames(1)


def with_networks(context: Context, tmp_path: Path, *names: str) -> None:
    context.models_dir = tmp_path / "shipped"
    for name in names:
        DeepQAgent(config=Config(hidden=(4,))).save(context.user_dir / "models" / name)


@pytest.mark.parametrize("hand", [StickHolder.HUMAN, StickHolder.NETWORK])
def test_the_pause_changes_the_network_in_mid_flight(
    open_game: Open, context: Context, tmp_path: Path, hand: StickHolder
):
    with_networks(context, tmp_path, "a", "b", "modern")
    driver = open_game(PlayScene, seed=4)
    play = scene(driver)
    assert play.network.name == "modern"
    driver.key(pygame.K_TAB)
    if hand is StickHolder.HUMAN:
        driver.key(pygame.K_TAB)
    driver.frames(20)
    flight, before = play.flight, play.flight.network
    driver.keys(pygame.K_ESCAPE, pygame.K_DOWN, pygame.K_DOWN, pygame.K_RETURN)
    assert driver.top_name == "NetworksScene"
    driver.keys(pygame.K_END, pygame.K_RETURN)  # the one that was saved first
    assert "PauseScene" in driver.top_name
    driver.keys(pygame.K_ESCAPE)
    assert scene(driver).flight is flight
    assert flight.hand is hand
    assert flight.network is not before
    assert play.network.name == context.settings.model == "a"
    driver.frames(20)


def test_a_network_that_breaks_on_the_way_gives_the_stick_back(open_game: Open, context: Context, tmp_path: Path):
    with_networks(context, tmp_path, "modern", "hurt")
    (context.user_dir / "models" / "hurt" / "online" / "config.json").write_text("{")
    driver = open_game(PlayScene, seed=4)
    driver.key(pygame.K_TAB)
    driver.frames(5)
    scene(driver).choose_network("hurt")
    driver.frames(5)
    assert scene(driver).flight.hand is StickHolder.HUMAN
    assert "No network" in driver.said


@pytest.mark.parametrize("hints", [True, False])
def test_hints_come_with_the_setting_and_go_with_it(open_game: Open, flown_by, monkeypatch, hints: bool):
    flown_by(ScriptedPilot())
    driver = open_game(PlayScene, seed=4)
    driver.app.context.settings.show_hints = hints
    written: list[str] = []
    monkeypatch.setattr(Canvas, "text", lambda self, text, *_, **__: written.append(text) or pygame.FRect())
    driver.frames(1)
    assert texts.MAIN_ENGINE in written  # the keys that fly are told on the first screen in any case
    assert (texts.HINT_HAND_OVER in written) is hints
    start_at(scene(driver), 0.0, 2.6, 0.0, -6.0, 0.0, 0.0)
    driver.frames(120)
    assert texts.OUTCOMES["CRASHED"][0] in written
    assert (texts.ADVICE["HARD"] in written) is hints


def test_the_networks_way_is_drawn_in_its_colour_if_there_is_one(open_game: Open, flown_by):
    flown_by(ScriptedPilot())
    driver = open_game(PlayScene, seed=4)
    driver.frames(200)
    assert len(scene(driver).flown.path_preview.forecast.path) > 5
    flown_by(None)
    driver = open_game(PlayScene, seed=4)
    driver.frames(2)
    assert not scene(driver).flown.path_preview.asks
