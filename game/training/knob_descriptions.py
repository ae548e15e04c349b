"""Knobs of a training run, made from the field descriptions of its configuration."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import Field, asdict, dataclass, fields
from functools import cache
from typing import Any, Final, Literal

from ai.lander.rewards import RewardWeights
from ai.training.config import Config
from game.core import texts

KnobKind = Literal["slider", "switch", "words"]
REWARD: Final = "reward"  # the page of the reward weights
WEIGHTS: Final = "reward_weights"
_LADDER: Final = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)  # steps of a scale, times a power of ten
_SHARES: Final = (0.0, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0)  # factors of a weight's default
_COSTS: Final = (0.0, -0.01, -0.02, -0.03, -0.05, -0.1, -0.2, -0.3, -0.5, -1.0)  # for a weight whose default is 0
_FEW: Final = 32  # whole numbers that a track shows one by one, at most
_EVEN_STEPS: Final = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
_EVEN: Final = 20  # steps on an evenly spaced track, at most

Configuration = Any  # `ai.training.config.Config`, or another dataclass with fields described in the same way


@dataclass(frozen=True)
class KnobDescription:
    """Knob for one field of the configuration, or for one of its reward weights.

    Attributes:
        field: the field of the configuration that changes.
        part: name of the weight, if the field holds the reward weights.
        page: group of knobs it is shown in.
        live: whether it may change during a run.
        stops: its possible values, from left to right on its track, or those of its words.
        advice: what comes of too little and of too much of it, and what to watch; empty for some.

    """

    field: str
    part: str
    label: str
    help: str
    page: str
    live: bool
    kind: KnobKind
    stops: tuple[Any, ...]
    advice: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Unique name of the knob: the field, and the part after a dot."""
        return f"{self.field}.{self.part}" if self.part else self.field

    def read(self, config: Configuration) -> Any:
        """Return the knob's value in a configuration."""
        value = getattr(config, self.field)
        return getattr(value, self.part) if self.part else value

    def write(self, config: Configuration, value: Any) -> Configuration:
        """Return the configuration with another value; raises ValueError for an invalid one."""
        if self.part:
            value = RewardWeights(**{**asdict(config.reward_weights), self.part: value})
        return config.changed(**{self.field: value})


def knob_descriptions(of: type[Configuration] = Config) -> tuple[KnobDescription, ...]:
    """Return every knob of a configuration class, in the order of its fields."""
    return _described(of, texts.LANGUAGE)  # type: ignore[arg-type]


@cache
def _described(of: type[Configuration], language: str) -> tuple[KnobDescription, ...]:  # noqa: ARG001
    made = []
    for item in fields(of):
        if item.name == WEIGHTS:
            made += [_weight(part, bool(item.metadata["live"])) for part in fields(RewardWeights)]
        elif stops := _stops(item):
            described = item.metadata
            made.append(KnobDescription(item.name, "", label(item.name), texts.said(described["help"]),
                             described["group"], described["live"], _kind(item), stops,
                             texts.KNOB_ADVICE.get(item.name, ()) if of is Config else ()))  # fmt: skip
    return tuple(made)


def label(name: str) -> str:
    """Return the label of a field on the screen."""
    return texts.KNOBS.get(name, name.replace("_", " ").capitalize())


def figure(value: Any) -> str:
    """Format a value for the player."""
    if isinstance(value, bool):
        return texts.KNOB_SWITCH[value]
    if isinstance(value, tuple):
        return "×".join(map(str, value))
    if isinstance(value, str):
        return texts.KNOB_WORDS.get(value, value.replace("_", " "))
    if isinstance(value, float):
        written = f"{value:.6g}"
        return f"{value:.7f}".rstrip("0") if "e-" in written else written.replace("-", "−")
    return f"{value:,}".replace(",", "\u00a0").replace("-", "−")


def told(changes: Mapping[str, Any]) -> str:
    """Format changes for the player, given values by the names of knobs."""
    labels = {knob.name: knob.label for knob in knob_descriptions()}
    return ", ".join(f"{labels.get(name, name)} {figure(value)}" for name, value in changes.items())


def _kind(item: Field[Any]) -> KnobKind:
    if item.type == "bool":
        return "switch"
    return "words" if item.metadata["choices"] or isinstance(item.default, tuple) else "slider"


def _weight(part: Field[Any], live: bool) -> KnobDescription:
    default = float(getattr(RewardWeights(), part.name))
    stops = tuple(_rounded(share * default) for share in _SHARES) if default else _COSTS
    word, said, *advice = texts.KNOB_WEIGHTS.get(part.name, (part.name.capitalize(), ""))
    return KnobDescription(WEIGHTS, part.name, word, said, REWARD, live, "slider", stops, tuple(advice))


def _stops(item: Field[Any]) -> tuple[Any, ...]:
    """Return the values that a field's knob can take; empty if the field has no knob."""
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
    if not described["log"] and low >= 0.8 and high <= 1.0:  # a factor near 1: its distance from 1 matters
        return tuple(_rounded(1.0 - distance) for distance in reversed(_ladder(1.0 - high, 1.0 - low)))
    if described["log"] or default < low + (high - low) / 10:
        return tuple(_ladder(low, high))
    step = next(step for step in _EVEN_STEPS if (high - low) / step <= _EVEN + 1e-9)
    return tuple(_rounded(low + number * step) for number in range(round((high - low) / step) + 1))


def _whole_stops(low: int, high: int) -> tuple[int, ...]:
    if high - low <= _FEW:
        return tuple(range(low, high + 1))
    if high & (high - 1) == 0:  # if the upper end is a power of two, so are all stops
        return tuple(2**power for power in range((low - 1).bit_length(), high.bit_length()))
    return tuple(sorted({round(stop) for stop in _ladder(low, high)}))


def _ladder(low: float, high: float) -> list[float]:
    """Return a logarithmic scale 1, 1.5, 2, 3, 5, 7, 10, ... from low to high, both included; with 0 if low is 0."""
    least = low if low > 0 else high * 1e-4
    steps = (step * 10.0**power for power in range(-8, 9) for step in _LADDER)
    between = (_rounded(step) for step in steps if least * (1 + 1e-9) < step < high * (1 - 1e-9))
    return [_rounded(low), *between, _rounded(high)]


def _rounded(value: float) -> float:
    return float(f"{value:.6g}") + 0.0  # without a minus before 0


def pages(of: Iterable[KnobDescription]) -> list[str]:
    """Return the names of the pages, in the order of their first knobs."""
    return list(dict.fromkeys(knob.page for knob in of))
