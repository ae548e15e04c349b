"""Scene of one step of the engine, piece by piece: boxes, axes, contact, and the impulses one by one."""

from __future__ import annotations

from typing import Final

import pygame

from game.core import texts
from game.core.source import source_of
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import INK, MUTE, SMALL
from game.input.controls import Command
from game.panels.code_listing import draw_listing
from game.scenes.physics.exhibits import Exhibit
from game.scenes.physics.step_pieces import Piece, pieces_of, rows, sentence
from game.scenes.physics.step_record import Pair, StepRecord
from game.scenes.physics.step_view import StepView
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.panel import Panel
from game.ui.panel_scene import PanelScene
from game.world.grip import Grip

_PICTURE, _LISTING = 410.0, 320.0  # heights
_NOTES: Final = 164.0  # points for the numbers beside the code
_LEAST: Final = 420.0  # width of a column


class PhysicsStepScene(PanelScene):
    """One step of an exhibit, recorded on a copy of it; the exhibit itself stays as it is.

    Attributes:
        record: the step.
        pair: the shapes that are followed through it; None if none is near another.
        pieces: what happens to them, one after the other.
        place: number of the piece that is shown.
        in_code: whether its code and its figures stand beside the picture.

    """

    def __init__(self, context: Context, exhibit: Exhibit, grip: Grip | None = None) -> None:
        super().__init__(context)
        self.record = StepRecord(exhibit, grip)
        self._view, self.in_code = StepView(self.record), False
        self.pair = max(self.record.pairs, key=self._push, default=None)
        self._follow(self.pair)
        self.form.focus(self._slider)

    def _push(self, pair: Pair) -> float:
        """Return the impulse between two shapes, -1 if they do not touch."""
        contacts = self.record.contacts
        return -1.0 if contacts is None or pair.contact is None else float(contacts.impulse[pair.contact, :2].sum())

    def describe(self, panel: Panel) -> None:
        """Add the kinds of pieces, what happens, the slider, and the picture, with its code and figures if wanted."""
        panel.aside(texts.STEP_TITLE)
        self._kinds = list(dict.fromkeys(piece.kind for piece in self.pieces))
        words, chosen = [texts.STEP_PIECES[kind][0] for kind in self._kinds], self._kinds.index(self.piece.kind)
        self._tabs = panel.choice("", words, chosen, self._turn_to_kind)
        panel.text(lambda: sentence(self.record, self.piece, self.pair))
        last = len(self.pieces) - 1
        self._slider = panel.slider(
            texts.STEP_PIECE, self.place, (0, last), self._turn_to, step=1,
            figure=lambda value: texts.STEP_PLACE.format(count=value + 1, total=last + 1),
        )  # fmt: skip
        left, *right = panel.beside((1, 1) if self.in_code else (1,), least=_LEAST, apart=40.0)
        left.picture(_PICTURE, lambda canvas, box: self._view.draw(canvas, box, self.piece, self.pair))
        for column in right:
            column.picture(_LISTING, self._draw_code)
            column.add(self._write_figures)

    # What is chosen

    @property
    def piece(self) -> Piece:
        """The piece that is shown."""
        return self.pieces[self.place]

    def _follow(self, pair: Pair | None, kind: str = "") -> None:
        """Follow a pair, from the first piece of a kind on, if it has one."""
        self.pair, self.pieces = pair, pieces_of(self.record, pair)
        self.place = next((place for place, piece in enumerate(self.pieces) if piece.kind == kind), 0)
        self.build()

    def _turn_to(self, place: float) -> None:
        self.place = round(place)
        self._tabs.index = self._kinds.index(self.piece.kind)

    def _turn_to_kind(self, index: int) -> None:
        self.place = next(place for place, piece in enumerate(self.pieces) if piece.kind == self._kinds[index])
        self._slider.value = float(self.place)

    def _other_pair(self, direction: int) -> None:
        """Follow another pair that touches; if none does, another that is near."""
        pairs = [pair for pair in self.record.pairs if pair.contact is not None] or self.record.pairs
        if self.pair in pairs:
            self._follow(pairs[(pairs.index(self.pair) + direction) % len(pairs)], self.piece.kind)

    def _show_code(self) -> None:
        self.in_code = not self.in_code
        self.build()

    def actions(self) -> Table:
        """Next piece; another pair; the code; back to the gallery."""
        pairs = [
            Action(Command.NEXT, lambda: self._other_pair(1), texts.HINT_NEXT_PAIR),
            Action(Command.PREVIOUS, lambda: self._other_pair(-1)),
        ]
        return [
            Action(Command.STEP, lambda: self._slider.set(self.place + 1), texts.HINT_NEXT_PIECE),
            *(pairs if len(self.record.pairs) > 1 else []),
            Action(Command.CHOICES, self._show_code, texts.STEP_CODE[self.in_code]),
            self.form.goes_back(texts.HINT_BACK),
        ]

    # The code

    def _draw_code(self, canvas: Canvas, box: pygame.FRect) -> None:
        piece, source = self.piece, source_of(self.piece.function)
        if source is None:
            draw_wrapped(canvas, texts.STEP_NO_SOURCE, (box.left, box.top + 14), box.width, colour=MUTE)
            return
        draw_listing(canvas, box, source, piece.line, piece.notes, notes_width=_NOTES if piece.notes else 0.0)

    def _write_figures(self, cursor: Cursor) -> None:
        for words, lit in rows(self.record, self.piece, self.pair):
            row = cursor.in_style(SMALL, INK if lit else MUTE)
            row.text(words)
            cursor.y = row.y
