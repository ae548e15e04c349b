"""A wheel is built, installed and used beside strangers of the same names: it owns the name `tranquility` alone."""

import json
import os
import re
import subprocess
import sys
from importlib.metadata import distributions
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.slow
ROOT = Path(__file__).parents[1]
DECOYS = ("main", "ai", "engine", "game", "models", "assets")

# A stranger's program that opens the game for some frames, and has a worker say where it finds its modules.
SESSION = """
import time

def places():
    import ai, engine, game
    yield [ai.__file__, engine.__file__, game.__file__]

def session():
    from tranquility.__main__ import find_own_folders, main
    find_own_folders()
    from game.shell.app import App
    from game.core.worker import Worker
    run, worker = App.run, Worker(places)
    App.run = lambda app, stop: run(app, stop, max_frames=20)
    assert main(["--user-dir", "player"]) == 0
    told = []
    while not told:
        time.sleep(0.02)
        told = worker.poll()
        assert not worker.problem, worker.problem
    worker.close()
    print("\\n".join([*next(places()), *told]))

if __name__ == "__main__":
    session()
"""


def run(*command: str, **options) -> str:
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=600, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of packages that the wheel was installed into, and then strangers of the names it once took."""
    made, folder = tmp_path_factory.mktemp("wheel"), tmp_path_factory.mktemp("packages")
    run(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(made), cwd=ROOT)
    (wheel,) = made.glob("*.whl")
    # Without the network, and without what the machine's own settings would add.
    run(sys.executable, "-m", "pip", "--isolated", "install", "--no-deps", "--no-index", "--no-compile",
        "--disable-pip-version-check", "--root-user-action=ignore", "--target", str(folder), str(wheel))  # fmt: skip
    assert {path.name for path in folder.iterdir() if path.suffix != ".dist-info"} == {"tranquility", "bin"}
    for name in DECOYS:
        (folder / name).mkdir()
        (folder / name / "__init__.py").write_text("raise SystemExit('a stranger')\n", encoding="utf-8")
    return folder


@pytest.fixture
def elsewhere(tmp_path: Path) -> Path:
    """The folder it is started in, which has files of the same names as well."""
    for name in DECOYS:
        (tmp_path / f"{name}.py").write_text("raise SystemExit('a stranger')\n", encoding="utf-8")
    return tmp_path


def environment(installed: Path) -> dict[str, str]:
    return os.environ | {"PYTHONPATH": str(installed), "SDL_VIDEODRIVER": "dummy", "SDL_AUDIODRIVER": "dummy"}


@pytest.mark.slow
def test_the_metadata_of_a_wheel_leads_nowhere_that_is_not_there(installed: Path):
    told: Any
    (told,) = (distribution.metadata for distribution in distributions(path=[str(installed)]))
    description = told.get_payload()
    assert isinstance(description, str)
    assert description.startswith("# Tranquility")
    assert not re.findall(r"!\[", description), "pictures"
    assert not [link for link in re.findall(r"\]\(([^)]*)\)", description) if not link.startswith("https://")]
    assert not re.findall(r"<(?:img|a)\b", description)
    assert told["License-Expression"] == "MIT AND CC-BY-SA-3.0"
    (info,) = installed.glob("*.dist-info")
    for name in told.get_all("License-File", []):
        assert (info / "licenses" / name).read_text(encoding="utf-8") == (ROOT / name).read_text(encoding="utf-8")
    licences = " ".join(file.read_text(encoding="utf-8") for file in (info / "licenses").rglob("*.*"))
    assert "creativecommons.org/licenses/by-sa/3.0" in licences


def test_commands_of_a_wheel_run_beside_strangers_of_the_same_names(installed: Path, elsewhere: Path):
    scripts = sorted((installed / "bin").iterdir())
    assert [script.stem for script in scripts] == ["tranquility", "tranquility-lander"]
    model = installed / "tranquility" / "models" / "lander" / "modern"
    for command in (["-m", "tranquility"], *([str(script)] for script in scripts)):
        told = run(sys.executable, *command, "evaluate", "--model", str(model), "--episodes", "4", "--json",
                   cwd=elsewhere, env=environment(installed))  # fmt: skip
        assert json.loads(told)["episodes"] == 4


def test_the_game_of_a_wheel_and_its_workers_are_its_own(installed: Path, elsewhere: Path):
    session = elsewhere / "session.py"
    session.write_text(SESSION, encoding="utf-8")
    told = run(sys.executable, str(session), cwd=elsewhere, env=environment(installed)).splitlines()[-6:]
    package = installed / "tranquility"
    assert [Path(place) for place in told] == [package / name / "__init__.py" for name in ("ai", "engine", "game")] * 2
