"""Runs beside the current one in Train are taken away, by keys, gamepad and mouse."""

from collections.abc import Callable
from dataclasses import replace

import pygame
import pytest

from ai.training.history import History
from game.scenes.train.scene import TrainScene
from game.training.record import put_beside
from game.ui.rows import RunRow
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
        put_beside(driver.top.run.earlier, name, run)
    driver.frames(30)
    return driver


@pytest.mark.parametrize("device", ["keys", "pad", "mouse"])
def test_a_run_is_taken_away(train: Driver, device: str) -> None:
    def shown() -> set[str]:
        train.frames(30)
        return {run.name for run in train.top.charts.charts[0].runs}

    row = next(each for each in train.form.widgets if isinstance(each, RunRow) and each.label == "two")
    assert len(shown()) == 5
    train.move(row.box.center) if device == "mouse" else train.form.focus(row)
    if device == "mouse":
        train.click(row.box.center)
    else:
        train.key(pygame.K_RETURN) if device == "keys" else train.button(pygame.CONTROLLER_BUTTON_A)
    assert shown() == {"one", "three", "four", "five"}
    assert [each.name for each in train.top.run.earlier] == ["five", "four", "three", "one"]
