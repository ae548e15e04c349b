"""Moving pictures: what they show, how they are written, and what becomes of them on a bad day."""

import multiprocessing
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pygame
import pytest
from PIL import Image

from game.core import texts
from game.export import film as film_module
from game.export.film import film, frames
from game.export.gif import GifWriter
from game.flight.flight_file import Record
from game.scenes.logbook import replay as module
from game.scenes.logbook.replay import ReplayScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import begun, fly_out, kept


@pytest.fixture
def record(context: Context) -> Record:
    return kept(context, fly_out(begun(5)))


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(film_module, "SIZE", (160, 90))
    monkeypatch.setattr(film_module, "EVERY", 60)


def test_the_frames_show_the_flight_and_a_still_camera_shows_little_else(record: Record, small: None):
    length = len(record.recording.pushes)
    before, after, end = frames(ReplayScene, record, [0, 20, length])
    assert before.shape == after.shape == (90, 160, 3)
    changed = (before != after).any(axis=2)
    assert 0 < changed.mean() < 0.1
    assert (after != end).any()


def test_a_film_is_written_whole_and_reported(record: Record, small: None, tmp_path: Path):
    path = tmp_path / "new folder" / "flight.gif"
    shares = [drawn.share for (drawn,) in film(ReplayScene, record, path)]
    assert shares == sorted(shares)
    assert shares[0] == 0
    assert shares[-1] < 1
    assert [each.name for each in path.parent.iterdir()] == [path.name]
    assert path.stat().st_size > 1000
    turns = film(ReplayScene, record, tmp_path / "pictures" / "flight.gif")
    next(turns)
    turns.close()  # one that is stopped leaves nothing
    assert not list((tmp_path / "pictures").iterdir())


def test_a_gif_shows_what_was_put_in(tmp_path: Path):
    ramp = np.linspace(0, 60, 160).astype(np.uint8)  # a dark sky, in which every step of a palette would be seen
    first = np.zeros((90, 160, 3), np.uint8) + ramp[:, None]
    second, third = first.copy(), first.copy()
    second[20:30, 40:50] = (250, 200, 90)  # a flame: a hundredth of the picture
    third[60:64, 100:120] = (40, 220, 120)
    with GifWriter(tmp_path / "a.gif", (160, 90), [first, second, third], 0.05) as gif:
        for frame in (first, second, second, third):
            gif.add(frame)
    with Image.open(tmp_path / "a.gif") as picture:
        assert picture.n_frames == 4  # type: ignore[attr-defined]
        for number, frame in enumerate((first, second, second, third)):
            picture.seek(number)
            assert picture.info["duration"] == 50
            seen = np.asarray(picture.convert("RGB"), int)
            assert np.abs(seen - frame).max() < 16
            assert abs((seen - frame).mean()) < 0.5  # the dither mixes what the palette lacks


def test_what_does_not_change_takes_no_room_in_a_gif(tmp_path: Path):
    """Not even between two corners that do change."""
    for changed, most in ((0, 400), (255, 10_000)):  # bytes; a frame of noise takes 14,000
        frames = [np.random.default_rng(1).integers(0, 255, (90, 160, 3), np.uint8) for _ in range(2)]
        frames[1][[0, -1], [0, -1]] ^= np.uint8(changed)
        sizes = []
        for count in (1, 11):
            path = tmp_path / f"{count}.gif"
            with GifWriter(path, (160, 90), frames[:1], 0.05) as gif:
                for number in range(count):
                    gif.add(frames[number % 2])
            sizes.append(path.stat().st_size)
        assert sizes[1] - sizes[0] < most


def test_a_full_disk_is_an_error_and_leaves_what_was_there(record: Record, small: None, tmp_path: Path):
    resource = pytest.importorskip("resource")
    path = tmp_path / "flight.gif"
    path.write_bytes(b"the one before")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (900, limits[1]))
    try:
        with pytest.raises(OSError):  # noqa: PT011 - each system and library has words of its own
            for _ in film(ReplayScene, record, path):
                pass
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert path.read_bytes() == b"the one before"
    assert [each.name for each in tmp_path.iterdir() if each.is_file()] == [path.name]


# In the game


@pytest.fixture
def replay(open_game: Callable[..., Driver], record: Record, monkeypatch, tmp_path: Path) -> tuple[Driver, ReplayScene]:
    monkeypatch.setattr(module, "films_dir", lambda: tmp_path / "pictures")
    driver = open_game(ReplayScene, record)
    driver.frames(2)
    driver.press_on(texts.MORE[0])
    driver.frames(2)
    return driver, driver.top


def test_a_name_that_no_system_takes_is_made_one_and_no_picture_takes_the_place_of_another(
    replay: tuple[Driver, ReplayScene], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, subtests: pytest.Subtests
):
    driver, scene = replay
    monkeypatch.setattr(module, "Export", Endless)
    folder, record = tmp_path / "pictures", scene.record
    folder.mkdir()
    for taken in ("Replay", "Replay 2", "a flight", "a flight 2"):
        (folder / f"{taken}.gif").write_text("another flight")
    for file in ("a\0b.json", "\ud800.json", "...json", "x" * 250 + ".json", "C:\\con.json", "", "a flight.json"):
        with subtests.test(file=file):
            scene.record = replace(record, entry=replace(record.entry, file=file))
            driver.press_on(texts.REPLAY_EXPORT)
            path = driver.app.context.film.path
            assert path.parent == folder
            assert not path.exists()
            path.touch()
            if file in ("", "a flight.json"):
                assert path.stem[-1] > "2"
            driver.press_on(next(widget.label for widget in driver.form.widgets if "%" in widget.label))


def test_a_film_is_made_while_the_replay_plays_and_after_it_is_left_and_can_be_stopped(
    replay: tuple[Driver, ReplayScene], tmp_path: Path
):
    driver, scene = replay
    driver.press_on(texts.REPLAY_EXPORT)
    scene.playback.stopped = False
    at = scene.flight_replay.at
    driver.frames(5)
    assert scene.flight_replay.at > at
    assert multiprocessing.active_children()
    driver.press_on(next(widget.label for widget in driver.form.widgets if "%" in widget.label))
    assert driver.said == texts.EXPORT_STOPPED
    driver.wait(lambda: not multiprocessing.active_children())  # on a busy machine even the killed take a moment
    driver.press_on(texts.REPLAY_EXPORT)
    driver.key(pygame.K_ESCAPE)
    driver.frames(2)
    assert multiprocessing.active_children()
    driver.app.close()
    deadline = time.monotonic() + 20
    while multiprocessing.active_children() and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not multiprocessing.active_children()


@pytest.mark.slow
def test_a_folder_that_cannot_be_had_is_reported(replay: tuple[Driver, ReplayScene], tmp_path: Path):
    driver, _ = replay
    (tmp_path / "pictures").write_text("in the way")
    driver.press_on(texts.REPLAY_EXPORT)
    driver.wait(lambda: driver.app.context.film is None)
    assert "could not be saved" in driver.said
    assert "File exists" in driver.said
    assert "Errno" not in driver.said
    assert driver.frames(2)


class Endless:
    """An export that never ends by itself."""

    share = 0.0

    def __init__(self, _scene: object, _record: Record, path: Path, **_: object) -> None:
        self.path = path

    def follow(self) -> str:
        return ""

    def close(self) -> None:
        """End."""
