"""Editing of the large network by hand: units are silenced, links are cut or pulled to another weight, and back.

The swarm flies with it at once, and learning is held still until the player lets it go on. What is drawn is what the
run tells back, never what was asked for.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np
import pygame

from ai.explain.inspection import links
from ai.nn import NeuralNetwork
from ai.training.edits import EditNetwork, LearnOn, SetWeight, SilenceUnit, UndoEdit
from game.core import texts
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, MUTE, SMALL
from game.panels.network_picking import Link, Part, Unit, draw_marks, name_of, part_at
from game.panels.network_view import NetworkView
from game.training.run import TrainingRun
from game.ui.form import Form
from game.ui.widget import Widget
from game.ui.widgets import Slider, TextButton

_ROW: Final = pygame.Rect(40, 116, 780, 24)
_SMALL_ROW: Final = pygame.Rect(40, 404, 780, 24)  # over the swarm, where the network is small
_SPLIT_ROW: Final = pygame.Rect(40, 154, 780, 24)  # over two swarms, whose names stand below them
_SLIDER: Final = 170  # width, with the link's weight, but without its name
_NAME: Final = 14.0  # points between the name and the track
_FIGURE: Final = 52
_GAP: Final = 14.0
_LEAST: Final = 1.0  # weight that a slider reaches at least
_REACH: Final = 2.0  # times the largest weight of the layer that it reaches
_PULL: Final = 160.0  # points that a link is pulled up for the largest weight
_NOTCH: Final = 0.05  # share of that for a notch of the wheel
_COVER: Final = 0.88


class NetworkEditing:
    """Editing of a run's network in its view, and the words for it.

    Attributes:
        picked: the unit or link that was chosen.
        past: whether an earlier moment is shown, which cannot be edited.
        split: whether an experiment is beside the run.

    """

    def __init__(self, form: Form, view: NetworkView, lander_run: TrainingRun) -> None:
        self._form, self._view, self._run = form, view, lander_run
        self.picked: Part | None = None
        self.past = self.split = self._large = False
        self._network: NeuralNetwork | None = None
        self._words: list[Widget] = []
        self._slider: Slider | None = None
        self._of: Part | None = None  # what the first words belong to
        self._own: list[Widget] = []  # these words
        self._laid: object = None
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

    def place(self, large: bool) -> None:
        """Show the network large, where it can be edited, or small."""
        self._large = large
        self.picked = self._dragged = None

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

    def follow(self, event: pygame.event.Event) -> None:
        """Follow the mouse or the virtual pointer on the large network."""
        if not self._large or not self.enabled:
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
            self._run.edit(EditNetwork(SilenceUnit(self.picked.stage, self.picked.unit)))

    def update(self) -> None:
        """Send what was changed in this frame, and lay the words that fit."""
        if self._wanted is not None and isinstance(self.picked, Link) and self.enabled:
            link = self.picked
            self._run.edit(EditNetwork(SetWeight(link.layer, link.start, link.end, self._wanted), self._amends))
            self._amends = self._wanted != 0.0  # a cut is a step of its own
            if self._slider is not None:
                self._slider.value = self._wanted
        self._wanted = None
        edits = self._run.edits
        pinned = {(unit.stage, unit.unit) for unit in _units(self.picked)} | set(edits.silenced)
        for weight in edits.weights:
            pinned |= {(unit.stage, unit.unit) for unit in _units(Link(*weight))}
        self._view.pinned = frozenset(pinned)
        shown = (self.enabled, self._large, self.picked, self._silent, edits.steps > 0, edits.holds, edits.way_back,
                 self.split)  # fmt: skip
        if shown != self._laid:
            self._laid = shown
            self._lay()

    # The words

    @property
    def _row(self) -> pygame.Rect:
        return _ROW if self._large else _SPLIT_ROW if self.split else _SMALL_ROW

    def _lay(self) -> None:
        """Add the slider and the words that fit what is picked and what was edited."""
        edits, row = self._run.edits, self._row
        part = self.picked if self.enabled and self._large and not self._silent else None
        if part != self._of or part is None:  # a slider that is being dragged stays
            self._of, self._slider = part, None
            self._own = self._of_picked() if part else []
        new: list[Widget] = [*self._own]
        words: list[tuple[str, Callable[[], None]]] = []
        if self.enabled and edits.steps:
            words.append((texts.EDIT_UNDO, lambda: self._run.edit(UndoEdit())))
        if self.enabled and edits.way_back:
            words.append((texts.EDIT_RESTORE, lambda: self._run.edit(UndoEdit(all=True))))
        if self.enabled and edits.holds:
            words.append((texts.EDIT_LEARN_ON, lambda: self._run.edit(LearnOn())))
        widths = [typeface.width(label, SMALL, "regular") for label, _ in words]
        left = row.right - sum(widths) - _GAP * max(len(widths) - 1, 0)
        if not self._large:
            left = row.left + typeface.width(self._sentence, SMALL, "regular") + _GAP
        for (label, press), width in zip(words, widths, strict=True):
            new.append(TextButton(self._form.manager, (left, row.top, width, row.height), label, press, size=SMALL))
            left += width + _GAP
        if new or self._words:
            self._form.replace(self._words, new)
        self._words = new

    def _of_picked(self) -> list[Widget]:
        """Return the widgets for the picked unit or link."""
        manager, row = self._form.manager, _ROW
        if isinstance(self.picked, Unit) and self.picked.stage < len(self._view.columns) - 1:
            left = row.left + typeface.width(self._sentence, SMALL, "regular") + _GAP
            return [self._word(left, texts.EDIT_SILENCE, self._silence)]
        if not isinstance(self.picked, Link) or self._fixed or self._weight is None:
            return []
        most = self._most
        name = name_of(self._view, self.picked)
        named = math.ceil(typeface.width(name, SMALL, "regular") + _NAME)
        box = (row.left, row.top, named + _SLIDER, row.height)
        self._slider = Slider(
            manager, box, name, self._weight, (-most, most), self._want, label_width=named, figure_width=_FIGURE,
            figure=_figure, colour=HUMAN,
        )  # fmt: skip
        return [self._slider, self._word(row.left + named + _SLIDER + _GAP, texts.EDIT_CUT, self._cut)]

    def _word(self, left: float, label: str, press: Callable[[], None]) -> TextButton:
        box = (left, _ROW.top, typeface.width(label, SMALL, "regular"), _ROW.height)
        return TextButton(self._form.manager, box, label, press, size=SMALL, colour=HUMAN)

    @property
    def _sentence(self) -> str:
        """What is said at the left end of the row."""
        if not self._large:
            return texts.EDIT_HOLDS if self._run.edits.holds else texts.EDIT_LEARNT_ON
        if self.past:
            return texts.EDIT_PAST
        if self.picked is None:
            return texts.EDIT_HINT
        if isinstance(self.picked, Link):
            return texts.EDIT_DUELING if self._fixed else ""
        if self.picked.stage == len(self._view.columns) - 1:
            return texts.EDIT_OUTPUT
        name = name_of(self._view, self.picked)
        return texts.EDIT_SILENT.format(name=name) if self._silent else name

    def draw(self, canvas: Canvas) -> None:
        """Draw the marks over the network, and the sentence beside the words."""
        if self._network is None:
            return
        row = self._row
        baseline = row.centery + 0.36 * SMALL
        if self._large:
            draw_marks(canvas, self._view, self._run.edits, self.picked)
            room = self._words[0].box.left - row.left - 8 if self._words else row.width
            colour = HUMAN if self.picked and not self.past else MUTE
            if self._run.alive and self._slider is None:
                canvas.text(self._sentence, (row.left, baseline), size=SMALL, colour=colour, room=room)
        elif self._words:
            canvas.panel((24, row.top - 4, self._words[-1].box.right + 16 - 24, row.height + 8), _COVER)
            canvas.text(self._sentence, (row.left, baseline), size=SMALL, colour=HUMAN)


def _units(part: Part | None) -> tuple[Unit, ...]:
    return part.ends if isinstance(part, Link) else (part,) if part else ()


def _figure(weight: float) -> str:
    return f"{weight:+.2f}".replace("-", "−")
