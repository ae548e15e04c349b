"""Pause: a column of entries over a scene that stands still; over a flight, with all that can be known of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

import pygame

from game.core import texts
from game.core.scene import Pop, Scene, Transition, push
from game.drawing.tokens import INK
from game.explain.explained import Explained
from game.explain.readouts import GAUGES, foot_of
from game.input.controls import Command
from game.scenes.play.head import Head, head_of
from game.ui.actions import Action, Table
from game.ui.hints import HintRow, hint_lines
from game.ui.panel_scene import PanelScene, StillPicture

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.scenes.play.scene import PlayScene
    from game.ui.context import Context
    from game.ui.panel import Panel
    from game.ui.widget import OnPress

_WORD: Final = 22.0
_COVER: Final = 0.94  # opacity: the Earth does not shine through the words
_AHEAD: Final = 3  # decisions of six futures that are flown in a frame


class PauseScene(PanelScene):
    """Pause over a scene, until the player resumes or leaves it.

    Args:
        below: the paused scene.
        retry: function that restarts the scene below; None for no such entry.
        retry_word: what that entry says; called each time the column is built.
        more: function that returns further entries and their actions; called each time the column is built.

    """

    most = 420.0

    def __init__(
        self,
        context: Context,
        below: Scene,
        retry: Callable[[], None] | None = None,
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
        panel.title(texts.PAUSE_TITLE, 44.0, "extralight")
        self.describe_below(panel)
        panel.gap(8)
        retry = [(self._retry_word(), self._begin_anew)] if self._retry else []
        rows: list[tuple[str, OnPress]] = [(texts.PAUSE_RESUME, Pop), *retry, *self._more()]
        rows += [(texts.PAUSE_SETTINGS, partial(push, "settings")), (texts.PAUSE_LEAVE, partial(Pop, 2))]
        for label, press in rows:
            panel.button(label, press, size=_WORD, weight="light", colour=INK)

    def describe_below(self, panel: Panel) -> None:
        """Add what is to be said of the scene below."""

    def actions(self) -> Table:
        return [self.form.moves, self.form.confirms(texts.HINT_CHOOSE), Action(Command.PAUSE, Pop, texts.HINT_RESUME)]

    def draw_behind(self, canvas: Canvas, alpha: float) -> None:
        self._behind.draw(canvas)

    def _begin_anew(self) -> Transition:
        assert self._retry is not None
        self._retry()
        return Pop()


class FlightPauseScene(PauseScene):
    """Pause of a flight, which is seen with all read-outs, what the network thinks, and its six futures as paths."""

    most = 300.0

    def __init__(self, context: Context, below: PlayScene, **options: object) -> None:
        self._flight = below
        self.explained = Explained()
        super().__init__(context, below, **options)  # type: ignore[arg-type]

    def describe_below(self, panel: Panel) -> None:
        """Add which flight it is, and what is to be known of it."""
        head = head_of(self._flight.flown, (), whole=True)
        panel.aside(head.caption)
        if not self._flight.challenge.rules.free:
            panel.text(head.name)
        for words in head.aside:
            panel.aside(words)

    def actions(self) -> Table:
        return [*super().actions(), self.explained.action()]

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        return None if self.explained.handle_event(event) else super().handle_event(event)

    def update(self) -> Transition | None:
        self._flight.flown.think(_AHEAD)
        self.explained.update()
        return super().update()

    def room(self, canvas: Canvas) -> pygame.FRect:
        room = super().room(canvas)
        return pygame.FRect(room.left, 28, room.width, min(row.top for row in self.hint_rows(canvas)) - 40)

    def hint_rows(self, canvas: Canvas) -> Sequence[HintRow]:
        left, _ = self._between(canvas)
        return hint_lines(self.hints, canvas, (left, foot_of(canvas, GAUGES).top - 20), self.most)

    def draw_behind(self, canvas: Canvas, alpha: float) -> None:
        self._flight.flown.draw(canvas, 1.0, Head(), whole=True)
        low = max(row.position[1] for row in self.hint_rows(canvas)) + 12
        canvas.panel((self.panel.box.left - 24, 12, self.panel.box.width + 48, low - 12), _COVER)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        super().draw(canvas, alpha)
        self.explained.draw(canvas)
