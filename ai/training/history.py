"""History of a training run: points of its curves, checkpoints, turned knobs and validations."""

from __future__ import annotations

import json
from collections.abc import Sequence
from copy import copy
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, NamedTuple

import numpy as np

from ai.agent.normalizer import Normalizer
from ai.common.environment import Doubles, Floats
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
    read_json,
)
from ai.files import described as array_said
from ai.lander.rewards import REWARDS
from ai.nn import ModelFormatError
from ai.training.config import Config

PARTS: Final = tuple(REWARDS)


class Column(NamedTuple):
    """What a run measures at each of its points.

    Attributes:
        name: as `History` has it.
        unit: of its numbers; empty for a plain number.
        help: what it is, in a few words.

    """

    name: str
    unit: str
    help: str


_SECONDS: Final = Column("seconds", "s", "training so far, pauses left out")
_LOSS: Final = Column("loss", "", "error of the last learning step")
COLUMNS: Final = (
    _SECONDS,
    Column("decisions", "", "decisions so far, of single landers"),
    Column("episodes", "", "flights that have ended"),
    Column("success", "share", "of the last hundred flights that landed, chance moves included"),
    Column("mean_return", "points", "earned by each of them, on average"),
    _LOSS,
    Column("mean_q", "scaled points", "what the network expects, on average"),
    Column("epsilon", "share", "of actions that are random"),
    Column("stage", "", "of the curriculum"),
    Column("steps_per_second", "1/s", "physics steps, of all landers"),
    Column("landed", "share", "of the last hundred flights"),  # the next ones too, in the order of Outcome
    Column("crashed", "share", "of the last hundred flights"),
    Column("out_of_bounds", "share", "of the last hundred flights"),
    Column("timed_out", "share", "of the last hundred flights"),
    *(Column(part, "points", "paid by this part of the reward per flight") for part in PARTS),
)
DIGIT_COLUMNS: Final = (
    _SECONDS,
    Column("step", "", "learning steps so far"),
    Column("epoch", "", "how often every image was seen"),
    _LOSS,
    Column("accuracy", "share", "of images read right as they were learnt from: bent, and with dropout"),
    Column("learning_rate", "", "how far a step moves the weights"),
    Column("images_per_second", "1/s", "learnt from"),
)
REVERTED: Final = "checkpoint"  # the name of the change that goes back to one
TURNING_SECONDS: Final = 1.0  # between two changes of a knob that is still being turned
HISTORY_FILE: Final = "history.npz"
CAPACITY: Final = 4000  # points
MOST_CHECKPOINTS: Final = 200
_VERSION: Final = 1
_MOST_TEXT: Final = 1 << 22  # letters of what is said of the arrays
_MOST_VALUES: Final = 1 << 26  # numbers in all checkpoints together: 256 MB
_MOST_COLUMNS: Final = 1000


@dataclass(frozen=True)
class Point:
    """Point of an agent's curves after one decision, with the numbers of `COLUMNS`.

    Unknown values are NaN: before the first flight has ended, and before the first learning step, which after a
    resumption waits for new memories.
    """

    may_thin: ClassVar = True  # of those not fetched yet, every other may be dropped

    seconds: float
    decisions: float
    episodes: float
    success: float
    mean_return: float
    loss: float
    mean_q: float
    epsilon: float
    stage: float
    steps_per_second: float
    landed: float = 0.0
    crashed: float = 0.0
    out_of_bounds: float = 0.0
    timed_out: float = 0.0
    parts: tuple[float, ...] = (0.0,) * len(PARTS)

    @property
    def values(self) -> tuple[float, ...]:
        """The numbers of `COLUMNS`."""
        *values, parts = vars(self).values()
        return (*values, *parts)


@dataclass(frozen=True)
class DigitPoint:
    """Point of a digit run's curves; loss and accuracy are means of the batches since the last point."""

    may_thin: ClassVar = True

    seconds: float
    step: int
    epoch: float
    loss: float
    accuracy: float
    learning_rate: float
    images_per_second: float

    @property
    def values(self) -> tuple[float, ...]:
        """The numbers of `DIGIT_COLUMNS`."""
        return tuple(vars(self).values())


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """Network that flew at one moment of a run; `ai.training.checkpoints.agent_of` makes an agent of it."""

    seconds: float
    decisions: int
    success: float
    values: Floats  # (parameters,) float32
    normalizer: dict[str, Any] | None = None  # of the observations, as Normalizer.to_json gives it


