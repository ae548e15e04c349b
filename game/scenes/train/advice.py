"""Advice of the training screen: one diagnosis, and its remedy at a press."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any

from ai.training.hints import Adviser
from game.core import texts
from game.drawing.tokens import HUMAN, SMALL
from game.training.run import TrainingRun
from game.training.run_settings import format_changes
from game.ui.panel import Column


class Advice:
    """Rows with the adviser's hint on a run; `turn` sets a knob by its name."""

    def __init__(self, run: TrainingRun, turn: Callable[[str, Any], None]) -> None:
        self._run, self._turn = run, turn
        self.adviser = Adviser()
        self._quiet = False

    @property
    def shown(self) -> bool:
        """Whether there is anything to show."""
        return not self._quiet and self.adviser.shown is not None

    @property
    def key(self) -> Hashable:
        """What decides which rows there are."""
        return self.shown, self.adviser.shown

    def follow(self) -> None:
        """Diagnose the run again; call it when there is news."""
        run = self._run
        self.adviser.advise(run.history, run.config)

    def silence(self, quiet: bool) -> None:
        """Hide the hint while other changes wait to be applied or undone: one question at a time."""
        self._quiet = quiet

    def clear(self) -> None:
        """Reset for another run."""
        self.adviser.reset()

    def describe(self, column: Column) -> None:
        """Add the hint, and the words that answer it."""
        hint = self.adviser.shown
        assert hint is not None
        column.caption(texts.HINT_TITLE)
        said = texts.HINTS[hint.name].format(what=format_changes(hint.remedy))
        column.text(said, size=SMALL, colour=HUMAN)
        apply = [(texts.HINT_APPLY, self._apply)] if hint.remedy or hint.back_to is not None else []
        column.words([*apply, (texts.HINT_DISMISS, self.adviser.dismiss)])

    def _apply(self) -> None:
        """Turn knobs, and return to a checkpoint if there is one."""
        hint = self.adviser.shown
        assert hint is not None
        self.adviser.dismiss()
        for name, value in hint.remedy.items():
            self._turn(name, value)
        if hint.back_to is not None:
            self._run.ask("restore", hint.back_to)
