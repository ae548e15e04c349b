"""Source code of our own functions, as it runs, for screens that show what computes their numbers."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final

_ROOT: Final = Path(__file__).parents[2]


@dataclass(frozen=True)
class Source:
    """Source code of a function, without its docstring.

    Attributes:
        path: file it stands in, from the project's folder on.
        name: qualified name of the function.
        lines: pairs of a line's number in the file and its text, without the function's own indentation.

    """

    path: str
    name: str
    lines: tuple[tuple[int, str], ...]


@cache
def source_of(function: Callable[..., Any]) -> Source | None:
    """Return the source of a function, or None where the program was installed without its source."""
    try:
        lines, first = inspect.getsourcelines(function)
        path = Path(inspect.getsourcefile(function) or "")
    except (OSError, TypeError):
        return None
    text = textwrap.dedent("".join(lines))
    silent = _docstring_lines(text)
    kept = [(first + row, line) for row, line in enumerate(text.splitlines()) if row not in silent]
    shown = path.relative_to(_ROOT).as_posix() if path.is_relative_to(_ROOT) else path.name
    return Source(shown, function.__qualname__, tuple(kept))


def _docstring_lines(text: str) -> range:
    """Return the rows, from 0, of a function's docstring."""
    body = ast.parse(text).body[0]
    assert isinstance(body, ast.FunctionDef)
    first = body.body[0]
    if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant) and isinstance(first.value.value, str):
        return range(first.lineno - 1, first.end_lineno or first.lineno)
    return range(0)
