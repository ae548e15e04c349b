"""Build the app for the system that this runs on: a folder, and an archive of it."""

from __future__ import annotations

import argparse
import os
import platform
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from packaging_app import recipe
from packaging_app.archive import EPOCH, needed_glibc, pack, size, strip_python
from packaging_app.extras import add_extras, draw_icons, write_metadata
from packaging_app.licences import FOLDER, collect, libraries_in

SPEC = Path(__file__).parent / "tranquility.spec"


def main() -> int:
    """Build, and say how large each part is."""
    parser = argparse.ArgumentParser(prog="python -m packaging_app", description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--output", type=Path, default=Path("dist"), metavar="DIR", help="default: dist")
    arguments = parser.parse_args()
    if find_spec("PyInstaller") is None:
        print('PyInstaller is missing. Install it: pip install -e ".[app]"', file=sys.stderr)
        return 2
    archive = build(arguments.output.resolve())
    print(f"{archive}: {archive.stat().st_size / 1e6:.1f} MB")
    return 0


def build(output: Path) -> Path:
    """Build the folder and its archive in `output`; return the archive's path."""
    app = output / (f"{recipe.TITLE}.app" if sys.platform == "darwin" else recipe.TITLE)
    beside = app / "Contents" / "Resources" if sys.platform == "darwin" else app
    with TemporaryDirectory(prefix="tranquility-app-") as work:
        made = Path(work) / "made"
        draw_icons(made)
        write_metadata(made)
        _freeze(output, Path(work), made)
        add_extras(beside, made)
    strip_python(app)
    collect(recipe.PACKAGES, app, beside / FOLDER)
    if sys.platform == "darwin":  # what was added has broken the seal that PyInstaller had put on it
        subprocess.run(["codesign", "--force", "--deep", "--sign", "-", str(app)], check=True)
    _report(app)
    return pack(app, f"{recipe.NAME}-{recipe.version()}-{_system()}")


def _freeze(output: Path, work: Path, made: Path) -> None:
    """Let PyInstaller make the folder, in a process of its own: in one hash order, so that it does the same again."""
    shutil.rmtree(output / recipe.TITLE, ignore_errors=True)
    environment = os.environ | {
        "PYTHONHASHSEED": "0",
        "SOURCE_DATE_EPOCH": str(EPOCH),
        "TRANQUILITY_MADE": str(made),
    }
    command = [sys.executable, "-m", "PyInstaller", "--noconfirm", "--clean", "--log-level", "ERROR", "--distpath",
               str(output), "--workpath", str(work / "work"), str(SPEC)]  # fmt: skip
    subprocess.run(command, env=environment, cwd=recipe.ROOT, check=True)


def _report(app: Path) -> None:
    inner = app / "_internal" if (app / "_internal").is_dir() else app / "Contents" / "Frameworks"
    parts = [(size(path) if path.is_dir() else path.stat().st_size, path.name) for path in inner.iterdir()
             if not path.is_symlink()]  # fmt: skip
    for count, name in sorted(parts, reverse=True)[:12]:
        print(f"{count / 1e6:8.1f} MB  {name}")
    print(f"{size(app) / 1e6:8.1f} MB  in all, unpacked")
    if any(needs := needed_glibc(app)):
        print("It starts on Linux with glibc {}.{} or later.".format(*needs))
    for name, licence in libraries_in(app):
        if not licence:
            print(f"The licence of {name} is not known here: see packaging_app/licences.py", file=sys.stderr)


def _system() -> str:
    system = {"linux": "linux", "darwin": "macos", "win32": "windows"}.get(sys.platform, sys.platform)
    return f"{system}-{platform.machine().lower()}"


if __name__ == "__main__":
    sys.exit(main())
