"""History of a training run: points of its curves, checkpoints, turned knobs and validations.

On disk, curves are a table that any program opens, `curves.csv`.
"""

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
from ai.files.reading import MOST, inside, problem_in, read_arrays, read_json, read_text
from ai.files.schema import Count, Sized, Within, read_as
from ai.lander.environment import NUM_ACTIONS, NUM_FEATURES
from ai.nn import ModelFormatError
from ai.run import Measured
from ai.training.config import Config
from ai.training.loop import PARTS, Progress

REVERTED: Final = "checkpoint"  # the name of the change that goes back to one
HISTORY_FILE: Final = "history.json"
CURVES_FILE: Final = "curves.csv"
CHECKPOINTS_FILE: Final = "checkpoints.npz"
CAPACITY: Final = 4000  # points
MOST_CHECKPOINTS: Final = 200
_VERSION: Final = 2
_TURNING: Final = 1.0  # seconds of training between two changes of a knob that is still being turned
_MOST_VALUES: Final = 1 << 26  # numbers in all checkpoints together: 256 MB
_SLACK: Final = 1 << 20  # bytes of an archive beside its numbers
# What a run measures at each of its points, by name.
COLUMNS: Final = (*(item.name for item in fields(Progress)[:-1]), *PARTS)
DIGIT_COLUMNS: Final = tuple(item.name for item in fields(DigitProgress))


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """Network that flew at one moment of a run."""

    seconds: float
    decisions: Count
    success: float
    values: Floats = field(default_factory=lambda: np.empty(0, np.float32))  # (parameters,) float32
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
    """Change of a knob during the run, or (REVERTED) a way back: `after` is then where to."""

    decisions: Count
    name: str
    before: Any
    after: bool | int | float | str
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
class _HistoryFile:
    version: int
    stride: Annotated[int, Within(1, MOST)]
    appended: Count
    reward_scale: Annotated[float, Within(1e-4, 1)]
    checkpoints: Annotated[tuple[Checkpoint, ...], Sized(MOST_CHECKPOINTS)]
    changes: tuple[SettingChange, ...]
    validations: tuple[Validation, ...]


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
        last = next((each for each in reversed(self.setting_changes) if each.name == entry.name), None)
        if last and entry.name != REVERTED and entry.seconds - last.seconds < _TURNING:
            # Values that a drag passes through act only for a moment, and only the last one counts.
            self.setting_changes.remove(last)
            entry = replace(entry, before=last.before)
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
            {name: part for name, part in vars(checkpoint).items() if name != "values"}
            for checkpoint in self.checkpoints
        ]
        described = {
            "version": _VERSION, "stride": self._stride, "appended": self._appended, "reward_scale": self.reward_scale,
            "checkpoints": checkpoints, "changes": [asdict(change) for change in self.setting_changes],
            "validations": [asdict(validation) for validation in self.validations],
        }  # fmt: skip
        (folder / HISTORY_FILE).write_text(json.dumps(described, allow_nan=False) + "\n", encoding="utf-8")
        rows = (",".join(map(repr, row)) for row in self.points.tolist())
        (folder / CURVES_FILE).write_text("\n".join([",".join(self.columns), *rows]) + "\n", encoding="utf-8")
        values = np.array([each.values for each in self.checkpoints] or np.empty((0, 0)), dtype=np.float32)
        np.savez(folder / CHECKPOINTS_FILE, allow_pickle=False, values=values)

    @classmethod
    def read(cls, folder: str | Path, columns: Sequence[str] = COLUMNS) -> History:
        """Read what `write` wrote; a run saved without a history has an empty one. Raises ModelFormatError."""
        history, file = cls(columns), HISTORY_FILE
        try:
            described = read_json(inside(folder, file))
            if not isinstance(described, dict) or described.get("version") != _VERSION:
                raise ValueError("was saved by another version, and is left as it is")
            history._restore(read_as(_HistoryFile, described))
            file = CURVES_FILE
            history._restore_points(read_text(inside(folder, file)).splitlines())
            file = CHECKPOINTS_FILE
            history._restore_networks(read_arrays(inside(folder, file), 4 * _MOST_VALUES + _SLACK)["values"])
        except FileNotFoundError as error:
            if file == HISTORY_FILE:
                return cls(columns)
            raise ModelFormatError(folder, f"{file} is missing") from error
        except (OSError, ValueError, KeyError, TypeError, ArithmeticError) as error:
            raise ModelFormatError(folder, f"{file}: {problem_in(error)}") from error
        return history

    def _restore(self, described: _HistoryFile) -> None:
        self._stride, self._appended, self.reward_scale = described.stride, described.appended, described.reward_scale
        self.setting_changes, self.validations = list(described.changes), list(described.validations)
        self.checkpoints = list(described.checkpoints)  # without their networks, which are in a file of their own
        for scale in (each.normalizer for each in self.checkpoints if each.normalizer is not None):
            Normalizer(len(scale["mean"])).load(scale)  # raises for one that makes no sense

    def _restore_points(self, lines: list[str]) -> None:
        """Take over the lines of a table; raises ValueError where it makes no sense."""
        if not lines or tuple(lines[0].split(",")) != self.columns:
            raise ValueError("its curves are of another kind of run, or of another version")
        self._length = len(lines) - 1
        if not self._length <= min(self._appended, CAPACITY):
            raise ValueError(f"{self._length} points of {self._appended}, at a stride of {self._stride}")
        for row, line in enumerate(lines[1:]):
            numbers = line.split(",")
            if len(numbers) != len(self.columns):
                raise ValueError(f"{len(numbers)} numbers in line {row + 2}, of {len(self.columns)} columns")
            self.points[row] = numbers

    def _restore_networks(self, values: Floats) -> None:
        """Give the checkpoints their networks; raises ValueError where they do not fit."""
        if values.ndim != 2 or values.dtype != np.float32 or not np.isfinite(values).all():
            raise ValueError("its networks are no rows of finite numbers")
        pairs = zip(self.checkpoints, values, strict=True)
        self.checkpoints = [replace(checkpoint, values=row) for checkpoint, row in pairs]
