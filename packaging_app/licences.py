"""The licences of all that is packed, collected from what is installed here."""

from __future__ import annotations

import re
import shutil
import sys
import sysconfig
from collections.abc import Iterable
from importlib.metadata import Distribution, distribution, packages_distributions
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from packaging_app.recipe import ROOT

FOLDER: Final = "LICENSES"
_TEXTS: Final = re.compile(r"(licen[cs]e|copying|notice|authors|sboms/)", re.IGNORECASE)
# Licences that lie beside what they are for, and not in its distribution's metadata.
_BESIDE: Final = {
    "font_manrope": ("files/OFL.txt",),
    "pygame_gui": ("data/licenses/FiraCode-LICENSE.txt", "data/licenses/NotoSans-LICENSE.txt"),
}
_LGPL: Final = Path(__file__).parent / "texts" / "LGPL-2.1.txt"  # pygame-ce's wheel has no text of it
_COPYLEFT: Final = "LGPL-2.1-or-later"
_GCC: Final = "GPL-3.0-or-later WITH GCC-exception-3.1"
# Shared libraries that come within the wheels, or from the system that the app is built on, by the start of the name.
LIBRARIES: Final = {
    "FLAC": "BSD-3-Clause", "SDL2": "Zlib", "Xau": "MIT", "brotli": "MIT", "bz2": "bzip2-1.0.6", "ffi": "MIT",
    "fluidsynth": _COPYLEFT, "freetype": "FTL", "gcc_s": _GCC, "gfortran": _GCC, "harfbuzz": "MIT", "jpeg": "IJG",
    "lzma": "0BSD", "mpg123": _COPYLEFT, "ogg": "BSD-3-Clause", "openjp2": "BSD-2-Clause", "opus": "BSD-3-Clause",
    "png": "libpng-2.0", "python": "PSF-2.0", "quadmath": _COPYLEFT, "scipy_openblas": "BSD-3-Clause",
    "sharpyuv": "BSD-3-Clause", "sndfile": _COPYLEFT, "stdc++": _GCC, "tiff": "libtiff", "vorbis": "BSD-3-Clause",
    "wavpack": "BSD-3-Clause", "webp": "BSD-3-Clause", "xcb": "MIT", "xmp": "MIT", "z": "Zlib", "zstd": "BSD-3-Clause",
}  # fmt: skip
_LIBRARY: Final = re.compile(r"^lib(.+?)(?:[-.]\w*)*\.(?:so|dylib)[\d.]*$")
_HEAD: Final = """What is packed with Tranquility, and under which licence; the texts lie beside this file.

Tranquility itself is under the MIT licence, LICENSE; the digits of MNIST in it are under CC BY-SA 3.0, MNIST.txt. The
libraries under the LGPL are files of their own in the folder of the program, and may be replaced by others of the same
interface.
"""


def collect(packages: Iterable[str], app: Path, folder: Path) -> None:
    """Write into a folder the licences of these packages, of Python, and of the libraries that lie in the app."""
    folder.mkdir(exist_ok=True)
    shutil.copy(ROOT / "LICENSE", folder / "LICENSE")
    shutil.copy(ROOT / "assets" / "mnist" / "README.txt", folder / "MNIST.txt")
    shutil.copy(_LGPL, folder / _LGPL.name)
    names = packages_distributions()
    distributions = sorted({names[package][0] for package in packages} | {"pyinstaller"})
    rows = [_python(folder), *(_keep(distribution(name), folder) for name in distributions)]
    for package in packages:
        for file in _BESIDE.get(package, ()):
            spec = find_spec(package)
            assert spec is not None
            assert spec.origin is not None
            shutil.copy(Path(spec.origin).parent / file, folder / f"{package}-{Path(file).name}")
    libraries = [f"{name}: {licence or 'unknown'}" for name, licence in libraries_in(app)]
    lines = [_HEAD, *rows, "", "Shared libraries:", *libraries, ""]
    (folder / "README.txt").write_text("\n".join(lines), encoding="utf-8")


def libraries_in(app: Path) -> list[tuple[str, str]]:
    """Return the name and the licence of each shared library in the app, "" for one that is not known here."""
    paths = sorted({path.name for path in app.rglob("lib*") if _LIBRARY.match(path.name)})
    return [(name, _licence(name)) for name in paths]


def _licence(library: str) -> str:
    stem = library.removeprefix("lib")
    found = [name for name in LIBRARIES if re.match(rf"{re.escape(name)}(?![a-zA-Z])", stem)]
    found = found or [name for name in LIBRARIES if len(name) > 2 and stem.startswith(name)]
    return LIBRARIES[max(found, key=len)] if found else ""


def _keep(package: Distribution, folder: Path) -> str:
    """Copy the texts of a distribution's licence, or what it says of itself; return its line in the list."""
    own = folder / f"{package.name}-{package.version}"
    metadata = [file for file in package.files or () if ".dist-info/" in file.as_posix()]
    texts = [file for file in metadata if _TEXTS.search(file.as_posix().partition(".dist-info/")[2])]
    for file in texts or [file for file in metadata if file.name == "METADATA"]:
        target = own / file.as_posix().partition(".dist-info/")[2]
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(str(package.locate_file(file)), target)
    names = ("License-Expression", "License")
    said = next((package.metadata[name] for name in names if name in package.metadata), "")
    return f"{package.name} {package.version}: {said.splitlines()[0] if said else f'see {own.name}'}"


def _python(folder: Path) -> str:
    for place in (Path(sysconfig.get_path("stdlib")), Path(sys.base_prefix), Path(sys.base_prefix) / "Resources"):
        if (place / "LICENSE.txt").is_file():
            shutil.copy(place / "LICENSE.txt", folder / "Python-LICENSE.txt")
            return f"Python {sys.version.split()[0]}: PSF-2.0"
    raise FileNotFoundError("the licence of this Python: LICENSE.txt")
