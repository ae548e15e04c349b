"""The floors: imports run down only, and nothing heavy is loaded before it is needed."""

import ast
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PROGRAM = [ROOT / "main.py", ROOT / "tranquility" / "__main__.py"]
STDLIB = set(sys.stdlib_module_names)
PYGAME = {"pygame", "pygame_gui"}
# What a single module may import besides, and only when it is used.
LATE = {
    "ai.files.writing": {"filelock"},
    "ai.cli.train": {"tqdm"},
    "ai.cli.sweep": {"tqdm"},
    "ai.training.gym_task": {"gymnasium"},
    "ai.files.folder": {"platformdirs"},
    "ai.sweep.cluster": {"ray"},
}
# What is there for the users of an extra alone.
EXTRA = {
    "ai.training.gym_lander": {"gymnasium"},
    "ai.sweep.driver": {"optuna", "ray"},
}
# The floors inside `ai` and `game`, from the bottom up: a package imports from itself and from those before it.
AI_FLOORS = (
    "ai.files", "ai.nn", "ai.environment", "ai.run", "ai.lander", "ai.pilots", "ai.flights", "ai.agent", "ai.digits",
    "ai.explain", "ai.training", "ai.copilot", "ai.sweep", "ai.cli",
)  # fmt: skip
GAME_FLOORS = (
    "game.core", "game.input", "game.audio", "game.drawing", "game.ui", "game.flight", "game.training",
    "game.world", "game.explain", "game.digits", "game.export", "game.shell", "game.scenes", "game.start",
    "game.verify", "game.cli",
)  # fmt: skip
# These only describe what is handed to them from above, for the type checker.
DESCRIBED_FROM_ABOVE = {"game.core.scene"}


def modules(folder):
    return sorted(path for path in (ROOT / folder).rglob("*.py"))


@cache
def found_in(path):
    """What a file imports: full names, each with whether a function does so, and whether it is for types alone."""
    found, ahead = set(), [(ast.parse(path.read_text(encoding="utf-8")), False, False)]
    while ahead:
        node, late, typed = ahead.pop()
        if isinstance(node, ast.Import):
            found.update((alias.name, late, typed) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: a relative import hides which floor it comes from"
            found.update((f"{node.module}.{alias.name}", late, typed) for alias in node.names)
        else:
            late |= isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
            typed |= isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING"
            within = (each for each in ast.iter_child_nodes(node) if not isinstance(each, ast.expr))
            ahead.extend((each, late, typed) for each in within)
    return found


def imports(path, everywhere=True, types=False):
    """Full names that a file imports: anywhere in it, or only when it is itself imported; those of types as well."""
    return {name for name, late, typed in found_in(path) if (everywhere or not late) and (types or not typed)}


def is_within(name, packages):
    return any(name == package or name.startswith(f"{package}.") for package in packages)


def name_of(path):
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def assert_imports_only(path, packages):
    strange = {name for name in imports(path) if name.split(".")[0] not in STDLIB and not is_within(name, packages)}
    assert not strange, f"{path.relative_to(ROOT)} stands on a floor that knows nothing of {sorted(strange)}"


@pytest.mark.parametrize(("folder", "name"), [("engine", "engine"), ("ai/nn", "ai.nn")])
def test_the_engine_and_the_network_library_stand_on_numpy_alone(subtests, folder, name):
    for path in modules(folder):
        with subtests.test(name_of(path)):
            assert_imports_only(path, {name, "ai.files", "numpy"})


def test_ai_stands_on_the_engine_and_the_network_library(subtests):
    for path in (path for path in modules("ai") if "nn" not in path.parts):
        with subtests.test(name := name_of(path)):
            late = LATE.get(name, set())
            assert_imports_only(path, {"ai", "engine", "numpy"} | late | EXTRA.get(name, set()))
            assert not [each for each in imports(path, everywhere=False) if is_within(each, late)]


def floor_of(name):
    return next((floor for floor in (*AI_FLOORS, *GAME_FLOORS) if is_within(name, {floor})), None)


def test_inside_ai_and_game_imports_run_down_only(subtests):
    for path in (*modules("ai"), *modules("game")):
        with subtests.test(name_of(path)):
            assert_imports_run_down(path)


def assert_imports_run_down(path):
    name, floors = name_of(path), [*AI_FLOORS, *GAME_FLOORS]
    if name in ("ai", "game"):
        assert not {each for each in imports(path) if is_within(each, {"ai", "game"})}
        return
    floor = floor_of(name)
    assert floor, f"{name} lies in no package of the floors: put it into one, or give it a floor"
    above = set(floors[floors.index(floor) + 1 :])
    everything = imports(path, types=name not in DESCRIBED_FROM_ABOVE)
    assert not {each for each in everything if is_within(each, above)}, f"{name} imports from above {floor}"


def test_no_modules_import_each_other_in_a_circle():
    names = {name_of(path): path for path in (*modules("engine"), *modules("ai"), *modules("game"))}

    def module_of(name):
        while name and name not in names:
            name = name.rpartition(".")[0]
        return name

    below = {
        name: {module_of(each) for each in imports(path, types=False)} - {name, ""} for name, path in names.items()
    }
    while leaves := {name for name, those in below.items() if not those & below.keys()}:
        below = {name: those for name, those in below.items() if name not in leaves}
    assert not below, "these import each other, or what does"


def test_only_the_game_imports_pygame():
    others = [*PROGRAM, *modules("engine"), *modules("ai")]
    assert not [name_of(path) for path in others if {name.split(".")[0] for name in imports(path)} & PYGAME]


def test_main_imports_the_game_only_when_it_is_played():
    for path in PROGRAM:
        assert not [name for name in imports(path, everywhere=False) if is_within(name, {"game"})]


@pytest.mark.parametrize("folder", ["engine", "ai", "game", "tests"])
def test_benchmarks_are_imported_by_nothing_and_tests_by_tests_alone(folder):
    strangers = {"benchmarks"} | {"tests", "docs"} - {folder, "docs" * (folder == "tests")}
    found = {name_of(path): imports(path) for path in (*modules(folder), *PROGRAM)}
    assert not {name: each for name, those in found.items() for each in those if is_within(each, strangers)}


def loaded_by(names, suspects):
    """Which of the suspects are in memory after these modules have been imported, one after another."""
    program = f"""
import importlib, sys
for name in {names!r}:
    importlib.import_module(name)
    for suspect in {suspects!r} & set(sys.modules):
        sys.exit(f"{{name}} loads {{suspect}}")
"""
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False, timeout=300
    )
    return done.stderr


def test_importing_all_but_the_game_does_not_load_pygame():
    names = ["main", "engine", *(name for path in modules("ai") if (name := name_of(path)) not in EXTRA)]
    assert loaded_by(names, PYGAME | {"tqdm", "gymnasium", "torch"}) == ""


def test_the_engine_does_not_load_the_rest():
    assert loaded_by([name_of(path) for path in modules("engine")], {"ai", "game", "main"}) == ""
    assert loaded_by([name_of(path) for path in modules("ai/nn")], {"engine", "game", "ai.lander.environment"}) == ""
