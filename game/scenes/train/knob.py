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
from game.core.scene import Transition
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, MUTE, NET, PANEL, SMALL, Colour
from game.input.controls import Command, translate
from game.training.knob_descriptions import KnobDescription, figure
from game.ui.entry import Entry, draw_line
from game.ui.rows import RowWidget
from game.ui.text_line import digits
from game.ui.widget import PointsManager, mix
from game.ui.widgets import draw_switch
from game.ui.words import TextButtonRow

_TRACK: Final = (150.0, 62.0)  # from the label to the track, from the track to the right end
_HEIGHT: Final = 20.0
_GAP: Final = 14.0  # between words
_DIM: Final = mix(FAINT, MUTE, 0.45)  # of a knob that has no effect
_NOTE: Final = LABEL - 1.5  # size of text over a track
_CLEAR: Final = 9.0  # from the middle of the handle to that text
_LONGEST_SEED: Final = 9  # digits
_NOWHERE: Final = (0, 0, 1, 1)


class _Row(RowWidget):
    """Row with a label, painted into its own box."""

    pad = 4.0
    idle = ""
    changed = False

    @property
    def track(self) -> tuple[float, float]:
        """Left and right end of the track, in points."""
        return self.box.left + min(_TRACK[0], 0.5 * self.box.width), self.box.right - _TRACK[1]

    def write(self, cursor: Cursor) -> None:
        """Draw the dot of a change, the label and the rest."""
        cursor.take(_HEIGHT)
        if (canvas := cursor.canvas) is None:
            return
        box = self.box
        if self.changed:
            canvas.dot((box.left - 11, box.centery), 2.5, HUMAN)
        colour = mix(_DIM if self.idle else mix(MUTE, INK, 0.7), INK, self.warmth)
        room = self.track[0] - box.left - 10
        canvas.text(self.label, (box.left, box.centery + 4.5), size=SMALL, colour=colour, room=room)
        canvas.cover(canvas.rect(*box))
        self.put(canvas)

    def put(self, canvas: Canvas) -> None:
        """Draw the control and the figure."""


class Knob(_Row):
    """Base of all knobs. The panel owns the value: `turn`, given the knob's name, asks for another; `display` shows it.

    `enter` is called by Enter, or a gamepad's A, on a slider, which has nothing to press.

    Attributes:
        value: the value that is shown.
        home: the preset's value.
        waits: whether the value is yet to be applied.
        now: the value in force at this moment of a run, where it differs; else None.
        idle: why the knob has no effect; empty if it has one.

    """

    def __init__(
        self,
        manager: PointsManager,
        description: KnobDescription,
        turn: Callable[[str, Any], None],
        enter: Callable[[], None] = lambda: None,
    ) -> None:
        super().__init__(manager, _NOWHERE, description.label)
        self.description, self.help = description, description.help
        self.value: Any = None
        self.home: Any = None
        self.waits = False
        self.now: float | None = None
        self._turn, self._enter = turn, enter
        self._named = False  # the mouse was pressed on the name

    def display(self, value: Any, home: Any, *, waits: bool, now: float | None = None, idle: str = "") -> None:
        """Show what the panel says."""
        self.value, self.home, self.waits, self.idle = value, home, waits, idle
        self.changed = bool(value != home)
        rounded = None if now is None else float(f"{now:.3g}")
        self.now = None if rounded is None or figure(rounded) == figure(value) else rounded
        self.help = idle or self.description.help

    @property
    def live(self) -> bool:
        """Whether the knob may change while a run goes on."""
        return self.description.live

    @property
    def colour(self) -> Colour:
        """Colour of the knob: blue, grey if it takes a new run, amber if it waits, dim if it has no effect."""
        return HUMAN if self.waits else _DIM if self.idle else NET if self.live else MUTE

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

    def written(self, canvas: Canvas, words: str, colour: Colour | None = None) -> None:
        """Write a figure at the right end."""
        place = (self.box.right, self.box.centery + 4.5)
        canvas.text(words, place, size=SMALL, colour=colour or self.colour, align="right", tabular=True,
                    room=_TRACK[1] - 8)  # fmt: skip


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

    def put(self, canvas: Canvas) -> None:
        """Draw track, tick, handle and figure."""
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
            x = left + self._at(self.now) * width
            canvas.line((x, middle - 1), (x, middle + 6), INK, 2)
            self._put_beside(canvas, texts.KNOB_NOW.format(value=figure(self.now)), x, handle[0])
        elif self.idle:
            self._put_beside(canvas, texts.KNOB_IDLE, handle[0], handle[0])
        self.written(canvas, figure(self.value))

    def _put_beside(self, canvas: Canvas, words: str, x: float, handle: float) -> None:
        """Write text over the track, around x as far as there is room, clear of the handle."""
        left, right = self.track
        width = canvas.text_width(words, size=_NOTE)
        start = min(max(x - width / 2, left), right - width)
        if start - _CLEAR < handle < start + width + _CLEAR:
            before, after = handle - _CLEAR - width, handle + _CLEAR
            start = before if before >= left and (x <= handle or after + width > right) else after
        if start < left or start + width > right:
            return  # a short track, as in a narrow window
        canvas.text(words, (start, self.box.centery - 4), size=_NOTE, colour=mix(MUTE, INK, self.warmth))


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
        self._slid = target if at_once or self._slid is None else self._slid + 0.3 * (target - self._slid)

    def put(self, canvas: Canvas) -> None:
        """Draw the switch and its state."""
        left, middle = self.track[0], self.box.centery
        slid = float(self.value) if self._slid is None else self._slid
        draw_switch(canvas, (left, middle - 7, 26, 14), slid, self.colour)
        if not self.live:
            canvas.dot((left + 7 + 12 * slid, middle), 2.6, mix(FAINT, self.colour, slid))
        self.written(canvas, texts.KNOB_SWITCH[bool(self.value)], self.colour if self.value else MUTE)


