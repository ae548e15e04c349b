"""Settings of a training run: values in effect, changes that wait for a new run, and undo.

Live settings change at once. A change that needs a new run waits until it is applied or undone.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from ai.files.knobs import Knobs
from ai.training.config import PRESETS, Config, InForce, idle
from ai.training.experiments import SABOTAGES, sabotaged
from game.core import texts
from game.training.knob_descriptions import Configuration, KnobDescription, figure, knob_descriptions, label

SEED: Final = "seed"
Named = tuple[str, str]  # a preset, and a sabotage or ""


@dataclass(frozen=True)
class RunKind:
    """Choices for one kind of run: knobs, presets and sabotages.

    Attributes:
        of: the class of configurations.
        presets: configurations by name.
        words: returns the label of each preset, and a sentence about it, by its name.
        sabotages: names of the parts that can be taken away from a preset.
        idle: returns which settings of a configuration have no effect in a new run, each with the one that causes it.
        seed_page: the page of knobs that shows the seed.
        first: names of the few knobs to begin with; without them, all are shown.

    """

    of: type[Configuration]
    presets: Mapping[str, Configuration]
    words: Callable[[], Mapping[str, tuple[str, str]]]
    seed_page: str
    sabotages: tuple[str, ...] = ()
    idle: Callable[[Any], Mapping[str, str]] = Knobs.unused
    first: tuple[str, ...] = ()

    @property
    def knob_descriptions(self) -> tuple[KnobDescription, ...]:
        """Every knob."""
        return knob_descriptions(self.of)

    def config_of(self, named: Named) -> Configuration:
        """Return the configuration of a preset or a sabotage."""
        base, sabotage = named
        return sabotaged(self.presets[base], sabotage) if sabotage else self.presets[base]

    def nearest(self, config: Configuration) -> Named:
        """Return the preset, or sabotage of one, that differs in the fewest fields; of equals, the preset."""
        every: list[Named] = [(base, sabotage) for sabotage in ("", *self.sabotages) for base in self.presets]
        given = config.to_json()

        def distance(named: Named) -> int:
            other = self.config_of(named).to_json()
            return sum(given[name] != other[name] for name in given)

        return min(every, key=distance)

    def word(self, named: Named) -> str:
        """Return the label of a preset or a sabotage."""
        base, sabotage = named
        return texts.SABOTAGES[sabotage][0] if sabotage else self.words().get(base, (base.capitalize(), ""))[0]

    def sentence(self, named: Named) -> str:
        """Return the sentence about a preset or a sabotage."""
        base, sabotage = named
        return texts.SABOTAGES[sabotage][1] if sabotage else self.words().get(base, ("", ""))[1]


LANDER: Final = RunKind(
    Config,
    PRESETS,
    lambda: texts.PRESETS,
    "lander",
    tuple(SABOTAGES),
    idle,
    ("learning_rate", "epsilon_end", "discount"),
)


class RunSettings:
    """Configuration and seed that the player can change.

    `on_change` is called with the name and value of each setting that changes in effect; `on_restart` with the
    configuration and seed of a new run, when changes are applied.

    Attributes:
        config: configuration in effect, without waiting changes.
        seed: seed in effect.
        draft: configuration that the knobs show, with waiting changes.
        named: the preset, or sabotage of one, that the draft is or started from.
        running: whether a run goes on.
        in_force: effective values, from the run's latest message.
        problem: why the last value was refused.
        put_aside: the draft that a preset has replaced, until the next change.

    """

    def __init__(
        self,
        config: Configuration,
        seed: int,
        on_change: Callable[[str, Any], None],
        on_restart: Callable[[Configuration, int], None],
        run_kind: RunKind = LANDER,
    ) -> None:
        self.run_kind = run_kind
        self.knob_descriptions = {knob.name: knob for knob in run_kind.knob_descriptions}
        self._on_change, self._on_restart = on_change, on_restart
        self.running = False
        self.in_force: InForce | None = None
        self.named, self.draft = run_kind.nearest(config), config
        self.set_config(config, seed)

    def set_config(self, config: Configuration, seed: int) -> None:
        """Set the configuration and the seed, without calling `on_change`."""
        if config != self.draft:
            self.named = self.run_kind.nearest(config)
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

    def now(self, name: str) -> float | None:
        """Return the value in effect at this moment, such as a schedule's; None if it is the knob's own."""
        return self.in_force.values.get(name) if self.in_force and name not in self.in_force.idle else None

    def idle(self, name: str) -> str:
        """Return a sentence why a knob has no effect, and which knob causes that; empty if it has an effect.

        A live knob is judged for the current run, any other for the new run that it would need.
        """
        knob = self.knob_descriptions[name]
        now = self.in_force.idle if self.in_force and knob.live else self.run_kind.idle(self.draft)
        instead = now.get(knob.field)
        if instead is None:
            return ""
        if sentence := texts.KNOBS_IDLE.get(knob.field):
            return sentence
        value = figure(getattr(self.config if self.in_force and knob.live else self.draft, instead))
        return texts.KNOBS_IDLE_WITHOUT.format(other=label(instead), value=value)

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
