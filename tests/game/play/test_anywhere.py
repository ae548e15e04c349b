"""Where it is not as on the moon, the network that lands anywhere flies by itself: mission, ghost, co-pilot."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.lander.environment import Outcome
from ai.lander.missions import FIRST, MISSIONS
from game.core import texts
from game.core.assets import MODELS_DIR
from game.flight import networks
from game.flight.flight import Flight, StickHolder
from game.scenes.play.challenge import FlownMission
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import play

Open = Callable[..., Driver]
ELSEWHERE = [name for name, mission in MISSIONS.items() if mission.elsewhere]


@pytest.fixture(scope="module")
def anywhere() -> networks.Policy:
    """The network that lands anywhere, as the game reads it."""
    found = networks.chosen(MODELS_DIR, Path("nowhere"), "", True)
    assert (found.name, found.problem, found.stands_in) == (networks.ANYWHERE, "", "")
    assert found.policy is not None
    return found.policy


@pytest.fixture
def copied(context: Context, tmp_path: Path) -> Path:
    """The networks of a game, to be damaged; its folder of landers."""
    shutil.copytree(MODELS_DIR, tmp_path / "models")
    context.models_dir = tmp_path / "models"
    return tmp_path / "models" / "lander"


def test_elsewhere_is_where_anything_but_the_start_differs_from_the_moon():
    assert ELSEWHERE[:7] == ["wind", "tank", "narrow", "mars", "earth", "ferry", "outage"]
    assert not FIRST.elsewhere


def test_it_takes_the_place_of_a_shipped_network_and_not_of_ones_own(tmp_path: Path):
    shutil.copytree(MODELS_DIR / "lander" / "modern", tmp_path / "models" / "mine")
    for name, flies in (("", "anywhere"), ("modern", "anywhere"), ("gone", "anywhere"), ("mine", "mine")):
        assert networks.chosen(MODELS_DIR, tmp_path, name, True).name == flies
    assert networks.chosen(MODELS_DIR, tmp_path).name == "modern"
    assert networks.ANYWHERE not in networks.folders(MODELS_DIR, tmp_path)
    assert networks.ANYWHERE not in networks.Policies(MODELS_DIR, tmp_path).names


@pytest.mark.parametrize("name", ELSEWHERE)
def test_handed_the_stick_it_lands_every_mission(name: str, anywhere: networks.Policy):
    flight = Flight(0, anywhere, mission=name)
    assert flight.hand_over()
    while not flight.over:
        flight.step(0)
    assert flight.outcome is Outcome.LANDED
    assert set(flight.recording.hands) == {StickHolder.NETWORK}


def test_on_a_mission_elsewhere_it_is_named_and_flies_the_ghost(open_game: Open, written: list[str]):
    driver = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["earth"]))
    driver.frames(2)
    driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0, unicode="", scancode=0)
    driver.frames(9)
    driver.key(pygame.K_ESCAPE)
    driver.frames(2)
    assert texts.NETWORK_EVERYWHERE in " ".join(written)
    assert "anywhere network" not in " ".join(written)
    driver.keys(pygame.K_ESCAPE, pygame.K_r)
    ghost = play(driver).flown.ghost
    while not ghost.flight.over:
        ghost.step()
    assert ghost.flight.outcome is Outcome.LANDED
    driver.key(pygame.K_TAB)
    while not play(driver).flight.over:
        driver.skip()
    assert play(driver).flight.outcome is Outcome.LANDED


def test_under_another_gravity_it_flies_and_back_on_the_moon_it_does_not(open_game: Open):
    driver = open_game(PlayScene, 3)
    assert play(driver).network.name == "modern"
    for gravity, name in ((2.0, networks.ANYWHERE), (1.0, "modern")):
        driver.app.context.settings.gravity = gravity
        driver.key(pygame.K_ESCAPE)
        driver.key(pygame.K_ESCAPE)
        assert play(driver).network.name == name
        assert play(driver).flight.network is play(driver).network.policy
        driver.frames(30)


@pytest.mark.parametrize("damage", ["missing", "torn", "another"])
def test_where_it_cannot_be_read_the_usual_network_flies_and_that_is_said(
    open_game: Open, context: Context, copied: Path, damage: str
):
    folder = copied / networks.ANYWHERE
    if damage == "torn":
        (folder / "config.json").write_text("{")
    else:
        shutil.rmtree(folder)
    if damage == "another":
        shutil.copytree(copied / "modern", folder)
    driver = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["earth"]))
    driver.frames(1)
    assert play(driver).network.name == "modern"
    assert isinstance(play(driver).network.policy, DeepQAgent)
    assert driver.said.startswith("modern flies here")
    driver.key(pygame.K_TAB)
    assert play(driver).flight.hand is StickHolder.NETWORK
    driver.frames(10)
