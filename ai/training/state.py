"""State of a run on disk: all that it goes on from, bit for bit, apart from the folder of its network.

A state is a tree of dicts; its leaves are arrays, or what JSON can hold. It is written whole into one archive, and
only the transitions of replay buffers lie in blocks beside that, each written once. Nothing is pickled, everything is
bounded, and all of it together takes at most `MOST` bytes. An archive is named after its moment, and the one before
is deleted only when the network's folder is of that moment too: whenever a process is killed, the two fit together.
"""

from __future__ import annotations

import io
import json
import secrets
import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ai.agent.replay import PrioritisedReplayBuffer, ReplayBuffer, Transition
from ai.files import (
    array_like,
    brief,
    count_of,
    inside,
    number_of,
    parse_json,
    problem_in,
    read_array,
    read_arrays,
    state_folder,
    write_bytes,
)
from ai.nn import ModelFormatError

BLOCK: Final = 1 << 13  # transitions
MOST: Final = 100_000_000  # bytes of a state, with the one before, which lasts until the new one stands
_TEXT: Final = "described"

State = dict[str, Any]


def rebuilt(template: Any, value: Any) -> Any:
    """Return a value from a file, if it is such a nested dict of arrays and numbers as `template`.

    Raises KeyError, TypeError or ValueError for anything else.
    """
    if isinstance(template, dict):
        return {name: rebuilt(part, value[name]) for name, part in template.items()}
    if isinstance(template, np.ndarray):
        return array_like(template, value, finite=False)
    if type(template) is not type(value):
        raise TypeError(f"{type(value).__name__} in place of {type(template).__name__}")
    return number_of(value)


class PreparedState(NamedTuple):
    """Copy of a state that can be written while training goes on."""

    name: str  # of its archive
    state: State
    blocks: dict[str, NDArray[np.uint8]]  # transitions that are not on the disk yet, by the names of their files


