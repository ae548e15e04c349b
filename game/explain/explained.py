"""Explanations: every word and bar says what it is, its unit, and what it means now.

Whoever draws something notes its area with `Canvas.explain`. The mouse, at rest over an area, shows a tooltip; by keys
and gamepad, F1 or the gamepad's Back button explains the first area, and the arrows one after the other.
"""

from __future__ import annotations

from typing import Final

import pygame

from game.core import texts
from game.drawing.canvas import Canvas, Explanation, Point
from game.drawing.prose import lines
from game.drawing.tokens import INK, LABEL
from game.input.controls import Command, translate
from game.ui.actions import Action
from game.ui.tooltip import TooltipRow, draw_tooltip

_REST: Final = 24  # updates for which the mouse rests before a tooltip is shown
_AGAIN: Final = 6  # and before the next one
_WIDTH: Final = 250.0  # points of a line
_MARGIN: Final = 8.0  # points from the edges of the view
_HEAD, _FOOT = 72.0, 180.0  # points from the upper and the lower edge within which an area stands at the head or foot
_ASIDE: Final = 12.0
_BEFORE: Final = frozenset({Command.LEFT, Command.UP, Command.PREVIOUS})
_AFTER: Final = frozenset({Command.RIGHT, Command.DOWN, Command.NEXT})
_LEAVE: Final = frozenset({Command.BACK, Command.PAUSE, Command.UNPLUGGED})
_MOUSE: Final = (pygame.MOUSEMOTION, pygame.MOUSEBUTTONDOWN)


class Explained:
    """Tooltips of one scene: pass it every event before the scene's own, `update` it, and draw it last.

    The arrows go on to other areas; the key that began, Esc or a click ends it.

    Attributes:
        stepping: whether areas are explained one after the other, without a mouse.

    """

    def __init__(self) -> None:
        self.stepping, self._any = False, True
        self._number = self._rest = 0
        self._ready = False  # whether the mouse has rested for long enough

    def action(self) -> Action:
        """Return the action that explains the first area; to be the last of a table, as F1 can be bound otherwise."""
        return Action(pygame.K_F1, self._begin, texts.HINT_EXPLAIN if self._any else "", gamepad=Command.CHOICES)

    def handle_event(self, event: pygame.event.Event) -> bool:
        """Go on to another area, or end; false for an event that is the scene's."""
        if event.type in _MOUSE:
            moves = event.type == pygame.MOUSEMOTION
            drags = moves and any(getattr(event, "buttons", ()))  # what is dragged must not be covered
            self._rest = _REST - _AGAIN if self._ready and moves and not drags else 0
            self.stepping = self._ready = False
            return False
        command = translate(event)
        if not self.stepping:
            return False
        if self.action().answers(event):
            self.stepping = False
        elif command in _AFTER:
            self._number += 1
        elif command in _BEFORE:
            self._number -= 1
        elif command in _LEAVE:
            self.stepping = False
        else:
            return False
        return True

    def update(self) -> None:
        """Advance by 1/60 s."""
        self._rest += not self._ready
        self._ready = self._rest >= _REST

    def draw(self, canvas: Canvas) -> None:
        """Draw the tooltip of the area that is pointed at, or that is the next to be explained."""
        areas = [area for area in canvas.explained if area.box.colliderect(canvas.view)]
        self._any = bool(areas)
        self.stepping &= self._any
        if self.stepping:
            area = areas[self._number % len(areas)]
            canvas.outline(area.box.inflate(8, 6), 6, INK, 1, 0.8)
            _draw(canvas, area)
        elif self._ready and canvas.pointer is not None:
            under = [area for area in areas if area.box.collidepoint(canvas.pointer)]
            if under:
                smallest = min(under, key=lambda area: area.box.width * area.box.height)
                _draw(canvas, smallest)

    def _begin(self) -> None:
        self.stepping, self._number = True, 0


def _draw(canvas: Canvas, area: Explanation) -> None:
    """Draw the tooltip beside its area, or below it at the head of the screen and above it at the foot."""
    what = _lines(canvas, area.what)
    rows = [row for line in area.now().split("\n") for row in _rows(canvas, line)]
    box, view = area.box, canvas.view
    within = view.inflate(-2 * _MARGIN, -2 * _MARGIN)
    place: Point = (box.right, box.centery)
    if box.bottom < view.top + _HEAD:
        within.height -= box.bottom + 6 - within.top
        within.bottom, place = view.bottom - _MARGIN, (box.left - _ASIDE, view.top)
    elif box.top > view.bottom - _FOOT:
        foot = (each.box for each in canvas.explained if each.box.top > view.bottom - _FOOT)
        top = min(each.top for each in foot if each.left < box.right and box.left < each.right)  # and of all above it
        within.height, place = top - 6 - within.top, (box.left - _ASIDE, view.bottom)
    elif box.right + _WIDTH + 40 > within.right and box.left - 6 - within.left > _WIDTH + 2 * _ASIDE:
        within.width, place = box.left - 6 - within.left, (box.left, box.bottom)  # off a sentence
    elif box.right + _WIDTH + 40 > within.right:
        within.height -= box.bottom + 6 - within.top
        within.bottom, place = view.bottom - _MARGIN, (box.left - _ASIDE, box.bottom)
    draw_tooltip(canvas, place, within, what, rows)


def _rows(canvas: Canvas, line: str) -> list[TooltipRow]:
    """Return the rows of a line: a word and its figure, if a tab parts them, or words on as many lines as they need."""
    word, tab, figure = line.partition("\t")
    if tab:
        return [TooltipRow(word, figure)]
    return [TooltipRow(each, "") for each in _lines(canvas, line) if each]


def _lines(canvas: Canvas, words: str) -> tuple[str, ...]:
    return lines(words, LABEL, "regular", _WIDTH, canvas.scale)
