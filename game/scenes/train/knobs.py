"""Panel of a run's settings: few knobs first, a page of them on demand, presets, and what comes of turning them."""

from __future__ import annotations

from collections.abc import Hashable
from functools import partial
from typing import Any, Final

from game.core import texts
from game.core.scene import push
from game.drawing.cursor import Cursor
from game.drawing.tokens import HUMAN, LABEL, MUTE, NET, SMALL, TITLE
from game.input.controls import Command
from game.scenes.train.knob import KINDS, Knob
from game.training.run_settings import (
    SEED,
    WEIGHTS,
    Configuration,
    KnobDescription,
    RunSettings,
    figure,
    label,
)
from game.ui.form import Form
from game.ui.hints import Hint, HintRow
from game.ui.panel import Column

_UNDERLINE: Final = 2.0
_SEEDS: Final = tuple(range(100))
_FEW: Final = 2  # changes that are named
_FIRST, _LAST = "learning_rate", "final_learning_rate"  # the first acts until its schedule is over, then the last


class KnobsPanel:
    """Rows of a panel of knobs; the scene lays them anew when `key` has changed.

    A knob that may change during a run takes effect at once. One that takes a new run waits, says so, and is applied
    or undone by the player.

    Args:
        form: the scene's form.
        settings: what they set, and what waits for a new run.

    Attributes:
        page: whether the page of knobs is shown, each with a line and a door to the chapter that explains it.

    """

    def __init__(self, form: Form, settings: RunSettings) -> None:
        self.form, self.settings = form, settings
        self._run_kind = run_kind = settings.run_kind
        chance = KnobDescription(SEED, "", label(SEED), texts.KNOB_SEED, False, "slider", _SEEDS)
        self._descriptions = {each.name: each for each in (*run_kind.knob_descriptions, chance)}
        self.page = False
        self._knobs: dict[str, Knob] = {}

    @property
    def config(self) -> Configuration:
        """The configuration in force, without changes that wait to be applied."""
        return self.settings.config

    @property
    def seed(self) -> int:
        """The seed of the configuration in force."""
        return self.settings.seed

    @property
    def name(self) -> str:
        """Displayed name of the preset or sabotage that this configuration is, or began as."""
        return self._run_kind.said(self.settings.holds)[0]

    @property
    def shown(self) -> tuple[str, ...]:
        """Names of the knobs that are shown: few, or a page of them, without one whose time is over."""
        if (in_force := self.settings.in_force) is None or _LAST not in in_force:
            return self._run_kind.page if self.page else self._run_kind.first
        names = self._run_kind.page if self.page else (_LAST, *self._run_kind.first)
        return tuple(name for name in names if name != _FIRST)

    @property
    def key(self) -> Hashable:
        """What decides which rows there are."""
        settings = self.settings
        return self.page, self.shown, settings.holds, settings.changed, self.asks, bool(settings.waiting)

    @property
    def asks(self) -> bool:
        """Whether something was changed that can be undone: what waits for a new run, or a preset's place taken."""
        return bool(self.settings.waiting or self.settings.put_aside)

    # What the run says

    def set_running(self, running: bool) -> None:
        """Set whether a run goes on; without one, every knob takes effect at once."""
        if running != self.settings.running:
            self.settings.set_running(running)
            self.show()

    def show_in_force(self, in_force: dict[str, float] | None) -> None:
        """Show the values in force at this moment of a run beside the settings; None for none."""
        if in_force != self.settings.in_force:
            self.settings.in_force = in_force
            self.show()

    def set_config(self, config: Configuration, seed: int) -> None:
        """Show a configuration from elsewhere, such as a loaded run, without calling `on_change` or `on_restart`."""
        self.settings.set_config(config, seed)
        self.show()

    def turn(self, name: str, value: Any) -> None:
        """Set a knob by its name, as if by hand; for an invalid value, the panel says why it is refused."""
        self.settings.turn(name, value)
        self.show()

    def load(self, base: str = "", sabotage: str = "") -> None:
        """Propose a preset, or this one without one of its parts, for a run of its own."""
        self.settings.load((base or self.settings.holds[0], sabotage))
        self.show()

    def show(self) -> None:
        """Show the current values in the knobs."""
        settings = self.settings
        for name, knob in self._knobs.items():
            waits = name in settings.waiting
            if name == SEED:
                knob.display(settings.draft_seed, settings.draft_seed, waits=waits)
                continue
            value, home = map(knob.description.read, (settings.draft, settings.home))
            knob.display(value, home, waits=waits, now=settings.now(name))

    # Rows

    def open(self) -> None:
        """Show the page of knobs."""
        self.page = True

    def close(self) -> None:
        """Show few knobs again."""
        self.page = False

    def describe(self, column: Column) -> None:
        """Add the preset's name, and the few knobs."""
        column.add(self._write_name)
        for name in self.shown:
            column.widget(self._knob(name))
        self.show()

    def describe_page(self, column: Column) -> None:
        """Add the presets, and every knob of the page with what it does, and the chapter that explains it."""
        kind = self._run_kind
        column.add(self._write_name)
        column.aside(kind.said(self.settings.holds)[1])
        others = [base for base in kind.presets if self.settings.changed or (base, "") != self.settings.holds]
        column.words([
            (texts.BACK, self.close), *((kind.said((base, ""))[0], partial(self.load, base)) for base in others)
        ])  # fmt: skip
        for name in self.shown:
            column.gap(6)
            knob = column.widget(self._knob(name))
            column.aside(knob.description.help)
            if chapter := kind.chapters.get(name):
                words = texts.KNOBS_CHAPTER.format(chapter=texts.LEARN[chapter]["title"])
                column.button(words, partial(push, "chapter", chapter), size=SMALL).pad = 1.0
        self.show()

    def describe_foot(self, column: Column) -> None:
        """Add what was refused, what waits for a new run, or the help of the knob in focus."""
        column.add(self._write_help)  # above the words, which must not move when it goes
        if self.asks:
            column.text(self._question, size=SMALL, colour=HUMAN)

    def _knob(self, name: str) -> Knob:
        """Return the widget of a setting: the same one as long as it is on the screen, so that a drag goes on."""
        knob = self._knobs.get(name)
        if knob is None or knob not in self.form.widgets:
            description = self._descriptions[name]
            knob = KINDS[description.kind](description, self.turn, self._focus_answer)
            self._knobs[name] = knob
        return knob

    def _write_name(self, cursor: Cursor) -> None:
        """Write the preset's name over a line, and whether it was changed."""
        title, left = cursor.in_style(TITLE), cursor.left
        title.text(self.name)
        if cursor.canvas:
            wide = min(title.measured(self.name), cursor.width)
            cursor.canvas.line((left, title.y + 2), (left + wide, title.y + 2), NET, _UNDERLINE)
            if self.settings.changed:
                place = left + wide + 10, cursor.in_style(TITLE).baseline
                cursor.canvas.text(texts.KNOBS_CHANGED, place, size=LABEL, colour=HUMAN, room=cursor.right - place[0])
        cursor.y = title.y + 12

    def _question(self) -> str:
        """Say what takes a new run, and what it was before."""
        settings, said = self.settings, self._run_kind.said
        if not settings.waiting:
            return texts.KNOBS_PUT_ASIDE.format(name=said(settings.named)[0])
        if settings.named != settings.holds:
            return texts.KNOBS_STARTS_ANEW_AS.format(name=said(settings.named)[0])
        changes = ", ".join(
            texts.KNOBS_CHANGE.format(knob=self._descriptions[name].label, **settings.change(name))
            for name in settings.waiting[:_FEW]
        )
        more = len(settings.waiting) - _FEW
        return texts.KNOBS_STARTS_ANEW.format(changes=changes if more <= 0 else texts.KNOBS_MORE.format(
            first=changes, count=more))  # fmt: skip

    def _write_help(self, cursor: Cursor) -> None:
        """Write what was refused, or what the knob in focus does, and how to restore it."""
        settings, knob = self.settings, self.form.focused
        if settings.problem:
            cursor.styled(settings.problem, SMALL, cursor.palette.warn)
        elif isinstance(knob, Knob):
            self._write_help_of(knob, cursor)

    def _write_help_of(self, knob: Knob, cursor: Cursor) -> None:
        if not self.page:
            cursor.aside(knob.description.help)
        if knob.description.field == WEIGHTS and self.settings.running:
            cursor.styled(texts.KNOBS_NEW_PAY, SMALL, HUMAN)
        if not knob.live:
            cursor.aside(texts.KNOBS_NEW_RUN)
        if knob.changed:
            controls = self.form.controls
            key = texts.KNOBS_CLICK if controls.mouse_in_use else controls.word(Command.RETRY)
            if cursor.canvas:
                hint = Hint(key, texts.KNOBS_BACK_TO.format(value=figure(knob.home)))
                HintRow([hint], (cursor.left, cursor.baseline), size=LABEL).draw(cursor.canvas)
            cursor.in_style(LABEL, MUTE).gap()
            cursor.gap(20)

    # What the widgets ask for

    def _focus_answer(self) -> None:
        """Move the focus to the word that starts anew, if something waits for it."""
        anew = next((widget for widget in self.form.widgets if widget.label == texts.TRAIN_ANEW), None)
        if anew and self.settings.waiting:
            self.form.focus(anew)

    def apply(self) -> None:
        """Start a new run, with the changes that wait for one."""
        self.settings.apply()
        self.show()

    def undo(self) -> None:
        """Undo what waits, or give the knobs their place back."""
        self.settings.undo()
        self.show()
