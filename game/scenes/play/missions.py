"""Missions scene: the campaign's missions with goals and best results."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

from ai.lander.missions import MISSIONS
from ai.lander.rules import tenths
from game.core import texts
from game.core.scene import Transition, push
from game.drawing.cursor import BASELINE, LEADING, Cursor
from game.drawing.tokens import HUMAN, INK, MUTE, SMALL, TITLE
from game.flight import flight_file
from game.flight.flight_file import Entry
from game.flight.logbook import Records, rank
from game.scenes.play.card import draw_lamps
from game.scenes.play.challenge import FlownMission
from game.ui.actions import Table
from game.ui.listing import Row
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from game.ui.context import Context
    from game.ui.panel import Panel

_LEAST: Final = 320.0  # points of a column
_PITCH, _AROUND = 30.0, 100.0  # points of a row of the list, and above and below the list
_FLIGHTS: Final = "flights"  # in the game's own data
_NAMES: Final = tuple(MISSIONS)


class MissionsScene(PanelScene):
    """Missions: a list in teaching order, and the chosen one beside it, or below it in a narrow window."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._index = 0
        self.enter()

    def enter(self) -> None:
        self._records = Records(self.context.user_dir)
        self._best = _best_by_course(self._records.entries())
        if self._records.problem:
            self.context.note(self._records.problem)
        self.build()

    def actions(self) -> Table:
        return [self.form.moves, *super().actions()]

    @property
    def chosen(self) -> str:
        return _NAMES[self._index]

    # Rows

    def describe(self, panel: Panel) -> None:
        panel.title(texts.MISSIONS_TITLE)
        panel.gap(8)
        left, right = panel.beside((5, 4), _LEAST)
        left.listing(
            [self._row(name) for name in _NAMES], lambda _: self._fly(), around=_AROUND, pitch=_PITCH,
            index=self._index, on_choose=self._choose,
        )  # fmt: skip
        right.title(lambda: texts.MISSIONS[self.chosen][0], 28.0)
        right.text(lambda: texts.MISSIONS[self.chosen][1])
        right.gap(10)
        for medal in (3, 2, 1):
            right.add(partial(self._write_medal, medal))
        right.add(self._write_best)
        right.gap(12)
        right.button(texts.MISSION_FLY, self._fly, size=TITLE, colour=INK)

    def _write_best(self, cursor: Cursor) -> None:
        if best := self._best.get(self.chosen):
            words = texts.MISSION_BEST.format(fuel=tenths(best.fuel), seconds=tenths(best.seconds), count=best.score)
            cursor.styled(words, SMALL, HUMAN)

    def _choose(self, index: int) -> None:
        self._index = index

    def _row(self, name: str) -> Row:
        best = self._best.get(name)
        return texts.MISSIONS[name][0], texts.MEDALS[best.medal] if best else "–"

    def _write_medal(self, medal: int, cursor: Cursor) -> None:
        """Write what a medal asks, behind its lamps, and a tick if it is won."""
        mission, best = MISSIONS[self.chosen], self._best.get(self.chosen)
        limit = {3: mission.gold, 2: mission.silver}.get(medal)
        words = texts.MISSION_LIMIT.format(fuel=limit[0], seconds=limit[1]) if limit else texts.MISSION_ANY
        if canvas := cursor.canvas:
            draw_lamps(canvas, (cursor.left + 31, cursor.baseline - 5), medal)
            canvas.text(texts.MEDALS[medal], (cursor.left + 52, cursor.baseline), size=SMALL + 1, colour=INK)
            if best and best.medal >= medal:
                canvas.marker("check", (cursor.right - 8, cursor.baseline - 4), 11, canvas.palette.good)
        beside = replace(cursor, left=cursor.left + 124, width=cursor.width - 148).in_style(SMALL, MUTE)
        beside.y += BASELINE * (cursor.size - SMALL)
        beside.text(words)
        cursor.y = max(beside.y, cursor.y + LEADING * cursor.size) + 6

    # Flights

    def _mission(self, name: str) -> FlownMission:
        """Choose a mission, so that the way back leads to it, and return it with the way to the next one.

        Its ghost is the network or, where that does not land, a recorded landing.
        """
        self._index, record = _NAMES.index(name), None
        if not MISSIONS[name].network_lands:
            try:
                record = flight_file.read(self.context.assets_dir / _FLIGHTS / f"{name}.json")
            except ValueError as error:
                self.context.note(str(error))
        later = _NAMES[_NAMES.index(name) + 1 :]
        following = partial(self._mission, later[0]) if later else None
        return FlownMission(MISSIONS[name], record, lambda: texts.MISSION_GHOST, following)

    def _fly(self) -> Transition:
        return push("play", 0, challenge=self._mission(self.chosen))


def _best_by_course(entries: list[Entry]) -> dict[str, Entry]:
    """Return the player's best unaided landing in each named challenge."""
    landings = [entry for entry in entries if entry.course and entry.alone and entry.landed]
    return {entry.course: entry for entry in sorted(landings, key=rank, reverse=True)}
