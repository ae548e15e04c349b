"""Knobs: rows of the panel of settings, each a label, a control (slider or words) and a figure.

A blue knob changes a run while it goes on. A grey, hollow knob takes a new run. An amber dot marks a value that the
player has changed; R, the gamepad's X, or a click on the name restores the preset's value, a tick on the track.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, Final

import numpy as np
import pygame

from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import HUMAN, INK, LABEL, MUTE, NET, PANEL, SMALL, Colour
from game.input.controls import Command, translate
from game.training.run_settings import KnobDescription, figure
from game.ui.widget import RowWidget, mix

_LABELS, _FIGURES = 150.0, 72.0  # points from the label to the track, and from the track to the right end
_HEIGHT: Final = 20.0
_GAP: Final = 14.0  # between words
_NOTE: Final = LABEL  # size of text over a track
_CLEAR: Final = 9.0  # from the middle of the handle to that text


class Knob(RowWidget):
    """Base of both kinds. The panel owns the value: `turn`, given the knob's name, asks for another.

    `enter` is called by Enter, or a gamepad's A, on a slider, which has nothing to press.

    Attributes:
        value: the value that is shown.
        home: the preset's value.
        waits: whether the value is yet to be applied.
        now: the value in force at this moment of a run, where it differs; else None.

    """

    pad = 4.0

    def __init__(
        self,
        description: KnobDescription,
        turn: Callable[[str, Any], None],
        enter: Callable[[], None] = lambda: None,
    ) -> None:
        super().__init__((0, 0, 1, 1), description.label)
        self.description = description
        self.value = self.home = None
        self.waits = self.changed = False
        self.now: float | None = None
        self._turn, self._enter = turn, enter
        self._named = False  # the mouse was pressed on the name

    def display(self, value: Any, home: Any, *, waits: bool, now: float | None = None) -> None:
        """Show what the panel says."""
        self.value, self.home, self.waits = value, home, waits
        self.changed = bool(value != home)
        rounded = None if now is None else float(f"{now:.3g}")
        self.now = None if rounded is None or figure(rounded) == figure(value) else rounded

    @property
    def live(self) -> bool:
        """Whether the knob may change while a run goes on."""
        return self.description.live

    @property
    def colour(self) -> Colour:
        """Colour of the knob: blue, grey if it takes a new run, amber if it waits."""
        return HUMAN if self.waits else NET if self.live else MUTE

    @property
    def track(self) -> tuple[float, float]:
        """Left and right end of the track, in points."""
        return _left(self.box), self.box.right - _FIGURES

    def turn(self, value: Any) -> None:
        """Request another value from the panel."""
        if value != self.value:
            self._turn(self.description.name, value)

    def take(self, event: pygame.event.Event) -> bool:
        """Restore the preset's value on the key for it."""
        if self.changed and translate(event) is Command.RETRY:
            self.turn(self.home)
            return True
        return False

    def process_event(self, event: pygame.event.Event) -> bool:
        """Tell a press on the name from one on the track."""
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == 1:
            self._named = self.hover_point(*event.pos) and event.pos[0] < self.track[0] - 10
            if self._named:
                return True
        if event.type == pygame.MOUSEBUTTONUP and event.button == 1 and self._named:
            self._named = False
            if self.hover_point(*event.pos) and self.changed:
                self.turn(self.home)
            return True
        return super().process_event(event)

    def write(self, cursor: Cursor) -> None:
        """Draw the dot of a change, the label, the control and the figure."""
        top, canvas = cursor.y, cursor.canvas
        cursor.take(_HEIGHT)
        if canvas:
            if self.changed:
                canvas.dot((cursor.left - 11, top + _HEIGHT / 2), 2.5, HUMAN)
            colour = mix(mix(MUTE, INK, 0.7), INK, self.warmth)
            room = self.track[0] - cursor.left - 10
            canvas.text(self.label, (cursor.left, top + _HEIGHT / 2 + 4.5), size=SMALL, colour=colour, room=room)
        self.put(cursor, top + _HEIGHT / 2)

    def put(self, cursor: Cursor, middle: float) -> None:
        """Draw the control and the figure around a height, and go on below if they need more room."""
        raise NotImplementedError


