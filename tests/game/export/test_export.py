"""Moving pictures: what they show, how they are written, and what becomes of them on a bad day."""

import importlib.util
import multiprocessing
import time
import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pygame
import pytest

from game.core import texts
from game.core.scene import Push
from game.export.export import Export
from game.export.film import film, frames
from game.export.kinds import KINDS, VideoKind
from game.flight.flight_file import Record
from game.scenes.logbook import replay as module
from game.scenes.logbook.replay import ReplayScene
from game.scenes.menus.menu import MenuScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import kept, landed

SMALL = {".gif": VideoKind("PIL", (160, 90), 60, True), ".mp4": VideoKind("av", (160, 90), 60, False)}


@pytest.fixture
def record(context: Context) -> Record:
    return kept(context, landed())


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    for suffix, kind in SMALL.items():
        monkeypatch.setitem(KINDS, suffix, kind)


def test_missing_is_whether_it_can_be_imported():
    assert KINDS[".gif"].missing is (importlib.util.find_spec("PIL") is None)
    assert VideoKind("no_such_module", (1, 1), 1, True).missing


def test_the_frames_show_the_flight_and_a_still_camera_shows_little_else(record: Record):
    length = len(record.recording.actions)
    before, after, end = frames(ReplayScene, record, SMALL[".gif"], [0, 20, length])
    assert before.shape == after.shape == (90, 160, 3)
    changed = (before != after).any(axis=2)
    assert 0 < changed.mean() < 0.1
    assert (after != end).any()


@pytest.mark.parametrize("suffix", KINDS)
def test_a_film_is_written_whole_and_told_of(suffix: str, record: Record, small: None, tmp_path: Path):
    pytest.importorskip(SMALL[suffix].needs)
    path = tmp_path / "new folder" / f"flight{suffix}"
    shares = [drawn.share for (drawn,) in film(ReplayScene, record, path)]
    assert shares == sorted(shares)
    assert shares[0] == 0
    assert shares[-1] < 1
    assert [each.name for each in path.parent.iterdir()] == [path.name]
    assert path.stat().st_size > 1000


def test_a_gif_shows_what_was_put_in(tmp_path: Path):
    image = pytest.importorskip("PIL.Image")
    from game.export.gif import GifWriter

    ramp = np.linspace(0, 60, 160).astype(np.uint8)  # a dark sky, in which every step of a palette would be seen
    first = np.zeros((90, 160, 3), np.uint8) + ramp[:, None]
    second, third = first.copy(), first.copy()
    second[20:30, 40:50] = (250, 200, 90)  # a flame: a hundredth of the picture
    third[60:64, 100:120] = (40, 220, 120)
    with GifWriter(tmp_path / "a.gif", (160, 90), [first, second, third], 0.05) as gif:
        for frame in (first, second, second, third):
            gif.add(frame)
    with image.open(tmp_path / "a.gif") as picture:
        assert picture.n_frames == 4
        for number, frame in enumerate((first, second, second, third)):
            picture.seek(number)
            assert picture.info["duration"] == 50
            seen = np.asarray(picture.convert("RGB"), int)
            assert np.abs(seen - frame).max() < 16
            assert abs((seen - frame).mean()) < 0.5  # the dither mixes what the palette lacks


@pytest.mark.parametrize(("changed", "most"), [(0, 400), (255, 10_000)])  # bytes; a frame of noise takes 14,000
def test_what_does_not_change_takes_no_room_in_a_gif(tmp_path: Path, changed: int, most: int):
    """Not even between two corners that do change."""
    pytest.importorskip("PIL")
    from game.export.gif import GifWriter

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


