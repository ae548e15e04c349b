"""What the player has chosen for a training run: what holds, what waits for a new run, and the way back.

What may change while a run goes on changes at once. What takes a new run waits until it is applied or undone.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from ai.agent.config import PRESETS
from ai.agent.schedule import InForce, idle
from ai.common.knobs import Knobs
from ai.training.sabotage import SABOTAGES, sabotaged
from game.core import texts
from game.training.dials import Configuration, Dial, dials, figure, label

SEED: Final = "seed"
Named = tuple[str, str]  # a preset, and what it was sabotaged by or nothing


@dataclass(frozen=True)
class Family:
    """What there is to choose from for one kind of run.

    Attributes:
        dials: every knob.
        presets: configurations by name.
        words: what a preset is called, and a sentence about it, by its name.
        sabotages: the same of what can be taken away from a preset, if anything.
        idle: says of a configuration which settings change nothing in a new run, each with the one that decides that.
        seed_page: the page of knobs that the seed stands on.

    """

    dials: tuple[Dial, ...]
    presets: Mapping[str, Configuration]
    words: Mapping[str, tuple[str, str]]
    seed_page: str
    sabotages: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    idle: Callable[[Any], Mapping[str, str]] = Knobs.unused

    def config_of(self, named: Named) -> Configuration:
        """Return what a name stands for."""
        base, sabotage = named
        return sabotaged(self.presets[base], sabotage) if sabotage else self.presets[base]

    def nearest(self, config: Configuration) -> Named:
        """Return the preset, or the sabotage of one, with the fewest fields different; a preset if it is as near."""
        every: list[Named] = [(base, sabotage) for sabotage in ("", *self.sabotages) for base in self.presets]
        given = config.to_json()

        def distance(named: Named) -> int:
            other = self.config_of(named).to_json()
            return sum(given[name] != other[name] for name in given)

        return min(every, key=distance)

    def word(self, named: Named) -> str:
        """Return what the player reads for it."""
        base, sabotage = named
        return self.sabotages[sabotage][0] if sabotage else self.words.get(base, (base.capitalize(), ""))[0]

    def sentence(self, named: Named) -> str:
        """Return what there is to say about it."""
        base, sabotage = named
        return self.sabotages[sabotage][1] if sabotage else self.words.get(base, ("", ""))[1]


LANDER: Final = Family(
    tuple(dials()), PRESETS, texts.PRESETS, "lander", {name: texts.SABOTAGES[name] for name in SABOTAGES}, idle
)


class Tuning:
    """A configuration and a seed in the hands of the player.

    `on_change` hears of each knob that holds another value now, by name; `on_restart` is asked for a new run with
    what was applied.

    Attributes:
        config: what holds; what waits is not in it.
        seed: the same of the seed.
        draft: what the knobs show, with what waits.
        named: the preset, or the sabotage of one, that this is or began as.
        running: whether a run goes on.
        in_force: what acts in it at this moment, as it told last.
        problem: why the last value was refused.
        put_aside: what a preset has taken the place of, until the next change.

    """

    def __init__(
        self,
        config: Configuration,
        seed: int,
        on_change: Callable[[str, Any], None],
        on_restart: Callable[[Configuration, int], None],
        family: Family = LANDER,
    ) -> None:
        self.family = family
        self.dials = {dial.name: dial for dial in family.dials}
        self._on_change, self._on_restart = on_change, on_restart
        self.running = False
        self.in_force: InForce | None = None
        self.named, self.draft = family.nearest(config), config
        self.set_config(config, seed)

    def set_config(self, config: Configuration, seed: int) -> None:
        """Hold a configuration that came from elsewhere; nobody is told."""
        if config != self.draft:
            self.named = self.family.nearest(config)
        self._named_held = self.named
        self.config = self.draft = config
        self.seed = self.draft_seed = seed
        self.problem = ""
        self.put_aside: tuple[Configuration, Named] | None = None

    def set_running(self, running: bool) -> None:
        """A run has begun, or is over: without one, nothing has to wait."""
        self.running, self.put_aside, self.in_force = running, None, None
        if not running:
            self._hold(self.draft, self.draft_seed)

    @property
    def home(self) -> Configuration:
        """The preset that this began as, whole."""
        return self.family.presets[self.named[0]]

    @property
    def holds(self) -> Named:
        """What the run that goes on is called; what waits has no run yet."""
        return self._named_held if self.waiting else self.named

    @property
    def changed(self) -> bool:
        """Whether what holds is not what its name says."""
        return bool((self.config if self.waiting else self.draft) != self.family.config_of(self.holds))

    @property
    def waiting(self) -> list[str]:
        """Which knobs wait for a new run, by name."""
        return self._different(self.draft, self.config) + [SEED] * (self.draft_seed != self.seed)

    def now(self, name: str) -> float | None:
        """Return what acts at this moment of a run in place of a knob's value; None if that is the value."""
        return self.in_force.values.get(name) if self.in_force and name not in self.in_force.idle else None

    def idle(self, name: str) -> str:
        """Say why a knob changes nothing, and which one does; empty for one that does.

        A live knob is asked about for the run as it is, another one for the new run that it would take.
        """
        dial = self.dials[name]
        now = self.in_force.idle if self.in_force and dial.live else self.family.idle(self.draft)
        instead = now.get(dial.field)
        if instead is None:
            return ""
        if sentence := texts.KNOBS_IDLE.get(dial.field):
            return sentence
        value = figure(getattr(self.config if self.in_force and dial.live else self.draft, instead))
        return texts.KNOBS_IDLE_WITHOUT.format(other=label(instead), value=value)

    def turn(self, name: str, value: Any) -> None:
        """Turn a knob; an impossible value changes nothing, and `problem` says why."""
        self.problem, self.put_aside = "", None
        if name == SEED:
            self.draft_seed = value
            self._hold(self.config, self.seed if self.running else value)
            return
        dial = self.dials[name]
        try:
            draft = dial.write(self.draft, value)
            held = dial.write(self.config, value) if dial.live or not self.running else self.config
        except ValueError as error:
            self.problem = _in_words(str(error))
            return
        self.draft = draft
        self._hold(held, self.seed)

    def load(self, named: Named) -> None:
        """Take a preset or a sabotage whole; knobs that were turned can be had back."""
        aside = (self.draft, self.named) if self.draft != self.family.config_of(self.named) else None
        self.problem = ""
        self._propose(self.family.config_of(named), named)
        self.put_aside = None if self.waiting else aside

    def apply(self) -> None:
        """Ask for a new run with what waits."""
        self.config, self.seed, self._named_held = self.draft, self.draft_seed, self.named
        self._on_restart(self.config, self.seed)

    def undo(self) -> None:
        """Go back to what holds, or to what a preset has taken the place of."""
        aside, self.put_aside, self.problem = self.put_aside, None, ""
        if aside:
            self._propose(*aside)
        else:
            self.draft, self.draft_seed, self.named = self.config, self.seed, self._named_held

    def _propose(self, config: Configuration, named: Named) -> None:
        """Take a whole configuration: at once if that can be, or to wait for a new run."""
        self.draft, self.named = config, named
        if not self.running or all(self.dials[name].live for name in self._different(config, self.config)):
            self._hold(config, self.seed)

    def _hold(self, config: Configuration, seed: int) -> None:
        """Let these hold from now on, and tell of all that is different."""
        names = self._different(config, self.config)
        reseeded = seed != self.seed
        self.config, self.seed = config, seed
        if config == self.draft:
            self._named_held = self.named
        for name in names:
            self._on_change(name, self.dials[name].read(config))
        if reseeded:
            self._on_change(SEED, seed)

    def _different(self, a: Configuration, b: Configuration) -> list[str]:
        return [name for name, dial in self.dials.items() if dial.read(a) != dial.read(b)]


def _in_words(problem: str) -> str:
    """Call the fields in a message what the player calls them."""
    return re.sub(r"\b[a-z_]+\b", lambda found: texts.KNOBS.get(found[0], found[0]), problem)
