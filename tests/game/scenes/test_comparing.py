"""Runs beside the current one in Train: their names, by keys, gamepad and mouse."""

from collections.abc import Callable
from dataclasses import replace

import pygame
import pytest

from ai.training.history import History
from game.core import texts
from game.scenes.menus.dialogs import NameDialog, QuestionDialog
from game.scenes.train.scene import TrainScene
from game.training.beside import put_beside
from game.ui.rows import EntryRow, RunRow
from tests.ai.training.test_hints import HEALTHY
from tests.support.driver import Driver


@pytest.fixture
def train(open_game: Callable[..., Driver]) -> Driver:
    driver = open_game(TrainScene)
    driver.frames(2)
    for name in ("one", "two", "three", "four", "five"):
        run = History()
        for second in range(20):
            run.append(replace(HEALTHY, seconds=second, decisions=100 * second))
        put_beside(driver.top.lander_run.earlier, name, run)
    driver.frames(30)
    return driver


def names(driver: Driver) -> list[str]:
    return [each.name for each in driver.top.lander_run.earlier]


@pytest.mark.parametrize("device", ["keys", "pad"])
def test_a_run_is_renamed_and_taken_away_without_a_mouse(train: Driver, device: str) -> None:
    def press(key: int, button: int) -> None:
        train.key(key) if device == "keys" else train.button(button)

    def confirm() -> None:
        press(pygame.K_RETURN, pygame.CONTROLLER_BUTTON_A)

    scene, chosen = train.top, "three"
    assert len(scene.training_charts.charts.charts[0].runs) == 5
    train.form.focus(train.widget(chosen))
    confirm()
    assert isinstance(train.top, QuestionDialog)
    confirm()
    train.frames(2)
    assert isinstance(train.top, NameDialog)
    train.the(EntryRow).text = "five"
    train.key(pygame.K_RETURN)
    assert isinstance(train.top, NameDialog), "another has that name"
    train.the(EntryRow).text = "renamed"
    train.key(pygame.K_RETURN)
    train.frames(2)
    assert train.top is scene
    assert "renamed" in names(train)
    assert chosen not in names(train)
    train.form.focus(train.widget("renamed"))
    confirm()
    press(pygame.K_RIGHT, pygame.CONTROLLER_BUTTON_DPAD_RIGHT)
    confirm()
    assert train.top is scene
    assert len(names(train)) == 4
    assert "renamed" not in names(train)
    train.frames(30)
    assert len(scene.training_charts.charts.charts[0].runs) == 4


def test_the_mouse_over_a_name_emphasises_its_line_and_a_click_asks(train: Driver) -> None:
    def colours() -> dict[str, object]:
        train.frames(30)
        return {run.series.name: run.series.colour for run in train.top.training_charts.charts.charts[0].runs}

    row = next(each for each in train.form.widgets if isinstance(each, RunRow) and each.label == "two")
    plain = colours()
    train.move(row.box.center)
    lit = colours()
    assert lit["two"] == plain["two"]
    assert all(lit[name] != plain[name] for name in ("one", "three", "four", "five"))
    train.click(row.box.center)
    assert isinstance(train.top, QuestionDialog)
    train.click(train.widget(texts.COMPARE_REMOVE).box.center)
    assert len(names(train)) == 4
