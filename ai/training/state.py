"""State of a run on disk: what it goes on from besides its networks, such as its memory.

One archive of arrays and a text in JSON in the run's folder. Without it, the networks fly all the same.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.files.folder import STATE_FILE
from ai.files.reading import inside, parse_json, read_arrays
from ai.nn.storage import reading

MOST: Final = 100_000_000  # bytes of a state; of a larger memory, the newest part is kept
_SLACK: Final = 1 << 20  # bytes of an archive beside its numbers
_VERSION: Final = 2
_TEXT: Final = "described"
GOING_ON: Final = f"{STATE_FILE}, without which the run goes on with an empty memory"  # what cannot be read, in words

State = dict[str, Any]  # arrays, and what JSON can hold, by name


def write_state(folder: Path, state: State) -> None:
    """Write a state into a run's new folder; raises OSError."""
    arrays = {name: part for name, part in state.items() if isinstance(part, np.ndarray)}
    said = {"version": _VERSION} | {name: part for name, part in state.items() if name not in arrays}
    text = np.frombuffer(json.dumps(said, allow_nan=False).encode(), np.uint8)
    np.savez(folder / STATE_FILE, allow_pickle=False, **{_TEXT: text}, **arrays)


def read_state(folder: str | Path) -> State | None:
    """Read the state in a run's folder; None if there is none. Raises ModelFormatError."""
    with reading(folder, GOING_ON):
        try:
            arrays = read_arrays(inside(folder, STATE_FILE), MOST + _SLACK)
        except FileNotFoundError:
            return None
        said = parse_json(arrays.pop(_TEXT).tobytes().decode())
        if not isinstance(said, dict) or said.get("version") != _VERSION:
            raise ValueError("was saved by another version, and is left as it is")
        return arrays | said
