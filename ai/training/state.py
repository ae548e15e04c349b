"""State of a run on disk: what it goes on from that its folder does not hold, such as its memory.

One archive of arrays and a text in JSON, in a hidden folder beside the run's. It is named after its moment, and the one
before is deleted only when the run's folder is of that moment too: whenever a process is killed, the two fit together.
"""

from __future__ import annotations

import io
import json
import math
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.files import brief, inside, parse_json, problem_in, read_arrays, state_folder, write_bytes
from ai.nn import ModelFormatError

MOST: Final = 100_000_000  # bytes of a state; of a larger memory, the newest part is kept
_SLACK: Final = 1 << 20  # bytes of an archive beside its numbers
_VERSION: Final = 2
_TEXT: Final = "described"

State = dict[str, Any]  # arrays, and what JSON can hold, by name


def write_state(folder: Path, moment: int, state: State) -> None:
    """Write the state of a moment to where it belongs to a run's folder, whole or not at all; raises OSError."""
    arrays = {name: part for name, part in state.items() if isinstance(part, np.ndarray)}
    said = {"version": _VERSION} | {name: part for name, part in state.items() if name not in arrays}
    text, content = json.dumps(said, allow_nan=False).encode(), io.BytesIO()
    np.savez(content, allow_pickle=False, **{_TEXT: np.frombuffer(text, np.uint8)}, **arrays)
    write_bytes(_path(folder, moment), content.getvalue())


def clear_states(folder: Path, but: int | None) -> None:
    """Delete what lies beside a run's folder, but the state of one moment, once the folder itself is of that."""
    if but is None:
        shutil.rmtree(state_folder(folder), ignore_errors=True)
        return
    with suppress(OSError):
        for path in state_folder(folder).iterdir():
            if path != _path(folder, but):
                path.unlink()


def read_state(folder: str | Path, moment: int) -> State | None:
    """Read the state of a moment that lies beside a run's folder; None if there is none. Raises ModelFormatError."""
    with going_on(folder):
        path = _path(folder, moment)
        try:
            arrays = read_arrays(inside(path.parent, path.name), MOST + _SLACK, _expect)
        except FileNotFoundError:
            return None
        said = parse_json(arrays.pop(_TEXT).tobytes().decode())
        if not isinstance(said, dict) or said.get("version") != _VERSION:
            raise ValueError(f"{path.name} was saved by another version, and is left as it is")
        return arrays | said


@contextmanager
def going_on(folder: str | Path) -> Iterator[None]:
    """Raise ModelFormatError, with the way out, for errors of what goes on from the state beside a run's folder."""
    try:
        yield
    except ModelFormatError:
        raise
    except (OSError, KeyError, TypeError, AttributeError, ValueError, ArithmeticError) as error:
        file = f"{Path(error.filename).name}: " if isinstance(error, OSError) and error.filename else ""
        said = f"{file}{brief(problem_in(error), 100)}; without this folder, the run goes on with an empty memory"
        raise ModelFormatError(state_folder(folder), said) from error


def _path(folder: str | Path, moment: int) -> Path:
    return state_folder(folder) / f"state-{moment}.npz"


def _expect(name: str, shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
    if dtype.kind not in "biuf" or dtype.itemsize * math.prod(shape) > MOST:
        raise ValueError(f"{name} is not what a state has")
