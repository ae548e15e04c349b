"""The page of Play: free flight, the start of the day, missions, descent and the logbook, each with how far one is."""

from __future__ import annotations

from datetime import date
from functools import partial
from typing import TYPE_CHECKING, Final

from ai.lander.missions import MISSIONS
from game.core import texts
from game.core.scene import Transition, push
from game.core.settings import TOP_RUNG
from game.drawing.tokens import INK
from game.flight.days import Days
from game.flight.logbook import Records, best_descent
from game.scenes.menus.background import MenuBackground
from game.ui.actions import Table
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.ui.context import Context
    from game.ui.panel import Panel

ROWS: Final = ("free", "day", "missions", "descent", "logbook")
_WORD: Final = 22.0


class FlightsScene(PanelScene):
    """What can be flown, and what was."""

    most = 360.0

    def __init__(self, context: Context, background: MenuBackground | None = None, today: date | None = None) -> None:
        super().__init__(context)
        self._background = background or MenuBackground(context)
        self._today = today or date.today()
        self._figures: dict[str, str] = {}
        self.enter()
        self.build()

    def enter(self) -> None:
        """Read again how far the player is."""
        self._background.enter()
        context, rung = self.context, self.context.settings.rung
        records, days = Records(context.user_dir), Days(context.user_dir)
        entries = records.entries()
        gold = {entry.course for entry in entries if entry.medal == 3 and not entry.outdated and entry.alone}
        attempt = days.attempts.get(self._today.isoformat())
        best = best_descent(entries)[0]
        self._figures = {
            "free": texts.FLIGHTS_RUNG.format(number=max(0, rung) + 1) if rung < TOP_RUNG else texts.FLIGHTS_ANYWHERE,
            "day": texts.FLIGHTS_FLOWN if attempt else texts.DAYS_NOT_FLOWN,
            "missions": texts.FLIGHTS_GOLD.format(gold=len(gold & MISSIONS.keys()), count=len(MISSIONS)),
            "descent": texts.DESCENT_LEGS.format(count=best) if best else "",
            "logbook": texts.FLIGHTS_COUNT.format(count=len(entries)) if entries else "",
        }
        if problem := records.problem or days.problem:
            context.note(problem)

    def describe(self, panel: Panel) -> None:
        """Add a row for each."""
        panel.title(texts.FLIGHTS_TITLE)
        panel.gap(12)
        for name in ROWS:
            label, line = texts.FLIGHTS[name]
            panel.button(
                label, partial(_open, name), line, figure=partial(self._figure, name), size=_WORD, weight="light",
                colour=INK,
            )  # fmt: skip

    def _figure(self, name: str) -> str:
        return self._figures[name]

    def update(self) -> Transition | None:
        """Animate the words and the background."""
        self._background.update()
        return super().update()

    def draw_behind(self, canvas: Canvas, alpha: float) -> None:
        """Draw the moon."""
        self._background.draw(canvas.whole, alpha)

    def actions(self) -> Table:
        """Move, choose, go back."""
        return [self.form.moves, *super().actions()]


def _open(name: str) -> Transition:
    return push({"free": "play", "day": "days"}.get(name, name))
