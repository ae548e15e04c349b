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
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkdtemp

import pygame
import pytest

from game.drawing.tokens import NET, PALETTE
from game.scenes.menus.menu import FLIGHTS, ROWS
from packaging_app import recipe
from packaging_app.__main__ import build
from packaging_app.licences import FOLDER, libraries_in
from tests.support.window import Window, screen, skip_without_a_screen

LARGEST = 50e6  # bytes of the archive
NOBODY = 65534
SLOW = 90  # seconds that anything may take on a busy machine
# What the system has to have: the C library with its loader, X11, and what tells of devices.
SYSTEM = re.compile(
    r"/(ld-linux|lib(c|m|dl|rt|pthread|util|X\w*|xcb|xkbcommon|bsd|md|udev|cap|resolv|wayland)\b)[^/]*$"
)
WHOLE = pygame.Rect(0, 0, 1280, 720)
TOP = pygame.Rect(0, 0, 1280, 240)  # where landings are told, above all that flies
CODE = pygame.Rect(850, 200, 150, 200)  # where a lesson lists code, and without it has nothing


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


def furnish(home: Path, settings: bytes) -> Path:
    """Write settings for the user that plays; return the folder that they lie in."""
    mine = home / ".local" / "share" / "tranquility"
    mine.mkdir(parents=True)
    (mine / "settings.json").write_bytes(settings)
    for path in home.rglob("*"):
        os.chown(path, home.stat().st_uid, home.stat().st_gid)
    return mine


def go_to(window: Window, name: str) -> None:
    """Go back to the menu, where one Escape more leads to its last row, and from there up to another."""
    window.key(*["Escape"] * 5, *["Up"] * ROWS[::-1].index(name), "Return")


def shows(window: Window, colour: tuple[int, int, int], area: pygame.Rect) -> bool:
    pixels = pygame.surfarray.array3d(window.picture().subsurface(area)).astype(int)
    return int((abs(pixels - colour).max(axis=2) < 8).sum()) > 12


def rows_of_text(window: Window, area: pygame.Rect) -> int:
    """How many lines of light letters stand in an area."""
    lit = pygame.surfarray.array3d(window.picture().subsurface(area)).min(axis=2).max(axis=0) > 120
    return int((lit[1:] & ~lit[:-1]).sum())


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


def test_a_whole_evening_by_keys_alone(app: Path, home: Path, display: str):
    mine = furnish(home, b'{"tutored": true, "opened": "replay", "slow_runs": false}')
    before = sorted(app.rglob("*"))
    with started(app, home, display) as window:
        assert not strangers(window, app)
        go_to(window, "play")
        window.key(
            *["Down"] * list(FLIGHTS).index("missions"), "Return", "Return", "Tab"
        )  # the network flies the first
        window.wait_for(lambda: shows(window, PALETTE.good, TOP), "the card of a landing", SLOW)
        window.key("t", "Down", "Down", "Right", "Right", "Right", "Return")  # watched again, and saved as GIF
        window.wait_for(within(home, "Documents/Tranquility/*.gif"), "the film", SLOW)
        go_to(window, "train")
        window.key("Return")
        offered = b'"lesson_offered": true'
        window.wait_for(lambda: offered in (mine / "settings.json").read_bytes(), "a first landing", SLOW)
        window.key("Return", "shift+Tab", "Return")  # its lesson, with code
        window.wait_for(lambda: rows_of_text(window, CODE) >= 4, "the lines that took the step", SLOW)
        go_to(window, "digits")
        window.wait_for(within(mine, "models/.training/config.json"), "the run to be kept", SLOW)
        assert not shows(window, NET, WHOLE)
        window.key("Return")
        window.wait_for(lambda: window.hold("Return+Down", 0.5) or shows(window, NET, WHOLE), "a 1 to be read", SLOW)
        assert window.close() == 0
        assert "Traceback" not in window.output()
    assert sorted(app.rglob("*")) == before
    (flight,) = mine.glob("flights/*.json")
    assert run(app, home, "verify", str(flight)).returncode == 0
    (film,) = home.glob("Documents/Tranquility/*.gif")
    assert film.read_bytes().startswith(b"GIF89a")


def test_without_a_screen_it_says_so(app: Path, home: Path):
    finished = run(app, home)
    assert finished.returncode == 2
    assert "needs a screen" in finished.stderr
    assert "Traceback" not in finished.stderr


def test_damaged_settings_are_put_aside(app: Path, home: Path, display: str):
    mine = furnish(home, b"{\0 nonsense")
    with started(app, home, display) as window:
        window.key("F10")
        window.wait_for(within(mine, "settings.damaged.json"), "the damaged file to be put aside", SLOW)
        assert window.close() == 0
        assert "Traceback" not in window.output()
    assert json.loads((mine / "settings.json").read_text())["muted"] is True


def test_in_a_home_that_takes_nothing_it_can_be_played(app: Path, display: str):
    with started(app, Path("/nonexistent"), display) as window:
        window.key("F10")  # a choice that can't be kept
        go_to(window, "watch")
        window.wait_for(lambda: shows(window, PALETTE.good, TOP), "the network to land", SLOW)
        assert window.close() == 0
        assert "Traceback" not in window.output()
