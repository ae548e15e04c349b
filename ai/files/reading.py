"""Bounded reading of untrusted files.

Nothing that a file claims costs memory or time before it is checked: a reader opens ordinary files only, so that a
pipe cannot let it wait; looks at the size first; and compares the header of every array with what is expected before
it makes room for the numbers. What the system refuses, and what is no ordinary file or too large, is an OSError; what
makes no sense is a ValueError. Messages are short, whatever the file says.
"""

import errno
import json
import math
import os
import re
import stat
import sys
import zipfile
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, BinaryIO, Final

import numpy as np
import numpy.typing as npt

SMALL: Final = 4_000_000  # bytes; what a person may read is smaller
DEPTH: Final = 32  # lists in lists that a JSON file of ours may have
MOST: Final = 2**53  # of anything that is counted: up to here, floats know every whole number
_DIGITS: Final = 40  # of a whole number; a seed of 128 bits has 39
_DIRECTORY: Final = 1 << 16  # bytes that a zip archive's list of its members may take
_END: Final = 22  # bytes at the end of a zip archive that say where that list is
_HEADER: Final = 1 << 20  # bytes of a file of one array besides its numbers
_FLAGS: Final = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0)
_BROKEN: Final = (EOFError, MemoryError, NotImplementedError, RuntimeError, zipfile.BadZipFile, zlib.error)

# Characters that end a line, move the cursor or turn the order of writing around, and show nothing themselves.
CONTROLS: Final = re.compile("[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")

Expect = Callable[[str, tuple[int, ...], np.dtype[Any]], None]  # raises ValueError for an array not expected


def brief(text: object, most: int = 200) -> str:
    """Return a text in at most so many letters, the end left out."""
    said = str(text)
    return said if len(said) <= most else said[: most - 1] + "…"


def shown(value: object, most: int = 40) -> str:
    """Return a value as a message quotes it: in JSON's words, not Python's, and shortened, whatever a file may hold."""
    try:
        text = repr(value) if isinstance(value, str) else json.dumps(value, ensure_ascii=False, default=repr)
    except ValueError:  # an int of more than some 4,000 digits
        return "a number of very many digits"
    return brief(text, most)


def problem_in(error: Exception) -> str:
    """Return what is wrong with values that a file holds, for which reading them failed: not in Python's words."""
    if isinstance(error, KeyError):
        return f"{brief(error.args[0], 60)} is missing"
    if isinstance(error, TypeError):
        return "what it holds is of another kind than it should be"
    return brief((isinstance(error, OSError) and error.strerror) or error, 400)


# Bytes and text


@contextmanager
def _opened(path: str | Path, most: int | None = None) -> Iterator[BinaryIO]:
    """Open an ordinary file of at most so many bytes for reading; raises OSError for anything else."""
    try:
        file = open(path, "rb", opener=lambda name, flags: os.open(name, flags | _FLAGS))  # noqa: SIM115
    except ValueError as error:
        raise OSError(errno.EINVAL, "no file can have such a name", str(path)) from error
    with file:
        said = os.fstat(file.fileno())
        if not stat.S_ISREG(said.st_mode):
            raise OSError(errno.EINVAL, "is not an ordinary file", str(path))
        if most is not None and said.st_size > most:
            raise _too_large(path, most)
        yield file


def read_bytes(path: str | Path, most: int = SMALL) -> bytes:
    """Return what a file of at most so many bytes holds; raises OSError."""
    with _opened(path, most) as file:
        held = file.read(most + 1)
    if len(held) > most:  # it has grown, or lies about its size as the system's own files do
        raise _too_large(path, most)
    return held


def read_text(path: str | Path, most: int = SMALL) -> str:
    """Return the text in a file of at most so many bytes; raises OSError, or ValueError if it is no UTF-8."""
    return read_bytes(path, most).decode("utf-8")


def read_end(path: str | Path, most: int) -> str:
    """Return the text at the end of a file, at most so many bytes of it; raises OSError."""
    with _opened(path) as file:
        file.seek(max(0, file.seek(0, os.SEEK_END) - most))
        return file.read(most).decode(errors="replace")


def inside(folder: str | Path, name: str) -> Path:
    """Return the path of a part of a folder; raises OSError if a link there leads out of the folder."""
    path = Path(folder) / name
    if not Path(os.path.realpath(path)).is_relative_to(os.path.realpath(folder)):
        raise OSError(errno.ELOOP, "is a link that leads out of its folder", str(path))
    return path


def _too_large(path: str | Path, most: int) -> OSError:
    return OSError(errno.EFBIG, f"is larger than the {most:,} bytes that there can be", str(path))


# JSON


def read_json(path: str | Path, most: int = SMALL) -> Any:
    """Return what a JSON file says; raises OSError, or ValueError as `parse_json` does."""
    return parse_json(read_text(path, most))


def parse_json(text: str) -> Any:
    """Return what a JSON text says.

    Raises ValueError for what is no JSON, is nested more deeply than DEPTH, or has numbers that are not finite or
    endless.
    """
    try:
        value = _DECODER.decode(text)
        # In most files there are too few brackets for more than that, so nobody has to look how they are nested.
        too_deep = text.count("[") + text.count("{") > DEPTH and _depth(value) > DEPTH
    except RecursionError:
        too_deep = True
    if too_deep:
        raise ValueError("is nested too deeply")
    return value


def _depth(value: Any) -> int:
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else None
    return 0 if parts is None else 1 + max(map(_depth, parts), default=0)


