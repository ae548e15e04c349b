"""Bench of an exhibit: sliders of its quantities, and on demand the panel of law and measurement."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

import pygame

from game.core import texts
from game.core.scene import Transition
from game.drawing import typeface
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import HUMAN, MARGIN, SMALL, VIEW_SIZE
from game.scenes.physics.exhibit import Exhibit
from game.scenes.physics.law_panel import LawPanel, RangeMeasurement, Results
from game.ui.form import Form
from game.ui.widget import OnPress, PointsManager, Widget
from game.ui.widgets import Slider, TextButton

_BUTTONS: Final = 128.0  # top of the row of words below the sliders
_HEIGHT: Final = 20
_GAP: Final = 22.0
_BUDGET: Final = 2.5e-3  # seconds of a frame for measuring
_REST: Final = 6  # steps without a change after which an exhibit of many bodies is made anew
_MANY: Final = 24
LEFT: Final = 868.0  # points from the left edge of the view, for all that is on the right of this band
_TOP, _PITCH = 78.0, 24.0
_LABEL_WIDTH, _FIGURE_WIDTH = 142.0, 76.0


class Bench:
    """Everything about an exhibit that the visitor sets or measures.

    Args:
        form: the scene's form, to which the widgets are added.
        rebuild: makes the exhibit anew, with `values`.
        open_step: opens the screen on which one step is taken apart.
        now: clock in seconds.

    Attributes:
        values: values of the quantities, by exhibit and name, as far as they have been changed.
        results: what all runs have measured.
        panel: the panel of law and measurement; None while it is hidden.
        measuring: the range that is being measured, if any; the exhibit waits meanwhile.

    """

    def __init__(self, form: Form, rebuild: Callable[[], None], open_step: OnPress, now: Callable[[], float]) -> None:
        self._form, self._rebuild, self._open_step, self._now = form, rebuild, open_step, now
        self.values: dict[str, dict[str, float]] = {}
        self.results = Results()
        self.panel: LawPanel | None = None
        self.measuring: RangeMeasurement | None = None
        self._shown = False
        self._changed: dict[str, str] = {}  # the quantity changed last, by exhibit
        self._waits: int | None = None  # steps until the exhibit is made anew
        self._exhibit: Exhibit | None = None
        self._sliders: list[Widget] = []
        self._panel_widgets: list[Widget] = []
        row: list[tuple[str, OnPress]] = [
            (texts.LAW_START_VALUES, self.reset),
            (texts.LAW_PLOT, self.toggle),
            (texts.LAW_STEP, open_step),
        ]
        left = LEFT
        self._buttons: list[Widget] = []
        for words, press in row:
            width = typeface.width(words, SMALL, "regular") + 2
            box = pygame.Rect(left, _BUTTONS, width, _HEIGHT)
            self._buttons.append(form.add(TextButton(form.manager, box, words, press, size=SMALL)))
            left += width + _GAP

    def show(self, exhibit: Exhibit) -> None:
        """Turn to an exhibit that has just been made."""
        another = self._exhibit is None or type(exhibit) is not type(self._exhibit)
        self._exhibit, self._waits, self.measuring = exhibit, None, None
        if another:
            sliders: list[Widget] = list(quantity_sliders(self._form.manager, exhibit, self._change))
            self._form.replace([*self._sliders, *self._buttons], [*sliders, *self._buttons])
            self._sliders = sliders
        self.renew()

    @property
    def _name(self) -> str:
        """Name of the quantity on the plot's axis."""
        assert self._exhibit
        return self._changed.get(self._exhibit.name, self._exhibit.quantities[0].name)

    def values_of(self, name: str) -> dict[str, float]:
        """Return the values that have been chosen for an exhibit."""
        return self.values.get(name, {})

    def _change(self, name: str, value: float) -> None:
        assert self._exhibit
        self.values.setdefault(self._exhibit.name, {})[name] = value
        self._changed[self._exhibit.name] = name
        self._waits = _REST if len(self._exhibit.bodies) > _MANY else 0

    def reset(self) -> None:
        """Put all quantities of the exhibit back to their start values, and make it anew."""
        assert self._exhibit
        self.values.pop(self._exhibit.name, None)
        start = self._exhibit.start_values()
        for slider, quantity in zip(self._sliders, self._exhibit.quantities, strict=True):
            slider.value = start[quantity.name]  # type: ignore[attr-defined]
        self._rebuild()

    def toggle(self) -> None:
        """Show or hide the panel of law and measurement."""
        self._shown = not self._shown
        self.measuring = None
        self.renew()

    @property
    def explained(self) -> list[tuple[Widget, str]]:
        """The widgets, and what each is for."""
        what = texts.EXPLAIN_PHYSICS
        buttons = zip(self._buttons, (what["start"], what["plot"], what["inside"]), strict=True)
        return [*((slider, what["slider"]) for slider in self._sliders), *buttons]

    def renew(self) -> None:
        """Make the panel anew, if it is shown."""
        assert self._exhibit
        self.panel = LawPanel(self._exhibit, self._name, self.results) if self._shown else None
        self._offer_measuring()

    def _offer_measuring(self) -> None:
        new: list[Widget] = []
        if self.panel:
            words = texts.LAW_CANCEL if self.measuring else texts.LAW_MEASURE
            new = [TextButton(self._form.manager, self.panel.foot, words, self.measure, size=SMALL, colour=HUMAN)]
        if [(each.label, each.box) for each in new] != [(each.label, each.box) for each in self._panel_widgets]:
            self._form.replace([*self._buttons, *self._panel_widgets], [*self._buttons, *new])
            self._panel_widgets = new

    def measure(self) -> Transition | None:
        """Begin to measure the whole range, or stop that."""
        assert self._exhibit
        self.measuring = None if self.measuring else RangeMeasurement(self._exhibit, self._name, self.results)
        self._offer_measuring()
        return None

    def update(self) -> None:
        """Advance by 1/60 s: make the exhibit anew if a quantity was changed, take in its result, measure on."""
        if self._waits is not None:
            self._waits -= 1
            if self._waits < 0:
                self._waits = None
                self._rebuild()
        assert self._exhibit
        news = self.results.add(self._exhibit)
        if self.measuring:
            before = self.measuring.done
            if self.measuring.advance(self._now, _BUDGET):
                self.measuring = None
                self._offer_measuring()
            news = news or self.measuring is None or self.measuring.done > before
        if self.panel:
            if news:
                self.panel.refresh()
            self.panel.update()

    def covers(self, point: Point) -> bool:
        """Whether the panel lies over a point of the canvas."""
        return self.panel is not None and self.panel.box.collidepoint(point)

    def hover(self, point: Point) -> None:
        """Follow the mouse, or the virtual pointer, in points."""
        if self.panel:
            self.panel.hover(point if self.covers(point) else None)

    def draw(self, canvas: Canvas) -> None:
        """Draw the panel, if it is shown; the form draws the widgets."""
        if self.panel:
            measuring = self.measuring
            progress = texts.LAW_PROGRESS.format(count=measuring.done, total=measuring.count) if measuring else ""
            self.panel.draw(canvas, progress)


def quantity_sliders(manager: PointsManager, exhibit: Exhibit, on_change: Callable[[str, float], None]) -> list[Slider]:
    """Return a slider for each quantity; `on_change` gets its name and its new value."""
    sliders = []
    for row, quantity in enumerate(exhibit.quantities):
        label, figure = texts.QUANTITIES[quantity.name]
        slider = Slider(
            manager,
            pygame.Rect(LEFT, _TOP + row * _PITCH, VIEW_SIZE[0] - MARGIN - LEFT, _HEIGHT),
            label,
            exhibit.values[quantity.name],
            quantity.limits,
            partial(on_change, quantity.name),
            step=quantity.step,
            label_width=_LABEL_WIDTH,
            figure_width=_FIGURE_WIDTH,
            figure=lambda value, figure=figure: figure.format(value=value),  # type: ignore[misc]
            colour=HUMAN,
        )
        sliders.append(slider)
    return sliders
