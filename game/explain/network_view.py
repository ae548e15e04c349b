"""Drawing of a network: its units in columns, the strongest links between them, and pulses along the links.

Blue adds and orange takes away, two colours that colour-blind eyes tell apart too. The drawing is cached on two
sheets, one of light and one of signs, until the numbers change; then new sheets are painted, a few edges a step, and
replace the old ones when finished. Only the pulses of learning are drawn every frame.
"""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence
from copy import copy
from typing import Final

import numpy.typing as npt
import pygame

from ai.nn import NeuralNetwork
from game.core import texts
from game.drawing import typeface
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import LABEL, SMALL
from game.explain.network_painting import ADDS, LARGE, MARGIN, TAKES, Sheets, paint
from game.explain.network_plan import Column, Edge, NetworkPlan, Show
from game.ui import plotting
from game.ui.tooltip import TooltipRow, draw_tooltip

_PITCH: Final = 13.0  # points between units, at least
_MOST_UNITS: Final = 24  # in a column
_REST: Final = 6  # sixtieths of a second between two drawings of new numbers
_FLOW: Final = 1 / 90  # of an edge that a pulse travels in a sixtieth of a second
_MOST_PULSES: Final = 26
_GOLDEN: Final = 0.618034  # golden ratio: spreads the pulses' starts as evenly as possible