class WordsKnob(Knob):
    """A choice among a few words."""

    @property
    def values(self) -> tuple[Any, ...]:
        """The values to choose from; one that has no word of its own gets one made for it."""
        return tuple(dict.fromkeys((*self.description.stops, self.home, self.value)))

    @property
    def row(self) -> TextButtonRow:
        """The words as they stand."""
        return TextButtonRow([figure(each) for each in self.values], self.track[0], self.box.right, SMALL, _GAP)

    def press(self) -> None:
        """Take the word under the mouse; without one, the next."""
        self.turn(self.values[self.row.pressed(self.mouse_x, self.values.index(self.value))])

    def shift(self, direction: int) -> bool:
        """Take the word to the left or right."""
        place = self.values.index(self.value) + direction
        if 0 <= place < len(self.values):
            self.turn(self.values[place])
        return True

    def put(self, canvas: Canvas) -> None:
        """Draw the words."""
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


KINDS: Final[dict[str, type[Knob]]] = {"slider": SliderKnob, "switch": SwitchKnob, "words": WordsKnob}


class SeedKnob(_Row, Entry):
    """The random seed: typed, or stepped with the arrows. It takes a new run, as a run begins with it."""

    live = False

    def __init__(self, manager: PointsManager, label: str, turn: Callable[[int], None]) -> None:
        super().__init__(manager, _NOWHERE, label, "0", self._accept, limit=_LONGEST_SEED, fits=digits, size=SMALL)
        self.help = texts.KNOB_SEED
        self._turn, self.value, self.waits = turn, 0, False

    def display(self, value: int, *, waits: bool) -> None:
        """Show what the panel says."""
        self.value, self.waits = value, waits
        if not self.typing:
            self.line.set(str(value))

    def shift(self, direction: int) -> bool:
        """Raise or lower the seed by one."""
        self._turn(min(max(self.value + direction, 0), 10**_LONGEST_SEED - 1))
        return True

    def _accept(self, text: str) -> Transition | None:
        self._turn(int(text))
        return None

    def ease(self, at_once: bool) -> None:
        """Take what was typed once the focus is elsewhere."""
        super().ease(at_once)
        self.commit()

    def commit(self) -> None:
        """Take what was typed, unless it is still being typed."""
        if not self.typing and self.line.text != str(self.value):
            self._turn(int(self.line.text or self.value))

    @property
    def start(self) -> tuple[float, float]:
        """Left end of the number, which is aligned to the right end of the row."""
        return self.box.right - typeface.width(self.line.shown, SMALL, "regular"), self.box.centery + 4.5

    def put(self, canvas: Canvas) -> None:
        """Draw the number."""
        x, baseline = self.start
        if self.typing:
            draw_line(canvas, self.line, (x, baseline), self.box.width, SMALL, typing=True)
            canvas.line((min(x, self.box.right - 20), baseline + 5.5), (self.box.right, baseline + 5.5), HUMAN, 1)
        else:
            canvas.text(self.line.text, (x, baseline), size=SMALL, colour=HUMAN if self.waits else MUTE)


@lru_cache(maxsize=1024)
def _along(stops: tuple[Any, ...], value: Any) -> float:
    """Return the place of a value between the first stop and the last, 0 to 1; stops are evenly spaced."""
    sizes = np.abs(np.array(stops, dtype=float))  # they rise, or fall below 0
    return float(np.interp(abs(value), sizes, np.linspace(0.0, 1.0, len(sizes))))