def test_an_mp4_has_every_frame_in_its_colours(tmp_path: Path):
    av = pytest.importorskip("av")
    from game.export.mp4 import Mp4Writer

    frame = np.full((90, 160, 3), (200, 120, 40), np.uint8)
    with Mp4Writer(tmp_path / "a.mp4", (160, 90), 60) as mp4:
        for _ in range(30):
            mp4.add(frame)
    with av.open(str(tmp_path / "a.mp4")) as container:
        pictures = [each.to_ndarray(format="rgb24") for each in container.decode(video=0)]
        assert container.streams.video[0].average_rate == 60
    assert len(pictures) == 30
    assert np.abs(pictures[10].astype(int) - frame).mean() < 4


@pytest.mark.parametrize("suffix", KINDS)
def test_a_full_disk_is_an_error_and_leaves_what_was_there(suffix: str, record: Record, small: None, tmp_path: Path):
    pytest.importorskip(SMALL[suffix].needs)
    resource = pytest.importorskip("resource")
    path = tmp_path / f"flight{suffix}"
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


def test_a_film_that_is_stopped_leaves_nothing(record: Record, small: None, tmp_path: Path):
    pytest.importorskip("PIL")
    turns = film(ReplayScene, record, tmp_path / "pictures" / "flight.gif")
    for _ in range(3):
        next(turns)
    turns.close()
    assert not list((tmp_path / "pictures").iterdir())


# In the game


def _choose_gif(driver: Driver) -> None:
    assert driver.top_name == "QuestionDialog"
    driver.key(pygame.K_RETURN)


@pytest.fixture
def replay(open_game: Callable[..., Driver], record: Record, monkeypatch, tmp_path: Path) -> tuple[Driver, ReplayScene]:
    monkeypatch.setattr(module, "exports_dir", lambda: tmp_path / "pictures")
    driver = open_game(ReplayScene, record)
    scene = driver.top
    driver.frames(2)
    driver.press_on(texts.REPLAY_EXPORT)
    return driver, scene


def _answers(driver: Driver) -> list[str]:
    return [widget.label for widget in driver.form.widgets]