class SliderKnob(Knob):
    """A number, chosen among the stops of a track."""

    def _at(self, value: Any) -> float:
        """Return the place of a value along the track, 0 to 1."""
        return _along(self.description.stops, value)

    def _places(self) -> dict[float, Any]:
        """Map places along the track to values: the stops, and the preset's value."""
        return {self._at(value): value for value in (*self.description.stops, self.home)}

    def shift(self, direction: int) -> bool:
        """Go to the next stop."""
        places, here = self._places(), self._at(self.value)
        ahead = [place for place in places if (place - here) * direction > 1e-6]
        if ahead:
            self.turn(places[min(ahead, key=lambda place: abs(place - here))])
        return True

    def press(self) -> None:
        """Call `enter`, unless the press is the mouse letting go of the handle."""
        if self.ringed:
            self._enter()

    def drag(self, x: float) -> None:
        """Go to the stop nearest to the mouse."""
        left, right = self.track
        places, fraction = self._places(), (x - left) / (right - left)
        self.turn(places[min(places, key=lambda place: abs(place - fraction))])

    def put(self, cursor: Cursor, middle: float) -> None:
        """Draw track, tick, handle and figure."""
        if (canvas := cursor.canvas) is None:
            return
        (left, right), colour = self.track, self.colour
        width = right - left
        handle, home = (left + self._at(value) * width for value in (self.value, self.home))
        canvas.line((home, middle - 5), (home, middle + 5), MUTE, 1, 0.8)
        canvas.bar((left, middle - 1, width, 2), self._at(self.value), colour)
        radius = 5 + self.warmth
        canvas.dot((handle, middle), radius, INK if self.live else mix(MUTE, INK, self.warmth))
        if not self.live:
            canvas.dot((handle, middle), radius - 1.6, PANEL)
        if self.now is not None:
            x = left + self._at(self.now) * width
            canvas.line((x, middle - 1), (x, middle + 6), INK, 2)
            said = figure(self.now)
            self._put_beside(canvas, texts.KNOB_NOW.format(value=said), x, handle) or self._put_beside(
                canvas, said, x, handle
            )
        place, room = (cursor.right, middle + 4.5), _FIGURES - 8
        canvas.text(figure(self.value), place, size=SMALL, colour=colour, align="right", tabular=True, room=room)

    def _put_beside(self, canvas: Canvas, words: str, x: float, handle: float) -> bool:
        """Write text over the track, around x as far as there is room, clear of the handle; return whether there is."""
        left, right = self.track
        width = canvas.text_width(words, size=_NOTE)
        start = min(max(x - width / 2, left), right - width)
        if start - _CLEAR < handle < start + width + _CLEAR:
            before, after = handle - _CLEAR - width, handle + _CLEAR
            start = before if before >= left and (x <= handle or after + width > right) else after
        fits = left <= start <= right - width  # a narrow window has short tracks
        if fits:
            canvas.text(words, (start, self.box.centery - 4), size=_NOTE, colour=mix(MUTE, INK, self.warmth))
        return fits


class WordsKnob(Knob):
    """A choice among a few words, on as many lines as they need."""

    _places: tuple[pygame.FRect, ...] = ()

    @property
    def values(self) -> tuple[Any, ...]:
        """The values to choose from; one that has no word of its own gets one made for it."""
        return tuple(dict.fromkeys((*self.description.stops, self.home, self.value)))

    def press(self) -> None:
        """Take the word under the mouse; without one, the next."""
        chosen: int | None = (self.values.index(self.value) + 1) % len(self.values)
        if not self.ringed:
            mouse = self.ui_manager.get_mouse_position()
            chosen = next((n for n, place in enumerate(self._places) if place.collidepoint(mouse)), None)
        if chosen is not None:
            self.turn(self.values[chosen])

    def shift(self, direction: int) -> bool:
        """Take the word to the left or right."""
        place = self.values.index(self.value) + direction
        if 0 <= place < len(self.values):
            self.turn(self.values[place])
        return True

    def put(self, cursor: Cursor, middle: float) -> None:
        """Draw the words, with a line under the chosen one."""
        small, left = cursor.in_style(SMALL), _left(cursor)
        x, y, places = left, middle, []
        for value in self.values:
            word, chosen = figure(value), value == self.value
            wide = small.measured(word)
            if x > left and x + wide > cursor.right:
                x, y = left, y + _HEIGHT
            if canvas := cursor.canvas:
                canvas.text(word, (x, y + 4.5), size=SMALL, colour=self.colour if chosen else MUTE)
                if chosen:
                    canvas.line((x, y + 10), (x + wide, y + 10), self.colour, 2.0 if self.live else 1.0)
            places.append(pygame.FRect(x - _GAP / 2, y - _HEIGHT / 2, wide + _GAP, _HEIGHT))
            x += wide + _GAP
        self._places = tuple(places)
        cursor.y = y + _HEIGHT / 2


KINDS: Final[dict[str, type[Knob]]] = {"slider": SliderKnob, "switch": WordsKnob, "words": WordsKnob}


def _left(row: pygame.Rect | Cursor) -> float:
    """Return where the control of a row begins, in points."""
    return row.left + min(_LABELS, 0.5 * row.width)


@lru_cache(maxsize=1024)
def _along(stops: tuple[Any, ...], value: Any) -> float:
    """Return the place of a value between the first stop and the last, 0 to 1; stops are evenly spaced."""
    sizes = np.abs(np.array(stops, dtype=float))  # they rise, or fall below 0
    return float(np.interp(abs(value), sizes, np.linspace(0.0, 1.0, len(sizes))))
