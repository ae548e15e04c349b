"""Advice of the training screen: one diagnosis, and its remedy at a press."""

from __future__ import annotations

from ai.training.hints import Adviser, Hint
from game.core import texts
from game.drawing.tokens import HUMAN, SMALL
from game.training.run import TrainingRun
from game.training.run_settings import RunSettings, format_changes
from game.ui.panel import Column


class Advice:
    """Rows with the adviser's hint on a run, which goes on with other settings at a press."""

    def __init__(self, run: TrainingRun, settings: RunSettings) -> None:
        self._run, self._settings = run, settings
        self.adviser = Adviser()
        self._seen: object = None  # the network on which there was advice last

    @property
    def shown(self) -> Hint | None:
        """The hint; None without one, beside an experiment, and while a change waits: one question at a time."""
        return None if self._settings.waits or self._run.twin else self.adviser.shown

    def update(self) -> None:
        """Diagnose the run again where there is news."""
        run = self._run
        if not run.alive:
            self.adviser.reset()
        elif run.network_state is not self._seen and len(run.history):
            self._seen = run.network_state
            self.adviser.advise(run.history, run.config)

    def describe(self, column: Column, hint: Hint) -> None:
        """Add the hint, with the words that answer it."""
        column.caption(texts.HINT_TITLE)
        column.text(texts.HINTS[hint.name].format(what=format_changes(hint.remedy)), size=SMALL, colour=HUMAN)
        apply = [(texts.HINT_APPLY, self._apply)] if hint.remedy or hint.back_to is not None else []
        column.words([*apply, (texts.HINT_DISMISS, self.adviser.dismiss)])

    def _apply(self) -> None:
        hint = self.adviser.shown
        assert hint is not None
        self.adviser.dismiss()
        for name, value in hint.remedy.items():
            self._settings.turn(name, value)
        if hint.back_to is not None:
            self._run.ask("restore", hint.back_to)
