"""Knobs: rows of the panel of settings, each a label, a control (slider, switch or words) and a figure.

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
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, MUTE, NET, PANEL, SMALL, Colour
from game.input.controls import Command, translate
from game.training.knob_descriptions import KnobDescription, figure
from game.ui.widget import PointsManager, Widget, mix
from game.ui.widgets import draw_switch
from game.ui.words import TextButtonRow

MARGIN: Final = 16  # left of the label, for the dot
_TRACK: Final = (142.0, 62.0)  # from the label to the track, from the track to the right end
_GAP: Final = 14.0  # between words
_DIM: Final = mix(FAINT, MUTE, 0.45)  # of a knob that has no effect
_NOTE: Final = LABEL - 1.5  # size of text over a track
_CLEAR: Final = 9.0  # from the middle of the handle to that text


class Knob(Widget):
    """Base of all knobs. The panel owns the value: `turn`, given the knob's name, asks for another; `display` shows it.

    `enter` is called by Enter, or a gamepad's A, on a slider, which has nothing to press.

    Attributes:
        value: the value that is shown.
        home: the preset's value.
        waits: whether the value is yet to be applied.
        now: the value in force at this moment of a run, where it differs; else None.
        idle: why the knob has no effect; empty if it has one.
        more: shows all that there is to say about it, and its experiments; None where there is no more.

    """

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        description: KnobDescription,
        turn: Callable[[str, Any], None],
        enter: Callable[[], None] = lambda: None,
    ) -> None:
        super().__init__(manager, box, description.label)
        self.description, self.help = description, description.help
        self.value: Any = None
        self.home: Any = None
        self.waits = False
        self.now: float | None = None
        self.idle = ""
        self._turn, self._enter = turn, enter
        self.more: Callable[[], None] | None = None
        self._named = False  # the mouse was pressed on the name

    def display(self, value: Any, home: Any, *, waits: bool, now: float | None = None, idle: str = "") -> None:
        """Show what the panel says."""
        self.value, self.home, self.waits, self.idle = value, home, waits, idle
        rounded = None if now is None else float(f"{now:.3g}")
        self.now = None if rounded is None or figure(rounded) == figure(value) else rounded
        self.help = idle or self.description.help

    @property
    def live(self) -> bool:
        """Whether the knob may change while a run goes on."""
        return self.description.live

    @property
    def changed(self) -> bool:
        """Whether the value is not the preset's."""
        return bool(self.value != self.home)

    @property
    def track(self) -> tuple[float, float]:
        """Left and right end of the track, in points."""
        return self.box.left + MARGIN + _TRACK[0], self.box.right - _TRACK[1]

    @property
    def colour(self) -> Colour:
        """Colour of the knob: blue, grey if it takes a new run, amber if it waits, dim if it has no effect."""
        return HUMAN if self.waits else _DIM if self.idle else NET if self.live else MUTE

    def turn(self, value: Any) -> None:
        """Request another value from the panel."""
        if value != self.value:
            self._turn(self.description.name, value)

    def take(self, event: pygame.event.Event) -> bool:
        """Restore the preset's value on the key for it, or show more."""
        if self.more is not None and translate(event) is Command.CHOICES:
            self.more()
            return True
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

    def paint(self, canvas: Canvas) -> None:
        """Draw the ring of the focus, the dot of a change and the label."""
        draw_row(canvas, self, changed=self.changed, dim=bool(self.idle))

    def write(self, canvas: Canvas, written: str) -> None:
        """Write a figure at the right end."""
        canvas.text(
            written,
            (self.box.right, self.box.centery + 4.5),
            size=SMALL,
            colour=self.colour,
            align="right",
            tabular=True,
            room=_TRACK[1] - 8,
        )


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

    def paint(self, canvas: Canvas) -> None:
        """Draw track, tick, handle and figure."""
        super().paint(canvas)
        left, right = self.track
        middle, width = self.box.centery, right - left
        fraction, home = self._at(self.value), left + self._at(self.home) * width
        canvas.line((home, middle - 5), (home, middle + 5), MUTE, 1, 0.8)
        canvas.bar((left, middle - 1, width, 2), fraction, self.colour)
        handle, radius = (left + fraction * width, middle), 5 + self.warmth
        whole = self.live and not self.idle
        canvas.dot(handle, radius, INK if whole else mix(_DIM if self.idle else MUTE, INK, self.warmth))
        if not whole:
            canvas.dot(handle, radius - 1.6, PANEL)
        if self.now is not None:
            self._paint_now(canvas, self.now, handle[0])
        elif self.idle:
            self._paint_beside(canvas, texts.KNOB_IDLE, middle - 4, handle[0], handle[0])
        self.write(canvas, figure(self.value))

    def _paint_now(self, canvas: Canvas, now: float, handle: float) -> None:
        """Mark the value in force on the track, and write it above."""
        left, right = self.track
        x, middle = left + self._at(now) * (right - left), self.box.centery
        canvas.line((x, middle - 1), (x, middle + 6), INK, 2)
        self._paint_beside(canvas, texts.KNOB_NOW.format(value=figure(now)), middle - 4, x, handle)

    def _paint_beside(self, canvas: Canvas, words: str, baseline: float, x: float, handle: float) -> None:
        """Write text over the track, around x as far as there is room, clear of the handle."""
        left, right = self.track
        width = canvas.text_width(words, size=_NOTE)
        start = min(max(x - width / 2, left), right - width)
        if start - _CLEAR < handle < start + width + _CLEAR:
            before, after = handle - _CLEAR - width, handle + _CLEAR
            start = before if before >= left and (x <= handle or after + width > right) else after
        canvas.text(words, (start, baseline), size=_NOTE, colour=mix(MUTE, INK, self.warmth))


