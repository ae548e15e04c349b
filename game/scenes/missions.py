"""The campaign: missions in a list, what each asks, and the player's best there; the start of the day below them."""

from __future__ import annotations

import datetime
from typing import Final

import pygame

from ai.missions import MISSIONS
from game import texts
from game.context import Context
from game.controls import Command
from game.course import Course, Daily, Flown
from game.flight_file import Entry
from game.records import Records, rank
from game.scene import Pop, Push, Transition
from game.ui.canvas import Canvas
from game.ui.form import Form
from game.ui.hints import draw_hints
from game.ui.listing import Listing, shortened
from game.ui.sky import NightSky
from game.ui.tokens import HUMAN, INK, LABEL, LINE, MARGIN, MUTE, SMALL, TEXT, TITLE, VIEW_SIZE, Colour
from game.ui.widgets import Word

_LIST: Final = pygame.Rect(MARGIN, 168, 560, 408)
_PITCH: Final = 34
_COLUMNS: Final = (112.0, 0.0)
_LEFT: Final = 720
_WIDTH: Final = VIEW_SIZE[0] - MARGIN - _LEFT
_VERB: Final = (_LEFT, 420.0, 200.0, 36.0)
_FOOT: Final = 608
_DAILY: Final = "daily"
# A medal is told by its word and by how many lamps are lit, not by its colour alone.
_MEDALS: Final[tuple[Colour, ...]] = (MUTE, (205, 140, 96), (196, 206, 224), (255, 208, 110))


class Missions:
    """The missions on the left, in the order in which they teach; the chosen one on the right."""

    def __init__(self) -> None:
        self._context: Context | None = None

    def enter(self, context: Context) -> None:
        """Build the screen, or look again at what was flown."""
        if self._context is None:
            self._context = context
            self._sky = NightSky(context.rng, ember=0.5, stars=70)
            self._form = Form(context, on_back=Pop)
            manager = self._form.manager
            self._names = [*MISSIONS, _DAILY]
            self._list = self._form.add(Listing(manager, _LIST, [], on_press=lambda _: self._fly(), columns=_COLUMNS,
                                                pitch=_PITCH))  # fmt: skip
            self._form.add(Word(manager, _VERB, texts.MISSION_FLY, self._fly, size=18))
            self._form.add(Word(manager, (MARGIN, _FOOT, 72, 36), texts.BACK, Pop, size=18))
        records = Records(context.user_dir)
        self._best = _best_by_course(records.entries())
        if records.problem:
            context.note(records.problem)
        self._list.set_rows([self._row(name) for name in self._names], self._list.index)

    def exit(self) -> None:
        """Nothing is held."""

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Leave it to the widgets."""
        return self._form.handle_event(event)

    def update(self) -> Transition | None:
        """Let the widgets ease."""
        return self._form.update()

    @property
    def chosen(self) -> str:
        """Name of the mission on the right."""
        return self._names[self._list.index]

    def _course(self) -> Course:
        return Daily(datetime.date.today()) if self.chosen == _DAILY else Flown(MISSIONS[self.chosen])

    def _fly(self) -> Transition:
        from game.scenes.play import Play

        course = self._course()
        return Push(Play(course.seed if isinstance(course, Daily) else 0, course=course))

    def _row(self, name: str) -> tuple[str, str, str]:
        best = self._best.get(name)
        if name == _DAILY:
            return texts.DAILY, "", f"{best.score}" if best else "–"
        return texts.MISSIONS[name][0], texts.MEDALS[best.medal] if best else "–", f"{best.fuel:.1f} s" if best else ""

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the list, and the chosen mission beside it."""
        assert self._context is not None
        self._sky.draw(canvas)
        canvas.text(texts.MISSIONS_TITLE, (MARGIN, 84), size=34, weight="light")
        gold = sum(entry.medal == 3 for name, entry in self._best.items() if name in MISSIONS)
        line = texts.MISSIONS_LINE.format(gold=gold, count=len(MISSIONS))
        canvas.text(line, (MARGIN, 110), size=SMALL, colour=MUTE)
        for label, column in zip(texts.MISSIONS_COLUMNS, (_LIST.width, *_COLUMNS), strict=True):
            align = "left" if column == _LIST.width else "right"
            place = (self._list.right - column, _LIST.top - 14)
            canvas.text(label, place, size=LABEL, weight="medium", colour=MUTE, align=align)  # type: ignore[arg-type]
        canvas.line((_LIST.left, _LIST.top), (self._list.right, _LIST.top), LINE)
        self._form.draw(canvas)
        self._draw_mission(canvas, self.chosen)
        controls = self._context.controls
        arrows = controls.arrows
        draw_hints(canvas, [(arrows, texts.HINT_MOVE), (controls.word(Command.CONFIRM), texts.HINT_CHOOSE),
                            (controls.word(Command.BACK), texts.HINT_BACK)], (MARGIN, VIEW_SIZE[1] - 40))  # fmt: skip

    def _draw_mission(self, canvas: Canvas, name: str) -> None:
        title, asked = (texts.DAILY, texts.DAILY_BEGIN) if name == _DAILY else texts.MISSIONS[name]
        canvas.text(title, (_LEFT, 190), size=TITLE + 6, weight="light")
        canvas.text(shortened(canvas, asked, TEXT, _WIDTH), (_LEFT, 224), size=TEXT, colour=INK)
        best = self._best.get(name)
        if name != _DAILY:
            mission = MISSIONS[name]
            for row, (medal, limit) in enumerate(((3, mission.gold), (2, mission.silver), (1, None))):
                y = 272 + 30 * row
                for lamp in range(medal):
                    canvas.dot((_LEFT + 5 + 13 * lamp, y - 4), 4, _MEDALS[medal])
                canvas.text(texts.MEDALS[medal], (_LEFT + 52, y), size=SMALL + 1, colour=INK)
                words = texts.MISSION_LIMIT.format(fuel=limit[0], seconds=limit[1]) if limit else texts.MISSION_ANY
                canvas.text(words, (_LEFT + 124, y), size=SMALL, colour=MUTE, tabular=True)
        if best:
            words = texts.MISSION_BEST.format(fuel=best.fuel, seconds=best.seconds, points=best.score)
            canvas.text(words, (_LEFT, 384), size=SMALL, colour=HUMAN, tabular=True)


def _best_by_course(entries: list[Entry]) -> dict[str, Entry]:
    """Return the best landing by the person alone in each course that has a name."""
    landings = [entry for entry in entries if entry.course and entry.landed and entry.alone]
    return {entry.course: entry for entry in sorted(landings, key=rank, reverse=True)}