class NetworkView:
    """View of a network in a box of any size, in points. `inputs` and `outputs` are the names of its ends."""

    def __init__(self, box: pygame.typing.RectLike, inputs: Sequence[str] = (), outputs: Sequence[str] = ()) -> None:
        self.box = pygame.FRect(box)
        self.inputs, self.outputs = tuple(inputs), tuple(outputs)
        self.output_scale = 1.0  # one point of reward, in units of the network's outputs
        self.plan: NetworkPlan | None = None
        self.edges: list[Edge] = []
        self.reads_out = True  # whether a unit's value is written beside it while it is highlighted
        self.redraws = 0  # number of times that the sheets were painted
        self.pinned: frozenset[tuple[int, int]] = frozenset()  # stage and number of units to be shown in any case
        self._show: Show = "weights"
        self._given: tuple[NeuralNetwork, npt.ArrayLike | None] | None = None
        self.hovered: tuple[int, int] | None = None  # column and place in it of the highlighted unit
        self.centres: list[list[Point]] = []  # of all units that are shown, in points
        self._canvas: Canvas | None = None  # for which the sheets were painted
        self._sheets: Sheets | None = None
        self._spare: Sheets | None = None
        self._painting: Generator[None, None, Sheets] | None = None
        self._stale = self._due = self._still = False
        self._rested = 0
        self._phase = 0.0

    # What is shown

    @property
    def columns(self) -> list[Column]:
        """The shown columns of the network, one per layer."""
        return self.plan.columns if self.plan else []

    @property
    def show(self) -> Show:
        """Quantity that the edges show: "weights", "activations" or "gradients"."""
        return self._show

    @show.setter
    def show(self, show: Show) -> None:
        if show != self._show:
            self._show = show
            self._pick_edges()
            self._due = True

    def set(self, network: NeuralNetwork, observation: npt.ArrayLike | None = None) -> None:
        """Show a network's current state, and its activations for an observation (inputs,) already normalised."""
        self._given = network, observation
        self.plan = NetworkPlan(network, observation, self._most_units, self.plan, self.pinned)
        self.centres = self._lay_out()
        if self.hovered and self.hovered not in self._places():
            self.hovered = None
        self._pick_edges()
        self._stale = True

    def place(self, box: pygame.typing.RectLike) -> None:
        """Move to another box; a larger one shows more of the network."""
        if pygame.FRect(box) != self.box:
            self.box = pygame.FRect(box)
            self._sheets = self._spare = self._painting = self.hovered = self._canvas = None
            if self._given:
                self.set(*self._given)

    @property
    def _most_units(self) -> int:
        return int(min(max((self.box.height - self._foot) // _PITCH, 2), _MOST_UNITS))

    def _pick_edges(self) -> None:
        most = int(min(max(0.3 * self.box.height, 16), 110))
        self.edges = self.plan.edges(self._show, most) if self.plan else []

    def hover(self, point: Point | None) -> None:
        """Highlight the unit under a point of the canvas; None for none."""
        hovered = self.unit_at(point) if point else None
        if hovered != self.hovered:
            self.hovered = hovered
            self._due = True

    def unit_at(self, point: Point) -> tuple[int, int] | None:
        """Return the column and the place in it of the unit at a point of the canvas."""
        if not self.centres or not self.box.inflate(8, 8).collidepoint(point):
            return None
        away = {(i, j): math.dist(point, self.centres[i][j]) for i, j in self._places()}
        nearest = min(away, key=away.__getitem__)
        return nearest if away[nearest] <= max(10.0, 2.2 * self.radius) else None

    def _places(self) -> list[tuple[int, int]]:
        return [(number, place) for number, column in enumerate(self.centres) for place in range(len(column))]

    def weight(self, layer: int, start: int, end: int) -> float:
        """Return the weight between two units of the network as it is shown, by their numbers; 0 if there is none."""
        return self.plan.weight(layer, start, end) if self.plan else 0.0

    def name(self, number: int, place: int) -> str:
        """Return the name of a unit, given its column and its place in it."""
        unit = int(self.columns[number].units[place])
        names = self.names(number)
        return names[unit] if unit < len(names) else texts.NETWORK_VIEW_UNIT.format(layer=number, unit=unit + 1)

    def unit_of(self, number: int) -> float:
        """Return the divisor for a column's displayed values; outputs are shown in points of reward."""
        return self.output_scale if number == len(self.columns) - 1 else 1.0

    def names(self, number: int) -> tuple[str, ...]:
        """Return the names of a column's units, as far as they have any."""
        return self.inputs if number == 0 else self.outputs if number == len(self.columns) - 1 else ()

    def update(self, at_once: bool = False) -> None:
        """Advance by 1/60 s: pulses travel. With reduced motion, `at_once`, only the edges' brightness shows them.

        If new sheets are due, part of them is painted.
        """
        self._rested += 1
        self._still = at_once
        self._phase = (self._phase + _FLOW) % 2.0
        self._due |= self._stale and self._rested >= _REST
        if self._canvas and self._due and self._painting is None:
            self._painting = self._paint(self._canvas)
            self._due = self._stale = False
            self._rested = 0
        self._go_on_painting()

    def _go_on_painting(self) -> None:
        """Paint a part of the new sheets, which replace the old ones once they are whole."""
        if self._painting:
            try:
                next(self._painting)
            except StopIteration as done:
                self._sheets, self._spare, self._painting = done.value, self._sheets, None

    @property
    def busy(self) -> bool:
        """Whether the next step paints part of new sheets, or begins to."""
        return self._due or self._painting is not None

    # Where things are, in points

    @property
    def large(self) -> bool:
        """Whether there is room for values beside the names."""
        return self.box.height >= LARGE

    @property
    def _foot(self) -> float:
        """Height for the legend and the unit counts, in points."""
        return 36.0 if self.large else 18.0

    @property
    def name_size(self) -> float:
        """Size of the names."""
        return SMALL if self.large else LABEL

    @property
    def _sides(self) -> tuple[float, float]:
        """Width for the names on the left and on the right, in points."""
        size = self.name_size
        left, right = (
            max((typeface.width(name, size, "regular") + 10 for name in names), default=4.0)
            for names in (self.inputs, self.outputs)
        )
        return left, right

    @property
    def radius(self) -> float:
        """Radius of a unit, in points."""
        crowd = max((len(column.units) for column in self.columns), default=1)
        return min(max(0.24 * (self.box.height - self._foot) / crowd, 2.0), 7.0)

    def _lay_out(self) -> list[list[Point]]:
        """Return the places of each column's units, in points."""
        (left, right), box, radius = self._sides, self.box, self.radius
        across = (box.width - left - right - 2 * radius) / max(len(self.columns) - 1, 1)
        high = box.height - self._foot - 2 * radius - 4
        centres = []
        for number, column in enumerate(self.columns):
            x, count = box.x + left + radius + number * across, len(column.units)
            steps = [place / (count - 1) for place in range(count)] if count > 1 else [0.5]
            centres.append([(x, box.y + radius + 2 + step * high) for step in steps])
        return centres

    # The picture

    def draw(self, canvas: Canvas) -> None:
        """Draw the network, and the pulses and the read-out over it."""
        if self._sheets is None or self._sheets[0].scale != canvas.scale:
            self._spare, self._canvas, self._painting = None, canvas, self._paint(canvas)
            while self._painting:
                self._go_on_painting()
        corner = (canvas.px(self.box.x - MARGIN), canvas.px(self.box.y - MARGIN))
        assert self._sheets is not None
        light, signs = self._sheets
        canvas.surface.blit(light.surface, corner, special_flags=pygame.BLEND_RGB_ADD)
        canvas.surface.blit(signs.surface, corner)
        if self._show == "gradients" and not self._still:
            self._draw_pulses(canvas)
        if self.hovered and self.reads_out:
            self._draw_tooltip(canvas, *self.hovered)

    def _blank(self, canvas: Canvas) -> Sheets:
        """Return empty sheets: the spare ones, or new ones."""
        if self._spare is None or self._spare[0].scale != canvas.scale:
            light, signs = (canvas.sheet(self.box.width + 2 * MARGIN, self.box.height + 2 * MARGIN) for _ in range(2))
            light.surface = pygame.Surface(light.size)
            return light, signs
        light, signs = self._spare
        light.surface.fill((0, 0, 0))
        signs.surface.fill((0, 0, 0, 0))
        signs.palette = canvas.palette
        return light, signs

    def _paint(self, canvas: Canvas) -> Generator[None, None, Sheets]:
        """Return the painting of the network as it is now onto new sheets."""
        self.redraws += 1
        return paint(copy(self), *self._blank(canvas))

    def _draw_pulses(self, canvas: Canvas) -> None:
        """Draw pulses that run backwards along the edges with the largest gradients."""
        radius = max(1.4, 0.4 * self.radius)
        for number, edge in enumerate(self.edges[-_MOST_PULSES:]):
            along = (self._phase * (1.0, 1.5, 1.0)[number % 3] + _GOLDEN * number) % 1.0
            (x0, y0), (x1, y1) = self.centres[edge.column][edge.start], self.centres[edge.column + 1][edge.end]
            place = (x1 + (x0 - x1) * along, y1 + (y0 - y1) * along)
            alpha = (0.35 + 0.65 * edge.size) * min(1.0, 6 * along, 6 * (1 - along))
            colour = ADDS if edge.positive else TAKES
            canvas.glow(place, 4 * radius, colour, 0.5 * alpha)
            canvas.dot(place, radius, colour, alpha)

    def _draw_tooltip(self, canvas: Canvas, number: int, place: int) -> None:
        column = self.columns[number]
        unit, last = self.unit_of(number), number == len(self.columns) - 1
        words = texts.NETWORK_VIEW_POINTS if last and self.outputs else texts.NETWORK_VIEW_VALUE
        rows = [TooltipRow(words, plotting.compact(float(column.values[place]) / unit))]
        if column.bias is not None:
            rows.append(TooltipRow(texts.NETWORK_VIEW_BIAS, plotting.compact(float(column.bias[place]) / unit)))
        head = self.name(number, place) + (texts.NETWORK_VIEW_DAMAGED if column.damaged[place] else "")
        draw_tooltip(canvas, self.centres[number][place], self.box, [head], rows)
