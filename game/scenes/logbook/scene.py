"""Logbook scene: the list of all flights, their totals, and charts of the player's skill."""

from __future__ import annotations

import time
from typing import Final

import numpy as np
import pygame

from ai.lander.rules import tenths
from game.core import texts
from game.core.scene import Transition, push
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, LABEL, MARGIN, MUTE, SMALL, TITLE, VIEW_SIZE
from game.flight import sharing
from game.flight.becoming import KINDS, Becoming, kind_of, said, tells
from game.flight.flight_file import Entry, Record
from game.flight.friend import paste
from game.flight.logbook import Records, Totals, best, totals
from game.flight.outcomes import ending_word
from game.panels.becoming_band import draw_band
from game.ui.actions import Action, Table
from game.ui.chart import Chart, Series
from game.ui.charts import Charts
from game.ui.clipboard import give
from game.ui.context import Context
from game.ui.list_scene import VERB_LINE, VERB_SIZE, ListLayout, ListScene
from game.ui.listing import Row
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widget import Widget
from game.ui.widgets import Choice, TextButton

_LEFT: Final = 824
_LAYOUT: Final = ListLayout(
    box=pygame.Rect(MARGIN, 252, 672, 336),
    columns=(392.0, 244.0, 164.0, 92.0, 0.0),
    headings=texts.LOGBOOK_COLUMNS,
    pitch=28,
    verbs=(_LEFT, 486),
    foot=612,
    size=SMALL + 1,
    rise=9,
)
_WIDTH: Final = VIEW_SIZE[0] - MARGIN - _LEFT
_KINDS: Final = 98  # the choice of a kind of start, above its chart
_CHARTS: Final = (136, 330)
_CHART_HEIGHT: Final = 150
_ENDS: Final = (2.0, 4.0)  # dashes of the band's ends
_SAID: Final = 304.0  # the estimate in words, between the charts
_TOTALS: Final = (146.0, 132.0)  # baseline of their labels, and how far apart they stand


