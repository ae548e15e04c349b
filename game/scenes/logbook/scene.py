"""Logbook scene: all flights, and what can be done with the chosen one."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING, Final

from game.core import texts
from game.core.scene import Transition, push
from game.drawing.tokens import INK, SMALL, TITLE
from game.flight import codes
from game.flight.flight_file import Entry, Record
from game.flight.friend import paste
from game.flight.logbook import Records, best
from game.flight.networks import flew
from game.flight.outcomes import ending_word
from game.ui.actions import Table
from game.ui.clipboard import give
from game.ui.listing import Row
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from game.ui.context import Context
    from game.ui.panel import Column, Panel

_LEAST: Final = 320.0  # points of a column
_COLUMNS: Final = (150.0, 0.0)  # from the right end of the list: where course and result end
_PITCH: Final = 30.0  # points of a row of the list


class LogbookScene(PanelScene):
    """Flights in a list, newest first; beside it, or below, what can be done with the chosen one.

    Attributes:
        items: what is listed.
        chosen: the chosen flight; None if there is none.

    """

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._records = Records(context.user_dir)
        self._filter = 0
        self.chosen: Entry | None = None
        self.enter()

    def enter(self) -> None:
        self._entries = self._records.entries()
        self._kept = self._records.kept()
        self.build()

    def describe(self, panel: Panel) -> None:
        panel.title(texts.LOGBOOK_TITLE)
        if self._records.problem:
            panel.aside(self._records.problem)
        left, right = panel.beside((3, 2), _LEAST, 48.0)
        left.choice("", texts.LOGBOOK_FILTERS, self._filter, self._show, size=SMALL)
        self.items: list[Entry] = self._shown
        index = self.items.index(self.chosen) if self.chosen in self.items else 0
        self.chosen = self.items[index] if self.items else None
        self._list = left.listing(
            [entry_row(entry) for entry in self.items], lambda _: self._watch(), texts.LOGBOOK_EMPTY,
            index=index, on_choose=self._choose, columns=_COLUMNS, pitch=_PITCH, size=SMALL + 1,
        )  # fmt: skip
        left.button(texts.CODE_PASTE, partial(paste, self.context))
        self.form.focus(self._list)
        self._describe_chosen(right)

    @property
    def _shown(self) -> list[Entry]:
        """All flights, newest first, or the best by their score."""
        newest = self._entries[::-1]
        return best(newest) if self._filter else newest

    def _describe_chosen(self, column: Column) -> None:
        """Add what can be done with the chosen flight, who flew it, and why it does not count."""
        entry = self.chosen
        if not entry:
            return
        if self._replayable:
            column.button(texts.LOGBOOK_WATCH, self._watch, size=TITLE, colour=INK)
            column.words([(texts.LOGBOOK_RACE, self._race), (texts.CODE_COPY, self._copy)])
        gone = "" if self._replayable else texts.FLIGHT_GONE
        for words in filter(None, (who_and_when(entry), why_not(entry), gone)):
            column.aside(words)

    def actions(self) -> Table:
        return [self.form.moves, *super().actions()]

    # What can be done

    def _show(self, number: int) -> None:
        self._filter = number
        self.build()
        self.form.focus(self.form.widgets[0])

    def _choose(self, number: int) -> None:
        self.chosen = self.items[number] if self.items else None
        self.build()

    @property
    def _replayable(self) -> bool:
        return self.chosen is not None and self.chosen.file in self._kept

    def _record(self) -> Record | None:
        """Read the chosen flight; if it is damaged, tell the player and return None."""
        if not self._replayable or self.chosen is None:
            return None
        try:
            return self._records.read(self.chosen.file)
        except ValueError as error:
            self.context.note(str(error))
            return None

    def _watch(self) -> Transition | None:
        return push("replay", record) if (record := self._record()) else None

    def _race(self) -> Transition | None:
        return push("race", record) if (record := self._record()) else None

    def _copy(self) -> None:
        if record := self._record():
            give(self.context, codes.code(record), texts.CODE_COPIED)


def who_and_when(entry: Entry) -> str:
    """Return when a flight ended, and who flew it."""
    who = flew(entry.network)
    by = {1.0: texts.LOGBOOK_YOU, 0.0: who}.get(entry.human, texts.LOGBOOK_SHARED.format(who=who))
    return texts.LOGBOOK_WHO.format(time=time.strftime("%H:%M", time.localtime(entry.when)), who=by)


def why_not(entry: Entry) -> str:
    """Return why a flight does not count; empty if it counts."""
    return texts.NOT_COUNTED[entry.bar].format(who=flew(entry.network)) if entry.bar else ""


def entry_row(entry: Entry) -> Row:
    """Return a flight as a row of the logbook: the day, what, and its points or how it ended."""
    points = (texts.LOGBOOK_UNCOUNTED if entry.bar else "{points}").format(points=entry.score)
    course = codes.course_name(entry.course, entry.leg, entry.spawn, entry.pads)
    result = points if entry.landed else ending_word(entry.outcome, intact=entry.intact)
    return time.strftime("%Y-%m-%d", time.localtime(entry.when)), course, result
