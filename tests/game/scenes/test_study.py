"""The study scene: trials, curves and knobs of a study that was made by the command, without its extra."""

import shutil
import subprocess
import sys
from pathlib import Path

import pygame
import pytest

from ai.sweep.study import Study
from game.core import texts
from game.flight import networks
from game.scenes.train.networks import NetworksScene
from game.scenes.train.study import StudyScene
from game.training.run_settings import label
from tests.support.screens import study as made
from tests.support.studies import shown_study

ROOT = Path(__file__).parents[3]


def test_trials_stand_by_their_results_and_the_chosen_one_is_described(open_game, written):
    driver = open_game(made)
    driver.frames(5)
    assert [trial.number for trial in driver.top.items] == [*range(9)]
    driver.keys(pygame.K_DOWN, pygame.K_DOWN)
    written.clear()
    driver.frames(20)
    assert driver.top.chosen.number == 2
    assert "Trial 2 · 120" in written
    assert any(f"{label('learning_rate')} 71 %" in line for line in written)


def test_a_trial_is_watched_and_the_players_own_network_stays_theirs(open_game, context):
    driver = open_game(made)
    driver.frames(3)
    mine = context.settings.model
    driver.keys(pygame.K_RETURN)
    driver.frames(5)
    assert driver.top_name == "WatchScene"
    assert driver.top.network.name == "mine 0"
    assert driver.top.network.policy is not None
    assert context.settings.model == mine
    driver.keys(pygame.K_ESCAPE)


def test_a_trial_is_raced(open_game):
    driver = open_game(made)
    driver.frames(3)
    driver.press_on(texts.STUDY_RACE)
    driver.frames(5)
    assert driver.top_name == "PlayScene"
    assert "mine 0" in driver.top.challenge.line


def test_a_trial_that_was_stopped_early_offers_nothing_to_fly(open_game, written):
    driver = open_game(made)
    driver.frames(3)
    driver.keys(pygame.K_END)
    written.clear()
    driver.frames(3)
    assert driver.top.chosen.stopped
    assert texts.STUDY_STOPPED in written
    assert texts.STUDY_WATCH not in written
    driver.keys(pygame.K_RETURN)
    assert driver.top_name == "StudyScene"


def test_a_study_that_cannot_be_read_says_so_and_without_any_what_makes_one(open_game, context, written):
    open_game(StudyScene).frames(3)
    assert texts.STUDY_NONE in written
    made(context)
    driver = open_game(StudyScene, context.user_dir / "studies" / "b")
    driver.frames(3)
    assert texts.STUDY_UNREADABLE in written
    assert driver.top.items == []


def test_the_best_run_of_a_study_is_among_the_players_networks(open_game, context):
    name = texts.STUDY_BEST.format(study="mine")
    study = shown_study(context.user_dir / "studies" / "mine")
    found = networks.folders(context.models_dir, context.user_dir)
    assert found[name] == study.run_folder(study.best(), 0)
    assert networks.load(name, found[name]).policy is not None
    driver = open_game(NetworksScene)
    driver.frames(3)
    run = next(run for run in driver.top.items if run.name == name)
    assert run.flyable
    assert not run.resumable, "what a study found stays as it is"
    driver.press_on(texts.STUDY_OPEN)
    driver.frames(3)
    assert driver.top_name == "StudyScene"


@pytest.mark.parametrize("damage", ["gone", "elsewhere", "nonsense"])
def test_a_study_file_that_is_wrong_offers_no_network(context, damage):
    study = shown_study(context.user_dir / "studies" / "mine")
    file = study.folder / "study.json"
    if damage == "gone":
        shutil.rmtree(study.trial_folder(0))
    elif damage == "elsewhere":
        file.write_text(file.read_text().replace("trials/0000/seed-0", "../../../other/seed-0"))
    else:
        file.write_text("{")
    assert texts.STUDY_BEST.format(study="mine") not in networks.folders(context.models_dir, context.user_dir)


def test_a_study_is_read_without_ray_or_optuna(tmp_path):
    folder = tmp_path / "mine"
    shown_study(folder)
    program = (
        "import sys; sys.modules['ray'] = sys.modules['optuna'] = None\n"
        "from pathlib import Path\n"
        "from ai.sweep.study import Study; from ai.sweep.report import page, table\n"
        f"study = Study.load(Path({str(folder)!r})); assert 'Trial' not in table(study); assert '<svg' in page(study)\n"
    )
    subprocess.run([sys.executable, "-c", program], cwd=ROOT, check=True)
    assert Study.load(folder).best().number == 0
