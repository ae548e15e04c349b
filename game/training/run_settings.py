"""Settings of a training run: what is asked for by its knobs, and how settings are written.

Live settings change at once. What needs a new run waits until one is started, or it is undone.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import fields, replace
from operator import attrgetter
from typing import Any, Final

from ai.training.experiments import differences, named
from game.core import texts
from game.core.catalogue import capital
from game.training.run import TrainingRun
from game.training.run_kind import Configuration

WEIGHTS: Final = "reward_weights"


def label(name: str) -> str:
    """Return the label of a setting on the screen."""
    name, _, part = name.partition(".")
    return capital(texts.REWARD_PARTS[part][0]) if part else texts.KNOBS.get(name, name.replace("_", " ").capitalize())


def help_of(of: type[Configuration], name: str) -> str:
    """Return the plain line about a setting of a class of configurations."""
    name, _, part = name.partition(".")
    if part:
        return texts.REWARD_PARTS[part][1]
    return texts.said(next(field.metadata["help"] for field in fields(of) if field.name == name))


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
    """Format changes for the player, given values by the names of settings."""
    return ", ".join(f"{label(name)} {figure(value)}" for name, value in changes.items())


class RunSettings:
    """What the player asks for, beside the configuration in force, which is the run's.

    Attributes:
        asked: the configuration that the knobs show.
        problem: why the last value was refused.

    """

    def __init__(self, run: TrainingRun, asked: Configuration) -> None:
        self._run, self.asked, self.problem = run, asked, ""

    @property
    def in_force(self) -> Configuration:
        """The run's configuration; without a run, what is asked for."""
        return self._run.config if self._run.alive else self.asked

    @property
    def preset(self) -> str:
        """Name of the preset that this configuration is, or began as; of an unknown one, the first."""
        presets, (name, _) = self._run.kind.presets, named(self.asked)
        return name if name in presets else next(iter(presets))

    @property
    def changed(self) -> bool:
        """Whether it differs from its preset."""
        return bool(self.asked != self._run.kind.presets[self.preset])

    @property
    def waits(self) -> bool:
        """Whether something is asked for that takes a new run."""
        in_force = self.in_force
        return self.asked != in_force and not all(map(self.is_live, differences(in_force, self.asked)))

    def is_live(self, name: str) -> bool:
        """Whether a setting may change while a run goes on."""
        return name.partition(".")[0] in self._run.kind.of.live_names()

    def read(self, name: str) -> Any:
        """Return what is asked for of a setting."""
        return attrgetter(name)(self.asked)

    def turn(self, name: str, value: Any) -> None:
        """Ask for a value of a setting; an invalid one changes nothing, and `problem` says why."""
        self.problem = ""
        whole, _, part = name.partition(".")
        try:
            now = getattr(self.asked, whole)
            self.asked = self.asked.changed(**{whole: replace(now, **{part: value}) if part else value})
        except ValueError as error:
            self.problem = re.sub(r"\b[a-z_]+\b", lambda found: texts.KNOBS.get(found[0], found[0]), str(error))
            return
        if self.is_live(name):
            self._run.ask("change", name, value)

    def load(self, preset: str) -> None:
        """Ask for a preset: at once if a run can change so, else for a new one."""
        self.ask(self._run.kind.presets[preset])
        if not self.waits:
            for name, (_, value) in differences(self.in_force, self.asked).items():
                self._run.ask("change", name, value)

    def ask(self, config: Configuration) -> None:
        """Ask for a whole configuration, such as that of a run that goes on; the run is not told."""
        self.asked, self.problem = config, ""

    def undo(self) -> None:
        """Ask for what is in force."""
        self.ask(self.in_force)
