import importlib.util
from pathlib import Path

import pygame
import pytest

from ai.pilots import ScriptedPilot
from game import export
from game.context import Context
from game.flight import Flight
from game.records import Records
from game.scenes import replay as module
from game.scenes.replay import Replay


@pytest.fixture
def scene(context: Context) -> Replay:
    flight = Flight(3, ScriptedPilot())
    flight.hand_over()
    while not flight.over:
        flight.step(0)
    records = Records(context.user_dir)
    return Replay(records.read(records.keep(flight, 1_700_000_000.0).file))


def test_without_pillow_a_message_says_what_to_install(open_game, scene: Replay, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(export, "missing", lambda: True)
    driver = open_game(scene)
    driver.frames(2)
    scene._export()
    assert "tranquility[export]" in driver.app._notes._text
    assert driver.frames(2)


def test_missing_is_whether_it_can_be_imported():
    assert export.missing() is (importlib.util.find_spec("PIL") is None)


def test_a_replay_is_saved_as_a_moving_picture(open_game, scene: Replay, monkeypatch, tmp_path: Path):
    image = pytest.importorskip("PIL.Image")
    monkeypatch.setattr(module, "exports_dir", lambda: tmp_path / "pictures")
    monkeypatch.setattr(export, "EVERY", 60)
    driver = open_game(scene)
    driver.frames(2)
    scene.tape.scout(10_000)
    scene._export()
    at = scene.tape.at
    driver.frames(60)
    assert scene.tape.at > at  # it goes on playing meanwhile
    (path,) = (tmp_path / "pictures").iterdir()
    with image.open(path) as picture:
        assert picture.size == export.SIZE
        assert picture.n_frames > 5


def test_a_full_disk_is_told_of_and_nothing_is_left(open_game, scene: Replay, monkeypatch, tmp_path: Path):
    pytest.importorskip("PIL")
    (tmp_path / "pictures").write_text("in the way")
    monkeypatch.setattr(module, "exports_dir", lambda: tmp_path / "pictures")
    monkeypatch.setattr(export, "EVERY", 200)
    driver = open_game(scene)
    driver.frames(2)
    scene.tape.scout(10_000)
    scene._export()
    driver.frames(20)
    assert "could not be saved" in driver.app._notes._text
    assert pygame.display.get_init()