class SwitchKnob(Knob):
    """A setting that is on or off."""

    _slid: float | None = None

    def press(self) -> None:
        """Change to the other state."""
        self.turn(not self.value)

    def shift(self, direction: int) -> bool:
        """Left is off, right is on."""
        self.turn(direction > 0)
        return True

    def ease(self, at_once: bool) -> None:
        """Let the switch slide."""
        super().ease(at_once)
        target = float(self.value)
        at_once = at_once or self._slid is None
        self._slid = target if at_once else (self._slid or 0.0) + 0.3 * (target - (self._slid or 0.0))

    def paint(self, canvas: Canvas) -> None:
        """Draw the switch and its state."""
        super().paint(canvas)
        left, middle = self.track[0], self.box.centery
        slid = float(self.value) if self._slid is None else self._slid
        draw_switch(canvas, (left, middle - 7, 26, 14), slid, self.colour)
        if not self.live:
            canvas.dot((left + 7 + 12 * slid, middle), 2.6, mix(FAINT, self.colour, slid))
        state = texts.KNOB_SWITCH[bool(self.value)]
        canvas.text(
            state, (self.box.right, middle + 4.5), size=SMALL, align="right", colour=self.colour if self.value else MUTE
        )


class WordsKnob(Knob):
    """A choice among a few words."""

    values: tuple[Any, ...] = ()
    row: TextButtonRow

    def display(self, value: Any, home: Any, *, waits: bool, now: float | None = None, idle: str = "") -> None:
        """Show what the panel says; a value without a word gets one made for it."""
        super().display(value, home, waits=waits, now=now, idle=idle)
        own = [extra for extra in (home, value) if extra not in self.description.stops]
        values = (*self.description.stops, *dict.fromkeys(own))
        if values != self.values:
            self.values = values
            self.row = TextButtonRow([figure(each) for each in values], self.track[0], self.box.right, SMALL, _GAP)

    def press(self) -> None:
        """Take the word under the mouse; without one, the next."""
        self.turn(self.values[self.row.pressed(self.mouse_x, self.values.index(self.value))])

    def shift(self, direction: int) -> bool:
        """Take the word to the left or right."""
        place = self.values.index(self.value) + direction
        if 0 <= place < len(self.values):
            self.turn(self.values[place])
        return True

    def paint(self, canvas: Canvas) -> None:
        """Draw the words."""
        super().paint(canvas)
        ink = self.colour if self.live or self.waits or self.idle else INK
        self.row.paint(
            canvas,
            self.box.centery + 4.5,
            self.values.index(self.value),
            ink=ink,
            line=self.colour,
            drop=5.5,
            thickness=2.0 if self.live else 1.0,
        )


@lru_cache(maxsize=1024)
def _along(stops: tuple[Any, ...], value: Any) -> float:
    """Return the place of a value between the first stop and the last, 0 to 1; stops are evenly spaced."""
    sizes = np.abs(np.array(stops, dtype=float))  # they rise, or fall below 0
    return float(np.interp(abs(value), sizes, np.linspace(0.0, 1.0, len(sizes))))


def draw_row(canvas: Canvas, widget: Widget, *, changed: bool, dim: bool = False) -> None:
    """Draw the parts that all rows share: focus ring, dot of a change, label."""
    box = widget.box
    if widget.ringed and widget.warmth > 0.02:
        canvas.outline(box.inflate(12, 0), 6, INK, 1, 0.35 * widget.warmth)
    if changed:
        canvas.dot((box.left + 5, box.centery), 2.5, HUMAN)
    colour = mix(_DIM if dim else mix(MUTE, INK, 0.7), INK, widget.warmth)
    canvas.text(
        widget.label, (box.left + MARGIN, box.centery + 4.5), size=SMALL, colour=colour, room=_TRACK[0] - MARGIN - 6
    )
