"""Editing of the large network by hand: units are silenced, links are cut, and back.

The swarm flies with it at once, and learning is held still until the player lets it go on. What is drawn is what the
run tells back, never what was asked for.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable
from typing import Final, NamedTuple

import numpy as np
import pygame

from ai.explain.inspection import links
from ai.nn import NeuralNetwork
from ai.training.edits import Edit, NetworkEdits
from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import HUMAN, NIGHT0, SMALL
from game.explain.network_view import NetworkView
from game.scenes.train.rewind import Rewind
from game.training.run import TrainingRun
from game.ui.panel import Column

_NEAR: Final = 5.0  # points from a link within which it is picked
_CLEAR: Final = 0.04  # share of a link at either end that belongs to its units
_DASH: Final = 7.0


class Unit(NamedTuple):
    """Unit of a network; stage 0 are the inputs."""

    stage: int
    unit: int


class Link(NamedTuple):
    """Link of a network, from a unit of stage `layer` to one of the next."""

    layer: int
    start: int
    end: int

    @property
    def ends(self) -> tuple[Unit, Unit]:
        """The units that it links."""
        return Unit(self.layer, self.start), Unit(self.layer + 1, self.end)


Part = Unit | Link


class NetworkEditing:
    """Editing of a run's network in its view, and the words for it.

    Attributes:
        picked: the unit or link that was chosen.

    """

    def __init__(self, view: NetworkView, run: TrainingRun, rewind: Rewind) -> None:
        self._view, self._run, self._rewind = view, run, rewind
        self.clear()

    def clear(self) -> None:
        """Reset for another run."""
        self.picked: Part | None = None
        self._network: NeuralNetwork | None = None

    def look(self, network: NeuralNetwork) -> None:
        """Take the network that is shown."""
        self._network = network
        if isinstance(self.picked, Link) and self._weight is None:
            self.picked = None

    @property
    def enabled(self) -> bool:
        """Whether the network can be edited now: one of an earlier moment cannot."""
        return self._run.alive and self._rewind.moment is None and self._network is not None

    @property
    def _weight(self) -> float | None:
        """Weight of the picked link; None without one, if it is of another network, or is not finite."""
        if not isinstance(self.picked, Link) or self._network is None:
            return None
        found, (layer, *place) = links(self._network), self.picked
        if layer >= len(found) or any(at >= size for at, size in zip(place, found[layer].weights.shape, strict=True)):
            return None
        weight = float(found[layer].weights[tuple(place)])
        return weight if np.isfinite(weight) else None

    @property
    def _fixed(self) -> bool:
        """Whether the picked link is the sum of several weights, as those of a dueling layer are."""
        last = len(self._view.columns) - 2
        return isinstance(self.picked, Link) and bool(self._run.config.dueling) and self.picked.layer == last

    @property
    def _silent(self) -> bool:
        """Whether the picked unit is silenced."""
        return isinstance(self.picked, Unit) and self.picked in self._run.edits.silenced

    # What is done

    def follow(self, event: pygame.event.Event) -> None:
        """Pick what the mouse or the virtual pointer is pressed on."""
        pressed = event.type == pygame.MOUSEBUTTONDOWN and event.button == 1
        if pressed and self.enabled and self._view.box.collidepoint(event.pos):
            self.picked = part_at(self._view, event.pos)

    def _take_away(self) -> None:
        """Silence the picked unit, or cut the picked link."""
        if self.picked is not None:
            self._run.ask("edit", Edit(*self.picked))

    def update(self) -> None:
        """Keep what was edited in sight."""
        picked, edits = self.picked, self._run.edits
        changed = [*([picked] if picked else []), *(Link(*weight) for weight in edits.weights)]
        units = {unit for part in changed for unit in (part.ends if isinstance(part, Link) else (part,))}
        self._view.pinned = frozenset({(*unit,) for unit in units} | {(*unit,) for unit in edits.silenced})

    # The words

    @property
    def key(self) -> Hashable:
        """What decides which rows there are."""
        edits = self._run.edits
        changed = edits.steps > 0, edits.holds, edits.way_back
        return self.enabled, self._rewind.moment is None, self.picked, self._silent, changed

    def describe(self, column: Column, *, opened: bool) -> None:
        """Add what is picked, and what can be done to it; where the network is not seen, what was edited alone."""
        edits, words = self._run.edits, list[tuple[str, Callable[[], None]]]()
        changed = self.enabled and (edits.steps > 0 or edits.holds or edits.way_back)
        if opened and self._run.alive:
            column.text(lambda: self._sentence, size=SMALL, colour=HUMAN)
            words += self._answers if self.enabled and not self._silent else []
        elif changed:
            column.text(texts.EDIT_HOLDS if edits.holds else texts.EDIT_LEARNT_ON, size=SMALL, colour=HUMAN)
        if changed and edits.steps:
            words.append((texts.EDIT_UNDO, lambda: self._run.ask("undo")))
        if changed and edits.way_back:
            words.append((texts.EDIT_RESTORE, lambda: self._run.ask("undo", True)))
        if changed and edits.holds:
            words.append((texts.EDIT_LEARN_ON, lambda: self._run.ask("learn_on")))
        if words:
            column.words(words)

    @property
    def _answers(self) -> list[tuple[str, Callable[[], None]]]:
        """What can be done to the picked unit or link."""
        if isinstance(self.picked, Unit):
            inner = self.picked.stage < len(self._view.columns) - 1
            return [(texts.EDIT_SILENCE, self._take_away)] if inner else []
        return [(texts.EDIT_CUT, self._take_away)] if self._weight and not self._fixed else []

    @property
    def _sentence(self) -> str:
        """What is said of what is picked."""
        if self._rewind.moment is not None:
            return texts.EDIT_PAST
        if self.picked is None:
            return texts.EDIT_HINT
        name = name_of(self._view, self.picked)
        if isinstance(self.picked, Link):
            return texts.EDIT_DUELING if self._fixed else name
        if self.picked.stage == len(self._view.columns) - 1:
            return texts.EDIT_OUTPUT
        return texts.EDIT_SILENT.format(name=name) if self._silent else name

    def draw(self, canvas: Canvas) -> None:
        """Draw the marks over the network."""
        if self._network is not None:
            draw_marks(canvas, self._view, self._run.edits, self.picked)


def part_at(view: NetworkView, point: Point) -> Part | None:
    """Return the unit at a point of the canvas, or else the drawn link; None for neither."""
    if found := view.unit_at(point):
        return Unit(found[0], int(view.columns[found[0]].units[found[1]]))
    best, least = None, _NEAR
    for edge in view.edges:
        start, end = view.centres[edge.column][edge.start], view.centres[edge.column + 1][edge.end]
        away = _distance(point, start, end) - edge.size  # of two that cross, the stronger one is meant
        if away < least:
            best, least = edge, away
    if best is None:
        return None
    left, right = view.columns[best.column], view.columns[best.column + 1]
    return Link(best.column, int(left.units[best.start]), int(right.units[best.end]))


def name_of(view: NetworkView, part: Part) -> str:
    """Return the name of a unit, or of a link by those of its ends."""
    if isinstance(part, Link):
        return texts.EDIT_LINK.format(start=name_of(view, part.ends[0]), end=name_of(view, part.ends[1]))
    place = _place(view, part)
    return "" if place is None else view.name(part.stage, place)


def draw_marks(canvas: Canvas, view: NetworkView, edits: NetworkEdits, picked: Part | None) -> None:
    """Draw silenced units hollow, cut links dashed, and the picked unit or link in amber."""
    for weight in edits.weights:
        _draw_link(canvas, view, Link(*weight), cut=True)
    for place in edits.silenced:
        if centre := _centre(view, Unit(*place)):
            canvas.dot(centre, view.radius + 2, NIGHT0)
            canvas.marker("ring", centre, 2 * view.radius + 2, HUMAN)
    if isinstance(picked, Link):
        _draw_link(canvas, view, picked, cut=tuple(picked) in edits.weights)
    elif picked and (centre := _centre(view, picked)):
        canvas.marker("ring", centre, 2 * view.radius + 8, HUMAN)


def _draw_link(canvas: Canvas, view: NetworkView, link: Link, *, cut: bool) -> None:
    start, end = (_centre(view, unit) for unit in link.ends)
    if start is None or end is None:
        return
    if not cut:
        canvas.line(start, end, HUMAN, 2.0)
        return
    first = pygame.Vector2(start)
    count = max(1, round(math.dist(start, end) / _DASH / 2))
    for number in range(count):
        here, there = first.lerp(end, number / count), first.lerp(end, (number + 0.5) / count)
        canvas.line((here.x, here.y), (there.x, there.y), HUMAN, 1.5, 0.7)


def _place(view: NetworkView, unit: Unit) -> int | None:
    """Return the place of a unit among the shown ones of its column; None if it is not shown."""
    if unit.stage >= len(view.columns):
        return None
    shown = np.flatnonzero(view.columns[unit.stage].units == unit.unit)
    return int(shown[0]) if len(shown) else None


def _centre(view: NetworkView, unit: Unit) -> Point | None:
    place = _place(view, unit)
    return None if place is None else view.centres[unit.stage][place]


def _distance(point: Point, start: Point, end: Point) -> float:
    """Return the distance from a point to a link between its ends; infinite beside them."""
    (x, y), (x0, y0), (x1, y1) = point, start, end
    along = ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / max((x1 - x0) ** 2 + (y1 - y0) ** 2, 1e-9)
    if not _CLEAR < along < 1 - _CLEAR:
        return math.inf
    return math.hypot(x - x0 - along * (x1 - x0), y - y0 - along * (y1 - y0))
