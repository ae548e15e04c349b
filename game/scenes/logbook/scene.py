"""Logbook scene: all flights, what can be done with the chosen one, and how often the player would land alone."""

from __future__ import annotations

import time
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import pygame

from game.core import texts
from game.core.scene import Transition, push
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, MUTE, SMALL, TITLE
from game.flight import sharing
from game.flight.becoming import KINDS, counts, curves, kind_of, said
from game.flight.flight_file import Entry, Record
from game.flight.friend import copy, paste
from game.flight.logbook import Records, best
from game.flight.networks import flew
from game.flight.outcomes import ending_word
from game.ui.actions import Action, Table
from game.ui.listing import Row
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas, Point
    from game.ui.context import Context
    from game.ui.panel import Column, Panel
    from game.ui.widget import OnPress

_LEAST: Final = 320.0  # points of a column
_COLUMNS: Final = (150.0, 0.0)  # from the right end of the list: where course and result end
_PITCH: Final = 30.0  # points of a row of the list
_CHART: Final = 130.0  # points of the chart's height
_BAND: Final = 0.16  # opacity
_LATEST: Final = 60  # flights on the chart


class LogbookScene(PanelScene):
    """Flights in a list, newest first; beside it, or below, what can be done with the chosen one; then the estimate.

    Attributes:
        items: what is listed.
        chosen: the chosen flight; None if there is none.

    """

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._records = Records(context.user_dir)
        self._filter, self._last_thrown = 0, ""
        self._more = False  # whether the estimate is shown
        self.chosen: Entry | None = None
        self.enter()
        counted = [entry for entry in self._entries if counts(entry)] or self._entries
        self._kind = kind_of(counted[-1]) if counted else KINDS[0]  # of the last flight that counts

    def enter(self) -> None:
        """Read the flights from disk, which the scene above may have changed."""
        self._entries = self._records.entries()
        self._kept, self._thrown = self._records.kept(), self._records.thrown()
        self.build()

    def describe(self, panel: Panel) -> None:
        panel.title(texts.LOGBOOK_TITLE)
        if self._records.problem:
            panel.aside(self._records.problem)
        left, self._beside = panel.beside((3, 2), _LEAST, 48.0)
        left.choice("", texts.LOGBOOK_FILTERS, self._filter, self._show, size=SMALL)
        self.items: list[Entry] = self._shown
        index = self.items.index(self.chosen) if self.chosen in self.items else 0
        self.chosen = self.items[index] if self.items else None
        self._list = left.listing(
            [self._row(entry) for entry in self.items], lambda _: self._watch(), texts.LOGBOOK_EMPTY,
            index=index, on_choose=self._choose, columns=_COLUMNS, pitch=_PITCH, size=SMALL + 1,
        )  # fmt: skip
        left.button(texts.CODE_PASTE, partial(paste, self.context))
        self.form.focus(self._list)
        self._describe_chosen(self._beside)

    @property
    def _shown(self) -> list[Entry]:
        """The flights that pass the filter, newest first, or the best flights by their score."""
        newest = self._entries[::-1]
        if self._filter == 1:
            return [entry for entry in newest if entry.landed]
        return [entry for entry in best(newest) if not entry.outdated] if self._filter else newest

    def _describe_chosen(self, column: Column) -> None:
        """Add what can be done with the chosen flight, why it does not count, and the estimate for whoever asks."""
        entry = self.chosen
        if entry and self._replayable:
            column.button(texts.LOGBOOK_WATCH, self._watch, size=TITLE, colour=INK)
            verbs: list[tuple[str, OnPress]] = [(texts.LOGBOOK_RACE, self._race), (texts.CODE_COPY, self._copy)]
            column.words([*verbs, (texts.LOGBOOK_THROW_AWAY, self._throw_away)])
        elif entry and entry.file in self._thrown:
            column.button(texts.LOGBOOK_BRING_BACK, self._bring_back, size=TITLE, colour=INK)
        if entry:
            for words in filter(None, (who_and_when(entry), why_not(entry), self._records.why_gone(entry))):
                column.aside(words)
        column.gap(14)
        column.button(texts.CHOICES_LESS if self._more else texts.CHOICES_MORE, self._switch_more)
        if self._more:
            column.caption(texts.BECOMING_TITLE)
            self._curves = curves(self._entries)
            kinds = [texts.BECOMING_KINDS[kind] for kind in KINDS]
            column.choice("", kinds, KINDS.index(self._kind), self._show_kind, size=SMALL)
            column.aside(lambda: said(self._curves[self._kind][-1]))
            column.picture(_CHART, self._draw_estimate)

    def _row(self, entry: Entry) -> Row:
        when, course, result = entry_row(entry)
        return when, course, texts.LOGBOOK_ROW_THROWN if entry.file in self._thrown else result

    def actions(self) -> Table:
        undo = [Action(pygame.K_z, self._undo)] if self._last_thrown in self._thrown else []
        return [self.form.moves, *super().actions(), Action(pygame.K_DELETE, self._throw_away), *undo]

    # What can be done

    def _show(self, number: int) -> None:
        self._filter = number
        self.build()
        self.form.focus(self.form.widgets[0])

    def _show_kind(self, number: int) -> None:
        self._kind = KINDS[number]

    def _switch_more(self) -> None:
        self._more = not self._more
        self._choose(self._list.index)

    def _choose(self, number: int) -> None:
        self.chosen = self.items[number] if self.items else None
        self._beside.clear()
        self._describe_chosen(self._beside)

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
            copy(self.context, record)

    def _throw_away(self) -> None:
        if self.chosen and self._replayable:
            self._last_thrown = self.chosen.file
            self._tell(self._records.throw_away(self.chosen.file), texts.LOGBOOK_THROWN)

    def _undo(self) -> None:
        self._tell(self._records.bring_back(self._last_thrown), texts.LOGBOOK_BROUGHT_BACK)

    def _bring_back(self) -> None:
        if self.chosen:
            self._tell(self._records.bring_back(self.chosen.file), texts.LOGBOOK_BROUGHT_BACK)

    def _tell(self, done: bool, words: str) -> None:
        self.context.note(words if done else self._records.problem)
        self.enter()
        self.form.focus(self._list)

    def _draw_estimate(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw of how many flights in ten the player would land, flight after flight; nothing before that is known."""
        curve = self._curves[self._kind]
        if not curve[-1].known:
            return
        area = pygame.FRect(box.left, box.top + 12, box.width - 28, box.height - 24)
        for share in (0.0, 0.5, 1.0):
            y = area.bottom - area.height * share
            canvas.line((area.left, y), (area.right, y), FAINT, alpha=0.7)
            canvas.text(str(round(10 * share)), (area.right + 10, y + 4), size=LABEL, colour=MUTE)
        curve = curve[1:][-_LATEST:]
        step = area.width / max(20, len(curve))

        def place(number: float, share: float) -> Point:
            return area.left + step * number, area.bottom - area.height * share

        for number, estimate in enumerate(curve):
            (left, top), (right, bottom) = place(number, estimate.high), place(number + 1, estimate.low)
            canvas.fill(canvas.rect(left, top, right - left, bottom - top), HUMAN, _BAND)
        points = [place(number + 0.5, estimate.mean) for number, estimate in enumerate(curve)]
        for start, end in pairwise(points):
            canvas.line(start, end, HUMAN, 1.5)
        canvas.dot(points[-1], 4, HUMAN)


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
    course = sharing.course_name(entry.course, entry.leg, entry.spawn, entry.pads)
    result = points if entry.landed else ending_word(entry.outcome, intact=entry.intact)
    return time.strftime("%Y-%m-%d", time.localtime(entry.when)), course, result
