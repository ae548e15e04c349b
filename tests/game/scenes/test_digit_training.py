"""Train it here: the screen, through real pygame events; with a real worker beside it where its process matters."""

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest

from ai.digits import training
from ai.digits.classifier import DigitClassifier
from ai.digits.config import DIGIT_PRESETS
from ai.digits.mnist import TRAIN, load_part
from ai.digits.validation import Confusion
from ai.files.folder import STATE_FILE
from game.core import texts
from game.core.scene import Scene
from game.core.worker import WorkerState
from game.scenes.train.digits import digit_training
from game.training.library import DigitModels
from game.training.run import TrainingRun
from game.training.run_kind import DIGITS
from game.ui.context import Context
from tests.support import inline_worker
from tests.support.driver import Driver
from tests.support.small import DIGITS as SMALL


@pytest.fixture(autouse=True)
def few_images(monkeypatch: pytest.MonkeyPatch) -> None:
    """Learn from the first images alone: all of them are copied for a second."""
    monkeypatch.setattr(training, "load_part", lambda _: few())


@cache
def few() -> tuple[np.ndarray, np.ndarray]:
    images, labels = load_part(TRAIN)
    return images[:6_000].copy(), labels[:6_000]


@pytest.fixture
def small_run() -> tuple[Callable[[Context], Scene], object]:
    return digit_training, SMALL


def confusion() -> Confusion:
    """4 is read as 9 twice, and 7 as 1 once."""
    table = np.diag(np.full(10, 50))
    table[4, 9], table[7, 1] = 2, 1
    cells = np.array([(4, 9), (4, 9), (7, 1)])
    return Confusion(table, cells, np.full((3, 28, 28), 99, np.uint8))


# A run


def test_start_pause_stop_and_go_on(train: Driver, tmp_path: Path):
    scene = train.top
    train.key(pygame.K_RETURN)
    train.wait(lambda: scene.run.confusion and len(scene.run.history))
    assert scene.run.config == SMALL
    assert scene.run.confusion.table.sum() == 2_000
    assert scene.view.matrix.confusion is scene.run.confusion
    train.key(pygame.K_RETURN)
    train.wait(lambda: scene.run.state is WorkerState.PAUSED)
    train.frames(5)
    train.click(train.widget(texts.DIGIT_RUN_STOP).box.center)
    train.wait(lambda: not scene.run.alive)
    assert scene.run.state is WorkerState.ENDED
    assert not scene.run.problem
    assert 0 < scene.run.test < 1, "what was stopped is measured"
    assert DigitClassifier.load(tmp_path / "user" / "digits" / "runs" / ".training").predict(np.zeros((1, 28, 28))).size
    train.wait(lambda: texts.TRAIN_GO_ON in [each.label for each in scene.form.widgets])
    stood = scene.run.history["step"][-1]
    scene.knobs.ask(DIGIT_PRESETS["modern"])
    train.click(train.widget(texts.TRAIN_GO_ON).box.center)
    train.wait(lambda: len(scene.run.history) and scene.run.history["step"][-1] > stood)
    assert scene.knobs.asked == SMALL, "it goes on with its own settings"
    assert scene.run.earlier
    scene.run.close()


def test_a_run_is_named(train: Driver, tmp_path: Path, monkeypatch):
    notes: list[str] = []
    monkeypatch.setattr(train.top.context, "note", notes.append)
    scene = train.top
    train.press_on(texts.TRAIN_SAVE)
    assert notes == [texts.TRAIN_NOTHING]
    scene.form.focus(scene.start_button)
    train.key(pygame.K_RETURN)
    train.wait(lambda: len(scene.run.history))
    train.click(train.widget(texts.TRAIN_SAVE).box.center)
    assert train.top_name == "NameDialog"
    train.key(pygame.K_RETURN)
    assert train.top is scene
    kept = tmp_path / "user" / "digits" / "runs" / texts.TRAIN_NAME.format(preset="Classic")
    train.wait(lambda: (kept / "config.json").exists() and len(notes) == 2)
    assert kept.name in notes[-1]
    train.click(train.widget(texts.DIGIT_RUN_STOP).box.center)
    train.wait(lambda: not scene.run.alive and scene.run.kept)


def test_leaving_ends_the_process_and_keeps_the_run(train: Driver):
    scene = train.top
    train.key(pygame.K_RETURN)
    train.wait(lambda: len(scene.run.history))
    notes: list[str] = []
    train.app.context.note = notes.append
    assert not train.key(pygame.K_ESCAPE)
    train.app.scenes.close()
    assert scene.run.state is WorkerState.ENDED
    assert scene.run.unfinished
    assert notes == [texts.TRAIN_KEPT]


# What is kept


def test_looking_for_an_unfinished_run_leaves_alone_what_is_being_written(tmp_path: Path, monkeypatch):
    inline_worker.install(monkeypatch.setattr)
    digit_run: Any = TrainingRun(DIGITS, DigitModels(tmp_path))
    digit_run.begin(SMALL, 0)
    unsaved = digit_run.collection.unsaved
    half = unsaved.with_name(f".{unsaved.name}.00000000.old")  # between the two renames of a save
    half.mkdir(parents=True)
    for name in ("training.json", STATE_FILE):
        (half / name).write_bytes(b"")
    assert not digit_run.unfinished
    assert half.exists()
    digit_run.close()
    assert digit_run.unfinished
    assert not half.exists()


@pytest.mark.slow
def test_a_run_is_named_although_the_next_one_was_asked_for_at_once(beside: Driver, tmp_path: Path):
    digit_run, runs = beside.top.run, tmp_path / "user" / "digits" / "runs"
    beside.key(pygame.K_RETURN)
    beside.wait(lambda: len(digit_run.history))
    assert digit_run.save("first") == ""
    digit_run.begin(SMALL, 4)
    assert digit_run.waiting
    assert digit_run.save("second") == texts.TRAIN_NOTHING
    beside.wait(lambda: len(digit_run.history))
    assert json.loads((runs / "first" / "training.json").read_text())["seed"] == 3
    assert digit_run.seed == 4


# The matrix


def test_nothing_stands_for_what_is_misread_until_something_was_read(train: Driver):
    scene = train.top
    assert scene.view.matrix not in scene.form.widgets
    scene.run.confusion = confusion()
    train.frames(3)
    assert scene.view.matrix in scene.form.widgets
    train.write_in("largest")
    train.frames(3)
    assert scene.view.matrix not in scene.form.widgets, "its digits would lie on each other"


def test_the_worst_cell_is_shown_until_another_is_chosen(train: Driver):
    scene = train.top
    scene.run.confusion = confusion()
    train.frames(2)
    assert scene.view.matrix.cell == (4, 9)
    box, pitch = scene.view.matrix.box, scene.view.matrix.pitch
    train.move((box.left + 1.5 * pitch, box.top + 7.5 * pitch))
    assert scene.view.matrix.cell == (7, 1)
    scene.run.confusion = confusion()
    train.frames(2)
    assert scene.view.matrix.cell == (7, 1)
    train.resize((960, 540))
    train.key(pygame.K_UP)
    train.key(pygame.K_LEFT)
    assert scene.view.matrix.cell == (6, 0)
    train.button(pygame.CONTROLLER_BUTTON_DPAD_DOWN)
    assert scene.view.matrix.cell == (7, 0)
    assert scene.form.focused is scene.view.matrix
    train.keys(*[pygame.K_RIGHT] * 10)
    assert scene.form.focused is not scene.view.matrix, "beyond the edge the focus goes on"
