"""Missions scene: the campaign's missions with goals and best results."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

import pygame

from ai.lander.missions import MISSIONS
from ai.lander.rules import tenths
from game.core import texts
from game.core.scene import Transition, push
from game.drawing.canvas import Canvas
from game.drawing.glyphs import icon
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, INK, MARGIN, MEDALS, MUTE, SMALL, TEXT, TITLE, VIEW_SIZE
from game.flight import flight_file
from game.flight.credit import TOGETHER
from game.flight.flight_file import Entry, Record
from game.flight.logbook import Records, rank
from game.scenes.play.card import draw_ring
from game.scenes.play.challenge import FlownMission
from game.ui.context import Context
from game.ui.list_scene import ListLayout, ListScene
from game.ui.listing import Row
from game.ui.widget import Widget
from game.ui.widgets import Choice

_LEFT: Final = 720
_LAYOUT: Final = ListLayout(
    box=pygame.Rect(MARGIN, 164, 560, 416),
    columns=(112.0, 0.0),
    headings=texts.MISSIONS_COLUMNS,
    pitch=32,
    verbs=(_LEFT, 524),
    foot=608,
)
_RING: Final = 14.0  # from a ring to its words
_LAMP, _LAMPS = 13.0, 62.0  # from one lamp of a medal to the next, and from the last to the end of its column
_WIDTH: Final = VIEW_SIZE[0] - MARGIN - _LEFT
_RIVAL: Final = (_LEFT, 412, _WIDTH, 32)
_RIVAL_LABEL: Final = 112.0
_NETWORK: Final = 468.0  # baseline of the network's result
_FLIGHTS: Final = "flights"  # in the game's own data
_NAMES: Final = tuple(MISSIONS)


class MissionsScene(ListScene[str]):
    """Missions scene: missions on the left, in teaching order; the chosen one on the right."""

    def __init__(self, context: Context) -> None:
        super().__init__(context, texts.MISSIONS_TITLE, _LAYOUT)
        self._rival = ""  # the player's choice of ghost; empty for the default of each mission
        self._fly_button = self._buttons([(texts.MISSION_FLY, self._fly)])
        self._reload()

    def _reload(self) -> None:
        """Reload the results from disk."""
        self._records = Records(self.context.user_dir)
        self._best = _best_by_course(self._records.entries())
        if self._records.problem:
            self.context.note(self._records.problem)
        self._kept, self._together = self._records.kept(), landed_together(self._records.entries())
        gold = sum(entry.medal == 3 for name, entry in self._best.items() if name in MISSIONS)
        self._line = texts.MISSIONS_LINE.format(gold=gold, count=len(MISSIONS))
        self._show(_NAMES, self.items and self.chosen)

    @property
    def chosen(self) -> str:
        """Name of the chosen mission."""
        return _NAMES[self._list.index]

    def _mission(self, name: str, rival: str) -> FlownMission:
        """Return a mission beside a ghost, with the way to the next one."""
        mission, record = MISSIONS[name], self._rival_record(name, rival)
        names = list(MISSIONS)
        later = names[names.index(name) + 1 :]
        following = partial(self._go_to, later[0]) if later else None
        if record is None:
            return FlownMission(mission, following=following)
        return FlownMission(mission, record, texts.MISSION_GHOSTS[rival], following)

    def _go_to(self, name: str) -> FlownMission:
        """Choose a mission, so that the way back leads to it, and return it beside its usual ghost."""
        self._list.index = _NAMES.index(name)
        return self._mission(name, _usual_rival(name))

    def _press_row(self) -> Transition:
        return self._fly()

    def _fly(self) -> Transition:
        return push("play", 0, challenge=self._mission(self.chosen, self._chosen_rival))

    # Ghosts

    @property
    def _offered(self) -> list[str]:
        """Names of the ghosts available in the chosen mission."""
        best = self._best.get(self.chosen)
        return ["network", "recorded", *(["own"] if best and best.file in self._kept else [])]

    @property
    def _chosen_rival(self) -> str:
        """The player's choice of ghost if available; else the network where it lands, or a recorded landing."""
        if self._rival in self._offered:
            return self._rival
        return _usual_rival(self.chosen)

    def _make_verbs(self) -> list[Widget]:
        """Return the choice of ghosts for the chosen mission, and the button that begins it."""
        offered = self._offered
        words = [texts.MISSION_RIVALS[name] for name in offered]
        rivals = Choice(self.form.manager, _RIVAL, texts.MISSION_RIVAL_LABEL, words, offered.index(self._chosen_rival),
                        self._choose_rival(offered), label_width=_RIVAL_LABEL)  # fmt: skip
        return [rivals, *self._fly_button]

    def _choose_rival(self, offered: list[str]) -> Callable[[int], None]:
        def choose(index: int) -> None:
            self._rival = offered[index]

        return choose

    def _rival_record(self, name: str, rival: str) -> Record | None:
        """Return the recorded flight to race, None for the network; tell the player of one that can't be read."""
        try:
            if rival == "own":
                return self._records.read(self._best[name].file)
            if rival == "recorded":
                return flight_file.read(self.context.assets_dir / _FLIGHTS / f"{name}.json")
        except ValueError as error:
            self.context.note(str(error))
        return None

    def _row(self, name: str) -> Row:
        best = self._best.get(name)
        title = f"{icon(name)}   {texts.MISSIONS[name][0]}"
        if best is None:
            return title, texts.MISSION_TOGETHER if name in self._together else "–", ""
        return title, texts.MEDALS[best.medal], f"{tenths(best.fuel):.1f} s"

    # The picture

    def _draw_chosen(self, canvas: Canvas) -> None:
        """Draw the lamps of the medals in the list, and the chosen mission beside it."""
        for row, name in enumerate(_NAMES):
            if name in self._best:
                end, medal = self._list.right - _LAYOUT.columns[0] - _LAMPS, self._best[name].medal
                _draw_lamps(canvas, (end - _LAMP * medal, self._list.baseline(row) - 4), medal)
            elif name in self._together:
                end = self._list.right - _LAYOUT.columns[0] - canvas.text_width(texts.MISSION_TOGETHER)
                draw_ring(canvas, (end - _RING, self._list.baseline(row) - 4))
        self._draw_mission(canvas, self.chosen)

    def _draw_mission(self, canvas: Canvas, name: str) -> None:
        title, asked = texts.MISSIONS[name]
        canvas.text(title, (_LEFT, 190), size=TITLE + 6, weight="light")
        draw_wrapped(canvas, asked, (_LEFT, 224), _WIDTH, size=TEXT, leading=22)
        best = self._best.get(name)
        self._draw_medals(canvas, name)
        draw_wrapped(canvas, _network_words(name), (_LEFT, _NETWORK), _WIDTH, colour=MUTE, leading=19)
        if best:
            fuel, seconds = tenths(best.fuel), tenths(best.seconds)
            words = texts.MISSION_BEST.format(fuel=fuel, seconds=seconds, count=best.score)
            canvas.text(words, (_LEFT, 384), size=SMALL, colour=HUMAN)

    def _draw_medals(self, canvas: Canvas, name: str) -> None:
        mission, best = MISSIONS[name], self._best.get(name)
        for row, (medal, limit) in enumerate(((3, mission.gold), (2, mission.silver), (1, None))):
            y = 276 + 30 * row
            _draw_lamps(canvas, (_LEFT + 5, y - 4), medal)
            canvas.text(texts.MEDALS[medal], (_LEFT + 52, y), size=SMALL + 1, colour=INK)
            words = texts.MISSION_LIMIT.format(fuel=limit[0], seconds=limit[1]) if limit else texts.MISSION_ANY
            canvas.text(words, (_LEFT + 124, y), size=SMALL, colour=MUTE)
            if best and best.medal >= medal:
                canvas.marker("check", (_LEFT + _WIDTH - 8, y - 4), 11, canvas.palette.good)


