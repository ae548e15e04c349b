"""Main menu, a title and six words; and the page of Play, what can be flown. Behind both is the moon."""

from __future__ import annotations

from datetime import date, timedelta
from functools import partial
from typing import TYPE_CHECKING, Final

from ai.lander.missions import MISSIONS
from game.core import texts
from game.core.scene import Pop, Quit, Transition, push
from game.core.settings import TOP_RUNG
from game.drawing.cursor import LEADING
from game.drawing.tokens import INK, MUTE, SMALL, STEP, VIEW_SIZE
from game.flight.days import Days
from game.flight.logbook import Records, best_descent, ladder_rung
from game.input.controls import Command
from game.scenes.menus.background import MenuBackground
from game.ui.actions import Action, Table
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.drawing.cursor import Cursor
    from game.ui.context import Context
    from game.ui.panel import Panel
    from game.ui.widget import OnPress

_WORD, _LEAST = 22.0, 18.0  # size of a word in a high window, and in a low one
# Size of the title: at most this, and these shares of the window's width and height.
_TITLE, _ACROSS, _DOWN = 88.0, 0.11, 0.12
_LINE_ROOM, _LINES = 380.0, 2  # points of the line, which ends before the Earth, and for how many there is room
_LOW: Final = 430.0  # points of a window in which nothing is left free
_ROOMY: Final = 560.0  # points of a window in which all that can be flown is explained
_CLOSE: Final = 5.0  # points around what can be flown: all of it is seen in a low window, a long result too
_PAD, _ABOVE, _BETWEEN = 4.0, 28.0, 20.0  # points around a word, above the title and below the line, in a high one

# Entries: the route of a screen and its key in `texts.MENU`; the last one closes the game.
ROWS: Final = ("play", "watch", "train", "digits", "learn", "settings", "quit")
# What can be flown, by its key in `texts.FLIGHTS`, and the routes.
FLIGHTS: Final = {"free": "play", "day": "day", "missions": "missions", "descent": "descent", "logbook": "logbook"}


class _OverMoon(PanelScene):
    """Words with the moon behind them, where a lander is flown down again and again."""

    def __init__(self, context: Context, on_back: OnPress, background: MenuBackground | None = None) -> None:
        super().__init__(context, on_back)
        self._background = background or MenuBackground(context)
        self._prepare()
        self.build()

    def _prepare(self) -> None:
        """Read what the words say."""

    def enter(self) -> None:
        self._background.enter()
        self._prepare()

    def update(self) -> Transition | None:
        self._background.update()
        return super().update()

    def draw_behind(self, canvas: Canvas, alpha: float) -> None:
        self._background.draw(canvas.whole, alpha)


class MenuScene(_OverMoon):
    """Main menu, the first screen."""

    def __init__(self, context: Context) -> None:
        super().__init__(context, self._back)

    def describe(self, panel: Panel) -> None:
        panel.add(self._write_title)
        panel.add(self._write_line)
        self._words = [panel.button(texts.MENU[name][0], partial(self._open, name), weight="light") for name in ROWS]

    def lay_out(self) -> None:
        for word in self._words:
            word.pad, word.size = _PAD * self._roominess, _LEAST + (_WORD - _LEAST) * self._roominess
        super().lay_out()

    @property
    def _roominess(self) -> float:
        """How high the window is, from 0, very low, to 1."""
        return min(max((self.context.reading().view.height - _LOW) / (VIEW_SIZE[1] - _LOW), 0.0), 1.0)

    def actions(self) -> Table:
        full_screen = Action(Command.FULLSCREEN, self.context.toggle_full_screen, texts.HINT_FULL_SCREEN)
        return [self.form.moves, self.form.confirms(texts.HINT_CHOOSE), full_screen]

    def _write_title(self, cursor: Cursor) -> None:
        view = self.context.reading().view
        size = min(_TITLE, _ACROSS * view.width, _DOWN * view.height)
        cursor.gap(_ABOVE * self._roominess)
        cursor.styled(texts.GAME, size, weight="extralight")

    def _write_line(self, cursor: Cursor) -> None:
        """Write where the word in focus leads to; what stands below stays where it is."""
        line, below = cursor.in_style(SMALL, MUTE), cursor.y + _LINES * LEADING * SMALL
        if self.form.focused:
            line.width = min(cursor.width, _LINE_ROOM)
            line.text(texts.MENU[ROWS[self.form.widgets.index(self.form.focused)]][1])
        cursor.y = max(line.y, below) + STEP + _BETWEEN * self._roominess

    def _open(self, name: str) -> Transition:
        if name == "quit":
            return Quit()
        if name == "play" and self.context.settings.tutored:
            return push("flights", self._background)
        return push(name)  # a newcomer's first flight teaches

    def _back(self) -> None:
        """Move the focus to Quit."""
        self.form.focus(self.form.widgets[-1])


class FlightsScene(_OverMoon):
    """The page of Play: what can be flown, and what was, each with how far one is."""

    most = 360.0

    def __init__(self, context: Context, background: MenuBackground | None = None, today: date | None = None) -> None:
        self._given = today
        super().__init__(context, Pop, background)

    def _prepare(self) -> None:
        """Read how far the player is."""
        context, settings, today = self.context, self.context.settings, self._given or date.today()
        records, days = Records(context.user_dir), Days(context.user_dir)
        entries = records.entries()
        won = {entry.course for entry in entries if entry.medal and entry.alone} & MISSIONS.keys()
        gold = won.intersection(entry.course for entry in entries if entry.medal == 3 and entry.alone)
        attempt = days.attempts.get(today.isoformat())
        self._yesterday = days.attempts.get((today - timedelta(days=1)).isoformat())
        best = best_descent(entries)[0]
        self._figures = {
            "free": self._free(ladder_rung(settings, entries)),
            "day": attempt.result if attempt else texts.DAYS_NOT_FLOWN,
            "missions": texts.FLIGHTS_GOLD.format(won=len(won), gold=len(gold), count=len(MISSIONS)),
            "descent": texts.DESCENT_LEGS.format(count=best) if best else "",
            "logbook": texts.FLIGHTS_COUNT.format(count=len(entries)) if entries else "",
        }
        if problem := records.problem or days.problem:
            context.note(problem)

    def _free(self, rung: int) -> str:
        if self.context.settings.three_pads:
            return texts.THREE_PADS.lower()
        return texts.FLIGHTS_RUNG.format(number=rung + 1) if rung < TOP_RUNG else texts.FLIGHTS_ANYWHERE

    def describe(self, panel: Panel) -> None:
        panel.title(texts.FLIGHTS_TITLE)
        panel.gap(8)
        for name, route in FLIGHTS.items():
            word, line, figure = texts.FLIGHTS[name][0], partial(self._line, name), partial(self._figure, name)
            row = panel.button(word, partial(push, route), line, figure=figure, size=_WORD, weight="light", colour=INK)
            row.pad = _CLOSE

    def _line(self, name: str) -> str:
        """Return what it is, where there is room for that."""
        if self.context.reading().view.height <= _ROOMY:
            return ""
        before = self._yesterday if name == "day" else None
        line = texts.FLIGHTS[name][1]
        return f"{line} {texts.DAYS_YESTERDAY.format(result=before.result)}" if before else line

    def _figure(self, name: str) -> str:
        return self._figures[name]

    def actions(self) -> Table:
        return [self.form.moves, *super().actions()]
