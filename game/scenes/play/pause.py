"""Pause: entries over a scene that stands still; over a flight, with its read-outs and the choices for it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

import pygame

from game.core import texts
from game.core.scene import Pop, Push, Replace, Scene, Transition, push
from game.core.settings import HELP, TOP_RUNG
from game.drawing.tokens import INK, LOW, MUTE, NARROW, SMALL, TEXT
from game.explain.explained import Explained
from game.explain.readouts import GAUGES, foot_of
from game.flight import networks
from game.input.controls import Command
from game.scenes.play.head import Head, head_of
from game.ui.actions import Action, Run, Table
from game.ui.hints import Hint, HintRow, hint_lines
from game.ui.panel_scene import PanelScene, StillPicture

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.drawing.cursor import Cursor
    from game.scenes.play.scene import PlayScene
    from game.ui.context import Context
    from game.ui.panel import Panel
    from game.ui.widget import OnPress

_TITLE, _WORD = 28.0, 20.0
_COLUMN: Final = 90.0  # points that a column of entries needs
_AROUND, _EDGE = 24.0, 12.0  # points between rows and the panel's sides, and from there to the edge of the window


class PauseScene(PanelScene):
    """Pause over a scene, until the player resumes or leaves it.

    Args:
        below: the paused scene.
        retry: function that restarts the scene below, or returns who asks first; None for no such entry.
        retry_word: what that entry says; called each time the rows are described.
        more: function that returns further entries and their actions; called each time the rows are described.

    """

    most = 420.0

    @property
    def ended(self) -> str:
        """How the scene below has ended, and cannot be resumed; empty if it can."""
        return ""

    def __init__(
        self,
        context: Context,
        below: Scene,
        retry: Run | None = None,
        retry_word: Callable[[], str] = lambda: texts.PAUSE_RETRY,
        more: Callable[[], list[tuple[str, OnPress]]] = list,
    ) -> None:
        super().__init__(context)
        self._behind = StillPicture(below)
        self._retry, self._retry_word, self._more = retry, retry_word, more
        self.build()

    def enter(self) -> None:
        """Name the entries anew, for a scene above may have changed them."""
        self.build()

    def describe(self, panel: Panel) -> None:
        panel.title(self.ended or texts.PAUSE_TITLE, _TITLE, "extralight")
        rows: list[tuple[str, OnPress]] = [] if self.ended else [(texts.PAUSE_RESUME, Pop)]
        rows += [(self._retry_word(), self._begin_anew)] if self._retry else []
        rows += self._more()
        rows += [(texts.PAUSE_SETTINGS, partial(push, "settings")), (texts.PAUSE_LEAVE, partial(Pop, 2))]
        half = (len(rows) + 1) // 2  # in two columns, to be in sight in any window
        for column, part in zip(panel.beside((1, 1), _COLUMN, 24.0), (rows[:half], rows[half:]), strict=True):
            for label, press in part:
                column.button(label, press, size=_WORD, weight="light", colour=INK)

    def actions(self) -> Table:
        back = texts.HINT_BACK if self.ended else texts.HINT_RESUME
        ways = dict.fromkeys((self.context.controls.arrows, self.context.controls.arrows_aside))
        moves = Hint(" ".join(ways), texts.HINT_MOVE)  # the columns stand side by side
        return [moves, self.form.confirms(texts.HINT_CHOOSE), Action(Command.PAUSE, Pop, back)]

    def draw_behind(self, canvas: Canvas, alpha: float) -> None:
        self._behind.draw(canvas)
        self._cover(canvas)

    def _cover(self, canvas: Canvas) -> None:
        """Cover what is behind the rows and the hints: neither words nor the Earth shine through."""
        box, low = self.panel.box, max(row.position[1] for row in self.hint_rows(canvas))
        cover = pygame.FRect(box.left - _AROUND, _EDGE, box.width + 2 * _AROUND, low)
        canvas.panel(cover.clip(canvas.view.inflate(-2 * _EDGE, 0)), 1.0)

    def _begin_anew(self) -> Transition:
        assert self._retry is not None
        asked = self._retry()
        return Replace(asked.scene) if isinstance(asked, Push) else Pop()


class FlightPauseScene(PauseScene):
    """Pause of a flight, and the choices for it and the next ones; each is saved the moment it is made.

    The flight is seen with all read-outs. What a challenge fixes is not offered.
    """

    def __init__(self, context: Context, below: PlayScene) -> None:
        self._flight = below
        self.explained = Explained()
        super().__init__(context, below, below.runs[Command.RETRY])

    @property
    def ended(self) -> str:
        card = self._flight.ending.card
        return card.title if card else ""

    def describe(self, panel: Panel) -> None:
        super().describe(panel)
        flown, settings = self._flight.flown, self.context.settings
        if not self._flight.challenge.rules.free:
            panel.add(self._write_about)
        if flown.helps:
            now = HELP.index(flown.helped.help)
            panel.choice(texts.CHOICES_HELP, [texts.HELP[word] for word in HELP], now, self._choose_help)
            panel.aside(lambda: self._flight.lack or texts.HELP_MEANS[flown.helped.help])
        if self._flight.challenge.rules.free:
            pads = texts.CHOICES_PADS_WORDS
            panel.choice(texts.CHOICES_PADS, pads, int(settings.three_pads), self._choose_pads)
            if not settings.three_pads:  # among hills, all begin from anywhere
                rung, rungs = max(0.0, settings.rung), (0.0, float(TOP_RUNG))
                panel.slider(texts.CHOICES_LADDER, rung, rungs, self._choose_rung, step=1.0, figure=_rung)
        if self._flight.words.next:
            panel.button(texts.TUTORIAL_LEAVE, self._flight.leave_challenge)
        elif not flown.credit.alone:
            choose = partial(push, "runs", choose=self._flight.choose_network)
            panel.button(texts.PAUSE_NETWORK.format(name=networks.word(self._flight.network.name)), choose)

    def _write_about(self, cursor: Cursor) -> None:
        """Write which flight it is, and what is to be known of it."""
        head = head_of(self._flight.flown, (), whole=True)
        cursor.styled(head.caption, SMALL, MUTE)
        cursor.styled(head.name, TEXT, INK)
        for words in head.aside:
            cursor.styled(words, SMALL, MUTE)

    def _choose_help(self, number: int) -> None:
        self._flight.flown.helped.help = HELP[number]
        self.context.apply_settings()

    def _choose_pads(self, number: int) -> None:
        self.context.settings.three_pads = bool(number)
        self.context.apply_settings()
        self.build()

    def _choose_rung(self, rung: float) -> None:
        self.context.settings.rung = round(rung)
        self.context.apply_settings()

    def actions(self) -> Table:
        again = self.context.controls.keys.codes(Command.CHOICES)  # its button explains here
        return [*super().actions(), self.explained.action(), *(Action(code, Pop) for code in again)]

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        return None if self.explained.handle_event(event) else super().handle_event(event)

    def update(self) -> Transition | None:
        self._flight.flown.think()
        self.explained.update()
        return super().update()

    @staticmethod
    def _beside(canvas: Canvas) -> bool:
        """Whether the flight and its read-outs have room beside the choices; in a small window, they give way."""
        return canvas.view.width >= NARROW and canvas.view.height >= LOW

    def room(self, canvas: Canvas) -> pygame.FRect:
        room = super().room(canvas)
        if not self._beside(canvas):
            return room
        return pygame.FRect(room.left, _AROUND, room.width, min(row.top for row in self.hint_rows(canvas)) - 36)

    def hint_rows(self, canvas: Canvas) -> Sequence[HintRow]:
        if not self._beside(canvas):
            return super().hint_rows(canvas)
        left, width = self._between(canvas)
        return hint_lines(self.hints, canvas, (left, foot_of(canvas, GAUGES).top - 20), min(width, self.most))

    def draw_behind(self, canvas: Canvas, alpha: float) -> None:
        view, beside = canvas.view, self._beside(canvas)
        self._flight.flown.draw(canvas, 1.0, Head(), whole=True, low=0.0 if beside else view.bottom)
        self._cover(canvas) if beside else canvas.panel(view, 1.0)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        super().draw(canvas, alpha)
        self.explained.draw(canvas)


def _rung(rung: float) -> str:
    return texts.CHOICES_RUNG.format(number=round(rung) + 1) if rung < TOP_RUNG else texts.CHOICES_TOP
