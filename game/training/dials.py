"""The knobs of a training run, made from what its configuration says of its own fields."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import Field, asdict, dataclass, fields
from functools import cache
from typing import Any, Final, Literal

from ai.agent.config import Config
from ai.lander.rewards import RewardWeights
from game.core import texts

Kind = Literal["slider", "switch", "words"]
REWARD: Final = "reward"  # the page of the parts of the reward
WEIGHTS: Final = "weights"
_LADDER: Final = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)  # times a power of ten
_SHARES: Final = (0.0, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0)  # of a weight's default
_COSTS: Final = (0.0, -0.01, -0.02, -0.03, -0.05, -0.1, -0.2, -0.3, -0.5, -1.0)  # for a part that is not paid yet
_FEW: Final = 32  # whole numbers that a track holds one by one
_EVEN_STEPS: Final = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
_EVEN: Final = 20  # steps on an even track, at the most

Configuration = Any  # `ai.agent.config.Config` or another dataclass of fields described like its own


@dataclass(frozen=True)
class Dial:
    """One knob: a field of the configuration, or one part of its reward weights.

    Attributes:
        field: the field of the configuration that changes.
        part: which of the weights, if that field is the weights.
        page: the group it is shown with.
        live: whether it may change while a run goes on.
        stops: the values it stops at, from the left end of its track to the right, or the words' values.

    """

    field: str
    part: str
    label: str
    help: str
    page: str
    live: bool
    kind: Kind
    stops: tuple[Any, ...]

    @property
    def name(self) -> str:
        """What it is called among other knobs: the field, and the part after a dot."""
        return f"{self.field}.{self.part}" if self.part else self.field

    def read(self, config: Configuration) -> Any:
        """Return the value it has in a configuration."""
        value = getattr(config, self.field)
        return getattr(value, self.part) if self.part else value

    def write(self, config: Configuration, value: Any) -> Configuration:
        """Return the configuration with another value; raises ValueError for an impossible one."""
        if self.part:
            value = RewardWeights(**{**asdict(config.weights), self.part: value})
        return config.changed(**{self.field: value})


def dials(of: type[Configuration] = Config) -> list[Dial]:
    """Return every knob there is of a class of configurations, in the order in which it has them."""
    made = []
    for item in fields(of):
        if item.name == WEIGHTS:
            made += [_weight(part, bool(item.metadata["live"])) for part in fields(RewardWeights)]
        elif stops := _stops(item):
            described = item.metadata
            made.append(Dial(item.name, "", label(item.name), described["help"], described["group"],
                             described["live"], _kind(item), stops))  # fmt: skip
    return made


def label(name: str) -> str:
    """Return what a field is called on the screen."""
    return texts.KNOBS.get(name, name.replace("_", " ").capitalize())


def figure(value: Any) -> str:
    """Write a value as the player reads it."""
    if isinstance(value, bool):
        return texts.KNOB_SWITCH[value]
    if isinstance(value, tuple):
        return "×".join(map(str, value))
    if isinstance(value, str):
        return texts.KNOB_WORDS.get(value, value.replace("_", " "))
    if isinstance(value, float):
        written = f"{value:.6g}"
        return f"{value:.7f}".rstrip("0") if "e-" in written else written.replace("-", "−")
    return f"{value:,}".replace(",", "\u2009").replace("-", "−")


def told(changes: Mapping[str, Any]) -> str:
    """Write what changes as the player reads it, given values by the names of dials."""
    return ", ".join(f"{_labels().get(name, name)} {figure(value)}" for name, value in changes.items())


@cache
def _labels() -> dict[str, str]:
    return {dial.name: dial.label for dial in dials()}


def _kind(item: Field[Any]) -> Kind:
    if item.type == "bool":
        return "switch"
    return "words" if item.metadata["choices"] or isinstance(item.default, tuple) else "slider"


def _weight(part: Field[Any], live: bool) -> Dial:
    default = float(getattr(RewardWeights(), part.name))
    stops = tuple(_rounded(share * default) for share in _SHARES) if default else _COSTS
    words = texts.KNOB_WEIGHTS.get(part.name, (part.name.capitalize(), ""))
    return Dial(WEIGHTS, part.name, *words, REWARD, live, "slider", stops)


def _stops(item: Field[Any]) -> tuple[Any, ...]:
    """Return the values a field may take on a knob; none if it is not to be turned."""
    described, default = item.metadata, item.default
    low, high = described["low"], described["high"]
    if stops := described["choices"] or described["offers"]:
        return tuple(stops)
    if item.type == "bool":
        return (False, True)
    if low is None:
        return ()
    if item.type == "int":
        return _whole_stops(int(low), int(high))
    if not described["log"] and low >= 0.8 and high <= 1.0:  # a factor: what matters is how far from 1 it is
        return tuple(_rounded(1.0 - distance) for distance in reversed(_ladder(1.0 - high, 1.0 - low)))
    if described["log"] or default < low + (high - low) / 10:
        return tuple(_ladder(low, high))
    step = next(step for step in _EVEN_STEPS if (high - low) / step <= _EVEN + 1e-9)
    return tuple(_rounded(low + number * step) for number in range(round((high - low) / step) + 1))


def _whole_stops(low: int, high: int) -> tuple[int, ...]:
    if high - low <= _FEW:
        return tuple(range(low, high + 1))
    if high & (high - 1) == 0:  # a power of two, and so is all below it
        return tuple(2**power for power in range((low - 1).bit_length(), high.bit_length()))
    return tuple(sorted({round(stop) for stop in _ladder(low, high)}))


def _ladder(low: float, high: float) -> list[float]:
    """Return 1, 1.5, 2, 3, 5, 7, 10 and so on from low to high, both included; 0 if low is 0."""
    least = low if low > 0 else high * 1e-4
    steps = (step * 10.0**power for power in range(-8, 9) for step in _LADDER)
    between = (_rounded(step) for step in steps if least * (1 + 1e-9) < step < high * (1 - 1e-9))
    return [_rounded(low), *between, _rounded(high)]


def _rounded(value: float) -> float:
    return float(f"{value:.6g}") + 0.0  # and no minus before a 0


def pages(of: Iterable[Dial]) -> list[str]:
    """Return the names of the pages, in the order in which their knobs first come."""
    return list(dict.fromkeys(dial.page for dial in of))
