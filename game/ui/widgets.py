"""Basic widgets: words, toggles, sliders and choices."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Final

import pygame

from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, INK, MUTE, NET, SMALL, TEXT, Colour
from game.drawing.typeface import Weight
from game.ui.widget import EASE, OnPress, PointsManager, Widget, mix
from game.ui.words import GAP as CHOICE_GAP
from game.ui.words import TextButtonRow

_SWITCH: Final = 46  # points that a switch takes of its box


class TextButton(Widget):
    """Text button; a short line under the word shows the focus."""

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        label: str,
        on_press: OnPress,
        *,
        size: float = TEXT,
        weight: Weight = "regular",
        colour: Colour = MUTE,
    ) -> None:
        super().__init__(manager, box, label)
        self._on_press, self._size, self._weight, self._colour = on_press, size, weight, colour

    @property
    def baseline(self) -> float:
        """The y of the word's baseline, in points."""
        return self.box.centery + 0.36 * self._size

    def press(self) -> Transition | None:
        return self._on_press()

    def tint(self) -> Colour:
        return mix(self._colour, INK, self.warmth)

    def paint(self, canvas: Canvas) -> None:
        left, baseline = self.box.left, self.baseline
        box = canvas.text(
            self.label, (left, baseline), size=self._size, weight=self._weight, colour=self.tint(), room=self.box.width
        )
        length = box.width * self.warmth
        if length > 1:
            y = baseline + 0.42 * self._size
            canvas.line((left, y), (left + length, y), NET, 2, self.warmth)


class Toggle(Widget):
    """On-off switch: a label on the left, a switch at the right end of the box."""

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        label: str,
        value: bool,
        on_change: Callable[[bool], None],
        *,
        hint: str = "",
    ) -> None:
        super().__init__(manager, box, label)
        self.value, self._on_change, self._hint = value, on_change, hint
        self._slid = float(value)

    def press(self) -> None:
        self.value = not self.value
        self._on_change(self.value)

    def shift(self, direction: int) -> bool:
        if self.value == (direction > 0):
            return False
        self.press()
        return True

    def ease(self, at_once: bool) -> None:
        super().ease(at_once)
        target = float(self.value)
        self._slid = target if at_once else self._slid + (target - self._slid) * 1.4 * EASE

    def paint(self, canvas: Canvas) -> None:
        super().paint(canvas)
        box = self.box
        middle = box.centery
        baseline = middle + 5 if not self._hint else middle - 4
        canvas.text(self.label, (box.left, baseline), colour=mix(mix(MUTE, INK, 0.6), INK, self.warmth))
        if self._hint:
            canvas.text(self._hint, (box.left, baseline + 21), size=SMALL, colour=MUTE, room=box.width - _SWITCH)
        draw_switch(canvas, (box.right - 32, middle - 8, 32, 16), self._slid)