class LogbookScene(ListScene[Entry]):
    """Logbook scene: flights on the left, newest first; skill and actions on the chosen flight on the right."""

    def __init__(self, context: Context) -> None:
        super().__init__(context, texts.LOGBOOK_TITLE, _LAYOUT, empty=texts.LOGBOOK_EMPTY)
        self._records = Records(context.user_dir)
        self._last_thrown = ""
        manager = self.form.manager
        box = (MARGIN, _LAYOUT.box.top - 54, 330, 20)
        self._filter = self.form.add(
            Choice(manager, box, "", texts.LOGBOOK_FILTERS, 0, lambda _: self._fill(), size=SMALL)
        )
        self._kind = self.form.add(
            Choice(
                manager,
                (_LEFT, _KINDS, _WIDTH, 20),
                "",
                [texts.BECOMING_KINDS[kind] for kind in KINDS],
                KINDS.index(self._last_kind()),
                lambda _: self._plot(),
                size=SMALL,
            )
        )
        self._charts = Charts([
            Chart((_LEFT, _CHARTS[0], _WIDTH, _CHART_HEIGHT), texts.BECOMING_TITLE, limits=(0.0, 10.0),
                  read="{:.1f}".format, read_x=texts.LOGBOOK_FLIGHT.format, empty=texts.BECOMING_NONE),
            Chart((_LEFT, _CHARTS[1], _WIDTH, _CHART_HEIGHT - 20), texts.LOGBOOK_FUEL, read="{:.1f} s".format,
                  read_x=texts.LOGBOOK_FLIGHT.format, empty=texts.LOGBOOK_FUEL_NONE),
        ])  # fmt: skip
        self.form.add(VirtualPointer(manager, self._charts.box, self._charts.follow))
        paste_box = (MARGIN + 130, _LAYOUT.foot, 220, VERB_LINE)
        self._paste = TextButton(manager, paste_box, texts.CODE_PASTE, lambda: paste(context), size=VERB_SIZE)
        self._reload()

    def _last_kind(self) -> str:
        """Return the kind of start of the last flight that tells something, or else of the last one."""
        entries = self._records.entries()
        told = [entry for entry in entries if tells(entry)] or entries
        return kind_of(told[-1]) if told else KINDS[0]

    def _below_list(self) -> list[Widget]:
        """Return the way back, and beside it the way in for a friend's flight."""
        return [*super()._below_list(), self._paste]

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Pass the event to the charts and the widgets."""
        self._charts.follow(event)
        return super().handle_event(event)

    def actions(self) -> Table:
        """Move, choose, go back; the Delete key deletes a flight."""
        delete = [] if self.form.typing else [Action(pygame.K_DELETE, self._throw_away)]
        undo = [Action(pygame.K_z, self._undo)] if self._last_thrown in self._thrown and not self.form.typing else []
        return [*super().actions(), *delete, *undo]

    def update(self) -> Transition | None:
        """Animate widgets and charts."""
        self._charts.update(self.context.settings.reduced_motion)
        return self.form.update()

    # What there is

    @property
    def _replayable(self) -> bool:
        return self.chosen is not None and self.chosen.file in self._kept

    def _reload(self) -> None:
        """Reload the flights from disk."""
        self._entries = self._records.entries()
        self._kept, self._thrown = self._records.kept(), self._records.thrown()
        self._line = self._records.problem or texts.LOGBOOK_PLACE.format(folder=self._records.folder)
        self._totals, self._becoming = totals(self._entries), Becoming(self._entries)
        self._plot()
        self._fill()

    def _fill(self) -> None:
        """List the flights that pass the filter, newest first, or the best flights by their score."""
        shown = [
            lambda: self._entries[::-1],
            lambda: [entry for entry in reversed(self._entries) if entry.landed],
            lambda: [entry for entry in best(self._entries) if not entry.outdated],
        ][self._filter.index]()
        self._show(shown, self.chosen)

    def _plot(self) -> None:
        """Draw the curve of the chosen kind of start, and the fuel of landings alone from it."""
        kind = KINDS[self._kind.index]
        curve, flights = self._becoming.curves[kind], self._becoming.flights[kind]
        number, span = np.arange(1, len(curve) + 1), (1.0, float(len(curve)))
        shares = np.array([(each.mean, each.low, each.high) for each in curve]).reshape(-1, 3)
        fuel = [entry.fuel if entry.landed and entry.alone else np.nan for entry in flights]
        series = [
            Series(number, 10 * share, name, HUMAN, dash=dash, smooth=False)
            for share, name, dash in zip(shares.T, texts.BECOMING_LINES, ((), _ENDS, _ENDS), strict=True)
        ]
        self._charts.charts[0].set(series, span)
        self._charts.charts[1].set([Series(number, np.array(fuel, float), texts.LOGBOOK_YOU, HUMAN)], span)

    def _row(self, entry: Entry) -> Row:
        when, course, end, *more = entry_row(entry)
        return when, course, texts.LOGBOOK_ROW_THROWN if entry.file in self._thrown else end, *more

    def _make_verbs(self) -> list[Widget]:
        self._why_gone = self._records.why_gone(self.chosen) if self.chosen else ""
        if self._replayable:
            return self._buttons(
                [
                    (texts.LOGBOOK_WATCH, self._watch),
                    (texts.LOGBOOK_RACE, self._race),
                    (texts.CODE_COPY, self._copy),
                    (texts.LOGBOOK_THROW_AWAY, self._throw_away),
                ]
            )
        if self.chosen and self.chosen.file in self._thrown:
            return self._buttons([(texts.LOGBOOK_BRING_BACK, self._bring_back)])
        return []

    # What can be done

    def _read(self) -> Record | None:
        """Read the chosen flight; if it is damaged, tell the player and return None."""
        if not self._replayable or self.chosen is None:
            return None
        try:
            return self._records.read(self.chosen.file)
        except ValueError as error:
            self.context.note(str(error))
            return None

    def _press_row(self) -> Transition | None:
        return self._watch()

    def _watch(self) -> Transition | None:
        record = self._read()
        return push("replay", record) if record else None

    def _race(self) -> Transition | None:
        record = self._read()
        return push("race", record) if record else None

    def _copy(self) -> None:
        if record := self._read():
            code = sharing.code(record)
            give(self.context, code, texts.CODE_COPIED.format(count=len(code)))

    def _throw_away(self) -> None:
        if self.chosen and self._replayable:
            self._last_thrown = self.chosen.file
            self._tell(self._records.throw_away(self.chosen.file), texts.LOGBOOK_THROWN)

    def _undo(self) -> None:
        """Bring back the flight that was thrown away last."""
        self._tell(self._records.bring_back(self._last_thrown), texts.LOGBOOK_BROUGHT_BACK)

    def _bring_back(self) -> None:
        if self.chosen:
            self._tell(self._records.bring_back(self.chosen.file), texts.LOGBOOK_BROUGHT_BACK)

    def _tell(self, done: bool, words: str) -> None:
        """Report what was done, or why it failed."""
        self._report(words if done else self._records.problem)

    # The picture

    def _draw_behind(self, canvas: Canvas) -> None:
        """Draw the totals and the charts."""
        _draw_totals(canvas, self._totals)
        kind, chart = KINDS[self._kind.index], self._charts.charts[0]
        curve = self._becoming.curves[kind]
        draw_band(canvas, curve, lambda number, share: chart.place(number, 10 * share))
        self._charts.draw(canvas)
        if curve:
            text = said(self._becoming.estimate(kind))
            canvas.text(text, (_LEFT, _SAID), size=SMALL, colour=MUTE, room=_WIDTH)

    def _draw_chosen(self, canvas: Canvas) -> None:
        """Write below the verbs why a flight does not count, and why it cannot be seen any more."""
        y = _LAYOUT.verbs[1] + 22 + VERB_LINE * len(self._verbs)
        bar = why_in_brackets(self.chosen) if self.chosen and self.chosen.bar else ""
        for text in filter(None, (bar, self._why_gone)):
            y = draw_wrapped(canvas, text, (_LEFT, y), _WIDTH, colour=MUTE, leading=19)


def why_in_brackets(entry: Entry) -> str:
    """Return the points of a flight that does not count, as its row has them, and why it does not."""
    return f"{texts.LOGBOOK_UNCOUNTED.format(points=entry.score)}: {texts.NOT_COUNTED[entry.bar]}"


def _draw_totals(canvas: Canvas, sums: Totals) -> None:
    percent = f"{100 * sums.landings / sums.flights:.0f}" if sums.flights else "–"
    figures = (
        (f"{sums.flights}", ""),
        (f"{sums.landings}", f"{percent} %"),
        (f"{sums.seconds / 60:.0f}", "min"),
        (f"{sums.fuel:.0f}", "s"),
        (f"{sums.streak}", ""),
    )
    y, pitch = _TOTALS
    for number, (label, (figure, unit)) in enumerate(zip(texts.LOGBOOK_TOTALS, figures, strict=True)):
        x = MARGIN + number * pitch
        canvas.text(label, (x, y), size=LABEL, weight="medium", colour=MUTE)
        box = canvas.text(figure, (x - 1, y + 30), size=TITLE + 4, weight="light", tabular=True)
        canvas.text(unit, (box.right + 5, y + 30), size=SMALL, colour=MUTE)


def entry_row(entry: Entry) -> Row:
    """Return a flight as a row of the logbook: when, what, how it ended, how long, points, and who flew."""
    when = time.strftime("%Y-%m-%d %H:%M", time.localtime(entry.when))
    points = (texts.LOGBOOK_UNCOUNTED if entry.bar else "{points}").format(points=entry.score)
    by = {1.0: texts.LOGBOOK_YOU, 0.0: texts.LOGBOOK_NETWORK}.get(entry.human, texts.LOGBOOK_SHARED)
    end, seconds = ending_word(entry.outcome, intact=entry.intact), f"{tenths(entry.seconds):.1f} s"
    course = sharing.course_name(entry.course, entry.leg, entry.spawn, entry.pads)
    return when, course, end, seconds, points if entry.landed else "–", by
