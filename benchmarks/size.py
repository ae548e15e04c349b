"""How large the code is: lines of all kinds, and lines of code, by package.

    python -m benchmarks.size

Lines of code are those that hold more than a comment or a docstring. The core, which is to be read in an afternoon, is
counted once more with all of this project that it imports, so that code which was only moved away still counts.
"""

import argparse
import ast
import tokenize
from collections.abc import Iterable
from io import StringIO
from itertools import groupby
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).parents[1]
TOPS: Final = ("engine", "ai", "game", "tests", "benchmarks")
CORE: Final = ("engine", "ai/nn", "ai/agent")
AIMS: Final = {  # lines of all kinds, of code for the core; a room is 10 % larger at most
    "engine": 1600,
    "ai": 13700,
    "ai/agent": 1000,
    "ai/cli": 750,
    "ai/copilot": 700,
    "ai/digits": 1500,
    "ai/explain": 900,
    "ai/files": 650,
    "ai/flights": 400,
    "ai/lander": 2300,
    "ai/nn": 1450,
    "ai/pilots": 450,
    "ai/sweep": 600,
    "ai/training": 3000,
    "game": 29700,
    "game/drawing": 1600,
    "game/explain": 1300,
    "game/flight": 2200,
    "game/scenes": 13500,
    "game/training": 900,
    "game/ui": 2900,
    "game/world": 3300,
    "engine + ai + game": 49000,
    "tests": 27000,
    "benchmarks": 3500,
    "engine + ai/nn + ai/agent": 3000,
}
_FREE: Final = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}


def size(path: Path) -> tuple[int, int]:
    """Return the lines of a file, and those of them that hold code."""
    text = path.read_text(encoding="utf-8")
    code = set[int]()
    for token in tokenize.generate_tokens(StringIO(text).readline):
        if token.type not in _FREE:
            code.update(range(token.start[0], token.end[0] + 1))
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            code -= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return len(text.splitlines()), len(code)


def total(paths: Iterable[Path]) -> tuple[int, int]:
    """Return the lines of files, and of their code."""
    lines, code = 0, 0
    for path in paths:
        more, of_code = size(path)
        lines, code = lines + more, code + of_code
    return lines, code


def files(*folders: str) -> list[Path]:
    """Return the source files of folders."""
    return sorted(path for folder in folders for path in (ROOT / folder).rglob("*.py"))


def imported(paths: Iterable[Path]) -> set[Path]:
    """Return files with all of this project that they import, and what that imports."""
    found, new = set[Path](), set(paths)
    while new:
        found |= new
        new = {target for path in new for target in _imports(path)} - found
    return found


def _imports(path: Path) -> set[Path]:
    names = set[str]()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            names.update([node.module or "", *(f"{node.module}.{alias.name}" for alias in node.names)])
        elif isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
    places = [ROOT.joinpath(*name.split(".")) for name in names]
    candidates = {place.with_suffix(".py") for place in places} | {place / "__init__.py" for place in places}
    return {candidate for candidate in candidates if candidate.is_file()}


def report(name: str, paths: Iterable[Path]) -> None:
    """Print one row."""
    lines, code = total(paths)
    print(f"{name:40}{lines:9,}{code:9,}" + (f"{AIMS[name]:9,}" if name in AIMS else ""))


def main() -> None:
    """Print the table."""
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    print(f"{'':40}{'lines':>9}{'code':>9}{'aim':>9}")
    for top in TOPS:
        report(top, files(top))
        packages = groupby(files(top), key=lambda path: "/".join(path.relative_to(ROOT).parts[:2]))
        if top in ("ai", "game"):
            for package, paths in packages:
                if (ROOT / package).is_dir():
                    report(package, list(paths))
    report("engine + ai + game", files("engine", "ai", "game"))
    print("\nThe core (its aim is in lines of code), and with all that it imports")
    for folders in (*((folder,) for folder in CORE), CORE):
        name = " + ".join(folders)
        report(name, files(*folders))
        report(f"{name}, and more", imported(files(*folders)))


if __name__ == "__main__":
    main()
