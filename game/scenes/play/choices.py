"""Your flights: help, pads and start of the next flights; all else stands under More."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

from game.core import texts
from game.core.scene import Pop, Scene
from game.core.settings import PACES, TOP_RUNG, Settings
from game.drawing.tokens import INK
from game.flight.credit import GUARDIAN, HELP, OTHER
from game.input.controls import Command
from game.scenes.play.help import MODES, choose, means, word_of
from game.ui.actions import Action, Table
from game.ui.panel_scene import PanelScene, StillPicture
from game.ui.rows import percent

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.ui.context import Context
    from game.ui.panel import Column, Panel

_LEAST: Final = 360.0  # points of a column


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
        more = self.context.settings.more_flights
        left, *beside = panel.beside((1, 1) if more else (1,), _LEAST)
        self._describe_help(left)
        if self._free:
            self._describe_starts(left)
        left.button(texts.CHOICES_LESS if more else texts.CHOICES_MORE, self._switch_more, colour=INK)
        if more:
            self._describe_more(left, beside[0])

    def _describe_help(self, column: Column) -> None:
        """Add the three words of help, and a fourth where the dial is elsewhere."""
        now = word_of(self._helped)
        words = [*HELP, *([OTHER] if now == OTHER else [])]
        labels = [texts.HELP.get(word, texts.CHOICES_MORE) for word in words]
        column.choice(texts.CHOICES_HELP, labels, words.index(now), lambda index: self._choose_help(words[index]))
        column.aside(lambda: (self._lack if self._helped.assist else "") or means(self._helped))

    def _choose_help(self, word: str) -> None:
        if word != OTHER:
            choose(self._helped, word)
        self.context.apply_settings()
        self.build()

    def _describe_starts(self, column: Column) -> None:
        settings, pads = self.context.settings, texts.CHOICES_PADS_WORDS
        column.choice(texts.CHOICES_PADS, pads, int(settings.three_pads), lambda at: self._set("three_pads", bool(at)))
        rung, rungs, aside = max(0.0, settings.rung), (0.0, float(TOP_RUNG)), texts.CHOICES_LADDER_HELP
        column.slider(texts.CHOICES_LADDER, rung, rungs, self._set_rung, step=1.0, figure=_rung, aside=aside)

    def _describe_more(self, left: Column, right: Column) -> None:
        helped = self._helped
        ticks = {HELP[word]: texts.HELP[word] for word in (HELP if helped.copilot == GUARDIAN else ["off"])}
        change = partial(self._help, "assist")
        left.slider(texts.CHOICES_ASSIST, helped.assist, (0.0, 1.0), change, step=0.1, figure=percent, ticks=ticks)
        index = MODES.index(helped.copilot) if helped.copilot in MODES else 0
        left.choice(texts.CHOICES_MODE, texts.CHOICES_MODES, index, self._choose_mode)
        left.aside(lambda: texts.CHOICES_MODES_HELP[MODES.index(helped.copilot)])
        self._share(right, "pace", texts.PACE, PACES, texts.CHOICES_PACE_HELP)
        key = self.context.controls.word(Command.MODE)
        self._toggle(right, "show_thinking", texts.SHOW_THINKING, texts.SHOW_THINKING_HELP.format(key=key))

    def _set_rung(self, rung: float) -> None:
        self._set("rung", round(rung))

    def _share(self, column: Column, name: str, label: str, limits: tuple[float, float], aside: str) -> None:
        value = getattr(self.context.settings, name)
        column.slider(
            label, value, limits, lambda to: self._set(name, round(to, 2)), step=0.1, figure=percent, aside=aside
        )

    def _help(self, name: str, value: float | str) -> None:
        setattr(self._helped, name, round(value, 2) if isinstance(value, float) else value)
        self.context.apply_settings()

    def _choose_mode(self, index: int) -> None:
        self._help("copilot", MODES[index])
        self.build()

    def _switch_more(self) -> None:
        self._set("more_flights", not self.context.settings.more_flights)
        self.build()

    def _toggle(self, column: Column, name: str, label: str, aside: str) -> None:
        column.toggle(label, getattr(self.context.settings, name), partial(self._set, name), aside)

    def _set(self, name: str, value: object) -> None:
        setattr(self.context.settings, name, value)
        self.context.apply_settings()

    def actions(self) -> Table:
        return [self.form.changes, self.form.goes_back(texts.HINT_BACK), Action(Command.CHOICES, Pop)]

    def draw_behind(self, canvas: Canvas, alpha: float) -> None:
        self._behind.draw(canvas)


def _rung(rung: float) -> str:
    return texts.CHOICES_RUNG.format(number=round(rung) + 1) if rung < TOP_RUNG else texts.CHOICES_TOP
