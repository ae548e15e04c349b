"""Panel of knobs of a training run: presets, pages of knobs, and help on the knob in focus."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from functools import partial
from typing import Any, Final

import pygame

from ai.agent.schedule import InForce
from ai.training.sabotage import MEASURED
from game.core import texts
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, INK, LABEL, LINE, MUTE, NET, SMALL, TEXT, TITLE, Colour
from game.panels import knob_foot
from game.panels.knob import MARGIN, Knob, SliderKnob, SwitchKnob, WordsKnob
from game.panels.seed_knob import SeedKnob
from game.training.knob_descriptions import Configuration, label, pages
from game.training.run_settings import LANDER, SEED, Named, RunKind, RunSettings
from game.ui.form import Form
from game.ui.widget import Widget
from game.ui.widgets import Choice, TextButton

_KINDS: Final[dict[str, type[Knob]]] = {"slider": SliderKnob, "switch": SwitchKnob, "words": WordsKnob}
_HEAD: Final = 34  # from the top to the line under the presets
_BASELINE: Final = 21.5  # of the presets
_TABS: Final = 36  # from there to the first row: the tabs are in between
_PITCH: Final = 26  # of the rows, where there is room
_TAB_GAP: Final = 13.0


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
        self._pages = pages(self._run_settings.knob_descriptions.values())
        self._page = 0
        self._picking = False
        self._sections: dict[str, tuple[Hashable, list[Widget]]] = {}
        self._widgets: list[Widget] = []
        self._lay()

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
        self._picking = False
        self._lay()

    def turn(self, name: str, value: Any) -> None:
        """Set a knob by its name, as if by hand; for an invalid value, the panel says why it is refused."""
        self._run_settings.turn(name, value)
        self._lay()

    def draw(self, canvas: Canvas) -> None:
        """Draw all but the widgets, which the form draws."""
        box, y = self._box, self._box.top + _HEAD
        canvas.line((box.left, y), (box.right, y), LINE, 1)
        if self.changed:
            self._draw_changed(canvas)
        if self._picking:
            heading = texts.SABOTAGE_HEADING.format(name=self._run_kind.word((self._run_settings.named[0], ""))).upper()
            canvas.text(heading, (box.left, y + 25), size=LABEL, weight="medium", colour=MUTE)
        focused = self._form.focused if self._form.focused in self._widgets else None
        knob_foot.draw_foot(canvas, self._box, self._run_settings, focused, self._form.controls, picking=self._picking)

    def _draw_changed(self, canvas: Canvas) -> None:
        """Mark that knobs were changed: by a word, or by a dot where there is no room for it."""
        left, baseline = self._box.left + canvas.text_width(self.name, size=TITLE) + 9, self._box.top + _BASELINE
        room = self._sections["head"][1][1].box.left - left - 9
        if canvas.text_width(texts.KNOBS_CHANGED, size=LABEL) <= room:
            canvas.text(texts.KNOBS_CHANGED, (left, baseline), size=LABEL, colour=HUMAN)
        else:
            canvas.dot((left, baseline - 5), 2.5, HUMAN)

    # Widgets

    def _lay(self) -> None:
        """Lay out the widgets of the current page, and show the current values in them."""
        run_settings, picking = self._run_settings, self._picking
        answer = "apply" if run_settings.waiting else "undo" if run_settings.put_aside else ""
        sections: dict[str, tuple[Hashable, Callable[[], list[Widget]]]] = {
            "head": ((run_settings.holds, picking), self._make_head),
            "tabs": (picking, lambda: [] if picking else [self._make_tabs()]),
            "body": ((picking, self._page), self._make_picks if picking else self._make_rows),
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
        chosen = _Title(
            manager, (box.left, top - 1, _width(self.name, TITLE), 28), self.name, self._loads(named), size=TITLE
        )
        others: list[tuple[str, Callable[[], None]]] = [
            (self._run_kind.word((base, "")), self._loads((base, "")))
            for base in self._run_kind.presets
            if (base, "") != named
        ]
        if self._run_kind.sabotages:
            word, section = (texts.SABOTAGE_LEAVE, "head") if self._picking else (texts.SABOTAGE, "body")
            others.append((word, partial(self._go, section, picking=not self._picking)))
        return [chosen, *self._make_words(others, box.right, pygame.Rect(0, top, 14, 24), SMALL)]

    def _make_words(
        self,
        words: Sequence[tuple[str, Callable[[], None]]],
        right: float,
        row: pygame.Rect,
        size: float,
        colour: Colour = MUTE,
    ) -> list[Widget]:
        """Make buttons in a row that ends at `right`; the row's width is the gap between them, in points."""
        made: list[Widget] = []
        for name, press in reversed(words):
            width = _width(name, size)
            box = (right - width, row.top, width, row.height)
            made.insert(0, TextButton(self._form.manager, box, name, press, size=size, colour=colour))
            right -= width + row.width
        return made

    def _make_tabs(self) -> Choice:
        words = [texts.KNOB_PAGES.get(page, page.capitalize()) for page in self._pages]
        box = (self._box.left, self._box.top + _HEAD + 8, self._box.width, 22)
        return Choice(self._form.manager, box, "", words, self._page, self._turn_page, size=LABEL, gap=_TAB_GAP)

    def _make_rows(self) -> list[Widget]:
        page, manager = self._pages[self._page], self._form.manager
        rows: list[Widget] = []
        for description in self._run_settings.knob_descriptions.values():
            if description.page == page:
                kind, box = _KINDS[description.kind], self._row(len(rows))
                rows.append(kind(manager, box, description, self.turn, self._seek))
        if page == self._run_kind.seed_page:
            rows.append(SeedKnob(manager, self._row(len(rows)), label(SEED), partial(self.turn, SEED)))
        return rows

    def _row(self, number: int) -> pygame.Rect:
        """Return the box of a row; the longest page sets the distance between rows."""
        box, knob_descriptions = self._box, self._run_settings.knob_descriptions.values()
        longest = max(sum(description.page == page for description in knob_descriptions) for page in self._pages)
        pitch = min(_PITCH, (box.height - _HEAD - _TABS - knob_foot.HEIGHT) // longest)
        return pygame.Rect(box.left - MARGIN, box.top + _HEAD + _TABS + number * pitch, box.width + MARGIN, pitch)

    def _make_picks(self) -> list[Widget]:
        """Make the list of sabotages, in two columns."""
        base, (left, top) = self._run_settings.named[0], self._box.topleft
        sabotages = self._run_kind.sabotages
        half = (len(sabotages) + 1) // 2
        picks: list[Widget] = []
        for number, name in enumerate(sabotages):
            column, row = divmod(number, half)
            box = (left + column * self._box.width // 2, top + _HEAD + 38 + row * _PITCH, 160, _PITCH)
            pick = TextButton(
                self._form.manager, box, self._run_kind.word((base, name)), self._loads((base, name)), size=SMALL + 1
            )
            told = sabotages[name][1:] if base == MEASURED else sabotages[name][1:2]
            pick.help = "\n".join(told)
            picks.append(pick)
        return picks

    def _make_answers(self, answer: str) -> list[Widget]:
        """Make the buttons that apply or undo."""
        undo = (texts.KNOBS_UNDO, partial(self._settle, self._run_settings.undo))
        apply = (texts.KNOBS_APPLY, partial(self._settle, self._run_settings.apply))
        words = {"apply": [apply, undo], "undo": [undo]}
        row = pygame.Rect(0, self._box.bottom - knob_foot.ANSWERS, 18, 28)
        return self._make_words(words.get(answer, []), self._box.right - 14.0, row, TEXT, HUMAN)

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
        self._go("answers", picking=self._picking)

    def _go(self, section: str, *, picking: bool = False) -> None:
        """Show the list of sabotages, or else the knobs, and move the focus to the first widget of a section."""
        self._picking = picking
        self._lay()
        if widgets := self._sections[section][1]:
            self._form.focus(widgets[0])

    def _loads(self, named: Named) -> Callable[[], None]:
        def load() -> None:
            self._run_settings.load(named)
            picking = bool(named[1] and self._run_settings.waiting)  # a sabotage's help stays as long as it waits
            self._go("answers" if picking else "head", picking=picking)

        return load

    def _settle(self, deed: Callable[[], None]) -> None:
        """Apply or undo the changes that wait, and leave the list of sabotages."""
        self._picking = False
        deed()
        self._go("tabs")


class _Title(TextButton):
    """Name of the chosen preset: large, with a line under it."""

    def paint(self, canvas: Canvas) -> None:
        """Draw the word and its line."""
        Widget.paint(self, canvas)
        box = self.box
        canvas.text(self.label, (box.left, box.top - 4 + _BASELINE), size=TITLE, colour=INK)
        canvas.line((box.left, box.top + 30), (box.left + box.width, box.top + 30), NET, 2)


def _width(text: str, size: float) -> float:
    return typeface.width(text, size, "regular")
