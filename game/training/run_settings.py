"""Settings of a training run: its kind, the knobs that the fields of its configuration describe, and what they set.

Live settings change at once. A change that needs a new run waits until it is applied or undone.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import Field, asdict, dataclass, field, fields
from functools import cache
from operator import attrgetter
from typing import Any, Final, Literal

from ai.lander.rewards import RewardWeights
from ai.training.config import Config
from ai.training.experiments import named, sabotaged
from ai.training.history import History
from ai.training.session import Session
from game.core import texts
from game.core.catalogue import capital
from game.core.worker import PATIENCE

KnobKind = Literal["slider", "switch", "words"]
Named = tuple[str, str]  # a preset, and a sabotage or ""
SEED: Final = "seed"
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
    """Knob for one field of the configuration, or for one of its reward weights."""

    field: str  # of the configuration
    part: str  # name of the weight, if the field holds the reward weights
    label: str
    help: str
    live: bool  # whether it may change during a run
    kind: KnobKind
    stops: tuple[Any, ...]  # its possible values, from left to right on its track, or those of its words

    @property
    def name(self) -> str:
        """Unique name of the knob: the field, and the part after a dot."""
        return f"{self.field}.{self.part}" if self.part else self.field

    def read(self, config: Configuration) -> Any:
        """Return the knob's value in a configuration."""
        return attrgetter(self.name)(config)

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
            said = texts.said(described["help"])
            made.append(KnobDescription(item.name, "", label(item.name), said, described["live"], _kind(item), stops))
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


def format_changes(changes: Mapping[str, Any]) -> str:
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
    word, said = texts.REWARD_PARTS.get(part.name, (part.name, ""))
    return KnobDescription(WEIGHTS, part.name, capital(word), said, live, "slider", stops)


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


@dataclass(frozen=True)
class RunKind:
    """Kind of run: how it is started, and its knobs, presets and sabotages."""

    session: type[Session[Any]]  # leads it in a worker
    of: type[Configuration]
    presets: Mapping[str, Configuration]
    words: Callable[[], Mapping[str, tuple[str, str]]]  # the label of each preset, and a sentence about it
    first: tuple[str, ...]  # names of the few knobs to begin with
    page: tuple[str, ...]  # and of those on one page, on demand; all others are for `--set` of the command
    chapters: Mapping[str, str] = field(default_factory=dict)  # of Learn, by the names of the knobs they explain
    sabotages: tuple[str, ...] = ()  # parts that can be taken away from a preset
    # Values of the scheduled settings at the latest point of a run.
    in_force: Callable[[Configuration, History], dict[str, float]] = lambda *_: {}
    grace: float = 3.0  # seconds that a run has to end by itself when the window closes it
    patience: float = PATIENCE  # seconds for a turn of its worker

    @property
    def knob_descriptions(self) -> tuple[KnobDescription, ...]:
        """Every knob."""
        return knob_descriptions(self.of)

    def config_of(self, named: Named) -> Configuration:
        """Return the configuration of a preset or a sabotage."""
        base, sabotage = named
        return sabotaged(self.presets[base], sabotage) if sabotage else self.presets[base]

    def named(self, config: Configuration) -> Named:
        """Return the preset, or sabotage of one, that a configuration began as; of other names, the first preset."""
        base, sabotage = named(config)
        if base not in self.presets:
            return next(iter(self.presets)), ""
        return base, sabotage if sabotage in self.sabotages else ""

    def said(self, named: Named) -> tuple[str, str]:
        """Return the label of a preset or a sabotage, and a sentence about it."""
        base, sabotage = named
        label, sentence = texts.SABOTAGES[sabotage][:2] if sabotage else self.words()[base]
        return label, sentence


