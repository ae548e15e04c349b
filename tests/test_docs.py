"""What documents, docstrings and comments name exists: modules, classes, functions and files."""

import re
import tomllib
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from tests.test_imports import AI_FLOORS, GAME_FLOORS
from tranquility.__main__ import _version

ROOT = Path(__file__).parents[1]
SOURCES = [path for folder in ("ai", "engine", "game", "benchmarks") for path in sorted((ROOT / folder).rglob("*.py"))]
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
_DOTTED = re.compile(r"`((?:ai|engine|game|benchmarks|tests)(?:\.\w+)+)(?<!\.pot)(?:\([^`]*\))?`")
_FILE = re.compile(r"`((?:ai|engine|game|benchmarks|tests|models|docs|assets)/[\w/.-]+\.(?:py|json|npz|pot|md))`")
_TEST = re.compile(r"\btests(?:/\w+)+(?:\.py)?")
_LINK = re.compile(r"\]\(([^)#:]+)(?:#[^)]*)?\)")


def exists(name: str) -> bool:
    """Whether a dotted name is a module, or something that a module has."""
    parts = name.split(".")
    for length in range(len(parts), 0, -1):
        try:
            thing: Any = import_module(".".join(parts[:length]))
        except ModuleNotFoundError:
            continue
        for part in parts[length:]:
            fields = getattr(thing, "__annotations__", {})
            if not hasattr(thing, part) and part not in fields:
                return False
            thing = getattr(thing, part, None)
        return True
    return False


def test_what_a_document_names_exists(subtests: pytest.Subtests):
    for document in DOCUMENTS:
        with subtests.test(document=document):
            text = document.read_text(encoding="utf-8")
            names = {name for name in _DOTTED.findall(text) if not exists(name)}
            files = {name for name in _FILE.findall(text) + _TEST.findall(text) if not (ROOT / name).exists()}
            links = {link for link in _LINK.findall(text) if not (document.parent / link).exists()}
            assert not names | files | links


def test_the_map_draws_every_floor_in_its_order():
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    game, ai = re.split(r"\n-+\n", page.split("```")[1], maxsplit=1)
    programs = {"start", "verify", "cli"}
    for drawn, floors, left_out in ((ai, AI_FLOORS, set()), (game, GAME_FLOORS, programs)):
        rows = [re.findall(r"\w+", re.split(r" {5,}", row)[0]) for row in drawn.splitlines()]
        names = [name for name in (floor.rpartition(".")[2] for floor in floors) if name not in left_out]
        heights = [next(height for height, row in enumerate(rows) if name in row) for name in names]
        assert heights == sorted(heights, reverse=True)


def test_every_picture_is_shown_and_has_a_way_to_be_made():
    kept = {path.stem for path in (ROOT / "docs" / "images").iterdir()}
    shown = {name for path in DOCUMENTS for name in re.findall(r"images/(\w+)\.webp", path.read_text(encoding="utf-8"))}
    script = (ROOT / "docs" / "pictures.py").read_text(encoding="utf-8")
    assert kept == shown
    assert not [name for name in kept if f'"{name}"' not in script]


def test_the_readme_is_short():
    assert len((ROOT / "README.md").read_text(encoding="utf-8").split()) <= 900


def test_what_a_source_names_exists():
    named = {(path, name) for path in SOURCES for name in _DOTTED.findall(path.read_text(encoding="utf-8"))}
    assert not {(str(path.relative_to(ROOT)), name) for path, name in named if not exists(name)}


def test_a_name_that_is_gone_is_found():
    assert exists("ai.nn.NeuralNetwork")
    assert not exists("ai.nn.NeuralNetwork.fly")
    assert not exists("game.shell.nothing")


def test_nobody_is_told_to_install_what_the_index_has_under_our_name():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["name"] == "tranquility-lander"
    assert project["scripts"].keys() == {"tranquility", project["name"]}
    own = {"tranquility", project["name"]}
    wanted = [re.split(r"[\[<>=; ]", need, maxsplit=1)[0] for needs in project["optional-dependencies"].values()
              for need in needs]  # fmt: skip
    assert own & set(wanted) == {project["name"]}
    texts = [*SOURCES, *DOCUMENTS, *sorted((ROOT / "game" / "locale").glob("*.pot"))]
    told = re.compile(r"install[^\n`]*[\s\"']tranquility\b(?!-lander\[)")
    assert not [path for path in texts if told.search(path.read_text(encoding="utf-8"))]


def test_the_version_is_our_own_not_that_of_a_namesake(tmp_path, monkeypatch):
    for name, version in (("tranquility", "9.9"), ("tranquility_lander", "3.2.1")):
        folder = tmp_path / f"{name}-{version}.dist-info"
        folder.mkdir()
        (folder / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert _version() == "Tranquility 3.2.1"