class StateWriter:
    """Writes the states of one run, one after another, to where they belong to its `folder`.

    `state` is the one that was read from there, if the run goes on: its blocks are there already.
    """

    def __init__(self, folder: Path, state: State | None = None) -> None:
        self.folder, self._folder = folder, state_folder(folder)
        self._token = secrets.token_hex(4)  # no two processes ever write blocks of one name
        self._written: dict[tuple[str, int], str] = {}  # files of blocks, by their buffers and numbers
        for name, saved in state["buffers"].items() if state else ():
            numbers = range((saved["added"] - saved["kept"]) // BLOCK, saved["added"] // BLOCK)
            self._written |= {(name, number): file for number, file in zip(numbers, saved["blocks"], strict=False)}

    def prepare(self, moment: int, state: State, buffers: Mapping[str, ReplayBuffer]) -> PreparedState:
        """Copy what is to be written of a state and of replay buffers, which may change from now on."""
        priorities = 16 * sum(len(each) for each in buffers.values() if isinstance(each, PrioritisedReplayBuffer))
        room = MOST - (MOST >> 5) - priorities
        saved, blocks = {}, dict[str, NDArray[np.uint8]]()
        for name, buffer in buffers.items():
            size = _packed(buffer).itemsize
            kept = min(len(buffer), max(0, room // size - BLOCK))
            room -= kept * size
            saved[name] = self._buffer_state(name, buffer, kept, blocks)
        return PreparedState(_name(moment), state | {"buffers": saved}, blocks)

    def _buffer_state(self, name: str, buffer: ReplayBuffer, kept: int, blocks: dict[str, NDArray[np.uint8]]) -> State:
        """Return the state of a buffer's newest transitions; add those blocks that are not on the disk yet."""
        oldest, whole = buffer.added - kept, buffer.added // BLOCK
        numbers = range(oldest // BLOCK, whole) if kept else range(0)
        for number in numbers:
            if (name, number) not in self._written:
                self._written[name, number] = file = f"{name}-{self._token}-{number}.npy"
                blocks[file] = _records(buffer, number * BLOCK, (number + 1) * BLOCK)
        state: State = {"start": buffer.start, "size": len(buffer), "added": buffer.added, "kept": kept}
        state["blocks"] = [self._written[name, number] for number in numbers]
        state["rest"] = _records(buffer, max(oldest, whole * BLOCK), buffer.added)
        if isinstance(buffer, PrioritisedReplayBuffer):
            rows = (buffer.start + np.arange(len(buffer) - kept, len(buffer))) % buffer.capacity
            state |= {"largest": buffer.largest, "priorities": buffer.priorities[rows]}
        return state

    def write(self, prepared: PreparedState) -> None:
        """Write a state; raises OSError if it cannot be."""
        try:
            for file, content in prepared.blocks.items():
                write_bytes(self._folder / file, _saved(np.save, content))
            write_bytes(self._folder / prepared.name, _archive(prepared.state))
        except OSError:
            self._written.clear()  # next time, all of them are written
            raise

    def clear(self, prepared: PreparedState | None) -> None:
        """Delete all files but those of a state, or all of them, once the run's folder is of its moment."""
        if prepared is None:
            shutil.rmtree(self._folder, ignore_errors=True)
            self._written.clear()
            return
        names = {prepared.name, *(file for saved in prepared.state["buffers"].values() for file in saved["blocks"])}
        with suppress(OSError):
            for path in self._folder.iterdir():
                if path.name not in names:
                    path.unlink()


def read_state(folder: str | Path, moment: int) -> State | None:
    """Read the state of a moment that lies beside a run's folder; None if there is none. Raises ModelFormatError."""
    left = MOST

    def expect(array: str, shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
        nonlocal left
        left -= dtype.itemsize * int(np.prod(shape, dtype=object))
        if left < 0 or dtype.kind not in "biuf":
            raise ValueError(f"{array} is not what a state has")

    with going_on(folder):
        try:
            arrays = read_arrays(inside(state_folder(folder), _name(moment)), MOST, expect)
        except FileNotFoundError:
            return None
        state = _tree(parse_json(arrays.pop(_TEXT).tobytes().decode()), arrays)
        if not isinstance(state, dict):
            raise ValueError("is no state")
        return state


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
        raise ModelFormatError(state_folder(folder), [said]) from error


def restore_buffer(folder: str | Path, buffer: ReplayBuffer, state: Any, num_actions: int) -> bool:
    """Fill an empty replay buffer from its state and the blocks; return whether it is as it was.

    Raises OSError, KeyError, TypeError or ValueError for what no such buffer can have been.
    """
    start, size = count_of(state["start"], 0, buffer.capacity - 1), count_of(state["size"], 0, buffer.capacity)
    added, kept = count_of(state["added"]), count_of(state["kept"], 0, size)
    if added < size:
        raise ValueError("fewer transitions were added than are held")
    oldest, whole, packed = added - kept, added // BLOCK, _packed(buffer)
    names = state["blocks"]
    if len(names) != (len(range(oldest // BLOCK, whole)) if kept else 0):
        raise ValueError("blocks of transitions are missing")
    rows = (start + np.arange(size - kept, size)) % buffer.capacity
    for number, name in enumerate(names, oldest // BLOCK):
        if Path(name).name != name or not name.endswith(".npy"):
            raise ValueError("is no name of a block")
        block = read_array(inside(state_folder(folder), name), (BLOCK, packed.itemsize), np.uint8)
        first = max(oldest, number * BLOCK)
        _fill(
            buffer, rows[first - oldest : (number + 1) * BLOCK - oldest], block[first - number * BLOCK :], num_actions
        )
    rest = array_like(np.empty((added - max(oldest, whole * BLOCK), packed.itemsize), np.uint8), state["rest"])
    _fill(buffer, rows[kept - len(rest) :], rest, num_actions)
    buffer.start, buffer.size, buffer.added = (start + size - kept) % buffer.capacity, kept, added
    if isinstance(buffer, PrioritisedReplayBuffer):
        priorities = array_like(np.empty(kept), state["priorities"], "priorities")
        if (priorities <= 0).any():
            raise ValueError("priorities are above 0")
        buffer.priorities[rows] = priorities
        buffer.largest = float(number_of(state["largest"], 0))
    return kept == size


def _name(moment: int) -> str:
    return f"state-{moment}.npz"


def _packed(buffer: ReplayBuffer) -> np.dtype[Any]:
    """Return the type of a transition on disk: nothing between its fields, and small numbers in few bytes."""
    features = buffer.transitions.state.shape[1]
    numbers = [("action", "<u2"), ("reward", "<f4"), ("terminal", "u1"), ("steps", "u1")]
    return np.dtype([("state", "<f4", features), ("next_state", "<f4", features), *numbers])


def _records(buffer: ReplayBuffer, first: int, last: int) -> NDArray[np.uint8]:
    """Return the transitions with these numbers, counted from the first ever added; zeros for those that are gone."""
    packed = np.zeros(last - first, _packed(buffer))
    oldest = buffer.added - len(buffer)
    held = max(first, oldest)
    rows = (buffer.start + np.arange(held - oldest, last - oldest)) % buffer.capacity
    taken = buffer.at(rows)
    for name, part in zip(Transition._fields, taken, strict=True):
        packed[name][held - first :] = part
    return packed.view(np.uint8).reshape(last - first, packed.itemsize)


def _fill(buffer: ReplayBuffer, rows: NDArray[np.intp], content: NDArray[np.uint8], num_actions: int) -> None:
    """Put packed transitions into rows of a buffer; raises ValueError for those that no run can have had."""
    records = np.ascontiguousarray(content).view(_packed(buffer)).reshape(len(rows))
    numbers = (records["state"], records["next_state"], records["reward"])
    if not all(np.isfinite(part).all() for part in numbers):
        raise ValueError("transitions hold numbers that are not finite")
    if (records["action"] >= num_actions).any() or (records["terminal"] > 1).any() or (records["steps"] < 1).any():
        raise ValueError("transitions hold what no decision is")
    for name, part in zip(Transition._fields, buffer.transitions, strict=True):
        part[rows] = records[name]


def _saved(save: Callable[..., Any], *arrays: NDArray[Any], **named: NDArray[Any]) -> bytes:
    content = io.BytesIO()
    save(content, *arrays, allow_pickle=False, **named)
    return content.getvalue()


def _archive(state: State) -> bytes:
    arrays: dict[str, NDArray[Any]] = {}
    text = json.dumps(_described(state, arrays))
    return _saved(np.savez, **{_TEXT: np.frombuffer(text.encode(), np.uint8)}, **arrays)


def _described(value: Any, arrays: dict[str, NDArray[Any]]) -> Any:
    """Return a tree with each array replaced by its name in the archive, {"array": name}."""
    if isinstance(value, np.ndarray):
        name = f"a{len(arrays)}"
        arrays[name] = value
        return {"array": name}
    if isinstance(value, dict):
        return {name: _described(part, arrays) for name, part in value.items()}
    return value


def _tree(value: Any, arrays: Mapping[str, NDArray[Any]]) -> Any:
    if isinstance(value, dict):
        if value.keys() == {"array"}:
            return arrays[value["array"]]
        return {name: _tree(part, arrays) for name, part in value.items()}
    return value
