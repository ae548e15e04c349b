"""Panel of a run's settings: few knobs first and all on demand, presets, and what comes of turning them."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import partial
from typing import Any, Final, Literal

from ai.training.config import InForce
from game.core import texts
from game.drawing.cursor import Cursor
from game.drawing.tokens import HUMAN, LABEL, MUTE, NET, SMALL, TITLE
from game.input.controls import Command
from game.scenes.train.knob import KINDS, Knob, SeedKnob
from game.training.knob_descriptions import Configuration, figure, label, pages
from game.training.run_settings import LANDER, SEED, RunKind, RunSettings
from game.ui.form import Form
from game.ui.hints import Hint, HintRow
from game.ui.panel import Column

View = Literal["few", "all"]
_UNDERLINE: Final = 2.0


class KnobsPanel:
    """Rows of a panel of knobs; the scene lays them anew when `key` has changed.

    A knob that may change during a run takes effect at once. One that takes a new run waits, says so, and is applied
    or undone by the player.

    Args:
        form: the scene's form.
        config: configuration to begin with.
        seed: seed to begin with.
        on_change: called with the name and value of every knob that changes; during a run, only of those that may.
            Names are those of the configuration ("reward_weights.time" for a part of the reward, "seed" for the seed).
        on_restart: called with a configuration and seed for a new run, once the player has applied them.
        run_kind: the kind of run, with its presets and knobs.

    Attributes:
        every: whether all knobs are shown.

    """

    def __init__(
        self,
        form: Form,
        config: Configuration,
        seed: int,
        on_change: Callable[[str, Any], None],
        on_restart: Callable[[Configuration, int], None],
        run_kind: RunKind = LANDER,
    ) -> None:
        self._form, self._run_kind = form, run_kind
        self._run_settings = RunSettings(config, seed, on_change, on_restart, run_kind)
        self.pages = pages(run_kind.knob_descriptions)
        self.every = False
        self._page = 0
        self._knobs: dict[str, Knob | SeedKnob] = {}

    @property
    def config(self) -> Configuration:
        """The configuration in force, without changes that wait to be applied."""
        return self._run_settings.config

    @property
    def seed(self) -> int:
        """The seed of the configuration in force."""
        return self._run_settings.seed

    @property
    def name(self) -> str:
        """Displayed name of the preset or sabotage that this configuration is, or began as."""
        return self._run_kind.word(self._run_settings.holds)

    @property
    def changed(self) -> bool:
        """Whether the configuration in force differs from the preset or sabotage of that name."""
        return self._run_settings.changed

    @property
    def waiting(self) -> list[str]:
        """Names of the knobs that wait for a new run."""
        return self._run_settings.waiting

    @property
    def first(self) -> tuple[str, ...]:
        """Names of the few knobs to begin with; one that has no effect any more gives way to the one that acts."""
        spent = in_force.idle if (in_force := self._run_settings.in_force) else {}
        return tuple(dict.fromkeys(spent.get(name, name) for name in self._run_kind.first))

    @property
    def key(self) -> Hashable:
        """What decides which rows there are."""
        run_settings = self._run_settings
        asked = bool(run_settings.waiting), bool(run_settings.put_aside)
        return self.every, self._page, self.first, run_settings.holds, self.changed, asked

    # What the run says

    def set_running(self, running: bool) -> None:
        """Set whether a run goes on; without one, every knob takes effect at once."""
        if running != self._run_settings.running:
            self._run_settings.set_running(running)
            self.show()

    def show_in_force(self, in_force: InForce | None) -> None:
        """Show the values in force at this moment of a run beside the settings; None for none."""
        if in_force is not self._run_settings.in_force:
            self._run_settings.in_force = in_force
            self.show()

    def set_config(self, config: Configuration, seed: int) -> None:
        """Show a configuration from elsewhere, such as a loaded run, without calling `on_change` or `on_restart`."""
        self._run_settings.set_config(config, seed)
        self.show()

    def turn(self, name: str, value: Any) -> None:
        """Set a knob by its name, as if by hand; for an invalid value, the panel says why it is refused."""
        self._run_settings.turn(name, value)
        self.show()

    def show(self) -> None:
        """Show the current values in the knobs."""
        run_settings = self._run_settings
        waiting = run_settings.waiting
        for name, knob in self._knobs.items():
            if isinstance(knob, SeedKnob):
                knob.display(run_settings.draft_seed, waits=SEED in waiting)
                continue
            read = knob.description.read
            knob.display(
                read(run_settings.draft),
                read(run_settings.home),
                waits=name in waiting,
                now=run_settings.now(name),
                idle=run_settings.idle(name),
            )

    # Rows

    def describe(self, column: Column) -> None:
        """Add the preset's name, and the knobs: few, or a page of all."""
        column.add(self._write_name)
        if not self.every:
            names = self.first
        else:
            presets = [
                base for base in self._run_kind.presets if self.changed or (base, "") != self._run_settings.holds
            ]
            column.words([(self._run_kind.word((base, "")), partial(self._load, base)) for base in presets])
            tabs = [texts.KNOB_PAGES.get(page, page.capitalize()) for page in self.pages]
            column.choice("", tabs, self._page, self._turn_page, LABEL)
            page = self.pages[self._page]
            names = tuple(each.name for each in self._run_kind.knob_descriptions if each.page == page)
            names += (SEED,) if page == self._run_kind.seed_page else ()
        for name in names:
            column.widget(self._knob(name))
        self.show()

    def describe_foot(self, column: Column) -> None:
        """Add what was refused, the question that waits, or the help of the knob in focus."""
        run_settings = self._run_settings
        column.add(self._write_help)  # above the words, which must not move when it goes
        if run_settings.waiting or run_settings.put_aside:
            column.text(self._question, size=SMALL, colour=HUMAN)
            apply = [(texts.KNOBS_APPLY, self._apply)] if run_settings.waiting else []
            column.words([*apply, (texts.KNOBS_UNDO, self._undo)])

    def _knob(self, name: str) -> Knob | SeedKnob:
        """Return the widget of a setting: the same one as long as it is on the screen, so that a drag goes on."""
        knob = self._knobs.get(name)
        if knob is None or knob not in self._form.widgets:
            manager = self._form.manager
            if name == SEED:
                knob = SeedKnob(manager, label(SEED), partial(self.turn, SEED))
            else:
                description = self._run_settings.knob_descriptions[name]
                knob = KINDS[description.kind](manager, description, self.turn, self._seek)
            self._knobs[name] = knob
        return knob

    def _write_name(self, cursor: Cursor) -> None:
        """Write the preset's name over a line, and whether it was changed."""
        title, left = cursor.in_style(TITLE), cursor.left
        if self.changed and cursor.canvas:
            words = cursor.in_style(LABEL, HUMAN)
            place = left + title.measured(self.name) + 10, title.baseline
            cursor.canvas.text(texts.KNOBS_CHANGED, place, size=LABEL, colour=HUMAN, room=words.right - place[0])
        title.text(self.name)
        if cursor.canvas:
            wide = min(title.measured(self.name), cursor.width)
            cursor.canvas.line((left, title.y + 2), (left + wide, title.y + 2), NET, _UNDERLINE)
        cursor.y = title.y + 12

    def _question(self) -> str:
        run_settings = self._run_settings
        name = self._run_kind.word(run_settings.named)
        if not run_settings.waiting:
            return f"{texts.KNOBS_PUT_ASIDE} {texts.KNOBS_PUT_ASIDE_LINE.format(name=name)}"
        anew = texts.KNOBS_STARTS_ANEW
        if run_settings.named != run_settings.holds:
            anew = texts.KNOBS_STARTS_ANEW_AS.format(name=name)
        return f"{anew}: {_listed(run_settings.waiting)}"

    def _write_help(self, cursor: Cursor) -> None:
        """Write what was refused, or what the knob in focus does, and how to restore it."""
        run_settings, focused = self._run_settings, self._form.focused
        if run_settings.problem:
            colour = cursor.canvas.palette.warn if cursor.canvas else HUMAN
            small = cursor.in_style(SMALL, colour)
            small.text(run_settings.problem)
            cursor.y = small.y
            return
        if not isinstance(focused, Knob | SeedKnob):
            if self.every and not (run_settings.waiting or run_settings.put_aside):
                cursor.aside(self._run_kind.sentence(run_settings.holds))
            return
        cursor.aside(focused.help)
        if not isinstance(focused, Knob):
            cursor.aside(texts.KNOBS_NEW_RUN)
            return
        for heading, told in zip(texts.KNOB_ADVICE_NAMES, focused.description.advice, strict=False):
            if told and self.every:
                cursor.aside(f"{heading}: {told}")
        if not focused.live:
            cursor.aside(texts.KNOBS_NEW_RUN)
        if focused.changed:
            controls = self._form.controls
            key = texts.KNOBS_CLICK if controls.mouse_in_use else controls.word(Command.RETRY)
            hint = Hint(key, texts.KNOBS_BACK_TO.format(value=figure(focused.home)))
            if cursor.canvas:
                HintRow([hint], (cursor.left, cursor.baseline), size=LABEL).draw(cursor.canvas)
            cursor.in_style(LABEL, MUTE).gap()
            cursor.gap(20)

    # What the widgets ask for

    def _turn_page(self, page: int) -> None:
        seed = self._knobs.get(SEED)
        if isinstance(seed, SeedKnob) and seed in self._form.widgets:
            seed.typing = False
            seed.commit()
        self._page = page

    def _seek(self) -> None:
        """Move the focus to the button that applies, if there is one."""
        answers = (texts.KNOBS_APPLY, texts.KNOBS_UNDO)
        for widget in self._form.widgets:
            if widget.label in answers:
                self._form.focus(widget)
                return

    def _load(self, base: str) -> None:
        self._run_settings.load((base, ""))
        self.show()

    def load_sabotage(self, sabotage: str) -> None:
        """Propose the preset without one of its parts, for a run of its own."""
        self._run_settings.load((self._run_settings.holds[0], sabotage))
        self.show()

    def _apply(self) -> None:
        self._run_settings.apply()
        self.show()

    def _undo(self) -> None:
        self._run_settings.undo()
        self.show()


def _listed(names: list[str]) -> str:
    """List the knobs that wait, as many as there is room for."""
    labels = list(dict.fromkeys(label(name.split(".")[0]) for name in names))
    return ", ".join(labels) if len(labels) < 3 else texts.KNOBS_MORE.format(first=labels[0], count=len(labels) - 1)
