"""Assist dial: a slider from player to network (keys, wheel, drag or gamepad), with who flies written above."""

from __future__ import annotations

from typing import Final

import pygame

from game.cockpit.hud import Lamp, draw_title
from game.core import texts
from game.core.settings import Settings
from game.drawing.canvas import Canvas, Now, moved
from game.drawing.tokens import FAINT, HUMAN, INK, MUTE, NET, SMALL, VIEW_SIZE
from game.flight.credit import FlownBy
from game.input.controls import Command, translate

_MIDDLE: Final = VIEW_SIZE[0] / 2
_TRACK: Final = (_MIDDLE - 90, _MIDDLE + 90)
_LINE: Final = 59.0
_HOLD: Final = pygame.Rect(_TRACK[0] - 14, _LINE - 12, 208, 24)  # where the mouse can grab the handle
_KEY_STEP: Final = 0.1
_WHEEL_STEP: Final = 0.05
_LEAST: Final = 0.04  # the first place above none, where a guardian looks one decision ahead
_EASE: Final = 0.2


class AssistDial:
    """Dial for `settings.assist`; the handle moves to the network's end while the network has the stick.

    It stands at the upper edge of the `view`, all that the window shows, in points.
    """

    def __init__(self, settings: Settings, view: pygame.FRect) -> None:
        self._settings, self._view = settings, view
        self._shown = settings.assist
        self._dragged = False

    def take(self, event: pygame.event.Event) -> bool:
        """Turn the dial by an event, a mouse's in points; return whether the event was meant for it."""
        hold = _HOLD.move(moved(self._view, 0, -1))
        match event.type:
            case pygame.MOUSEWHEEL:
                self._step(_WHEEL_STEP * event.y)
            case pygame.MOUSEBUTTONDOWN if event.button == 1 and hold.collidepoint(event.pos):
                self._dragged = True
                self._drag(event.pos[0])
            case pygame.MOUSEMOTION if self._dragged:
                self._drag(event.pos[0])
            case pygame.MOUSEBUTTONUP if self._dragged and event.button == 1:
                self._dragged = False
            case _:
                command = translate(event)
                if command not in (Command.SLOWER, Command.FASTER):
                    return False
                self._step(_KEY_STEP if command is Command.FASTER else -_KEY_STEP)
        return True

    def follow(self, stick: FlownBy) -> None:
        """Advance the handle by 1/60 s towards the assist in force, which is 0 where the stick can't be shared."""
        assist = self._settings.assist if stick is FlownBy.BOTH else 0.0
        wanted = 1.0 if stick is FlownBy.NETWORK else assist
        at_once = self._settings.reduced_motion or self._dragged
        self._shown += (1.0 if at_once else _EASE) * (wanted - self._shown)

    def draw(self, canvas: Canvas, text: str, stick: FlownBy, lamp: Lamp, means: Now) -> float:
        """Write who flies, after a lamp of that shape, colour and glow, and draw the slider.

        `means` says, for those who ask, what the dial means now. Returns the text's width in points.
        """
        canvas = canvas.at(0, -1)
        width = draw_title(canvas, text, lamp)
        left, right = _TRACK
        for word, x, align in zip(texts.DIAL_ENDS, (left - 10, right + 10), ("right", "left"), strict=True):
            canvas.text(word, (x, _LINE + 4), size=SMALL, colour=MUTE, align=align)  # type: ignore[arg-type]
        canvas.pill((left, _LINE - 1, right - left, 2), FAINT, 0.8)
        reach = self._shown * (right - left)
        if reach >= 1:
            canvas.pill((left, _LINE - 1, reach, 2), NET)
        canvas.explain(_HOLD, texts.EXPLAIN_DIAL, means)
        handle = (left + reach, _LINE)
        canvas.dot(handle, 5 + self._dragged, HUMAN if stick is FlownBy.PERSON else INK)
        return width

    def _drag(self, x: float) -> None:
        share = (x - _TRACK[0]) / (_TRACK[1] - _TRACK[0])
        self._turn(_LEAST if _LEAST / 2 < share <= _LEAST else round(share / _WHEEL_STEP) * _WHEEL_STEP)

    def _step(self, by: float) -> None:
        """Turn by a step; one that would skip the least help ends there, and the next goes on from none."""
        now = self._settings.assist
        beyond = (0.0 if now == _LEAST and by > 0 else now) + by
        self._turn(_LEAST if min(now, beyond) < _LEAST < max(now, beyond) else beyond)

    def _turn(self, assist: float) -> None:
        self._settings.assist = round(min(max(assist, 0.0), 1.0), 2)
