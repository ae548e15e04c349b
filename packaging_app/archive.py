"""Finish a built folder: smaller libraries, what they need of the system, and one archive of it all."""

from __future__ import annotations

import gzip
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path
from typing import Final

# All files in an archive are of this time, so that the same files make the same archive: 1 January 2020, UTC.
EPOCH: Final = 1_577_836_800
_GLIBC: Final = re.compile(rb"\0GLIBC_(\d+)\.(\d+)(?=[\0.])")


def strip_python(app: Path) -> None:
    """Take debugging symbols out of Python's own libraries; those of the wheels are left as they were published."""
    if sys.platform != "linux" or shutil.which("strip") is None:
        return
    inner = app / "_internal"
    own = [*inner.glob("libpython*.so*"), *inner.glob("python3*/lib-dynload/*.so")]
    subprocess.run(["strip", "--strip-unneeded", *map(str, own)], check=True)


def needed_glibc(app: Path) -> tuple[int, int]:
    """Return the oldest version of the C library that everything in the app can be loaded with; (0, 0) elsewhere."""
    files = [path for path in app.rglob("*") if path.is_file() and not path.is_symlink()]
    binaries = [data for data in (path.read_bytes() for path in files) if data.startswith(b"\x7fELF")]
    found = {(int(major), int(minor)) for data in binaries for major, minor in _GLIBC.findall(data)}
    return max(found, default=(0, 0))


def size(folder: Path) -> int:
    """Return the bytes of all files in a folder."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file() and not path.is_symlink())


def pack(folder: Path, name: str) -> Path:
    """Pack a folder into one file beside it: a .zip on Windows, elsewhere a .tar.gz, which keeps modes and links."""
    if sys.platform == "win32":
        return _zip(folder, folder.parent / f"{name}.zip")
    path = folder.parent / f"{name}.tar.gz"
    with (
        path.open("wb") as file,
        gzip.GzipFile("", "wb", 9, file, EPOCH) as packed,
        tarfile.open(fileobj=packed, mode="w") as tar,
    ):
        for each in [folder, *sorted(folder.rglob("*"))]:
            tar.add(each, each.relative_to(folder.parent).as_posix(), recursive=False, filter=_same)
    return path


def _same(entry: tarfile.TarInfo) -> tarfile.TarInfo:
    """Forget who built it, and when."""
    entry.uid = entry.gid = 0
    entry.uname = entry.gname = ""
    entry.mtime = EPOCH
    entry.mode = 0o755 if entry.isdir() or entry.mode & 0o100 else 0o644
    return entry


def _zip(folder: Path, path: Path) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as packed:
        for each in sorted(folder.rglob("*")):
            if each.is_file():
                info = zipfile.ZipInfo(each.relative_to(folder.parent).as_posix(), (2020, 1, 1, 0, 0, 0))
                info.compress_type = zipfile.ZIP_DEFLATED
                packed.writestr(info, each.read_bytes())
    return path
