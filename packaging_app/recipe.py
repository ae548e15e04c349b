"""What is packed, and what is left out."""

from __future__ import annotations

import tomllib
from importlib.metadata import packages_distributions
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parents[1]
NAME: Final = "tranquility"
TITLE: Final = "Tranquility"
ENTRY: Final = ROOT / "packaging_app" / "start.py"

OWN: Final = ("tranquility", "engine", "ai", "game")
# All that the game imports, and all that these import.
PACKAGES: Final = ("numpy", "pygame", "pygame_gui", "i18n", "font_manrope", "platformdirs", "filelock", "tqdm", "PIL")
_BUILDS: Final = ("PyInstaller", "_pyinstaller_hooks_contrib")  # at work while it is built

# Folders of data, and which files of them: each is found beside the packages, as in a checkout.
DATA: Final = {"assets": "**/*", "models": "**/*", "examples": "microlander.py", "game/locale": "**/*.mo"}
# Files of other packages: fonts and defaults that they open by themselves.
PACKAGE_DATA: Final = {
    "font_manrope": ("files/Manrope-*.ttf",),
    "pygame_gui": ("data/default_theme.json", "data/FiraCode-Regular.ttf", "data/NotoSans-Regular.ttf"),
    "pygame": ("pygame_icon.bmp", "freesansbold.ttf"),
}

# Parts of the standard library with libraries of their own that nothing here uses. hashlib, hmac and zipfile do
# without theirs.
_UNUSED_STANDARD: Final = (
    "tkinter", "_tkinter", "ssl", "_ssl", "_hashlib", "sqlite3", "_sqlite3", "readline", "curses", "_curses",
    "_curses_panel", "_gdbm", "_dbm", "lib2to3", "pydoc_data", "idlelib", "ensurepip",
)  # fmt: skip
# Formats of pictures that are neither read nor written, MIDI, cameras, compilers, and others' tests.
_UNUSED_PARTS: Final = (
    "PIL._avif", "PIL._imagingcms", "PIL._imagingft", "PIL._imagingtk", "PIL._webp", "PIL.ImageTk", "PIL.ImageQt",
    "pygame._camera", "pygame.camera", "pygame.pypm", "pygame.midi", "pygame.tests", "pygame.examples", "pygame.docs",
    "numpy.f2py", "numpy.distutils",
)  # fmt: skip


def version() -> str:
    """Return the version in pyproject.toml."""
    return str(_project()["version"])


def distribution() -> str:
    """Return the name under which the version is looked for."""
    return str(_project()["name"])


def _project() -> dict[str, Any]:
    return dict(tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"])


def modules() -> list[str]:
    """Return every module of the program: scenes, chapters and commands are imported by names put together."""
    paths = (path.relative_to(ROOT) for package in OWN for path in sorted((ROOT / package).rglob("*.py")))
    return [".".join(path.with_suffix("").parts).removesuffix(".__init__") for path in paths]


def data_files() -> list[tuple[Path, Path]]:
    """Return each file of data, and the folder that it lies in within the app."""
    own = [path for folder, files in DATA.items() for path in sorted((ROOT / folder).glob(files)) if path.is_file()]
    found = [(path, path.parent.relative_to(ROOT)) for path in own]
    for package, patterns in PACKAGE_DATA.items():
        folder = _folder(package)
        paths = (path for pattern in patterns for path in sorted(folder.glob(pattern)))
        found += [(path, path.parent.relative_to(folder.parent)) for path in paths]
    return found


def excluded() -> list[str]:
    """Return the modules to leave out: all that is installed and not on the list above, and parts of what is."""
    kept = {*OWN, *PACKAGES, *_BUILDS}
    installed = {name for name in packages_distributions() if name.isidentifier()}
    return sorted({*(installed - kept), *_UNUSED_STANDARD, *_UNUSED_PARTS})


def _folder(package: str) -> Path:
    spec = find_spec(package)
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError(f"{package} is not installed")
    return Path(spec.origin).parent