@dataclass(frozen=True)
class SettingChange:
    """Change of a knob during the run, or (REVERTED) a way back: `after` is then where to.

    `amends` says that it replaces the last change of that name: the values that a drag passes through act only
    for a moment, and only the last one counts.
    """

    decisions: Count
    name: str
    before: Any
    after: Any
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


# What a file holds of it


@dataclass(frozen=True)
class _CheckpointFile:
    seconds: float
    decisions: Count
    success: float
    scale: dict[str, Any] | None


@dataclass(frozen=True)
class _SettingChangeFile:
    decisions: Count
    name: str
    before: Any
    after: bool | int | float | str
    seconds: float = 0.0


@dataclass(frozen=True)
class _HistoryFile:
    version: Annotated[int, OneOf((_VERSION,))]
    columns: Annotated[tuple[str, ...], Sized(_MOST_COLUMNS)]
    stride: Annotated[int, Within(1, MOST)]
    told: Count
    checkpoints: Annotated[tuple[_CheckpointFile, ...], Sized(MOST_CHECKPOINTS)]
    alterations: tuple[_SettingChangeFile, ...]
    validations: tuple[Validation, ...]
    reward_scale: Annotated[float, Above(0)] | None = None  # None in files from before it was kept here


@dataclass(frozen=True)
class _RewardFile:
    reward_scale: Annotated[float, Above(0)]


@dataclass(frozen=True)
class _AgentFile:
    config: _RewardFile


Entry = Point | DigitPoint | Checkpoint | SettingChange | Validation


class History:
    """History of a run, as charts show it. Memory is bounded: when full, every other point is dropped.

    `history["success"]` is a column of the points, (n,); `history.parts` (n, len(PARTS)). Both are views: they
    are as the run was when asked for, until the next `append`.

    Attributes:
        columns: what the points measure, of one kind of run.
        reward_scale: size of one point of reward in the unit of `history["mean_q"]`, which is the network's own.

    """

    def __init__(self, columns: Sequence[Column] = COLUMNS) -> None:
        self.columns = tuple(columns)
        self._column = {each.name: number for number, each in enumerate(columns)}
        self.checkpoints: list[Checkpoint] = []
        self.setting_changes: list[SettingChange] = []
        self.validations: list[Validation] = []
        self.reward_scale = 1.0
        self._table: Doubles = np.empty((CAPACITY, len(self.columns)))
        self._length = 0
        self._stride = 1  # how many points told for one kept
        self._told = 0

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
        return self.points[:, self._column[name]]

    def append(self, entry: Entry) -> None:
        """Record an entry of any kind."""
        match entry:
            case Point() | DigitPoint():
                self._append_point(entry)
            case Checkpoint():
                self._append_checkpoint(entry)
            case SettingChange():
                self._append_setting_change(entry)
            case Validation():
                self.validations.append(entry)

    def _append_point(self, point: Point | DigitPoint) -> None:
        # The latest point is always the last row; the next takes its place, unless its number is on the stride.
        if self._length == 0 or (self._told - 1) % self._stride == 0:
            if self._length == CAPACITY:
                self._thin()
            self._length += 1
        self._table[self._length - 1] = point.values
        self._told += 1

    def _append_setting_change(self, entry: SettingChange) -> None:
        if entry.amends:
            last = next(each for each in reversed(self.setting_changes) if each.name == entry.name)
            self.setting_changes.remove(last)
            entry = replace(entry, before=last.before, amends=False)
        if entry.before != entry.after:  # otherwise the knob is back where it was
            self.setting_changes.append(entry)

    def _append_checkpoint(self, checkpoint: Checkpoint) -> None:
        self.checkpoints.append(checkpoint)
        if len(self.checkpoints) > MOST_CHECKPOINTS:
            moments = np.array([each.decisions for each in self.checkpoints])
            # The one whose neighbours are closest together is the least missed.
            del self.checkpoints[1 + int((moments[2:] - moments[:-2]).argmin())]

    def _thin(self) -> None:
        kept = self._table[: self._length : 2].copy()
        self._table[: len(kept)] = kept
        self._length = len(kept)
        self._stride *= 2

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
        twin._table = self._table.copy()
        twin.checkpoints, twin.setting_changes = self.checkpoints.copy(), self.setting_changes.copy()
        twin.validations = self.validations.copy()
        return twin

    def write(self, folder: Path) -> None:
        """Write the history into a run's folder; raises OSError if it cannot be written."""
        described = {
            "version": _VERSION, "columns": list(self._column), "reward_scale": self.reward_scale,
            "stride": self._stride, "told": self._told,
            "alterations": [_written(change) for change in self.setting_changes],
            "validations": [asdict(validation) for validation in self.validations],
            "checkpoints": [
                {"seconds": each.seconds, "decisions": each.decisions, "success": each.success,
                 "scale": each.normalizer}
                for each in self.checkpoints
            ],
        }  # fmt: skip
        values = [checkpoint.values for checkpoint in self.checkpoints]
        np.savez(
            folder / HISTORY_FILE,
            allow_pickle=False,
            described=np.array(json.dumps(described)),
            points=self.points,
            values=np.array(values, dtype=np.float32) if values else np.empty((0, 0), dtype=np.float32),
        )

    @classmethod
    def read(cls, folder: str | Path, columns: Sequence[Column] = COLUMNS) -> History:
        """Read what `write` wrote; a run saved without a history has an empty one. Raises ModelFormatError."""
        history = cls(columns)
        try:
            arrays = read_arrays(inside(folder, HISTORY_FILE), _MOST_VALUES * 4 + _MOST_TEXT * 8, _expect)
            described = read_as(_HistoryFile, parse_json(str(arrays["described"])))
            history._restore(described, arrays["points"], arrays["values"])
            history.reward_scale = described.reward_scale or _scale_beside(folder)
        except FileNotFoundError:
            return cls(columns)
        except OSError as error:
            raise ModelFormatError(folder, [f"{HISTORY_FILE}: {error.strerror or error}"]) from error
        except (ValueError, KeyError, TypeError, ArithmeticError) as error:
            raise ModelFormatError(folder, [f"{HISTORY_FILE}: {problem_in(error)}"]) from error
        return history

    def _restore(self, described: _HistoryFile, points: Doubles, values: Floats) -> None:
        """Take over what was read; raises KeyError, TypeError or ValueError where it makes no sense."""
        if points.ndim != 2 or points.shape[1] != len(described.columns) or len(points) > CAPACITY:
            raise ValueError(f"points of shape {points.shape}")
        self._length, self._stride, self._told = len(points), described.stride, described.told
        if self._told < self._length:
            raise ValueError(f"{self._length} points of {self._told}, at a stride of {self._stride}")
        # By name, so that a run from before a part was added can still be looked at.
        self.points[...] = 0.0
        for column, name in enumerate(described.columns):
            if name in self._column:
                self.points[:, self._column[name]] = points[:, column]
        if not np.isfinite(values).all():
            raise ValueError("checkpoints that are not finite")
        self.checkpoints = [
            _checkpoint(told, row.astype(np.float32)) for told, row in zip(described.checkpoints, values, strict=True)
        ]
        self.setting_changes = [_setting_change(told) for told in described.alterations]
        self.validations = list(described.validations)