def _draw_lamps(canvas: Canvas, first: tuple[float, float], medal: int) -> None:
    """Draw a medal: three lamps for gold, two for silver, one for bronze."""
    for lamp in range(medal):
        canvas.dot((first[0] + _LAMP * lamp, first[1]), 4, MEDALS[medal])


def landed_together(entries: list[Entry]) -> set[str]:
    """Return the missions that player and network have landed together, under the current rules."""
    return {
        entry.course
        for entry in entries
        if entry.course in MISSIONS and entry.landed and entry.human > 0 and entry.bar in TOGETHER
    }


def _usual_rival(name: str) -> str:
    """Return the ghost of a mission that nobody has chosen: the network where it lands, or a recorded landing."""
    return "network" if MISSIONS[name].network_lands else "recorded"


def _network_words(name: str) -> str:
    """Return the shipped network's result in a mission, in words."""
    return texts.MISSION_NETWORK.format(landed=MISSIONS[name].landed)


def _best_by_course(entries: list[Entry]) -> dict[str, Entry]:
    """Return the player's best unaided landing in each named challenge, under the current rules."""
    own = (entry for entry in entries if entry.course and entry.alone)
    landings = [entry for entry in own if entry.landed and not entry.outdated]
    return {entry.course: entry for entry in sorted(landings, key=rank, reverse=True)}
