"""Editing of the large network by hand: units are silenced, links are cut or pulled to another weight, and back.

The swarm flies with it at once, and learning is held still until the player lets it go on. What is drawn is what the
run tells back, never what was asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Final

import numpy as np
import pygame

from ai.explain.inspection import links
from ai.nn import NeuralNetwork
from ai.training.edits import Edit
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, SMALL
from game.panels.network_view import NetworkView
from game.scenes.train.picking import Link, Part, Unit, draw_marks, name_of, part_at
from game.training.run import TrainingRun
from game.ui.panel import Column
from game.ui.rows import SliderRow

_LEAST: Final = 1.0  # weight that a slider reaches at least
_REACH: Final = 2.0  # times the largest weight of the layer that it reaches
_PULL: Final = 160.0  # points that a link is pulled up for the largest weight
_NOTCH: Final = 0.05  # share of that for a notch of the wheel
_STEPS: Final = 50  # of the slider, from 0 to the largest weight


class NetworkEditing:
    """Editing of a run's network in its view, and the words for it.

    Attributes:
        picked: the unit or link that was chosen.
        past: whether an earlier moment is shown, which cannot be edited.

    """

    def __init__(self, view: NetworkView, lander_run: TrainingRun) -> None:
        self._view, self._run = view, lander_run
        self.picked: Part | None = None
        self.past = False
        self._network: NeuralNetwork | None = None
        self._slider: SliderRow | None = None
        self._dragged: tuple[float, float] | None = None  # the mouse's y and the weight, where a pull began
        self._wanted: float | None = None  # weight to be sent with the next update
        self._amends = False  # whether the next weight belongs to the step before

    def clear(self) -> None:
        """Reset for another run."""
        self.picked = self._network = self._dragged = self._wanted = None

    def look(self, network: NeuralNetwork) -> None:
        """Take the network that is shown."""
        self._network = network
        if isinstance(self.picked, Link) and self._weight is None:
            self.picked = None
        if self._slider is not None and self._wanted is None and self._weight is not None:
            self._slider.value = self._weight

    @property
    def enabled(self) -> bool:
        """Whether the network can be edited now."""
        return self._run.alive and not self.past and self._network is not None

    @property
    def _weight(self) -> float | None:
        """Weight of the picked link; None without one, if it is of another network, or is not finite."""
        if not isinstance(self.picked, Link) or self._network is None:
            return None
        found, link = links(self._network), self.picked
        if link.layer >= len(found):
            return None
        weights = found[link.layer].weights
        inside = link.start < weights.shape[0] and link.end < weights.shape[1]
        return float(weights[link.start, link.end]) if inside and np.isfinite(weights[link.start, link.end]) else None

    @property
    def _fixed(self) -> bool:
        """Whether the picked link is the sum of several weights, as those of a dueling layer are."""
        assert self._network is not None
        return isinstance(self.picked, Link) and self._run.config.dueling and self.picked.layer == len(
            links(self._network)
        ) - 1  # fmt: skip

    @property
    def _silent(self) -> bool:
        """Whether the picked unit is silenced."""
        return isinstance(self.picked, Unit) and (self.picked.stage, self.picked.unit) in self._run.edits.silenced

    # What is done

    def follow(self, event: pygame.event.Event, *, opened: bool) -> None:
        """Follow the mouse or the virtual pointer on the network."""
        if not opened or not self.enabled:
            self._dragged = None
        elif event.type == pygame.MOUSEBUTTONDOWN and event.button == 1 and self._view.box.collidepoint(event.pos):
            self.picked = part_at(self._view, event.pos)
            weight = None if self._fixed else self._weight
            self._dragged = None if weight is None else (event.pos[1], weight)
            self._amends = False
        elif event.type == pygame.MOUSEMOTION and self._dragged:
            start, weight = self._dragged
            self._want(weight + (start - event.pos[1]) / _PULL * self._most)
        elif event.type == pygame.MOUSEBUTTONUP:
            self._dragged = None
        elif event.type == pygame.MOUSEWHEEL and self._weight is not None and not self._fixed:
            self._want((self._weight if self._wanted is None else self._wanted) + event.y * _NOTCH * self._most)

    def _want(self, weight: float) -> None:
        most = self._most
        self._wanted = min(max(weight, -most), most)

    @property
    def _most(self) -> float:
        """Largest weight that the picked link can be pulled to."""
        if self._slider is not None:
            return self._slider.limits[1]
        assert isinstance(self.picked, Link)
        assert self._network is not None
        size = np.abs(links(self._network)[self.picked.layer].weights)
        return max(_LEAST, _REACH * float(np.nan_to_num(size, posinf=0.0).max()))

    def _cut(self) -> None:
        self._amends = False
        self._wanted = 0.0

    def _silence(self) -> None:
        if isinstance(self.picked, Unit):
            self._run.edit("edit", Edit(self.picked.stage, self.picked.unit))

    def update(self) -> None:
        """Send what was changed in this frame, and lay the words that fit."""
        if self._wanted is not None and isinstance(self.picked, Link) and self.enabled:
            link = self.picked
            self._run.edit("edit", Edit(link.layer, link.start, link.end, self._wanted), self._amends)
            self._amends = self._wanted != 0.0  # a cut is a step of its own
            if self._slider is not None:
                self._slider.value = self._wanted
        self._wanted = None
        edits = self._run.edits
        pinned = {(unit.stage, unit.unit) for unit in _units(self.picked)} | set(edits.silenced)
        for weight in edits.weights:
            pinned |= {(unit.stage, unit.unit) for unit in _units(Link(*weight))}
        self._view.pinned = frozenset(pinned)

    # The words

    @property
    def key(self) -> Hashable:
        """What decides which rows there are."""
        edits = self._run.edits
        return self.enabled, self.past, self.picked, self._silent, edits.steps > 0, edits.holds, edits.way_back

    def describe(self, column: Column, *, opened: bool) -> None:
        """Add what is picked, and what can be done to it; where the network is not seen, what was edited alone."""
        edits, words = self._run.edits, list[tuple[str, Callable[[], None]]]()
        self._slider = None
        changed = self.enabled and (edits.steps > 0 or edits.holds or edits.way_back)
        if not opened and not changed:
            return
        if not opened:
            column.text(texts.EDIT_HOLDS if edits.holds else texts.EDIT_LEARNT_ON, size=SMALL, colour=HUMAN)
        elif self._run.alive:
            column.text(lambda: self._sentence, size=SMALL, colour=HUMAN)
            words += self._describe_picked(column) if self.enabled and not self._silent else []
        if self.enabled and edits.steps:
            words.append((texts.EDIT_UNDO, lambda: self._run.edit("undo")))
        if self.enabled and edits.way_back:
            words.append((texts.EDIT_RESTORE, lambda: self._run.edit("undo", True)))
        if self.enabled and edits.holds:
            words.append((texts.EDIT_LEARN_ON, lambda: self._run.edit("learn_on")))
        if words:
            column.words(words)

    def _describe_picked(self, column: Column) -> list[tuple[str, Callable[[], None]]]:
        """Add the slider of the picked link; return what can be done to the unit or link."""
        if isinstance(self.picked, Unit):
            return [(texts.EDIT_SILENCE, self._silence)] if self.picked.stage < len(self._view.columns) - 1 else []
        if self.picked is None or self._fixed or self._weight is None:
            return []
        most = self._most
        self._slider = column.slider(
            texts.EDIT_WEIGHT, self._weight, (-most, most), self._want, step=most / _STEPS, figure=_figure
        )
        return [(texts.EDIT_CUT, self._cut)]

    @property
    def _sentence(self) -> str:
        """What is said of what is picked."""
        if self.past:
            return texts.EDIT_PAST
        if self.picked is None:
            return texts.EDIT_HINT
        if isinstance(self.picked, Link):
            return texts.EDIT_DUELING if self._fixed else name_of(self._view, self.picked)
        if self.picked.stage == len(self._view.columns) - 1:
            return texts.EDIT_OUTPUT
        name = name_of(self._view, self.picked)
        return texts.EDIT_SILENT.format(name=name) if self._silent else name

    def draw(self, canvas: Canvas) -> None:
        """Draw the marks over the network."""
        if self._network is not None:
            draw_marks(canvas, self._view, self._run.edits, self.picked)


def _units(part: Part | None) -> tuple[Unit, ...]:
    return part.ends if isinstance(part, Link) else (part,) if part else ()


def _figure(weight: float) -> str:
    return f"{weight:+.2f}".replace("-", "−")