def test_a_gif_works_as_installed_and_an_mp4_is_offered_only_where_it_can_be_made(
    replay: tuple[Driver, ReplayScene], monkeypatch
):
    driver, _ = replay
    project = tomllib.loads(Path("pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert any(need.startswith("pillow") for need in project["dependencies"])
    driver.key(pygame.K_ESCAPE)
    monkeypatch.setitem(KINDS, ".mp4", VideoKind("no_such_module", (1, 1), 1, False))
    driver.press_on(texts.REPLAY_EXPORT)
    assert _answers(driver) == ["GIF", texts.EXPORT_CANCEL]
    command = driver.top.more.partition("run: ")[2]
    assert command in Path("README.md").read_text(encoding="utf-8")
    driver.key(pygame.K_ESCAPE)
    monkeypatch.setitem(KINDS, ".mp4", VideoKind("json", (1, 1), 1, False))
    driver.press_on(texts.REPLAY_EXPORT)
    assert _answers(driver) == ["GIF", "MP4", texts.EXPORT_CANCEL]


@pytest.mark.parametrize("way", ["key", "word"])
def test_who_does_not_want_a_film_after_all_gets_none(replay: tuple[Driver, ReplayScene], way: str):
    driver, scene = replay
    if way == "key":
        driver.key(pygame.K_ESCAPE)
    else:
        driver.click(driver.form.widgets[-1].box.center)
    assert driver.top is scene
    assert scene.export is None


@pytest.mark.parametrize("file", ["a\0b.json", "\ud800.json", "...json", "x" * 250 + ".json", "C:\\con.json"])
def test_a_name_that_no_system_takes_is_made_one(
    replay: tuple[Driver, ReplayScene], file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    driver, scene = replay
    monkeypatch.setattr(module, "Export", Endless)
    scene.record = replace(scene.record, entry=replace(scene.record.entry, file=file))
    _choose_gif(driver)
    driver.frames(2)
    path = scene.export.path
    path.parent.mkdir(exist_ok=True)
    path.touch()
    assert path.parent == tmp_path / "pictures"


@pytest.mark.parametrize("name", ["a\0b.gif", "\ud800.gif"])
def test_an_export_under_an_impossible_name_can_be_closed_and_says_why(record: Record, name: str, tmp_path: Path):
    export = Export(ReplayScene, record, tmp_path / name)
    end = time.monotonic() + 60
    while not export.over and time.monotonic() < end:
        export.poll()
        time.sleep(0.01)
    assert export.problem
    export.close()


def test_a_replay_is_saved_while_it_goes_on_playing(replay: tuple[Driver, ReplayScene], tmp_path: Path):
    pytest.importorskip("PIL")
    driver, scene = replay
    _choose_gif(driver)
    scene.playback.stopped = False
    at = scene.flight_replay.at
    driver.frames(5)
    assert scene.flight_replay.at > at
    scene.export.close()  # a film of full size takes its time: the process itself is tested elsewhere
    driver.wait(lambda: scene.export is None)


@pytest.mark.parametrize("file", ["", "a flight.json"])
def test_no_picture_takes_the_place_of_another(
    replay: tuple[Driver, ReplayScene], file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    driver, scene = replay
    monkeypatch.setattr(module, "Export", Endless)
    scene.record = replace(scene.record, entry=replace(scene.record.entry, file=file))
    folder, name = tmp_path / "pictures", Path(file).stem or "Replay"
    folder.mkdir()
    for taken in (f"{name}.gif", f"{name} 2.gif"):
        (folder / taken).write_text("another flight")
    _choose_gif(driver)
    assert scene.export.path == folder / f"{name} 3.gif"


def test_a_film_can_be_stopped_and_leaving_ends_its_process(replay: tuple[Driver, ReplayScene], tmp_path: Path):
    pytest.importorskip("PIL")
    driver, _ = replay
    for _ in range(2):
        _choose_gif(driver)
        driver.frames(3)
        assert multiprocessing.active_children()
        driver.press_on(next(label for label in _answers(driver) if "%" in label))
        driver.wait(lambda: not multiprocessing.active_children())  # on a busy machine even the killed take a moment
        driver.press_on(texts.REPLAY_EXPORT)
    _choose_gif(driver)
    driver.app.close()
    deadline = time.monotonic() + 20
    while multiprocessing.active_children() and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not multiprocessing.active_children()


def test_a_folder_that_cannot_be_had_is_told_of(replay: tuple[Driver, ReplayScene], tmp_path: Path):
    pytest.importorskip("PIL")
    driver, scene = replay
    (tmp_path / "pictures").write_text("in the way")
    _choose_gif(driver)
    driver.wait(lambda: scene.export is None)
    assert "could not be saved" in driver.said
    assert "File exists" in driver.said
    assert "Errno" not in driver.said
    assert driver.frames(2)


def test_who_leaves_a_replay_is_told_that_its_film_was_not_saved(
    open_game: Callable[..., Driver], context: Context, record: Record, small: None, monkeypatch: pytest.MonkeyPatch
):
    pytest.importorskip("PIL")
    driver = open_game(MenuScene)
    scene = ReplayScene(driver.app.context, record)
    driver.app.scenes.apply(Push(scene))
    driver.frames(2)
    monkeypatch.setattr(module, "Export", Endless)
    driver.press_on(texts.REPLAY_EXPORT)
    _choose_gif(driver)
    driver.frames(2)
    told: list[str] = []
    monkeypatch.setattr(context, "note", told.append)
    driver.key(pygame.K_ESCAPE)
    assert isinstance(driver.top, MenuScene)
    assert told == [texts.EXPORT_STOPPED]


class Endless:
    """An export that never ends by itself."""

    share, over, problem = 0.0, False, ""

    def __init__(self, _scene: object, _record: Record, path: Path, **_: object) -> None:
        self.path, self.closed = path, False

    def poll(self) -> None:
        """Go on."""

    def close(self) -> None:
        self.closed = True
