"""History of a training run: points of its curves, checkpoints, turned knobs and validations."""

from __future__ import annotations

import json
from collections.abc import Sequence
from copy import copy
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Annotated, Any, Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.normalizer import Normalizer
from ai.digits.training import DigitProgress
from ai.environment import Doubles, Floats
from ai.files import (
    MOST,
    Above,
    Count,
    OneOf,
    Sized,
    Within,
    inside,
    parse_json,
    problem_in,
    read_arrays,
    read_as,
)
from ai.files import described as array_said
from ai.lander.environment import NUM_ACTIONS, NUM_FEATURES
from ai.nn import ModelFormatError
from ai.run import Measured
from ai.training.config import Config
from ai.training.loop import PARTS, Progress

REVERTED: Final = "checkpoint"  # the name of the change that goes back to one
HISTORY_FILE: Final = "history.npz"
CAPACITY: Final = 4000  # points
MOST_CHECKPOINTS: Final = 200
_VERSION: Final = 1
_MOST_TEXT: Final = 1 << 22  # letters of what is said of the arrays
_MOST_VALUES: Final = 1 << 26  # numbers in all checkpoints together: 256 MB
_MOST_COLUMNS: Final = 1000


# What a run measures at each of its points, by name.
COLUMNS: Final = (*(item.name for item in fields(Progress)[:-1]), *PARTS)
DIGIT_COLUMNS: Final = tuple(item.name for item in fields(DigitProgress))


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """Network that flew at one moment of a run."""

    seconds: float
    decisions: int
    success: float
    values: Floats  # (parameters,) float32
    normalizer: dict[str, Any] | None = None  # of the observations, as Normalizer.to_json gives it

    def agent(self, config: Config) -> DeepQAgent:
        """Return an agent that flies as a lander's run did then; raises ValueError if it does not fit."""
        agent = DeepQAgent(NUM_FEATURES, NUM_ACTIONS, config)
        if agent.online.values.shape != self.values.shape:
            raise ValueError(
                f"the checkpoint has {len(self.values)} parameters, the network {len(agent.online.values)}"
            )
        self.restore(agent)
        agent.decisions = self.decisions
        return agent

    def restore(self, agent: DeepQAgent) -> None:
        """Restore the networks of an agent of its size; raises ValueError if its normalizer makes no sense."""
        normalizer = None
        if self.normalizer is not None:
            normalizer = Normalizer(agent.num_features)
            try:
                normalizer.load(self.normalizer)
            except (KeyError, TypeError) as error:
                raise ValueError(f"the checkpoint's scale of observations: {problem_in(error)}") from error
        agent.restore(self.values, normalizer)


@dataclass(frozen=True)
class SettingChange:
    """Change of a knob during the run, or (REVERTED) a way back: `after` is then where to.

    `amends` says that it replaces the last change of that name: the values that a drag passes through act only
    for a moment, and only the last one counts.
    """

    decisions: Count
    name: str
    before: Any
    after: bool | int | float | str
    amends: bool = False
    seconds: float = field(default=0.0, compare=False)  # of training


@dataclass(frozen=True)
class Validation:
    """Validation of the network, by what is used neither to train nor to test it.

    Of an agent, flights without exploration; of a digit network, images, whose share read right is its `success`.
    """

    decisions: Count
    success: float
    mean_return: float
    best: bool  # of the run so far
    seconds: float = field(default=0.0, compare=False)  # of training


Entry = Measured | Checkpoint | SettingChange | Validation


@dataclass(frozen=True)
class _CheckpointFile:
    seconds: float
    decisions: Count
    success: float
    scale: dict[str, Any] | None


@dataclass(frozen=True)
class _HistoryFile:
    version: Annotated[int, OneOf((_VERSION,))]
    columns: Annotated[tuple[str, ...], Sized(_MOST_COLUMNS)]
    stride: Annotated[int, Within(1, MOST)]
    told: Count
    checkpoints: Annotated[tuple[_CheckpointFile, ...], Sized(MOST_CHECKPOINTS)]
    alterations: tuple[SettingChange, ...]
    validations: tuple[Validation, ...]
    reward_scale: Annotated[float, Above(0)]


