"""Scene of one step of the engine, piece by piece: boxes, axes, contact, and the impulses one by one."""

from __future__ import annotations

from typing import Final

import pygame

from game.core import texts
from game.core.source import source_of
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.sky import NightSky
from game.drawing.tokens import INK, LABEL, MARGIN, MUTE, SMALL, TEXT, VIEW_SIZE
from game.input.controls import Command
from game.panels.code_listing import draw_listing
from game.scenes.physics.exhibits import Exhibit
from game.scenes.physics.step_pieces import Piece, pieces_of, rows, sentence
from game.scenes.physics.step_record import Pair, StepRecord
from game.scenes.physics.step_view import StepView
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FormScene
from game.ui.hints import HintRow
from game.ui.playback import LABEL_WIDTH
from game.ui.widgets import Choice, Slider
from game.world.grip import Grip

_LISTING: Final = (690.0, 148.0, VIEW_SIZE[0] - 690.0 - 40, 300.0)
_HINTS: Final = 620.0
_NOTES: Final = 164.0  # at the normal size of text
_ROWS: Final = 478.0  # baseline of the first row of figures
_LEADING: Final = 18.0
_TABS: Final = (MARGIN, 50.0, 860.0, 24.0)
_SLIDER: Final = (MARGIN, 640.0, 580.0, 20.0)
_FOLLOW: Final = (MARGIN, 668.0, 420.0, 18.0)


class PhysicsStepScene(FormScene):
    """One step of an exhibit, recorded on a copy of it; the exhibit itself stays as it is."""

    def __init__(self, context: Context, exhibit: Exhibit, grip: Grip | None = None) -> None:
        super().__init__(context)
        self.record = StepRecord(exhibit, grip)
        self._view = StepView(self.record)
        self._sky = NightSky(context.rng, ember=0.35, stars=60)
        self.pair = self._first_pair()
        self._all = False
        self.place = 0
        self.pieces = pieces_of(self.record, self.pair)
        manager = self.form.manager
        self._tabs, self._slider = self._make_tabs(), self._make_slider()
        self.form.add(self._tabs)
        self.form.add(self._slider)
        if self.record.pairs:
            words = texts.STEP_FOLLOWED
            box = pygame.Rect(_FOLLOW)
            follow = Choice(
                manager, box, texts.STEP_FOLLOW, words, 0, self._follow, label_width=LABEL_WIDTH, size=SMALL
            )
            self.form.add(follow)
        self.form.focus(self._slider)

    def _first_pair(self) -> Pair | None:
        """Return the pair with the greatest impulse, or any that is near."""
        contacts = self.record.contacts

        def size(pair: Pair) -> float:
            return -1.0 if contacts is None or pair.contact is None else float(contacts.impulse[pair.contact, :2].sum())

        return max(self.record.pairs, key=size, default=None)

    # Widgets

    def _make_tabs(self) -> Choice:
        self._kinds = list(dict.fromkeys(piece.kind for piece in self.pieces))
        words = [texts.STEP_PIECES[kind][0] for kind in self._kinds]
        chosen = self._kinds.index(self.piece.kind)
        return Choice(self.form.manager, pygame.Rect(_TABS), "", words, chosen, self._turn_to_kind)

    def _make_slider(self) -> Slider:
        last = len(self.pieces) - 1
        return Slider(
            self.form.manager, pygame.Rect(_SLIDER), texts.STEP_PIECE, self.place, (0, last), self._turn_to,
            step=1, label_width=LABEL_WIDTH, figure_width=96,
            figure=lambda value: texts.STEP_PLACE.format(count=value + 1, total=last + 1),
        )  # fmt: skip

    def _renew(self, kind: str) -> None:
        """Make the pieces anew for what is followed now, and turn to the first of a kind, if there is one."""
        self.pieces = pieces_of(self.record, None if self._all else self.pair)
        places = [place for place, piece in enumerate(self.pieces) if piece.kind == kind]
        self.place = places[0] if places else 0
        tabs, slider = self._make_tabs(), self._make_slider()
        self.form.replace([self._tabs, self._slider], [tabs, slider])
        self._tabs, self._slider = tabs, slider

    # What is chosen

    @property
    def piece(self) -> Piece:
        """The piece that is shown."""
        return self.pieces[self.place]

    def _turn_to(self, place: float) -> None:
        self.place = round(place)
        self._tabs.index = self._kinds.index(self.piece.kind)

    def _turn_to_kind(self, index: int) -> None:
        kind = self._kinds[index]
        self.place = next(place for place, piece in enumerate(self.pieces) if piece.kind == kind)
        self._slider.value = float(self.place)

    def _follow(self, index: int) -> None:
        self._all = bool(index)
        self._renew(self.piece.kind)

    def _other_pair(self, direction: int) -> None:
        """Follow another pair that touches; if none does, another that is near."""
        pairs = [pair for pair in self.record.pairs if pair.contact is not None] or self.record.pairs
        if self.pair in pairs:
            self.pair = pairs[(pairs.index(self.pair) + direction) % len(pairs)]
            self._renew(self.piece.kind)

    def actions(self) -> Table:
        """Next piece; another pair; back to the gallery."""
        pairs = [
            Action(Command.NEXT, lambda: self._other_pair(1), texts.HINT_NEXT_PAIR),
            Action(Command.PREVIOUS, lambda: self._other_pair(-1)),
        ]
        return [
            Action(Command.STEP, lambda: self._slider.set(self.place + 1), texts.HINT_NEXT_PIECE),
            *(pairs if len(self.record.pairs) > 1 and not self._all else []),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints in the upper right corner."""
        return [HintRow(self.hints, (VIEW_SIZE[0] - MARGIN, 38), from_right=True, room=_HINTS)]

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the piece, the code that computed it, and its figures."""
        piece = self.piece
        self._sky.draw(canvas)
        canvas.text(texts.STEP_TITLE, (MARGIN, 38), size=SMALL, colour=MUTE)
        self._view.draw(canvas, piece, piece.pair or self.pair)
        draw_wrapped(
            canvas, sentence(self.record, piece), (MARGIN, 108), VIEW_SIZE[0] - 2 * MARGIN, size=TEXT, leading=20
        )
        source = source_of(piece.function)
        if source:
            width = _NOTES * typeface.grown(LABEL) / LABEL
            draw_listing(canvas, _LISTING, source, piece.line, piece.notes, notes_width=width if piece.notes else 0.0)
        else:
            canvas.text(texts.STEP_NO_SOURCE, (_LISTING[0], _LISTING[1] + 14), size=SMALL, colour=MUTE)
        y = _ROWS
        for words, lit in rows(self.record, piece):
            canvas.text(
                words, (_LISTING[0], y), size=SMALL, colour=INK if lit else MUTE, tabular=True, room=_LISTING[2]
            )
            y += _LEADING
        self.form.draw(canvas)
        self.draw_hints(canvas)
