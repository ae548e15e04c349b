"""One reader for files that anybody may have made.

It takes regular files alone, inside their folder and within a size; JSON with finite numbers; arrays without pickled
objects, of a shape that is checked. What the system refuses, and what is no regular file or too large, is an OSError;
what makes no sense is a ValueError. Messages are short, whatever the file says.
"""

import errno
import json
import math
import os
import re
import stat
import sys
import zipfile
from pathlib import Path
from typing import Any, BinaryIO, Final

import numpy as np
import numpy.typing as npt

SMALL: Final = 4_000_000  # bytes; what a person may read is smaller
MOST: Final = 2**53  # of anything that is counted: up to here, floats know every whole number
_HEADER: Final = 1 << 20  # bytes of a file of one array besides its numbers

# Characters that end a line, move the cursor or turn the order of writing around, and show nothing themselves.
CONTROLS: Final = re.compile("[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")


def brief(text: object, most: int = 200) -> str:
    """Return a text in at most so many letters, the end left out."""
    said = str(text)
    return said if len(said) <= most else said[: most - 1] + "…"


def shown(value: object, most: int = 40) -> str:
    """Return a value as a message quotes it: in JSON's words, not Python's, and shortened, whatever a file may hold."""
    try:
        text = repr(value) if isinstance(value, str) else json.dumps(value, ensure_ascii=False, default=repr)
    except (ValueError, RecursionError):  # an int of more than some 4,000 digits, or lists in lists without end
        return "something very large"
    return brief(text, most)


def problem_in(error: Exception) -> str:
    """Return what is wrong with values that a file holds, for which reading them failed: not in Python's words."""
    if isinstance(error, KeyError):
        return f"{brief(error.args[0], 60)} is missing"
    if isinstance(error, TypeError):
        return "what it holds is of another kind than it should be"
    return brief((isinstance(error, OSError) and error.strerror) or error, 400)


# Bytes and text


def _open(path: str | Path, most: int) -> BinaryIO:
    """Open a regular file of at most so many bytes for reading; raises OSError for anything else."""
    said = Path(path).stat()  # before it is opened: a pipe would wait for its writer
    if not stat.S_ISREG(said.st_mode):
        raise OSError(errno.EINVAL, "is not an ordinary file", str(path))
    _check_size(path, said.st_size, most)
    return Path(path).open("rb")


def _check_size(path: str | Path, size: int, most: int) -> None:
    if size > most:
        raise OSError(errno.EFBIG, f"is larger than the {most:,} bytes that there can be", str(path))


def read_bytes(path: str | Path, most: int = SMALL) -> bytes:
    """Return what a file of at most so many bytes holds; raises OSError."""
    with _open(path, most) as file:
        return file.read(most)


def read_text(path: str | Path, most: int = SMALL) -> str:
    """Return the text in a file of at most so many bytes; raises OSError, or ValueError if it is no UTF-8."""
    return read_bytes(path, most).decode("utf-8")


def read_end(path: str | Path, most: int) -> str:
    """Return the text at the end of a file, at most so many bytes of it; raises OSError."""
    with _open(path, MOST) as file:
        file.seek(max(0, file.seek(0, os.SEEK_END) - most))
        return file.read(most).decode(errors="replace")


def inside(folder: str | Path, name: str) -> Path:
    """Return the path of a part of a folder; raises OSError if a link there leads out of the folder."""
    path = Path(folder) / name
    if not Path(os.path.realpath(path)).is_relative_to(os.path.realpath(folder)):
        raise OSError(errno.ELOOP, "is a link that leads out of its folder", str(path))
    return path


# JSON


def read_json(path: str | Path, most: int = SMALL) -> Any:
    """Return what a JSON file says; raises OSError, or ValueError as `parse_json` does."""
    return parse_json(read_text(path, most))


def parse_json(text: str) -> Any:
    """Return what a JSON text says; raises ValueError for what is none, or has numbers that are not finite."""
    try:
        return json.loads(text, parse_float=_finite, parse_constant=_finite)
    except RecursionError:
        raise ValueError("is nested too deeply") from None


def _finite(digits: str) -> float:
    number = float(digits)
    if not math.isfinite(number):
        raise ValueError(f"{brief(digits, 20)} is no finite number")
    return number


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
    """Return the array of an `.npy` file, which is to have this shape and dtype and finite numbers, in C order.

    Raises OSError, or ValueError if it holds another.
    """
    wanted = np.empty(shape, dtype)
    return array_like(wanted, _load(path, wanted.nbytes + _HEADER), "it")


def read_arrays(path: str | Path, most: int) -> dict[str, npt.NDArray[Any]]:
    """Return the arrays of an `.npz` file of at most so many bytes, unpacked, by name.

    Raises OSError, or ValueError for what is no such file, or damaged.
    """
    arrays = _load(path, most)
    if isinstance(arrays, np.ndarray):
        raise ValueError("is no archive of arrays")
    return arrays


def _load(path: str | Path, most: int) -> npt.NDArray[Any] | dict[str, npt.NDArray[Any]]:
    """Return the array, or the arrays by name, of a file of NumPy's that has at most so many bytes, unpacked as well.

    Raises OSError, or ValueError for anything else.
    """
    with _open(path, most) as file:
        try:
            if zipfile.is_zipfile(file):
                _check_size(path, sum(each.file_size for each in zipfile.ZipFile(file).infolist()), most)
            file.seek(0)
            held = np.load(file, allow_pickle=False)
            return held if isinstance(held, np.ndarray) else dict(held)
        except OSError:
            raise
        except Exception as error:  # NumPy and zipfile raise whatever damage leads them to
            raise ValueError("holds no arrays that can be read, or is damaged") from error


def array_like(template: npt.NDArray[Any], value: Any, name: str) -> npt.NDArray[Any]:
    """Return a copy of an array of finite numbers that has the shape and dtype of another; raises ValueError if not."""
    if not isinstance(value, np.ndarray) or (value.shape, value.dtype) != (template.shape, template.dtype):
        wanted = brief(f"{template.dtype.name} {list(template.shape)}", 60)
        raise ValueError(f"{name} should hold {wanted}")
    if value.dtype.kind == "f" and not np.isfinite(value).all():
        raise ValueError(f"{name} holds numbers that are not finite")
    return value.copy()