def _expect(name: str, shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
    """Raise ValueError for an array that no history has."""
    fits = {
        "described": shape == () and dtype.kind == "U" and dtype.itemsize <= 4 * _MOST_TEXT,
        "points": len(shape) == 2 and shape[0] <= CAPACITY and 0 <= shape[1] <= _MOST_COLUMNS and dtype == np.float64,
        "values": len(shape) == 2
        and 0 <= shape[0] <= MOST_CHECKPOINTS
        and shape[1] >= 0
        and shape[0] * shape[1] <= _MOST_VALUES
        and dtype == np.float32,
    }
    if not fits.get(name):
        raise ValueError(f"{name} is not what a history has: {array_said(shape, dtype)}")


def _checkpoint(told: _CheckpointFile, values: Floats) -> Checkpoint:
    """Return a checkpoint of a file; raises KeyError, TypeError or ValueError for a scale that is none."""
    if told.scale is not None:
        Normalizer(len(told.scale["mean"])).load(told.scale)
    return Checkpoint(told.seconds, told.decisions, told.success, values, told.scale)


def _setting_change(told: _SettingChangeFile) -> SettingChange:
    """Return a setting change of a file; an older run has the names of its day."""
    name = Config.name_now(told.name)
    return SettingChange(told.decisions, name, told.before, told.after, seconds=told.seconds)


def _scale_beside(folder: str | Path) -> float:
    """Return the reward scale of the network beside a history from before it told its own; 1 if there is none."""
    try:
        return read_as(_AgentFile, read_json(inside(folder, "config.json"))).config.reward_scale
    except (OSError, ValueError):
        return 1.0


def _written(change: SettingChange) -> dict[str, Any]:
    """Return a setting change as a file holds it: `amends` only matters before it is in a history."""
    return {name: value for name, value in asdict(change).items() if name != "amends"}
