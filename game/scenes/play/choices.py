"""Your flights: help, pads and start of the next flights, and whether one sees what the network thinks."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from game.core import texts
from game.core.scene import Pop, Scene
from game.core.settings import HELP, TOP_RUNG, Settings
from game.input.controls import Command
from game.ui.actions import Action, Table
from game.ui.panel_scene import PanelScene, StillPicture

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.ui.context import Context
    from game.ui.panel import Column, Panel


class ChoicesScene(PanelScene):
    """Choices over a flight. Each is saved the moment it is made; Escape goes back.

    A challenge fixes most of them, so it offers fewer; `helped` are the settings that its own choice of help changes.
    `lack` says why who would help cannot.
    """

    def __init__(
        self,
        context: Context,
        below: Scene,
        *,
        begun: bool,
        free: bool = True,
        helped: Settings | None = None,
        lack: str = "",
    ) -> None:
        super().__init__(context)
        self._lack = lack
        self._begun, self._free, self._helped = begun, free, helped or context.settings
        self._behind = StillPicture(below, dimmed=0.7)
        self.build()

    def describe(self, panel: Panel) -> None:
        panel.title(texts.CHOICES_TITLE)
        if self._begun and self._free:
            panel.aside(texts.CHOICES_LATER)
        panel.gap(4)
        self._describe_help(panel)
        if self._free:
            self._describe_starts(panel)
        key = self.context.controls.word(Command.MODE)
        shown, aside = self.context.settings.show_thinking, texts.SHOW_THINKING_HELP.format(key=key)
        panel.toggle(texts.SHOW_THINKING, shown, partial(self._set, "show_thinking"), aside)

    def _describe_help(self, column: Column) -> None:
        labels, now = [texts.HELP[word] for word in HELP], HELP.index(self._helped.help)
        column.choice(texts.CHOICES_HELP, labels, now, self._choose_help)
        column.aside(lambda: (self._lack if self._helped.help != "off" else "") or texts.HELP_MEANS[self._helped.help])

    def _choose_help(self, number: int) -> None:
        self._helped.help = HELP[number]
        self.context.apply_settings()

    def _describe_starts(self, column: Column) -> None:
        settings, pads = self.context.settings, texts.CHOICES_PADS_WORDS
        column.choice(texts.CHOICES_PADS, pads, int(settings.three_pads), lambda at: self._set("three_pads", bool(at)))
        rung, rungs, aside = max(0.0, settings.rung), (0.0, float(TOP_RUNG)), texts.CHOICES_LADDER_HELP
        column.slider(texts.CHOICES_LADDER, rung, rungs, self._set_rung, step=1.0, figure=_rung, aside=aside)

    def _set_rung(self, rung: float) -> None:
        self._set("rung", round(rung))

    def _set(self, name: str, value: object) -> None:
        setattr(self.context.settings, name, value)
        self.context.apply_settings()

    def actions(self) -> Table:
        return [self.form.changes, self.form.goes_back(texts.HINT_BACK), Action(Command.CHOICES, Pop)]

    def draw_behind(self, canvas: Canvas, alpha: float) -> None:
        self._behind.draw(canvas)


def _rung(rung: float) -> str:
    return texts.CHOICES_RUNG.format(number=round(rung) + 1) if rung < TOP_RUNG else texts.CHOICES_TOP