class History:
    """History of a run, as charts show it. Memory is bounded: when full, every other point is dropped.

    `history["success_rate"]` is a column of the points, (n,); `history.parts` (n, len(PARTS)). Both are views: they
    are as the run was when asked for, until the next `append`.

    Attributes:
        columns: names of what the points measure, of one kind of run.
        reward_scale: size of one point of reward in the unit of `history["mean_q"]`, which is the network's own.

    """

    def __init__(self, columns: Sequence[str] = COLUMNS) -> None:
        self.columns = tuple(columns)
        self._number = {name: number for number, name in enumerate(columns)}
        self.checkpoints: list[Checkpoint] = []
        self.setting_changes: list[SettingChange] = []
        self.validations: list[Validation] = []
        self.reward_scale = 1.0
        self._table: Doubles = np.empty((CAPACITY, len(self.columns)))
        self._length = 0
        self._stride = 1  # how many points appended for one kept
        self._appended = 0

    def __len__(self) -> int:
        return self._length

    @property
    def points(self) -> Doubles:
        """All points, (n, columns)."""
        return self._table[: self._length]

    @property
    def parts(self) -> Doubles:
        """Points that each part of the reward has paid per flight, (n, len(PARTS))."""
        return self.points[:, -len(PARTS) :]

    def __getitem__(self, name: str) -> Doubles:
        """Return one column, (n,), by its name."""
        return self.points[:, self._number[name]]

    def append(self, entry: Entry) -> None:
        """Record an entry of any kind."""
        match entry:
            case Measured():
                self._append_point(entry)
            case Checkpoint():
                self._append_checkpoint(entry)
            case SettingChange():
                self._append_setting_change(entry)
            case Validation():
                self.validations.append(entry)

    def _append_point(self, point: Measured) -> None:
        # The latest point is always the last row; the next takes its place, unless its number is on the stride.
        if self._length == 0 or (self._appended - 1) % self._stride == 0:
            if self._length == CAPACITY:
                kept = self._table[::2].copy()
                self._length, self._stride = len(kept), 2 * self._stride
                self.points[...] = kept
            self._length += 1
        self._table[self._length - 1] = point.values
        self._appended += 1

    def _append_setting_change(self, entry: SettingChange) -> None:
        if entry.amends:
            last = next((each for each in reversed(self.setting_changes) if each.name == entry.name), None)
            if last is not None:  # else there is nothing to amend: it stands for itself
                self.setting_changes.remove(last)
                entry = replace(entry, before=last.before)
            entry = replace(entry, amends=False)
        if entry.before != entry.after:  # otherwise the knob is back where it was
            self.setting_changes.append(entry)

    def _append_checkpoint(self, checkpoint: Checkpoint) -> None:
        self.checkpoints.append(checkpoint)
        if len(self.checkpoints) > MOST_CHECKPOINTS:
            moments = np.array([each.decisions for each in self.checkpoints])
            # The one whose neighbours are closest together is the least missed.
            del self.checkpoints[1 + int((moments[2:] - moments[:-2]).argmin())]

    def row_at(self, decisions: float) -> int:
        """Return the number of the point nearest to a moment, the earlier of two; there must be one."""
        return int(np.abs(self["decisions"] - decisions).argmin())

    def checkpoint_at(self, decisions: float) -> Checkpoint | None:
        """Return the last checkpoint up to that moment, or the first; None without any."""
        earlier = [checkpoint for checkpoint in self.checkpoints if checkpoint.decisions <= decisions]
        return earlier[-1] if earlier else self.checkpoints[0] if self.checkpoints else None

    def copy(self) -> History:
        """Return one that stays as it is while this one goes on; the checkpoints' networks are shared."""
        twin = copy(self)
        vars(twin).update({name: copy(value) for name, value in vars(self).items()})
        return twin

    def write(self, folder: Path) -> None:
        """Write the history into a run's folder; raises OSError if it cannot be written."""
        checkpoints = [
            {"seconds": each.seconds, "decisions": each.decisions, "success": each.success, "scale": each.normalizer}
            for each in self.checkpoints
        ]
        described = {
            "version": _VERSION, "columns": self.columns, "reward_scale": self.reward_scale, "checkpoints": checkpoints,
            "stride": self._stride, "told": self._appended,
            "alterations": [asdict(change) for change in self.setting_changes],
            "validations": [asdict(validation) for validation in self.validations],
        }  # fmt: skip
        values = np.array([each.values for each in self.checkpoints] or np.empty((0, 0)), dtype=np.float32)
        text = np.array(json.dumps(described, allow_nan=False))
        np.savez(folder / HISTORY_FILE, allow_pickle=False, described=text, points=self.points, values=values)

    @classmethod
    def read(cls, folder: str | Path, columns: Sequence[str] = COLUMNS) -> History:
        """Read what `write` wrote; a run saved without a history has an empty one. Raises ModelFormatError."""
        history = cls(columns)
        try:
            arrays = read_arrays(inside(folder, HISTORY_FILE), _MOST_VALUES * 4 + _MOST_TEXT * 8, _expect)
            described = read_as(_HistoryFile, parse_json(str(arrays["described"])))
            history._restore(described, arrays["points"], arrays["values"])
            history.reward_scale = described.reward_scale
        except FileNotFoundError:
            return cls(columns)
        except (OSError, ValueError, KeyError, TypeError, ArithmeticError) as error:
            raise ModelFormatError(folder, [f"{HISTORY_FILE}: {problem_in(error)}"]) from error
        return history

    def _restore(self, described: _HistoryFile, points: Doubles, values: Floats) -> None:
        """Take over what was read; raises KeyError, TypeError or ValueError where it makes no sense."""
        if described.columns != self.columns:
            raise ValueError("its curves are of another kind of run, or of another version")
        if points.ndim != 2 or points.shape[1] != len(self.columns) or len(points) > CAPACITY:
            raise ValueError(f"points of shape {points.shape}")
        self._length, self._stride, self._appended = len(points), described.stride, described.told
        if self._appended < self._length:
            raise ValueError(f"{self._length} points of {self._appended}, at a stride of {self._stride}")
        self.points[...] = points
        if not np.isfinite(values).all():
            raise ValueError("checkpoints that are not finite")
        for saved, row in zip(described.checkpoints, values, strict=True):
            if saved.scale is not None:
                Normalizer(len(saved.scale["mean"])).load(saved.scale)  # raises for one that makes no sense
            self.checkpoints.append(Checkpoint(saved.seconds, saved.decisions, saved.success, row, saved.scale))
        self.setting_changes = list(described.alterations)
        self.validations = list(described.validations)


def _expect(name: str, shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
    """Raise ValueError for an array that no history has."""
    rows, columns = shape if len(shape) == 2 else (-1, -1)
    few = 0 <= rows <= MOST_CHECKPOINTS and columns >= 0 and rows * columns <= _MOST_VALUES
    fits = {
        "described": shape == () and dtype.kind == "U" and dtype.itemsize <= 4 * _MOST_TEXT,
        "points": 0 <= rows <= CAPACITY and 0 <= columns <= _MOST_COLUMNS and dtype == np.float64,
        "values": few and dtype == np.float32,
    }
    if not fits.get(name):
        raise ValueError(f"{name} is not what a history has: {array_said(shape, dtype)}")
