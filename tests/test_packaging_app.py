"""What can be said of the packed app without building one; `python -m pytest packaging_app` builds and plays it."""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

from game.scenes import ROUTES
from game.scenes.learn.path import PATH
from packaging_app import licences, recipe, start
from packaging_app.archive import needed_glibc, pack

ROOT = Path(__file__).parents[1]

# Opens every page that needs nothing to begin with, as the app would: what is left out of it cannot be imported. Prints
# all files that were opened, and the fonts, which pygame opens by itself.
SESSION = """
import sys

opened, left_out = set(), set(sys.argv[2:])

class LeftOut:
    def find_spec(self, name, path=None, target=None):
        if name in left_out:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, LeftOut())
sys.addaudithook(lambda event, args: opened.add(str(args[0])) if event == "open" else None)

import pygame.font

class Font(pygame.font.Font):
    def __init__(self, file, size):
        opened.add(str(file))
        super().__init__(file, size)

pygame.font.Font = Font

def session(run):
    from game.core.scene import Route
    from game.shell.app import App
    from game.drawing import typeface
    from game.scenes import ROUTES

    def play(app, stop):
        for name in ("play", "missions", "watch", "train", "runs", "digits", "learn", "physics", "logbook", "settings"):
            app.show(Route(name))
            app.tick()
            assert "Error" not in type(app.scenes.top).__name__, app.scenes.top.trace
        for weight in ("extralight", "light", "regular", "medium", "semibold", "code"):
            typeface.render("x", 12.0, weight, (1, 1, 1))
        app.close()
        return 0

    App.run = play
    assert run(["--user-dir", sys.argv[1]]) == 0

if __name__ == "__main__":
    from tranquility.__main__ import main
    session(main)
    import PIL.GifImagePlugin, tqdm
    print("\\n".join(sorted(opened)))
"""


@pytest.fixture(scope="module")
def files() -> list[tuple[Path, Path]]:
    return recipe.data_files()


def test_every_file_beside_the_sources_is_packed_or_known_to_be_left_out(files):
    packed = {path for path, _ in files}
    folders = [*recipe.OWN, *recipe.DATA]
    beside = [path for folder in folders for path in (ROOT / folder).rglob("*") if path.is_file()]
    forgotten = {path for path in beside if path.suffix not in (".py", ".pyc", ".pot", ".po", ".pyi")} - packed
    assert not forgotten


def test_data_lies_in_the_app_as_in_a_checkout(files):
    for path, folder in files:
        if path.is_relative_to(ROOT) and ".venv" not in path.parts:
            assert ROOT / folder / path.name == path
    assert {"mnist", "models", "files"} <= {part for _, folder in files for part in folder.parts}


@pytest.mark.slow
def test_the_game_opens_nothing_that_is_left_out(files, tmp_path: Path):
    script = tmp_path / "session.py"
    script.write_text(SESSION, encoding="utf-8")
    environment = os.environ | {"PYTHONPATH": str(ROOT), "SDL_VIDEODRIVER": "dummy", "SDL_AUDIODRIVER": "dummy"}
    left_out = recipe.excluded()
    assert "pytest" in left_out
    done = subprocess.run([sys.executable, str(script), str(tmp_path / "player"), *left_out], env=environment, cwd=ROOT,
                          capture_output=True, text=True, check=False, timeout=120)  # fmt: skip
    assert done.returncode == 0, done.stderr
    packed = {str(path) for path, _ in files}
    opened = [Path(line) for line in done.stdout.splitlines() if Path(line).is_file()]
    data = [path for path in opened if path.suffix in (".ttf", ".otf", ".json", ".npy", ".npz", ".mo", ".bmp")]
    ours = [path for path in data if not path.is_relative_to(tmp_path)]
    assert {path.suffix for path in ours} >= {".ttf", ".json", ".npy", ".mo"}
    assert not {str(path) for path in ours} - packed


def test_every_module_that_is_found_by_its_name_is_packed():
    modules = set(recipe.modules())
    named = {f"game.scenes.{place.partition('.')[0]}" for place in ROUTES.values()}
    named |= {f"game.scenes.learn.{place.partition('.')[0]}" for place in PATH.values()}
    named |= {"game.cli", "ai.cli.train", "ai.cli.evaluate", "tranquility.__main__"}
    assert named <= modules
    assert not modules & set(recipe.excluded())


def test_a_worker_of_the_packed_app_begins_before_anything_is_loaded():
    """PyInstaller's `freeze_support` takes over the process there, so it comes first, and nothing of ours before it."""
    tree = ast.parse(recipe.ENTRY.read_text(encoding="utf-8"))
    block = tree.body[-1]
    assert isinstance(block, ast.If)
    assert ast.unparse(block.body[0]) == "freeze_support()"
    imported = {node.module or "" for node in tree.body if isinstance(node, ast.ImportFrom)}
    assert {name.partition(".")[0] for name in imported} <= sys.stdlib_module_names


def test_a_start_that_fails_is_one_sentence_and_a_file(monkeypatch, tmp_path: Path, capsys):
    def fail() -> int:
        raise RuntimeError("the moon is missing")

    monkeypatch.setattr("tranquility.__main__.main", fail)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    assert start.start() == start.FAILED
    told = capsys.readouterr().err
    assert "the moon is missing" in told
    assert "Traceback" not in told
    assert "Traceback" in (tmp_path / start.REPORT).read_text()
    monkeypatch.setenv("HOME", str(tmp_path / "gone"))
    monkeypatch.setattr(start, "gettempdir", lambda: str(tmp_path / "gone"))
    start.start()
    assert "Traceback" in capsys.readouterr().err  # nothing takes it, so it is at least seen


def test_licences_are_collected_and_a_strange_library_is_noticed(tmp_path: Path):
    (tmp_path / "_internal").mkdir()
    for name in ("libSDL2-2-50d19f93.0.so.0.3200.10", "libpng16-fefdc88d.so.16.58.0", "libstranger.so.1", "libz.so.1"):
        (tmp_path / "_internal" / name).touch()
    folder = tmp_path / licences.FOLDER
    licences.collect(recipe.PACKAGES, tmp_path, folder)
    said = (folder / "README.txt").read_text(encoding="utf-8")
    for name in ("numpy", "pygame-ce", "pillow", "tqdm", "Python"):
        assert name in said
        assert [path for path in folder.rglob("*") if path.is_file() and name.lower() in str(path).lower()]
    assert dict(licences.libraries_in(tmp_path)) == {
        "libSDL2-2-50d19f93.0.so.0.3200.10": "Zlib", "libpng16-fefdc88d.so.16.58.0": "libpng-2.0",
        "libstranger.so.1": "", "libz.so.1": "Zlib",
    }  # fmt: skip
    assert "licenses/by-sa/3.0" in (folder / "MNIST.txt").read_text(encoding="utf-8")
    assert "SIL OPEN FONT LICENSE" in (folder / "font_manrope-OFL.txt").read_text(encoding="utf-8").upper()


@pytest.mark.skipif(sys.platform != "linux", reason="an archive with modes and links")
def test_the_same_files_make_the_same_archive(tmp_path: Path):
    folder = tmp_path / "Tranquility"
    folder.mkdir()
    (folder / "program").write_bytes(b"\x7fELF\0GLIBC_2.4\0GLIBC_2.31\0GLIBCXX_3.4.30\0")
    (folder / "link").symlink_to("program")
    first = pack(folder, "archive").read_bytes()
    os.utime(folder / "program", (1, 1))
    assert pack(folder, "archive").read_bytes() == first
    assert needed_glibc(folder) == (2, 31)
