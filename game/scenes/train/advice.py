"""Advice of the training screen: one diagnosis, its remedy at a press, and an undo."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any

from ai.training.config import Config
from ai.training.hints import Adviser
from game.core import texts
from game.drawing.tokens import HUMAN, SMALL
from game.training.run import TrainingRun
from game.training.run_settings import format_changes
from game.ui.panel import Column


class Advice:
    """Rows with the adviser's hint on a run; `turn` sets a knob by its name.

    Attributes:
        done: description of the last remedy's effect.

    """

    def __init__(self, run: TrainingRun, turn: Callable[[str, Any], None]) -> None:
        self._run, self._turn = run, turn
        self.adviser = Adviser(Config())
        self._came_from: int | None = None  # the moment at which a remedy went back, in decisions
        self.done = ""
        self._quiet = False

    @property
    def shown(self) -> bool:
        """Whether there is anything to show."""
        return not self._quiet and (self.adviser.shown is not None or self.adviser.can_undo)

    @property
    def key(self) -> Hashable:
        """What decides which rows there are."""
        return self.shown, self.adviser.shown

    @property
    def hint(self) -> str:
        """Name of the hint that is shown; empty without one."""
        return self.adviser.shown.name if self.adviser.shown and self.shown else ""

    def follow(self) -> None:
        """Diagnose the run again; call it when there is news."""
        run = self._run
        self.adviser.advise(run.history, run.config)

    def silence(self, quiet: bool) -> None:
        """Hide the hint while other changes wait to be applied or undone: one question at a time."""
        if quiet != self._quiet:
            self._quiet = quiet
            self.adviser.undo()  # that question decides on what was applied

    def clear(self) -> None:
        """Reset for another run."""
        self.adviser.reset()

    def describe(self, column: Column) -> None:
        """Add the hint, or what its remedy did, with the words that answer it."""
        hint = self.adviser.shown
        column.caption(texts.HINT_TITLE if hint else texts.HINT_APPLIED)
        said = texts.HINTS[hint.name].format(what=format_changes(hint.remedy)) if hint else self.done
        column.text(said, size=SMALL, colour=HUMAN)
        if hint is None:
            column.words([(texts.HINT_UNDO, self._undo), (texts.HINT_KEEP, self._keep)])
            return
        apply = [(texts.HINT_APPLY, self._apply)] if hint.remedy or hint.back_to is not None else []
        column.words([*apply, (texts.HINT_DISMISS, self.adviser.dismiss)])

    def _apply(self) -> None:
        assert self.adviser.shown is not None
        back_to = self.adviser.shown.back_to
        remedy = self.adviser.apply(went_back=back_to is not None)
        went = [] if back_to is None else [texts.HINT_WENT_BACK.format(count=back_to)]
        goes_on = [texts.HINT_SET.format(what=format_changes(remedy))] if remedy else []
        self.done = " ".join([*went, *goes_on])
        self._came_from = None if back_to is None else int(self._run.history["decisions"][-1])
        self._set(remedy, back_to)

    def _undo(self) -> None:
        self._set(self.adviser.undo(), self._came_from)

    def _set(self, values: Any, back_to: int | None) -> None:
        """Turn knobs, and return to a checkpoint if there is one."""
        for name, value in values.items():
            self._turn(name, value)
        if back_to is not None and (checkpoint := self._run.history.checkpoint_at(back_to)) is not None:
            self._run.ask("restore", checkpoint.decisions)

    def _keep(self) -> None:
        """Keep the remedy."""
        self.adviser.undo()