class RunSettings:
    """Configuration and seed that the player can change.

    `on_change` is called with the name and value of each setting that changes in effect ("reward_weights.time" for a
    part of the reward, "seed" for the seed); `on_restart` with the configuration and seed of a new run, when changes
    are applied.

    Attributes:
        config, seed: in effect, without waiting changes.
        draft, draft_seed: those that the knobs show.
        named: the preset, or sabotage of one, that the draft is or started from.
        in_force: effective values of the scheduled settings.
        problem: why the last value was refused.
        put_aside: the draft that a preset has replaced, until the next change.

    """

    def __init__(
        self,
        config: Configuration,
        seed: int,
        on_change: Callable[[str, Any], None],
        on_restart: Callable[[Configuration, int], None],
        run_kind: RunKind,
    ) -> None:
        self.run_kind = run_kind
        self.knob_descriptions = {knob.name: knob for knob in run_kind.knob_descriptions}
        self._on_change, self._on_restart = on_change, on_restart
        self.running = False
        self.in_force: dict[str, float] | None = None
        self.named, self.draft = run_kind.named(config), config
        self.set_config(config, seed)

    def set_config(self, config: Configuration, seed: int) -> None:
        """Set the configuration and the seed, without calling `on_change`."""
        if config != self.draft:
            self.named = self.run_kind.named(config)
        self._named_held = self.named
        self.config = self.draft = config
        self.seed = self.draft_seed = seed
        self.problem = ""
        self.put_aside: tuple[Configuration, Named] | None = None

    def set_running(self, running: bool) -> None:
        """Set whether a run goes on; without one, no change has to wait."""
        self.running, self.put_aside, self.in_force = running, None, None
        if not running:
            self._hold(self.draft, self.draft_seed)

    @property
    def home(self) -> Configuration:
        """Configuration of the preset that the draft started from."""
        return self.run_kind.presets[self.named[0]]

    @property
    def holds(self) -> Named:
        """Preset or sabotage of the current run, without waiting changes."""
        return self._named_held if self.waiting else self.named

    @property
    def changed(self) -> bool:
        """Whether the settings in effect differ from their preset or sabotage."""
        return bool((self.config if self.waiting else self.draft) != self.run_kind.config_of(self.holds))

    @property
    def waiting(self) -> list[str]:
        """Names of the knobs whose changes wait for a new run."""
        return self._different(self.draft, self.config) + [SEED] * (self.draft_seed != self.seed)

    def change(self, name: str) -> dict[str, str]:
        """Return what a setting is in effect, and what it is to be, in words."""
        if name == SEED:
            return {"before": figure(self.seed), "after": figure(self.draft_seed)}
        read = self.knob_descriptions[name].read
        return {"before": figure(read(self.config)), "after": figure(read(self.draft))}

    def now(self, name: str) -> float | None:
        """Return the value in effect at this moment, such as a schedule's; None if it is the knob's own."""
        return self.in_force.get(name) if self.in_force else None

    def turn(self, name: str, value: Any) -> None:
        """Set a knob; an invalid value changes nothing, and `problem` says why."""
        self.problem, self.put_aside = "", None
        if name == SEED:
            self.draft_seed = value
            self._hold(self.config, self.seed if self.running else value)
            return
        knob = self.knob_descriptions[name]
        try:
            draft = knob.write(self.draft, value)
            held = knob.write(self.config, value) if knob.live or not self.running else self.config
        except ValueError as error:
            self.problem = _in_words(str(error))
            return
        self.draft = draft
        self._hold(held, self.seed)

    def load(self, named: Named) -> None:
        """Load a preset or a sabotage; `undo` restores the knobs."""
        aside = (self.draft, self.named) if self.draft != self.run_kind.config_of(self.named) else None
        self.problem = ""
        self._propose(self.run_kind.config_of(named), named)
        self.put_aside = None if self.waiting else aside

    def apply(self) -> None:
        """Start a new run with the waiting changes."""
        self.config, self.seed, self._named_held = self.draft, self.draft_seed, self.named
        self._on_restart(self.config, self.seed)

    def undo(self) -> None:
        """Revert to the settings in effect, or to those that a preset has replaced."""
        aside, self.put_aside, self.problem = self.put_aside, None, ""
        if aside:
            self._propose(*aside)
        else:
            self.draft, self.draft_seed, self.named = self.config, self.seed, self._named_held

    def _propose(self, config: Configuration, named: Named) -> None:
        """Set a whole configuration: at once if possible, else to wait for a new run."""
        self.draft, self.named = config, named
        if not self.running or all(self.knob_descriptions[name].live for name in self._different(config, self.config)):
            self._hold(config, self.seed)

    def _hold(self, config: Configuration, seed: int) -> None:
        """Put a configuration and a seed into effect, and call `on_change` for each difference."""
        names = self._different(config, self.config)
        reseeded = seed != self.seed
        self.config, self.seed = config, seed
        if config == self.draft:
            self._named_held = self.named
        for name in names:
            self._on_change(name, self.knob_descriptions[name].read(config))
        if reseeded:
            self._on_change(SEED, seed)

    def _different(self, a: Configuration, b: Configuration) -> list[str]:
        if a == b:  # as nearly always; this is asked in every frame
            return []
        return [name for name, knob in self.knob_descriptions.items() if knob.read(a) != knob.read(b)]


def _in_words(problem: str) -> str:
    """Replace the names of fields in a message by their labels."""
    return re.sub(r"\b[a-z_]+\b", lambda found: texts.KNOBS.get(found[0], found[0]), problem)
