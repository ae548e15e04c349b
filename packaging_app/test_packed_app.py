"""The app is built, unpacked, started and played: without the machine's Python, without network, writing nothing.

It takes some minutes, so the usual suite leaves it out: `python -m pytest packaging_app`. With TRANQUILITY_APP, the
path of an archive, that one is tested and none is built.

As root, the app runs as `nobody`, from a read-only mount, in a network of its own that reaches nobody, and this
Python's folder may be closed to it. As another user, it runs as that user, from a folder that nobody may write to.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import mkdtemp

import pygame
import pytest

from game.drawing.tokens import HUMAN, NET, PALETTE
from packaging_app import recipe
from packaging_app.__main__ import build
from packaging_app.licences import FOLDER, libraries_in
from tests.support.window import Window, screen, skip_without_a_screen

LARGEST = 120e6  # bytes of the archive
NOBODY = 65534
SLOW = 90  # seconds that anything may take on a busy machine
# What the system has to have: the C library with its loader, X11, and what tells of devices.
SYSTEM = re.compile(
    r"/(ld-linux|lib(c|m|dl|rt|pthread|util|X\w*|xcb|xkbcommon|bsd|md|udev|cap|resolv|wayland)\b)[^/]*$"
)
CODE = pygame.Rect(850, 265, 390, 85)  # where a lesson lists code, and Train has nothing
BARS = pygame.Rect(656, 262, 192, 250)  # how likely each digit is
SWITCH = pygame.Rect(1198, 144, 32, 16)  # of a step of what a network sees
NAME = pygame.Rect(430, 345, 420, 25)  # the line under a network's name
ANSWERS = pygame.Rect(425, 388, 50, 24)  # the first answer to a question, underlined
LAMP = pygame.Rect(540, 28, 90, 16)
CARD = pygame.Rect(420, 160, 180, 60)
WORDS = {"Save as film": (1098, 189), "Save run": (1211, 692), "One lesson": (720, 150)}  # pixels, in the first window


@pytest.fixture(scope="module")
def place() -> Iterator[Path]:
    """A folder that every user can read: pytest's own are closed."""
    folder = Path(mkdtemp(prefix="tranquility-packed-"))
    folder.chmod(0o755)
    yield folder
    subprocess.run(["chmod", "-R", "u+w", str(folder)], check=True)
    shutil.rmtree(folder)


@pytest.fixture(scope="module")
def archive(place: Path) -> Path:
    given = os.environ.get("TRANQUILITY_APP")
    return Path(given) if given else build(place / "built")


@pytest.fixture(scope="module")
def app(archive: Path, place: Path) -> Path:
    """The folder of the archive, unpacked where nobody may write."""
    with tarfile.open(archive) as packed:
        packed.extractall(place / "unpacked", filter="tar")
    subprocess.run(["chmod", "-R", "a-w", str(place / "unpacked")], check=True)
    return place / "unpacked" / recipe.TITLE


@pytest.fixture
def home(place: Path, request: pytest.FixtureRequest) -> Path:
    """An empty home of the user that plays."""
    folder = place / request.node.name[:40]
    folder.mkdir()
    if os.geteuid() == 0:
        os.chown(folder, NOBODY, NOBODY)
    return folder


@pytest.fixture(scope="module")
def display() -> Iterator[str]:
    skip_without_a_screen()
    with screen() as name:
        yield name


