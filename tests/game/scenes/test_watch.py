from collections.abc import Callable
from pathlib import Path
from shutil import copytree

import numpy as np
import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.training.config import Config
from game.core import texts
from game.core.settings import SettingsFile
from game.flight.networks import DECISION_STEPS
from game.scenes.networks.scene import NetworksScene
from game.scenes.watch.scene import WatchScene
from game.training.library import Library
from game.ui.context import Context
from game.ui.rows import ChoiceRow
from tests.support.driver import Driver

Open = Callable[..., Driver]


def scene(driver: Driver) -> WatchScene:
    assert isinstance(driver.top, WatchScene)
    return driver.top


def steps(driver: Driver) -> int:
    return scene(driver).swarm.env.steps[0]


def test_space_stops_and_a_period_goes_one_decision(watching: Driver):
    watching.frames(5)
    watching.key(pygame.K_SPACE)
    swarm = scene(watching).swarm
    before, decided = steps(watching), swarm.decided[0]
    watching.frames(10)
    assert steps(watching) == before
    start = swarm.env.position[0].copy()
    sensed = []
    for press in range(12):
        watching.key(pygame.K_PERIOD)
        assert swarm.decided[0] == decided + press + 1
        sensed.append(scene(watching).decision.observation[0])
    assert steps(watching) <= before + 12 * DECISION_STEPS
    assert len(np.unique(sensed, axis=0)) == 12
    assert np.hypot(*(swarm.env.position[0] - start)) > 0.5  # a viewer sees that it moved
    watching.key(pygame.K_SPACE)
    watching.frames(5)
    assert steps(watching) > before + 12 * DECISION_STEPS


def test_one_step_leads_from_the_end_of_a_flight_to_the_first_decision_of_the_next(watching: Driver):
    watch = scene(watching)
    watch.playback.stopped = True
    while watch.swarm.since_end[0] == 0:
        watch.swarm.step()
    last = watch.decision
    watching.key(pygame.K_PERIOD)
    assert watch.swarm.since_end[0] == 0
    assert watch.decision.observation[0, 1] > last.observation[0, 1] + 1.0
    assert watch.swarm.env.actions[0] == watch.decision.action[0]


def test_another_number_of_landers_while_stopped_shows_what_they_will_fly(watching: Driver):
    watching.frames(30)
    watching.key(pygame.K_SPACE)
    watching.form.focus(watching.choice(texts.WATCH_MANY[1]))
    watching.key(pygame.K_RIGHT)
    watch = scene(watching)
    assert watch.playback.stopped
    assert watch.swarm.env.num_envs == 64
    assert steps(watching) == 0
    shown = watch.decision
    assert np.array_equal(shown.observation[0], watch.swarm.env.observe()[0])
    watch.swarm.step()
    assert watch.swarm.env.actions[0] == shown.action[0]


def test_slower_and_faster(watching: Driver):
    for key, times, speed in ((pygame.K_MINUS, 1, 0.25), (pygame.K_PLUS, 9, 4)):
        watching.keys(*[key] * times)
        before = steps(watching)
        watching.skip(40)
        assert steps(watching) - before == pytest.approx(40 * speed, abs=1)


def test_the_mouse_chooses_words_and_landers(watching: Driver):
    choice = watching.choice(texts.WATCH_MANY[1])
    watching.click(choice._places[1].center)
    assert scene(watching).swarm.env.num_envs == 64
    scene(watching).playback.stopped = True
    positions = scene(watching).swarm.env.position
    apart = [np.sort(np.hypot(*(positions - place).T))[1] for place in positions]
    free = [slot for slot in np.argsort(apart)[::-1] if abs(positions[slot][0]) < 9 and slot]
    watching.click(scene(watching).world.place(positions[free[0]]))
    assert scene(watching).world.shown == free[0]
    watching.keys(pygame.K_n)
    assert scene(watching).world.shown == (free[0] + 1) % 64


def test_restart_flies_new_starts(watching: Driver):
    first = scene(watching).swarm
    watching.key(pygame.K_r)
    assert scene(watching).swarm is not first
    assert np.abs(scene(watching).swarm.poses.now - first.poses.before).max() > 0.5


@pytest.fixture
def many(open_game: Open, context: Context, tmp_path: Path) -> Driver:
    """Twenty networks of the player's own, the game's, and the scripted pilot."""
    context.models_dir = tmp_path / "shipped"
    DeepQAgent(config=Config(hidden=(4,))).save(context.models_dir / "lander" / "modern")
    for number in range(20):
        copytree(context.models_dir / "lander" / "modern", context.user_dir / "models" / f"run {number:02}")
    context.settings.model = "run 03"
    SettingsFile(context.user_dir).save(context.settings)
    return open_game(WatchScene, seed=2)


def test_of_many_networks_only_the_one_that_flies_is_read(many: Driver):
    assert scene(many).flyer.network.name == "run 03"
    assert scene(many).flyer.policies.read.keys() == {"run 03"}
    many.key(pygame.K_RIGHT)
    assert scene(many).flyer.policies.read.keys() == {"run 03", "run 04"}


def who(driver: Driver) -> ChoiceRow:
    found = driver.form.find(texts.WATCH_MODEL)
    assert isinstance(found, ChoiceRow)
    return found


def flies(driver: Driver) -> str:
    return who(driver).options[who(driver).index]


def test_a_list_opens_to_choose_from_also_by_way_of_the_pause(many: Driver, context: Context):
    flown = "run 03"
    for way in ("mouse", "pause"):
        if way == "mouse":
            many.click(who(many)._places[-1].center)
        else:
            many.keys(pygame.K_ESCAPE, pygame.K_DOWN, pygame.K_DOWN, pygame.K_RETURN)
        runs = many.top
        assert isinstance(runs, NetworksScene)
        assert runs.chosen is not None
        assert runs.chosen.name == flown
        flown = next(run.name for run in runs.items if run.name != flown)
        many.keys(pygame.K_HOME, *[pygame.K_DOWN] * [run.name for run in runs.items].index(flown), pygame.K_RETURN)
        if way == "pause":
            many.key(pygame.K_ESCAPE)
        assert scene(many).flyer.network.name == context.settings.model == flies(many) == flown


def test_what_was_renamed_or_deleted_meanwhile_is_noted(many: Driver, context: Context):
    library = Library(context.user_dir)
    many.key(pygame.K_ESCAPE)
    library.delete("run 03")
    library.rename("run 04", "better")
    many.key(pygame.K_ESCAPE)
    watch = scene(many)
    assert "better" in who(many).options
    assert "run 03" not in who(many).options
    assert watch.flyer.network.name == flies(many)
    many.frames(5)


def test_a_missing_network_is_listed_with_what_is_wrong_and_another_flies(watching: Driver):
    watching.frames(2)
    watch = scene(watching)
    assert "missing" in watch.flyer.problem
    assert watch.flyer.network.name == "scripted"
    watching.key(pygame.K_RIGHT)
    assert not watch.flyer.problem
    watching.frames(60)
    assert watching.top is watch


def test_motion_reduced_in_a_pause_brings_the_camera_to_rest(watching: Driver):
    watch = scene(watching)
    before = watch.world.camera.shot
    watching.key(pygame.K_ESCAPE)
    watching.app.context.settings.reduced_motion = True
    watching.key(pygame.K_ESCAPE)
    assert scene(watching) is watch
    watching.frames(5)
    rests = watch.world.camera.shot
    assert rests != before
    watching.frames(60)
    assert watch.world.camera.shot == rests
