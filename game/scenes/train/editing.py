"""Editing of the large network by hand: units are silenced, links are cut, and back.

The swarm flies with it at once, and learning is held still until the player lets it go on. What is drawn is what the
run tells back, never what was asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable

import numpy as np
import pygame

from ai.explain.inspection import links
from ai.nn import NeuralNetwork
from ai.training.edits import Edit
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, SMALL
from game.explain.network_view import NetworkView
from game.scenes.train.picking import Link, Part, Unit, draw_marks, name_of, part_at
from game.training.run import TrainingRun
from game.ui.panel import Column


class NetworkEditing:
    """Editing of a run's network in its view, and the words for it.

    Attributes:
        picked: the unit or link that was chosen.
        past: whether an earlier moment is shown, which cannot be edited.

    """

    def __init__(self, view: NetworkView, run: TrainingRun) -> None:
        self._view, self._run = view, run
        self.past = False
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
        """Whether the network can be edited now."""
        return self._run.alive and not self.past and self._network is not None

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
            self._run.edit("edit", Edit(*self.picked))

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
        return self.enabled, self.past, self.picked, self._silent, edits.steps > 0, edits.holds, edits.way_back

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
            words.append((texts.EDIT_UNDO, lambda: self._run.edit("undo")))
        if changed and edits.way_back:
            words.append((texts.EDIT_RESTORE, lambda: self._run.edit("undo", True)))
        if changed and edits.holds:
            words.append((texts.EDIT_LEARN_ON, lambda: self._run.edit("learn_on")))
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
        if self.past:
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
