"""Source code of our own functions, as it runs, for screens that show what computes their numbers."""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from itertools import islice
from pathlib import Path
from typing import Any, Final

_ROOT: Final = Path(__file__).parents[2]
_FOR_TOOLS: Final = re.compile(r"\s+# (?:noqa|fmt|type): ?.*")  # remarks that only tools read
Mark = str | Callable[..., Any]  # what a line is found by: a variable, or a function that is called in it


@dataclass(frozen=True)
class Source:
    """Source code of a function, without its docstring and remarks for tools.

    Attributes:
        path: file it stands in, from the project's folder on.
        name: qualified name of the function.
        lines: pairs of a line's number in the file and its text, without the function's own indentation.

    """

    path: str
    name: str
    lines: tuple[tuple[int, str], ...]
    _tree: ast.AST = field(compare=False, repr=False)

    def line_of(self, mark: Mark, number: int = 0) -> int:
        """Return the number of the line that sets a variable last, or only mentions it; or that calls a function.

        Of several calls, `number` chooses one. Raises LookupError if there is none.
        """
        nodes = list(ast.walk(self._tree))
        if callable(mark):
            calls = [node for node in nodes if isinstance(node, ast.Call) and _name(node.func) == mark.__name__]
            found = sorted(node.lineno for node in calls)
        else:
            named = [node for node in nodes if isinstance(node, ast.Name | ast.Attribute) and _name(node) == mark]
            sets = sorted((node.lineno for node in named if isinstance(node.ctx, ast.Store)), reverse=True)
            found = sets or sorted(node.lineno for node in named)
        line = next(islice(found, number, None), None)
        if line is None:
            raise LookupError(f"{self.name} has no line for {mark}")
        return line


@cache
def source_of(function: Callable[..., Any]) -> Source | None:
    """Return the source of a function, or None where the program was installed without its source."""
    try:
        lines, first = inspect.getsourcelines(function)
        path = Path(inspect.getsourcefile(function) or "")
    except (OSError, TypeError):
        return None
    text = textwrap.dedent("".join(lines))
    tree = ast.parse(text).body[0]
    assert isinstance(tree, ast.FunctionDef)
    ast.increment_lineno(tree, first - 1)
    silent = _docstring_lines(tree)
    lines = [_FOR_TOOLS.sub("", line) for line in text.splitlines()]
    kept = [(number, line) for number, line in enumerate(lines, first) if number not in silent]
    shown = path.relative_to(_ROOT).as_posix() if path.is_relative_to(_ROOT) else path.name
    return Source(shown, function.__qualname__, tuple(kept), tree)


def _docstring_lines(function: ast.FunctionDef) -> range:
    """Return the numbers of the lines of a function's docstring."""
    if ast.get_docstring(function, clean=False) is None:
        return range(0)
    return range(function.body[0].lineno, (function.body[0].end_lineno or 0) + 1)


def _name(node: ast.AST) -> str:
    """Return the last word of a name: `find` of `self.tree.find`; empty for what is none."""
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""