class Slider(Widget):
    """Slider for a number: a thin track with a round handle, the label on the left, the figure on the right.

    `ticks` are values that have a name; it stops at them as well as after each `step`.
    """

    by_arrows = True

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        label: str,
        value: float,
        limits: tuple[float, float],
        on_change: Callable[[float], None],
        *,
        step: float = 0.0,
        ticks: Mapping[float, str] = MappingProxyType({}),
        logarithmic: bool = False,
        label_width: float = 142,
        figure_width: float = 62,
        figure: Callable[[float], str] = "{:.2f}".format,
        colour: Colour = NET,
    ) -> None:
        super().__init__(manager, box, label)
        self.value, self.limits, self._on_change = value, limits, on_change
        self._step, self._ticks, self._logarithmic = step, ticks, logarithmic
        self._figure, self._colour = figure, colour
        self._track = (self.box.left + label_width, self.box.right - figure_width)

    @property
    def fraction(self) -> float:
        """Position of the handle on its track, 0 to 1."""
        return self._fraction_of(self.value)

    def _fraction_of(self, value: float) -> float:
        low, high, value = map(self._scale, (*self.limits, value))
        return min(max((value - low) / (high - low), 0.0), 1.0)

    def set(self, value: float) -> None:
        """Set the value, clipped to the limits and rounded to a step or a tick."""
        low, high = self.limits
        if self._step:
            stops = low + round((value - low) / self._step) * self._step, *self._ticks
            value = min(stops, key=lambda stop: abs(stop - value))
        value = min(max(value, low), high)
        if value != self.value:
            self.value = value
            self._on_change(value)

    def shift(self, direction: int) -> bool:
        if self._step:
            low, value = self.limits[0], self.value
            steps = math.floor(direction * (value - low) / self._step + 1e-6) + 1
            stops = low + direction * steps * self._step, *self._ticks
            self.set(
                min((stop for stop in stops if direction * (stop - value) > 0), key=lambda stop: abs(stop - value))
            )
        else:
            self._set_fraction(self.fraction + direction / 20)
        return True

    def advance(self) -> None:
        """Move the handle one step to the right, or from the right end to the left one."""
        if self.value >= self.limits[1]:
            self.set(self.limits[0])
        else:
            self.shift(1)

    def drag(self, x: float) -> None:
        left, right = self._track
        self._set_fraction((x - left) / (right - left))

    def _set_fraction(self, fraction: float) -> None:
        low, high = map(self._scale, self.limits)
        value = low + min(max(fraction, 0.0), 1.0) * (high - low)
        self.set(math.exp(value) if self._logarithmic else value)

    def _scale(self, value: float) -> float:
        return math.log(value) if self._logarithmic else value

    def paint(self, canvas: Canvas) -> None:
        super().paint(canvas)
        box, (left, right) = self.box, self._track
        baseline, middle = box.centery + 5, box.centery
        canvas.text(self.label, (box.left, baseline), size=SMALL + 1, colour=self.tint(), room=left - box.left - 12)
        canvas.bar((left, middle - 1, right - left, 2), self.fraction, self._colour)
        handle = (left + self.fraction * (right - left), middle)
        canvas.dot(handle, 5 + self.warmth, INK)
        canvas.text(
            self._figure(self.value),
            (box.right, baseline),
            size=SMALL + 1,
            colour=self._colour,
            align="right",
            tabular=True,
            room=box.right - right - 10,
        )


class Choice(Widget):
    """Choice of one word in a row, with a line under the chosen one.

    Words that do not fit into the box go on further pages, one of which is shown at a time, between arrows.
    """

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        label: str,
        options: Sequence[str],
        index: int,
        on_change: Callable[[int], None],
        *,
        label_width: float = 0,
        size: float = TEXT,
        gap: float = CHOICE_GAP,
    ) -> None:
        super().__init__(manager, box, label)
        self.options, self.index, self._on_change, self._size = options, index, on_change, size
        self._label_room = max(label_width - 10, 0)
        self.row = TextButtonRow(options, self.box.left + label_width, self.box.right, size, gap)

    def choose(self, index: int) -> None:
        """Choose an option by its number."""
        index = min(max(index, 0), len(self.options) - 1)
        if index != self.index:
            self.index = index
            self._on_change(index)

    def press(self) -> Transition | None:
        self.choose(self.row.pressed(self.mouse_x, self.index))
        return None

    def shift(self, direction: int) -> bool:
        before = self.index
        self.choose(self.index + direction)
        return self.index != before

    def paint(self, canvas: Canvas) -> None:
        super().paint(canvas)
        baseline = self.box.centery + 0.36 * self._size
        canvas.text(self.label, (self.box.left, baseline), size=self._size, colour=self.tint(), room=self._label_room)
        self.row.paint(canvas, baseline, self.index)


def draw_switch(canvas: Canvas, rect: tuple[float, float, float, float], slid: float, colour: Colour = NET) -> None:
    """Draw a switch; `slid` is the position of its knob, from 0, off, to 1, on."""
    left, top, width, height = rect
    canvas.pill(rect, mix(FAINT, colour, slid))
    half = height / 2
    canvas.dot((left + half + (width - height) * slid, top + half), half - 2.5, INK)
