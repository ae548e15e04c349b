"""Panel of knobs of a training run: presets, pages of knobs, and help on the knob in focus."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from functools import partial
from typing import Any, Final, Literal

import pygame

from ai.training.config import InForce
from ai.training.experiments import MEASURED
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, LABEL, LINE, MUTE, SMALL, TEXT, TITLE
from game.panels import knob_foot
from game.panels.knob import Knob
from game.panels.knob_rows import Deeds, KnobRows
from game.panels.knob_words import Title, Word, draw_changed, make_words, word_width
from game.panels.lab import TOP
from game.panels.seed_knob import SeedKnob
from game.training.knob_descriptions import Configuration
from game.training.run_settings import LANDER, SEED, Named, RunKind, RunSettings
from game.ui.form import Form
from game.ui.widget import Widget
from game.ui.widgets import TextButton

View = Literal["few", "all", "knob", "picks", "guess", "result"]

Section = tuple[Hashable, Callable[[], list[Widget]]]  # made again when the first changes
_PICK: Final = 26  # points from one sabotage to the next


class KnobsPanel:
    """Panel of knobs, as widgets of a form in a box of about 384 by 360 points; the scene draws its background.

    A knob that may change during a run takes effect at once. One that takes a new run waits, says so, and is applied
    or undone by the player.

    Args:
        form: form to which the widgets are added; the scene passes events and updates to it, and draws it.
        box: box of the panel, in points; the dots of changed knobs are up to 16 points to the left of it.
        config: configuration to begin with.
        seed: seed to begin with.
        on_change: called with the name and value of every knob that changes; during a run, only of those that may.
            Names are those of the configuration ("reward_weights.time" for a part of the reward, "seed" for the seed).
        on_restart: called with a configuration and seed for a new run, once the player has applied them.
        run_kind: the kind of run, with its presets and knobs.

    """

    def __init__(
        self,
        form: Form,
        box: pygame.typing.RectLike,
        config: Configuration,
        seed: int,
        on_change: Callable[[str, Any], None],
        on_restart: Callable[[Configuration, int], None],
        run_kind: RunKind = LANDER,
    ) -> None:
        self._form, self._box, self._run_kind = form, pygame.Rect(box), run_kind
        self._run_settings = RunSettings(config, seed, on_change, on_restart, run_kind)
        self._page = 0
        self._rows = KnobRows(form.manager, self._box, self._run_settings, self._deeds)
        self._view: View = self._home
        self._opened = ""  # the knob whose page is open
        self._sections: dict[str, tuple[Hashable, list[Widget]]] = {}
        self._widgets: list[Widget] = []
        self._lay()

    @property
    def _home(self) -> View:
        """The view of the knobs."""
        return "all"

    @property
    def _deeds(self) -> Deeds:
        """What knobs ask for."""
        return Deeds(self.turn, self._seek)

    @property
    def _shown_few(self) -> tuple[str, ...]:
        """Names of the knobs that are shown alone, where few are."""
        return ()

    @property
    def view(self) -> View:
        """What is shown: knobs, the list of sabotages, a guess, or what came of an experiment."""
        return self._view

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

    def set_running(self, running: bool) -> None:
        """Set whether a run goes on; without one, every knob takes effect at once."""
        if running != self._run_settings.running:
            self._run_settings.set_running(running)
            self._lay()

    def show_in_force(self, in_force: InForce | None) -> None:
        """Show the values in force at this moment of a run beside the settings; None for none."""
        if in_force is not self._run_settings.in_force:
            self._run_settings.in_force = in_force
            self._lay()

    def set_config(self, config: Configuration, seed: int) -> None:
        """Show a configuration from elsewhere, such as a loaded run, without calling `on_change` or `on_restart`."""
        self._run_settings.set_config(config, seed)
        if self._view in ("picks", "guess"):
            self._view = self._home
        self._lay()

    def turn(self, name: str, value: Any) -> None:
        """Set a knob by its name, as if by hand; for an invalid value, the panel says why it is refused."""
        self._run_settings.turn(name, value)
        self._lay()

    def draw(self, canvas: Canvas) -> None:
        """Draw all but the widgets, which the form draws."""
        box, y = self._box, self._box.top + TOP
        canvas.line((box.left, y), (box.right, y), LINE, 1)
        if self.changed:
            draw_changed(canvas, box, self.name, self._sections["head"][1][1].box.left)
        if self._view == "picks":
            heading = texts.SABOTAGE_HEADING.format(name=self._run_kind.word((self._run_settings.named[0], ""))).upper()
            canvas.text(heading, (box.left, y + 25), size=LABEL, weight="medium", colour=MUTE)
        self._draw_page(canvas)

    def _draw_page(self, canvas: Canvas) -> None:
        """Draw what is written beside the widgets of the page."""
        self._draw_foot(canvas, None)

    def _draw_foot(self, canvas: Canvas, room: pygame.Rect | None) -> None:
        focused = self._form.focused if self._form.focused in self._widgets else None
        knob_foot.draw_foot(
            canvas,
            self._box,
            self._run_settings,
            getattr(focused, "knob", focused),
            self._form.controls,
            picking=self._view == "picks",
            room=room,
        )

    # Widgets

    def _lay(self) -> None:
        """Lay out the widgets of the current page, and show the current values in them."""
        run_settings, view = self._run_settings, self._view
        answer = "apply" if run_settings.waiting else "undo" if run_settings.put_aside else ""
        sections: dict[str, Section] = {
            "head": ((run_settings.holds, self._lab_word()[0]), self._make_head),
            "tabs": (view, lambda: [self._rows.tabs(self._page, self._turn_page)] if view == "all" else []),
            "body": ((view, self._page, self._opened, self._shown_few), self._bodies[view]),
            **self._more_sections(),
            "answers": (answer, lambda: self._make_answers(answer)),
        }
        for name, (key, make) in sections.items():
            if name not in self._sections or self._sections[name][0] != key:
                self._sections[name] = (key, make())
        widgets = [widget for name in sections for widget in self._sections[name][1]]
        if widgets != self._widgets:
            self._form.replace(self._widgets, widgets)
            self._widgets = widgets
        waiting = run_settings.waiting
        for widget in widgets:
            if isinstance(widget, Knob):
                name, read = widget.description.name, widget.description.read
                widget.display(
                    read(run_settings.draft),
                    read(run_settings.home),
                    waits=name in waiting,
                    now=run_settings.now(name),
                    idle=run_settings.idle(name),
                )
            elif isinstance(widget, SeedKnob):
                widget.display(run_settings.draft_seed, waits=SEED in waiting)

    def _make_head(self) -> list[Widget]:
        """Make the head: the chosen preset large on the left (a press restores it), the others on the right."""
        box, named, manager = self._box, self._run_settings.holds, self._form.manager
        top = box.top + 5
        chosen = Title(
            manager, (box.left, top - 1, word_width(self.name, TITLE), 28), self.name, self._loads(named), size=TITLE
        )
        others: list[Word] = [
            (self._run_kind.word((base, "")), self._loads((base, "")))
            for base in self._run_kind.presets
            if (base, "") != named
        ]
        if self._run_kind.sabotages:
            others.append(self._lab_word())
        return [chosen, *make_words(manager, others, box.right, pygame.Rect(0, top, 14, 24), SMALL)]

    def _lab_word(self) -> Word:
        """Return the word that leads to the laboratory, or back from there."""
        if self._view in ("picks", "guess"):
            return texts.SABOTAGE_LEAVE, self._leave_lab
        return texts.SABOTAGE, partial(self._show, "picks")

    @property
    def _bodies(self) -> dict[View, Callable[[], list[Widget]]]:
        """What makes the widgets of each view."""
        return {"all": lambda: self._rows.page(self._page), "picks": self._make_picks}

    def _more_sections(self) -> dict[str, Section]:
        """Return further sections of widgets, after the body."""
        return {}

    def _make_picks(self) -> list[Widget]:
        """Make the list of sabotages, in two columns."""
        base, (left, top) = self._run_settings.named[0], self._box.topleft
        sabotages = self._run_kind.sabotages
        half = (len(sabotages) + 1) // 2
        picks: list[Widget] = []
        for number, (name, (word, *said)) in enumerate(sabotages.items()):
            column, row = divmod(number, half)
            box = (left + column * self._box.width // 2, top + TOP + 38 + row * _PICK, 160, _PICK)
            pick = TextButton(self._form.manager, box, word, self._picks((base, name)), size=SMALL + 1)
            pick.help = "\n".join(self._told(base, said))
            picks.append(pick)
        return picks

    def _picks(self, named: Named) -> Callable[[], None]:
        """Return what a sabotage of the list does at a press."""
        return self._loads(named)

    def _told(self, base: str, said: Sequence[str]) -> Sequence[str]:
        """Return what the list says of a sabotage of a preset: what was measured holds for one of them."""
        return said if base == MEASURED else said[:1]

    def _make_answers(self, answer: str) -> list[Widget]:
        """Make the buttons that apply or undo."""
        undo = (texts.KNOBS_UNDO, partial(self._settle, self._run_settings.undo))
        apply = (texts.KNOBS_APPLY, partial(self._settle, self._run_settings.apply))
        words: dict[str, list[Word]] = {"apply": [apply, undo], "undo": [undo]}
        row = pygame.Rect(0, self._box.bottom - knob_foot.ANSWERS, 18, 28)
        return make_words(self._form.manager, words.get(answer, []), self._box.right - 14.0, row, TEXT, HUMAN)

    # What the widgets ask for

    def _turn_page(self, page: int) -> None:
        for widget in self._widgets:
            if isinstance(widget, SeedKnob):
                widget.typing = False
                widget.commit()
        self._page = page
        self._lay()

    def _seek(self) -> None:
        """Move the focus to the buttons that apply and undo, if there are any."""
        self._go("answers")

    def _go(self, section: str) -> None:
        """Lay out the widgets, and move the focus to the first widget of a section."""
        self._lay()
        if widgets := self._sections[section][1]:
            self._form.focus(widgets[0])

    def _show(self, view: View) -> None:
        self._view = view
        self._go("body")

    def _leave_lab(self) -> None:
        """Go back from the list of sabotages to the knobs."""
        self._show(self._home)

    def _loads(self, named: Named) -> Callable[[], None]:
        def load() -> None:
            self._run_settings.load(named)
            picking = bool(named[1] and self._run_settings.waiting)  # a sabotage's help stays as long as it waits
            self._view = "picks" if picking else self._home
            self._go("answers" if picking else "head")

        return load

    def _settle(self, deed: Callable[[], None]) -> None:
        """Apply or undo the changes that wait, and leave the list of sabotages."""
        if self._view in ("picks", "guess"):
            self._view = self._home
        deed()
        self._go("tabs" if self._view == "all" else "body")
