"""English stands in one file, ready for translation."""

import ast
import re
import string
from collections.abc import Iterator
from pathlib import Path

import pytest

from game.core import texts

GAME = Path(texts.__file__).parents[1]
WORDS = re.compile(r"[A-Za-z]{2,} [a-zA-Z]{2,}")
NO_ENGLISH = {"tranquility flight", "wireless controller", "pro controller"}  # a file's format, devices' names


def spoken(tree: ast.AST) -> Iterator[ast.Constant]:
    """Yield the strings of a module that are neither documentation nor for its log, an error or an assertion."""
    silent: set[int] = set()
    for node in ast.walk(tree):
        logs = (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and ast.unparse(node.func.value) == "_log"
        )
        if isinstance(node, ast.Raise | ast.Assert) or logs:
            silent |= {id(child) for child in ast.walk(node)}
        elif isinstance(node, ast.Expr):
            silent.add(id(node.value))
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in silent:
            yield node


@pytest.mark.parametrize("path", sorted(GAME.rglob("*.py")), ids=lambda path: path.relative_to(GAME).as_posix())
def test_no_sentence_stands_elsewhere(path: Path):
    if path.name == "texts.py":
        return
    tree = ast.parse(path.read_text(encoding="utf-8"))
    found = [node.value for node in spoken(tree) if WORDS.search(node.value) and node.value not in NO_ENGLISH]
    assert not found


def test_the_scan_finds_a_sentence():
    tree = ast.parse('"""A module of words."""\ncanvas.text(f"Two words {x}")\nraise ValueError("not for players")')
    assert [node.value for node in spoken(tree) if WORDS.search(node.value)] == ["Two words "]


def test_what_is_filled_in_has_a_name():
    """A translation may need another order."""
    for name, value in vars(texts).items():
        for text in strings(value) if name.isupper() else ():
            fields = [field for _, field, _, _ in string.Formatter().parse(text) if field is not None]
            assert all(fields) or len(fields) == 1, f"{name}: {text}"


def strings(value: object) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        yield from strings(tuple(value.values()))
    elif isinstance(value, tuple):
        for each in value:
            yield from strings(each)
