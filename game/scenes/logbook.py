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
from game.core.scene import Pop, Transition, push
from game.drawing.canvas import Canvas
from game.drawing.prose import wrapped
from game.drawing.sky import NightSky
from game.drawing.tokens import HUMAN, LABEL, LINE, MARGIN, MUTE, SMALL, TITLE, VIEW_SIZE
from game.flight.flight_file import Entry, Record
from game.flight.logbook import Records, Totals, best, skill, totals
from game.play.race import race
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FormScene
from game.ui.listing import Listing, shortened
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widget import Widget
from game.ui.widgets import Choice, TextButton

_LIST: Final = pygame.Rect(MARGIN, 252, 672, 336)
_PITCH: Final = 28
_COLUMNS: Final = (392.0, 244.0, 164.0, 92.0, 0.0)  # how far from the list's right end each cell ends
_LEFT: Final = 824
_WIDTH: Final = VIEW_SIZE[0] - MARGIN - _LEFT
_CHARTS: Final = (136, 304)
_CHART_HEIGHT: Final = 150
_FIRST_VERB: Final = 486
_LINE: Final = 36
_FOOT: Final = 612
_TOTALS: Final = (146.0, 132.0)  # baseline of their labels, and how far apart they stand


class LogbookScene(FormScene):
    """Logbook scene: flights on the left, newest first; skill and actions on the chosen flight on the right."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._shown: list[Entry] = []
        self._build(context)
        self._reload()

    def enter(self) -> None:
        """Reload the flights, to which one may have been added."""
        self._reload()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Pass the event to the charts and the widgets."""
        self._charts.follow(event)
        return super().handle_event(event)

    def actions(self) -> Table:
        """Move, choose, go back; the Delete key deletes a flight."""
        delete = [] if self.form.typing else [Action(pygame.K_DELETE, self._throw_away)]
        return [self.form.moves, *super().actions(), *delete]

    def update(self) -> Transition | None:
        """Animate widgets and charts."""
        self._charts.update(self.context.settings.reduced_motion)
        return self.form.update()

    # What there is

    @property
    def chosen(self) -> Entry | None:
        """The flight selected in the list; None if there is none."""
        return self._shown[self._list.index] if self._shown else None

    @property
    def _replayable(self) -> bool:
        return self.chosen is not None and self.chosen.file in self._kept

    def _build(self, context: Context) -> None:
        self._records = Records(context.user_dir)
        self._sky = NightSky(context.rng, ember=0.5, stars=70)
        manager = self.form.manager
        box = (MARGIN, _LIST.top - 54, 330, 20)
        self._filter = Choice(manager, box, "", texts.LOGBOOK_FILTERS, 0, lambda _: self._fill(), size=SMALL)
        self._list = self.form.add(Listing(
            manager, _LIST, [], on_choose=lambda _: self._set_verbs(), on_press=lambda _: self._watch(),
            empty=texts.LOGBOOK_EMPTY, columns=_COLUMNS, pitch=_PITCH, size=SMALL + 1,
        ))  # fmt: skip
        self.form.add(self._filter)
        self._verbs: list[Widget] = []
        self._charts = Charts([
            Chart((_LEFT, _CHARTS[0], _WIDTH, _CHART_HEIGHT), texts.LOGBOOK_SKILL, limits=(0.0, 100.0),
                  read="{:.0f} %".format, read_x=texts.LOGBOOK_FLIGHT.format),
            Chart((_LEFT, _CHARTS[1], _WIDTH, _CHART_HEIGHT), texts.LOGBOOK_FUEL, read="{:.1f} s".format,
                  read_x=texts.LOGBOOK_FLIGHT.format),
        ])  # fmt: skip
        self.form.add(VirtualPointer(manager, self._charts.box, self._charts.follow))

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
        before = self.chosen
        chosen = [
            lambda: self._entries[::-1],
            lambda: [entry for entry in reversed(self._entries) if entry.landed],
            lambda: [entry for entry in best(self._entries) if not entry.outdated],
        ][self._filter.index]()
        self._shown = chosen
        index = chosen.index(before) if before in chosen else 0
        self._list.set_rows([_row(entry) for entry in chosen], index)
        self._set_verbs()

    def _plot(self) -> None:
        own = skill(self._entries)
        fuel = [entry.fuel if entry.landed else np.nan for entry in self._entries if entry.alone]
        number, span = np.arange(1, len(own) + 1), (1.0, float(len(own)))
        share = Series(number, 100 * np.array(own), texts.LOGBOOK_YOU, HUMAN, smooth=False)
        landings = Series(number, np.array(fuel, float), texts.LOGBOOK_YOU, HUMAN)
        for chart, series in zip(self._charts.charts, (share, landings), strict=True):
            chart.set([series], span)

    def _set_verbs(self) -> None:
        self._why_gone = self._records.why_gone(self.chosen) if self.chosen else ""
        rows = []
        if self._replayable:
            rows = [(texts.LOGBOOK_WATCH, self._watch), (texts.LOGBOOK_RACE, self._race),
                    (texts.LOGBOOK_THROW_AWAY, self._throw_away)]  # fmt: skip
        elif self.chosen and self.chosen.file in self._thrown:
            rows = [(texts.LOGBOOK_BRING_BACK, self._bring_back)]
        manager = self.form.manager
        new: list[Widget] = [
            TextButton(manager, (_LEFT, _FIRST_VERB + number * _LINE, 220, _LINE), label, press, size=18)
            for number, (label, press) in enumerate(rows)
        ]
        new.append(TextButton(manager, (MARGIN, _FOOT, 72, _LINE), texts.BACK, Pop, size=18))
        self.form.replace(self._verbs, new)
        self._verbs = new

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
        """Report what was done, or why it failed, and reload the list."""
        self.context.note(words if done else self._records.problem)
        self._reload()
        self.form.focus(self._list)

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the list, the totals and the charts."""
        self._sky.draw(canvas)
        canvas.text(texts.LOGBOOK_TITLE, (MARGIN, 84), size=34, weight="light")
        canvas.text(shortened(canvas, self._line, SMALL, 700), (MARGIN, 110), size=SMALL, colour=MUTE, room=700)
        _draw_totals(canvas, self._totals)
        y = _LIST.top - 9
        for label, column in zip(texts.LOGBOOK_COLUMNS, (None, *_COLUMNS), strict=True):
            x = _LIST.left if column is None else self._list.right - column
            align = "left" if column is None else "right"
            canvas.text(label, (x, y), size=LABEL, weight="medium", colour=MUTE, align=align)  # type: ignore[arg-type]
        canvas.line((_LIST.left, _LIST.top), (self._list.right, _LIST.top), LINE)
        self._charts.draw(canvas)
        self.form.draw(canvas)
        y = _FIRST_VERB + 22 + _LINE * (len(self._verbs) - 1)  # below the verbs, of which Back is one
        bar = texts.NOT_COUNTED[self.chosen.bar] if self.chosen and self.chosen.bar else ""
        for line in [line for text in (bar, self._why_gone) if text for line in wrapped(canvas, text, SMALL, _WIDTH)]:
            canvas.text(line, (_LEFT, y), size=SMALL, colour=MUTE)
            y += 19
        self.draw_hints(canvas)


def _draw_totals(canvas: Canvas, sums: Totals) -> None:
    percent = f"{100 * sums.landings / sums.flights:.0f}" if sums.flights else "–"
    figures = (
        (f"{sums.flights}", ""), (f"{sums.landings}", f"{percent} %"), (f"{sums.seconds / 60:.0f}", "min"),
        (f"{sums.fuel:.0f}", "s"), (f"{sums.streak}", ""),
    )  # fmt: skip
    y, pitch = _TOTALS
    for number, (label, (figure, unit)) in enumerate(zip(texts.LOGBOOK_TOTALS, figures, strict=True)):
        x = MARGIN + number * pitch
        canvas.text(label, (x, y), size=LABEL, weight="medium", colour=MUTE)
        box = canvas.text(figure, (x - 1, y + 30), size=TITLE + 4, weight="light", tabular=True)
        canvas.text(unit, (box.right + 5, y + 30), size=SMALL, colour=MUTE)


def _row(entry: Entry) -> tuple[str, ...]:
    when = time.strftime("%Y-%m-%d %H:%M", time.localtime(entry.when))
    challenge = _challenge(entry)
    points = (texts.LOGBOOK_UNCOUNTED if entry.bar else "{points}").format(points=entry.score) if entry.landed else "–"
    by = {1.0: texts.LOGBOOK_YOU, 0.0: texts.LOGBOOK_NETWORK}.get(entry.human, texts.LOGBOOK_SHARED)
    return when, challenge, texts.OUTCOMES[entry.outcome][0], f"{tenths(entry.seconds):.1f} s", points, by


def _challenge(entry: Entry) -> str:
    """Return the name of the course that a flight was flown on."""
    if entry.course == "daily":
        return texts.DAILY
    return texts.MISSIONS[entry.course][0] if entry.course in texts.MISSIONS else texts.COURSE_FREE.get(entry.pads, "")