def command(app: Path, home: Path, *arguments: str, **variables: str) -> list[str]:
    """What starts the app with these variables alone."""
    values = {"PATH": "/usr/bin:/bin", "HOME": str(home)} | variables
    plain = ["env", "-i", *(f"{name}={value}" for name, value in values.items()), str(app / recipe.NAME), *arguments]
    if os.geteuid() != 0:
        return plain
    closed = 'mount --bind "$0" "$0" && mount -o remount,bind,ro "$0" && exec setpriv "$@"'
    user = [f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups", "--no-new-privs"]
    return ["unshare", "--net", "--mount", "sh", "-c", closed, str(app), *user, *plain]


def run(app: Path, home: Path, *arguments: str, **variables: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command(app, home, *arguments, **variables), capture_output=True, text=True, check=False,
                          timeout=SLOW, cwd="/")  # fmt: skip


@contextmanager
def started(app: Path, home: Path, display: str, *arguments: str) -> Iterator[Window]:
    pictures = app.parents[1] / "pictures"
    pictures.mkdir(exist_ok=True)
    window = Window(display, pictures / "user", command=command(app, home, *arguments, DISPLAY=display), seconds=SLOW)
    try:
        yield window
    finally:
        window.end()


def shows(window: Window, colour: tuple[int, int, int], area: pygame.Rect) -> bool:
    pixels = pygame.surfarray.array3d(window.picture().subsurface(area)).astype(int)
    return int((abs(pixels - colour).max(axis=2) < 8).sum()) > 12


def rows_of_text(window: Window, area: pygame.Rect) -> int:
    """How many lines of light letters stand in an area."""
    lit = pygame.surfarray.array3d(window.picture().subsurface(area)).min(axis=2).max(axis=0) > 120
    return int((lit[1:] & ~lit[:-1]).sum())


def children(window: Window) -> list[str]:
    """The commands of the processes that the program has started."""
    parent = str(window.process.pid)
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            if status.read_text().rpartition(")")[2].split()[1] == parent:
                found.append((status.parent / "cmdline").read_text().replace("\0", " "))
        except OSError:
            continue  # it has ended meanwhile
    return found


def strangers(window: Window, app: Path) -> set[str]:
    """The libraries in the program's memory that are neither its own nor the system's."""
    maps = Path(f"/proc/{window.process.pid}/maps").read_text().splitlines()
    files = {line.split(maxsplit=5)[5] for line in maps if ".so" in line or "python" in line}
    return {file for file in files if not file.startswith(str(app)) and not SYSTEM.search(file)}


def within(home: Path, pattern: str) -> Callable[[], list[Path]]:
    return lambda: [path for path in home.glob(pattern) if path.stat().st_size]


def test_the_archive_is_small_and_has_all_licences(archive: Path, app: Path):
    assert archive.stat().st_size < LARGEST
    inside = {path.name.split("-")[0] for path in (app / "_internal").iterdir() if path.is_dir()}
    libraries = {
        "pillow.libs",
        "numpy.libs",
        "pygame_ce.libs",
        f"python{sys.version_info.major}.{sys.version_info.minor}",
    }
    assert inside <= {*recipe.OWN, *recipe.PACKAGES, "assets", "models"} | libraries | {
        "tqdm",
        "numpy",
        "lib",
        "examples",
        "tranquility_lander",
    }
    known = dict(libraries_in(app))
    assert known
    assert all(known.values()), [name for name, licence in known.items() if not licence]
    texts = [path.name for path in (app / FOLDER).rglob("*") if path.is_file()]
    assert len(texts) > 15
    assert {"LICENSE", "LGPL-2.1.txt", "MNIST.txt", "Python-LICENSE.txt", "font_manrope-OFL.txt"} <= set(texts)


def test_commands_train_evaluate_and_say_what_they_are(app: Path, home: Path):
    assert run(app, home, "--version").stdout.strip() == f"Tranquility {recipe.version()}"
    trained = run(app, home, "train", "--seconds", "2", "--seed", "0", "--output", str(home / "run"))
    assert trained.returncode == 0, trained.stderr
    told = run(app, home, "evaluate", "--model", str(home / "run"), "--episodes", "4", "--json")
    assert json.loads(told.stdout)["episodes"] == 4
    assert run(app, home, "nonsense").returncode == 2


def test_a_whole_evening_from_an_empty_home(app: Path, home: Path, display: str):
    mine = home / ".local" / "share" / "tranquility"
    before = sorted(app.rglob("*"))
    with started(app, home, display) as window:
        assert not strangers(window, app)
        window.key("Down", "Down", "Return", "Return")  # Missions, the first of them
        window.key("Tab")
        window.wait_for(lambda: shows(window, NET, LAMP), "the network to fly", SLOW)
        window.wait_for(within(mine, "flights/*.json"), "the flight to be saved", SLOW)
        window.wait_for(lambda: shows(window, PALETTE.good, CARD), "the card of a landing", SLOW)
        window.key("Escape", "Escape", *["Down"] * 6, "Return", "Return")  # Logbook, the flight
        click_until(window, "Save as film", lambda: any(home.glob("Documents/Tranquility/*")), answer="Return")  # GIF
        window.wait_for(within(home, "Documents/Tranquility/*.gif"), "the film", SLOW)
        window.key("Escape", "Escape", *["Up"] * 4, "Return")  # Train
        time.sleep(1)
        window.key("Return")
        window.wait_for(lambda: any("--multiprocessing-fork" in each for each in children(window)), "a worker", SLOW)
        window.wait_for(lambda: shows(window, NET, pygame.Rect(40, 400, 700, 300)), "the first curves", SLOW)
        click_until(window, "One lesson", lambda: rows_of_text(window, CODE) >= 4)  # the lines that took the step
        window.key("Escape")
        click_until(window, "Save run", lambda: shows(window, HUMAN, NAME))
        window.key("Return")
        window.wait_for(within(mine, "models/[!.]*/config.json"), "the network to be saved", SLOW)
        window.key("Escape")
        time.sleep(1)
        window.key("Down", "Return")  # Draw a digit
        window.wait_for(lambda: shows(window, NET, SWITCH), "the page of digits", SLOW)
        assert not shows(window, NET, BARS)
        window.drag([(250, y) for y in range(250, 450, 20)])
        window.wait_for(lambda: shows(window, NET, BARS), "a digit to be read", SLOW)
        assert window.close() == 0
        output = window.output()
    assert "Traceback" not in output
    assert sorted(app.rglob("*")) == before
    flights = [str(path) for path in mine.glob("flights/*.json")]
    assert run(app, home, "verify", *flights).returncode == 0
    (film,) = home.glob("Documents/Tranquility/*.gif")
    assert film.read_bytes().startswith(b"GIF89a")


def click_until(window: Window, word: str, happened: Callable[[], object], answer: str = "") -> None:
    """Click on a word, and answer what it asks; again after a while, if the page was still on its way."""
    for _ in range(4):
        window.click(*WORDS[word])
        with suppress(AssertionError):
            if answer:
                window.wait_for(lambda: shows(window, NET, ANSWERS), f"the question of {word}", SLOW / 6)
                window.key(answer)
            window.wait_for(happened, word, SLOW / 3)
            return
    raise AssertionError(f"nothing comes of a click on {word}")


def test_without_a_screen_it_says_so(app: Path, home: Path):
    finished = run(app, home)
    assert finished.returncode == 2
    assert "needs a screen" in finished.stderr
    assert "Traceback" not in finished.stderr


def test_damaged_settings_are_put_aside(app: Path, home: Path, display: str):
    mine = home / ".local" / "share" / "tranquility"
    mine.mkdir(parents=True)
    (mine / "settings.json").write_bytes(b"{\0 nonsense")
    if os.geteuid() == 0:
        for folder in (mine, *mine.parents[:2]):
            os.chown(folder, NOBODY, NOBODY)
    with started(app, home, display) as window:
        window.key("F10")
        window.wait_for(within(mine, "settings.damaged.json"), "the damaged file to be put aside", SLOW)
        assert window.close() == 0
        assert "Traceback" not in window.output()
    assert json.loads((mine / "settings.json").read_text())["muted"] is True


def test_in_a_home_that_takes_nothing_it_can_be_played(app: Path, display: str):
    with started(app, Path("/nonexistent"), display) as window:
        window.key("F10", "Down", "Down", "Down", "Return")  # a choice that can't be kept; Watch
        window.wait_for(lambda: shows(window, NET, LAMP), "the network to fly", SLOW)
        assert window.close() == 0
        assert "Traceback" not in window.output()