def _whole(digits: str) -> int:
    if len(digits) > _DIGITS:
        raise ValueError(f"{brief(digits, 20)} is too large a number")
    return int(digits)


def _finite(digits: str) -> float:
    number = float(digits)
    if not math.isfinite(number):
        raise ValueError(f"{brief(digits, 20)} is no finite number")
    return number


_DECODER: Final = json.JSONDecoder(parse_int=_whole, parse_float=_finite, parse_constant=_finite)


def count_of(value: Any, least: int = 0, most: int = MOST) -> int:
    """Return a whole number that a file has given; raises ValueError if it is none, or out of range."""
    if type(value) is not int or not least <= value <= most:
        raise ValueError(f"{shown(value)} is no whole number from {least:,} to {most:,}")
    return value


def number_of(value: Any, least: float = -math.inf) -> float:
    """Return a finite number that a file has given, as it is; raises ValueError if it is none, or too small."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= sys.float_info.max:
        raise ValueError(f"{shown(value)} is no finite number")
    if value < least:
        raise ValueError(f"{shown(value)} is below {least:g}")
    return value


# Arrays


def read_array(path: str | Path, shape: tuple[int, ...], dtype: npt.DTypeLike) -> npt.NDArray[Any]:
    """Return the array of an `.npy` file, which is to have this shape and dtype: C-ordered, of this machine.

    Raises OSError, or ValueError if it holds another, or more or fewer bytes.
    """
    wanted, name = np.dtype(dtype), Path(path).name

    def expect(_: str, held: tuple[int, ...], kind: np.dtype[Any]) -> None:
        if (held, kind.name) != (shape, wanted.name):
            raise ValueError(f"{name} holds {described(held, kind)}, and should hold {described(shape, wanted)}")

    with _opened(path, math.prod(shape) * wanted.itemsize + _HEADER) as file:
        return _read_member(file, name, expect)


def array_like(
    template: npt.NDArray[Any], value: Any, name: str = "an array", *, finite: bool = True
) -> npt.NDArray[Any]:
    """Return a copy of an array that has the shape and dtype of another; raises ValueError if not.

    Its numbers must be finite, or else at least be numbers.
    """
    if not isinstance(value, np.ndarray) or (value.shape, value.dtype) != (template.shape, template.dtype):
        raise ValueError(f"{name} should hold {described(template.shape, template.dtype)}")
    if value.dtype.kind == "f" and (not np.isfinite(value).all() if finite else np.isnan(value).any()):
        raise ValueError(f"{name} holds numbers that are not finite")
    return value.copy()


def described(shape: tuple[int, ...], dtype: np.dtype[Any]) -> str:
    """Describe an array, as in "float32 [9, 128]"."""
    return brief(f"{dtype.name} {list(shape)}", 60)


def read_arrays(path: str | Path, most: int, expect: Expect) -> dict[str, npt.NDArray[Any]]:
    """Return the arrays of an `.npz` file of at most so many bytes, by name.

    `expect` is asked about each by its name, shape and dtype before room is made for it, and raises ValueError for
    what should not be there. Raises OSError, or ValueError for members that are encrypted, packed in a way that
    NumPy does not use, there twice, or longer than they say.
    """
    try:
        with _opened(path, most) as file:
            _check_directory(file)
            with zipfile.ZipFile(file) as archive:
                members = archive.infolist()
                found = {member.filename.removesuffix(".npy"): _unpack(archive, member, expect) for member in members}
    except _BROKEN as error:
        raise ValueError(f"is damaged: {brief(error) or type(error).__name__}") from error
    if len(found) != len(members):
        raise ValueError("holds two arrays of one name")
    return found


def _check_directory(file: BinaryIO) -> None:
    """Raise ValueError for an archive that does not end as NumPy's do, or whose list of members is a long one."""
    size = file.seek(0, os.SEEK_END)
    file.seek(max(0, size - _END - 20))
    locator, end = file.read(20), file.read()
    if size < _END + 20 or end[:4] != b"PK\5\6" or end[-2:] != b"\0\0" or locator[:4] == b"PK\6\7":
        raise ValueError("is no archive of arrays, or only a part of one")
    if int.from_bytes(end[12:16], "little") > _DIRECTORY:
        raise ValueError("holds too many arrays")


def _unpack(archive: zipfile.ZipFile, member: zipfile.ZipInfo, expect: Expect) -> npt.NDArray[Any]:
    name = brief(member.filename.removesuffix(".npy"), 60)
    if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise ValueError(f"{name} is packed in an unknown way")
    with archive.open(member) as file:
        return _read_member(file, name, expect)


def _read_member(file: IO[bytes], name: str, expect: Expect) -> npt.NDArray[Any]:
    """Read one array in NumPy's format, all that a file holds; see `read_arrays`."""
    try:
        version = np.lib.format.read_magic(file)
        reader = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}[version]
        shape, fortran, dtype = reader(file)
    except OSError:
        raise
    except Exception as error:  # a header is Python's own notation, and damage to it can surface as anything
        raise ValueError(f"{name} begins as no array does: {brief(error, 100)}") from error
    expect(name, shape, dtype)
    size = math.prod(shape) * dtype.itemsize
    held = file.read(size + 1)
    if len(held) != size:
        raise ValueError(f"{name} holds {'more' if len(held) > size else 'fewer'} bytes than the {size:,} it says")
    flat = np.frombuffer(held, dtype) if size else np.empty(0, dtype)
    return flat.reshape(shape, order="F" if fortran else "C").astype(dtype.newbyteorder("="), order="C")
