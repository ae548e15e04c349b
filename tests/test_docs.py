"""What documents, docstrings and comments name exists: modules, classes, functions and files."""

import re
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SOURCES = [path for folder in ("ai", "engine", "game", "benchmarks") for path in sorted((ROOT / folder).rglob("*.py"))]
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
_DOTTED = re.compile(r"`((?:ai|engine|game|benchmarks|tests)(?:\.\w+)+)(?<!\.pot)(?:\([^`]*\))?`")
_FILE = re.compile(r"`((?:ai|engine|game|benchmarks|tests|models|docs|assets)/[\w/.-]+\.(?:py|json|npz|pot|md))`")
_LINK = re.compile(r"\]\(([^)#:]+)(?:#[^)]*)?\)")


def exists(name: str) -> bool:
    """Whether a dotted name is a module, or something that a module has."""
    parts = name.split(".")
    for length in range(len(parts), 0, -1):
        try:
            thing = import_module(".".join(parts[:length]))
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
            files = {name for name in _FILE.findall(text) if not (ROOT / name).exists()}
            links = {link for link in _LINK.findall(text) if not (document.parent / link).exists()}
            assert not names | files | links


def test_what_a_source_names_exists():
    named = {(path, name) for path in SOURCES for name in _DOTTED.findall(path.read_text(encoding="utf-8"))}
    assert not {(str(path.relative_to(ROOT)), name) for path, name in named if not exists(name)}


def test_a_name_that_is_gone_is_found():
    assert exists("ai.nn.NeuralNetwork")
    assert not exists("ai.nn.NeuralNetwork.fly")
    assert not exists("game.shell.nothing")
