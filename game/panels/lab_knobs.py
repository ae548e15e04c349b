"""Panel of knobs with a laboratory: few knobs first, all on demand, and experiments beside a healthy twin."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final

import pygame

from ai.training.experiments import Experiment, experiment_of
from game.core import texts
from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.panels import knob_page, lab
from game.panels.knob import Knob
from game.panels.knob_rows import Deeds
from game.panels.knob_words import Word
from game.panels.knobs import KnobsPanel, Section, View
from game.panels.lab import Laboratory
from game.training.knob_descriptions import Configuration, KnobDescription
from game.training.run_settings import Named
from game.ui.form import Form
from game.ui.widget import Widget

_KNOBS: Final[tuple[View, ...]] = ("few", "all", "knob")


class LabKnobsPanel(KnobsPanel):
    """Panel of the knobs of landers, of which few come first, with a laboratory. See `KnobsPanel` for the rest.

    Args:
        form, box, config, seed, on_change, on_restart: as those of `KnobsPanel`.
        laboratory: flies experiments beside the run.
        show_all: whether to show all knobs at first.
        on_show: called with that when the player changes it.

    """

    def __init__(
        self,
        form: Form,
        box: pygame.typing.RectLike,
        config: Configuration,
        seed: int,
        on_change: Callable[[str, Any], None],
        on_restart: Callable[[Configuration, int], None],
        *,
        laboratory: Laboratory,
        show_all: bool,
        on_show: Callable[[bool], None],
    ) -> None:
        self._laboratory, self._show_all, self._on_show = laboratory, show_all, on_show
        super().__init__(form, box, config, seed, on_change, on_restart)

    @property
    def _home(self) -> View:
        return "all" if self._show_all else "few"

    @property
    def _deeds(self) -> Deeds:
        return Deeds(self.turn, self._seek, self._open, self._try)

    def show_experiment(self) -> None:
        """Show what has come of the experiment that flies, or the knobs if there is none."""
        self._show("result" if self._laboratory.flies else self._home)

    @property
    def _shown_few(self) -> tuple[str, ...]:
        """Names of the knobs that are shown with their experiments."""
        return {"few": self._first, "knob": (self._opened,)}.get(self._view, ())

    @property
    def _first(self) -> tuple[str, ...]:
        """Names of the few knobs to begin with; one that has no effect any more gives way to the one that acts."""
        spent = in_force.idle if (in_force := self._run_settings.in_force) else {}
        return tuple(dict.fromkeys(spent.get(name, name) for name in self._run_kind.first))

    # The picture

    def _draw_page(self, canvas: Canvas) -> None:
        laboratory = self._laboratory
        if laboratory.chosen and self._view == "guess":
            lab.draw_guess(canvas, self._box, laboratory.chosen)
        elif self._view == "result":
            lab.draw_result(canvas, self._box, laboratory)
        else:
            knob_page.draw_try(canvas, self._sections["tries"][1])
            self._draw_foot(canvas, None if self._view == "picks" else self._rows.advice_room(len(self._shown_few)))

    # Widgets

    @property
    def _bodies(self) -> dict[View, Callable[[], list[Widget]]]:
        return super()._bodies | {
            "few": lambda: self._rows.few(self._shown_few),
            "knob": lambda: self._rows.few(self._shown_few),
            "guess": self._make_guess,
            "result": self._make_result,
        }

    def _more_sections(self) -> dict[str, Section]:
        return {"tries": ((self._shown_few, self.config), self._make_tries), "switch": (self._view, self._make_switch)}

    def _lab_word(self) -> Word:
        if self._laboratory.flies and self._view in _KNOBS:
            return texts.LAB_RESULT, self.show_experiment
        return super()._lab_word()

    def _make_tries(self) -> list[Widget]:
        return self._rows.tries(self._sections["body"][1]) if self._shown_few else []

    def _make_switch(self) -> list[Widget]:
        """Make the word that shows all knobs, or few again, or leaves the page of one."""
        if self._view not in _KNOBS:
            return []
        words: dict[View, str] = {
            "few": texts.KNOBS_ALL.format(count=len(self._run_settings.knob_descriptions)),
            "all": texts.KNOBS_FEW.format(count=len(self._run_kind.first)),
        }
        return [self._rows.switch(words.get(self._view, texts.BACK), self._switch, every=self._view == "all")]

    def _make_guess(self) -> list[Widget]:
        if self._laboratory.chosen is None:
            return []
        alone = self._loads((self._run_settings.named[0], self._laboratory.chosen.experiment.sabotage))
        return lab.guess_widgets(self._laboratory, self._form.manager, self._box, alone)

    def _make_result(self) -> list[Widget]:
        keep = self._laboratory.keep
        words: list[Word] = [
            (texts.LAB_KNOBS, partial(self._show, self._home)),
            (texts.LAB_KEEP_RUN, partial(keep, experiment=False)),
            (texts.LAB_KEEP_EXPERIMENT, partial(keep, experiment=True)),
        ]
        return lab.words_of(self._form.manager, self._box, words)

    # What the widgets ask for

    def _seek(self) -> None:
        knob = self._form.focused
        if not self._sections["answers"][1] and isinstance(knob, Knob) and knob.more is not None:
            knob.more()
        else:
            super()._seek()

    def _open(self, name: str) -> None:
        """Open the page of a knob; where it is open already, go to its first experiment."""
        if self._view == "all":
            self._opened = name
            self._show("knob")
        elif tries := [
            each for each in self._sections["tries"][1] if getattr(each, "knob", None) is self._form.focused
        ]:
            self._form.focus(tries[0])

    def _switch(self) -> None:
        """Show all knobs or few; from the page of one knob, all again."""
        opened = self._opened if self._view == "knob" else ""
        if not opened:
            self._show_all = not self._show_all
            self._on_show(self._show_all)
        self._show(self._home)
        for widget in self._sections["body"][1]:
            if isinstance(widget, Knob) and widget.description.name == opened:
                self._form.focus(widget)

    def _try(self, experiment: Experiment, description: KnobDescription) -> Transition | None:
        """Fly a knob's experiment beside the run."""
        self._laboratory.choose(experiment, lab.experiment_name(experiment, description))
        return self._laboratory.fly(None)

    def _picks(self, named: Named) -> Callable[[], None]:
        """Return what asks for a guess at what a sabotage will do."""

        def ask() -> None:
            self._laboratory.choose(experiment_of(self.config, named[1]), self._run_kind.word(named))
            self._show("guess")

        return ask

    def _told(self, base: str, said: Sequence[str]) -> Sequence[str]:  # noqa: ARG002
        return said[:1]  # what was measured comes after the guess

    def _leave_lab(self) -> None:
        self._show("picks" if self._view == "guess" else "result" if self._laboratory.flies else self._home)
