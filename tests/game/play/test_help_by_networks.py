"""Networks beside the player: why help did not save a flight, when it stepped in, and which one flies elsewhere."""

import shutil
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.lander.environment import Outcome
from ai.lander.missions import MISSIONS
from ai.lander.push import KEYS
from game.core import texts
from game.core.assets import MODELS_DIR
from game.flight import networks
from game.flight.flight import StickHolder
from game.flight.foresight import HELD, SixFutures
from game.scenes.play import interventions
from game.scenes.play.challenge import FlownMission
from game.scenes.play.interventions import Interventions
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import begun, fly_out, play

Open = Callable[..., Driver]


@pytest.fixture(scope="module")
def agent() -> DeepQAgent:
    return DeepQAgent.load(MODELS_DIR / "lander" / "modern")


def test_six_futures_end_where_the_flight_ends_after_that_action(agent: DeepQAgent):
    flight = begun(4, agent)
    futures = SixFutures(agent)
    before = flight.env.snapshot()
    while not futures.paths:
        futures.follow(flight.env, 10)
    assert all(lands is not None for lands in futures.lands)
    for action, (path, lands) in enumerate(zip(futures.paths, futures.lands, strict=True)):
        flown = begun(4, agent)
        for _ in range(round(60 * HELD / 4) * 4):
            flown.step(KEYS[action])
        flown.chooser.hand_over()
        while not flown.over:
            flown.step()
        assert (flown.outcome is Outcome.LANDED) is lands
        assert path[-1] == pytest.approx(flown.env.position[0], abs=0.6)
    assert (flight.env.snapshot()["bodies"]["pose"] == before["bodies"]["pose"]).all()


def test_help_of_free_flights_does_not_follow_into_a_mission_which_says_so_and_can_be_given_it(
    open_game, context, written: list[str]
):
    context.settings.help = "guide"
    context.settings_file.save(context.settings)
    driver = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["brake"]))
    driver.frames(2)
    assert not play(driver).flight.chooser.shared
    assert "− +" in written
    driver.key(pygame.K_PLUS)
    driver.frames(2)
    assert play(driver).flight.chooser.shared
    assert driver.app.context.settings.help == "guide"
    driver.key(pygame.K_r)
    assert play(driver).flight.chooser.shared  # for this mission it stays


# How often a co-pilot stepped in, whether a guardian watched over all of a flight, and what is said of it.


def follow(shown: Interventions, assist: float | None, *, changed: bool = False) -> None:
    """Follow a step under a guardian with that assist, or under none."""
    guarded, decision = assist is not None, SimpleNamespace(assist=assist)
    flight = SimpleNamespace(
        choice=SimpleNamespace(together=decision, guarded=guarded, overridden=changed),
        chooser=SimpleNamespace(shared=guarded, guard=None),
        env=SimpleNamespace(position=np.zeros((1, 2))),
    )  # fmt: skip
    shown.follow(flight)


@pytest.fixture
def wordless(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(interventions, "changed_by", lambda _: "changed")


@pytest.mark.usefixtures("wordless")
def test_changes_within_a_second_of_each_other_are_one_intervention():
    shown = Interventions()
    for changed in [False] * 90 + [True] * 4 + [False] * 90 + [True] * 4 + [False] * 20 + [True] * 4:
        follow(shown, 0.4, changed=changed)
    assert len(shown.moments) == 2


@pytest.mark.usefixtures("wordless")
def test_a_guardian_counts_only_if_it_watched_over_the_whole_flight_alike():
    for assists, throughout in (
        ([0.4, 0.4, 0.4], 0.4),
        ([0.4, 0.5, 0.5], 0.0),
        ([None, 0.4], 0.0),
        ([0.4, None, 0.4], 0.0),
    ):
        shown = Interventions()
        for assist in assists:
            follow(shown, assist)
        assert shown.throughout == throughout, assists


# Where it is not as on the moon, the network that lands anywhere flies by itself: mission, ghost, co-pilot.

ELSEWHERE = [name for name, mission in MISSIONS.items() if mission.elsewhere]


@pytest.fixture(scope="module")
def anywhere() -> networks.Policy:
    """The network that lands anywhere, as the game reads it."""
    found = networks.chosen(MODELS_DIR, Path("nowhere"), "", True)
    assert (found.name, found.problem) == (networks.ANYWHERE, "")
    assert found.policy is not None
    return found.policy


@pytest.fixture
def copied(context: Context, tmp_path: Path) -> Path:
    """The networks of a game, to be damaged; its folder of landers."""
    shutil.copytree(MODELS_DIR, tmp_path / "models")
    context.models_dir = tmp_path / "models"
    return tmp_path / "models" / "lander"


def test_it_takes_the_place_of_a_shipped_network_and_not_of_ones_own(tmp_path: Path):
    shutil.copytree(MODELS_DIR / "lander" / "modern", tmp_path / "models" / "mine")
    for name, flies in (("", "anywhere"), ("modern", "anywhere"), ("gone", "anywhere"), ("mine", "mine")):
        assert networks.chosen(MODELS_DIR, tmp_path, name, True).name == flies
    assert networks.chosen(MODELS_DIR, tmp_path).name == "modern"
    assert networks.ANYWHERE not in networks.folders(MODELS_DIR, tmp_path)
    assert networks.ANYWHERE not in networks.Policies(MODELS_DIR, tmp_path).names


@pytest.mark.slow
def test_handed_the_stick_it_lands_every_mission(anywhere: networks.Policy):
    for name in ELSEWHERE:
        flight = begun(0, anywhere, mission=name)
        assert flight.chooser.hand_over()
        assert fly_out(flight).outcome is Outcome.LANDED, name
        assert set(flight.recording.hands) == {StickHolder.NETWORK}


def test_on_a_mission_elsewhere_it_is_named_and_flies_the_ghost(open_game: Open, written: list[str]):
    driver = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["earth"]))
    driver.frames(2)
    driver.key(pygame.K_UP)
    driver.key(pygame.K_ESCAPE)
    driver.frames(2)
    assert texts.NETWORK_EVERYWHERE in " ".join(written)
    assert "anywhere network" not in " ".join(written)
    driver.keys(pygame.K_ESCAPE, pygame.K_r, pygame.K_TAB)
    driver.frames(2)
    for flight in (play(driver).flight, play(driver).flown.ghost.flight):
        assert fly_out(flight).outcome is Outcome.LANDED


@pytest.mark.parametrize("damage", ["missing", "another"])
def test_where_it_cannot_be_read_the_usual_network_flies_and_the_player_is_told(
    open_game: Open, context: Context, copied: Path, damage: str
):
    folder = copied / networks.ANYWHERE
    shutil.rmtree(folder)
    if damage == "another":
        shutil.copytree(copied / "modern", folder)
    driver = open_game(PlayScene, 0, challenge=FlownMission(MISSIONS["earth"]))
    driver.frames(1)
    assert driver.said.startswith("The network for every world cannot fly: ")
    assert play(driver).network.name == "modern"
    assert isinstance(play(driver).network.policy, DeepQAgent)
    driver.key(pygame.K_TAB)
    assert play(driver).flight.chooser.hand is StickHolder.NETWORK
    driver.frames(10)
