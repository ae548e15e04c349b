"""Advice of the training screen: one diagnosis, its remedy at a press, and an undo."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any

from ai.training.config import Config
from ai.training.hints import Adviser, Hint
from ai.training.history import History
from game.core import texts
from game.drawing.tokens import HUMAN, SMALL
from game.training.knob_descriptions import told
from game.ui.panel import Column


class Advice:
    """Rows with the adviser's current hint; `turn` sets a knob by its name.

    `go_back` is called with the moment, in decisions, that a run should return to.

    Attributes:
        done: description of the last remedy's effect.

    """

    def __init__(self, turn: Callable[[str, Any], None], go_back: Callable[[int], None]) -> None:
        self._turn, self._go_back = turn, go_back
        self.adviser = Adviser(Config())
        self._moment = 0  # of the run as it was last seen, in decisions
        self._came_from: int | None = None  # the moment at which a remedy went back
        self._hint: Hint | None = None
        self.done = ""  # what the last remedy did
        self._quiet = False

    @property
    def shown(self) -> bool:
        """Whether there is anything to show."""
        return not self._quiet and (self._hint is not None or self.adviser.can_undo)

    @property
    def key(self) -> Hashable:
        """What decides which rows there are."""
        return self.shown, self._hint

    @property
    def hint(self) -> str:
        """Name of the hint that is shown; empty without one."""
        return self._hint.name if self._hint and self.shown else ""

    def follow(
        self, history: History, config: Config, dead_share: float | None = None, clipped_share: float | None = None
    ) -> None:
        """Diagnose the run again; call it when there is news."""
        if len(history):
            self._moment = int(history["decisions"][-1])
        self._hint = self.adviser.advise(history, config, dead_share, clipped_share)

    def hush(self, quiet: bool) -> None:
        """Hide the hint while other changes wait to be applied or undone: one question at a time."""
        if quiet != self._quiet:
            self._quiet = quiet
            self.adviser.undo()  # that question decides on what was applied

    def clear(self) -> None:
        """Reset for another run."""
        self.adviser.reset()
        self._hint = None

    def describe(self, column: Column) -> None:
        """Add the hint, or what its remedy did, with the words that answer it."""
        hint = self._hint
        said = texts.HINTS[hint.name].format(what=told(hint.remedy)) if hint else self.done
        column.caption(texts.HINT_TITLE if hint else texts.HINT_APPLIED)
        column.text(said, size=SMALL, colour=HUMAN)
        if hint is None:
            column.words([(texts.HINT_UNDO, self._undo), (texts.HINT_DISMISS, self._keep)])
            return
        apply = [(texts.HINT_APPLY, self._apply)] if hint.remedy or hint.back_to is not None else []
        column.words([*apply, (texts.HINT_DISMISS, self._dismiss)])

    def _apply(self) -> None:
        back_to = self._hint.back_to if self._hint else None
        remedy = self.adviser.apply(went_back=back_to is not None)
        went = [] if back_to is None else [texts.HINT_WENT_BACK.format(count=back_to)]
        self.done = ", ".join([*([told(remedy)] if remedy else []), *went])
        for name, value in remedy.items():
            self._turn(name, value)
        self._came_from = None if back_to is None else self._moment
        if back_to is not None:
            self._go_back(back_to)
        self._hint = None

    def _undo(self) -> None:
        for name, value in self.adviser.undo().items():
            self._turn(name, value)
        if self._came_from is not None:
            self._go_back(self._came_from)
        self._hint = None

    def _dismiss(self) -> None:
        self.adviser.dismiss()
        self._hint = None

    def _keep(self) -> None:
        """Keep the remedy, and close the hint."""
        self.adviser.undo()
        self._hint = None
