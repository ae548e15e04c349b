"""Logbook scene: the list of all flights, their totals, and charts of the player's skill."""

from __future__ import annotations

import time
from typing import Final

import numpy as np
import pygame

from ai.lander.rules import tenths
from game.charts.chart import Chart, Series
from game.charts.charts import Charts
from game.core import texts
from game.core.scene import Transition, push
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, LABEL, MARGIN, MUTE, SMALL, TITLE, VIEW_SIZE
from game.flight.flight_file import Entry, Record
from game.flight.logbook import Records, Totals, best, skill, totals
from game.play.race import race
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.list_scene import VERB_LINE, ListLayout, ListScene
from game.ui.listing import Row
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widget import Widget
from game.ui.widgets import Choice

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
_CHARTS: Final = (136, 304)
_CHART_HEIGHT: Final = 150
_TOTALS: Final = (146.0, 132.0)  # baseline of their labels, and how far apart they stand


class LogbookScene(ListScene[Entry]):
    """Logbook scene: flights on the left, newest first; skill and actions on the chosen flight on the right."""

    def __init__(self, context: Context) -> None:
        super().__init__(context, texts.LOGBOOK_TITLE, _LAYOUT, empty=texts.LOGBOOK_EMPTY)
        self._records = Records(context.user_dir)
        manager = self.form.manager
        box = (MARGIN, _LAYOUT.box.top - 54, 330, 20)
        self._filter = self.form.add(
            Choice(manager, box, "", texts.LOGBOOK_FILTERS, 0, lambda _: self._fill(), size=SMALL)
        )
        self._charts = Charts([
            Chart((_LEFT, _CHARTS[0], _WIDTH, _CHART_HEIGHT), texts.LOGBOOK_SKILL, limits=(0.0, 100.0),
                  read="{:.0f} %".format, read_x=texts.LOGBOOK_FLIGHT.format),
            Chart((_LEFT, _CHARTS[1], _WIDTH, _CHART_HEIGHT), texts.LOGBOOK_FUEL, read="{:.1f} s".format,
                  read_x=texts.LOGBOOK_FLIGHT.format),
        ])  # fmt: skip
        self.form.add(VirtualPointer(manager, self._charts.box, self._charts.follow))
        self._reload()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Pass the event to the charts and the widgets."""
        self._charts.follow(event)
        return super().handle_event(event)

    def actions(self) -> Table:
        """Move, choose, go back; the Delete key deletes a flight."""
        delete = [] if self.form.typing else [Action(pygame.K_DELETE, self._throw_away)]
        return [*super().actions(), *delete]

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
        self._totals = totals(self._entries)
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
        own = skill(self._entries)
        fuel = [entry.fuel if entry.landed else np.nan for entry in self._entries if entry.alone]
        number, span = np.arange(1, len(own) + 1), (1.0, float(len(own)))
        share = Series(number, 100 * np.array(own), texts.LOGBOOK_YOU, HUMAN, smooth=False)
        landings = Series(number, np.array(fuel, float), texts.LOGBOOK_YOU, HUMAN)
        for chart, series in zip(self._charts.charts, (share, landings), strict=True):
            chart.set([series], span)

    def _row(self, entry: Entry) -> Row:
        return entry_row(entry)

    def _make_verbs(self) -> list[Widget]:
        self._why_gone = self._records.why_gone(self.chosen) if self.chosen else ""
        if self._replayable:
            return self._buttons(
                [
                    (texts.LOGBOOK_WATCH, self._watch),
                    (texts.LOGBOOK_RACE, self._race),
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
        return push("play", record.recording.seed, challenge=race(record)) if record else None

    def _throw_away(self) -> None:
        if self.chosen and self._replayable:
            self._tell(self._records.throw_away(self.chosen.file), texts.LOGBOOK_THROWN)

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
        self._charts.draw(canvas)

    def _draw_chosen(self, canvas: Canvas) -> None:
        """Write below the verbs why a flight does not count, and why it cannot be seen any more."""
        y = _LAYOUT.verbs[1] + 22 + VERB_LINE * len(self._verbs)
        bar = texts.NOT_COUNTED[self.chosen.bar] if self.chosen and self.chosen.bar else ""
        for text in filter(None, (bar, self._why_gone)):
            y = draw_wrapped(canvas, text, (_LEFT, y), _WIDTH, colour=MUTE, leading=19)


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
    end, seconds = texts.OUTCOMES[entry.outcome][0], f"{tenths(entry.seconds):.1f} s"
    return when, _challenge(entry), end, seconds, points if entry.landed else "–", by


def _challenge(entry: Entry) -> str:
    """Return the name of the challenge that a flight belongs to."""
    if entry.leg:
        return texts.DESCENT_COURSE.format(number=entry.leg)
    if entry.course == "daily":
        return texts.DAILY
    return texts.MISSIONS[entry.course][0] if entry.course in texts.MISSIONS else texts.COURSE_FREE.get(entry.pads, "")
