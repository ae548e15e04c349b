"""Scene of one step of the engine, piece by piece: boxes, axes, contact, and the impulses one by one."""

from __future__ import annotations

import math
from functools import cached_property, partial
from typing import Final

import numpy as np
import pygame

from engine.vector import Array, right_of
from game.core import texts
from game.core.scene import Transition
from game.core.source import source_of
from game.drawing.canvas import Canvas, Point
from game.drawing.cursor import LEADING, Cursor
from game.drawing.tokens import INK, LINE, MUTE, NET, SMALL, TEXT, Colour
from game.explain.code_listing import draw_listing
from game.explain.explained import Explained
from game.input.controls import Command
from game.scenes.physics.bodies import Outlines
from game.scenes.physics.exhibit import Exhibit, Grip
from game.scenes.physics.step import Axis, Impulse, Pair, Piece, StepRecord, written
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.panel import Panel
from game.ui.panel_scene import PanelScene
from game.world.camera import View

_PICTURE, _LISTING = 344.0, 400.0  # greatest heights
_LOW: Final = 0.42  # of its width, the picture's height in a narrow window
_LEAST: Final = 420.0  # width of a column
_SHARE: Final = 0.42  # of the picture's height that the two bodies fill
_WIDER: Final = 2.6  # how much more is shown where all boxes are
_LARGE: Final = 60.0  # metres: a box beyond that is the floor's or a wall's
_ARROW: Final = 84.0  # points of the longest arrow
_NORMAL: Final = 46.0  # points of a normal
_HEAD: Final = 6.0
_INSIDE: Final = 44.0  # points from a contact to the letter of a body that cannot move
_APART: Final = 20.0  # between two words of the field
_LINES, _ROWS = 2, 3  # of a sentence and of a legend, for which there is always room
# By the kind of a piece, the words of the field that name what is shown.
_TERMS: Final = {
    "axes": ("axis",),
    "contact": ("normal",),
    "memory": ("impulse", "solver"),
    "impulses": ("impulse", "normal", "friction", "solver"),
}
Scale = tuple[float, float]  # a round value, and how many points long it is drawn
Legend = list[tuple[Colour, float, str]]  # colour and length in points of an arrow, and what it means


class PhysicsStepScene(PanelScene):
    """One step of an exhibit, recorded on a copy of it; the exhibit itself stays as it is.

    Attributes:
        record: the step.
        pair: the shapes that are followed through it; None if none is near another.
        pieces: what happens to them, one after the other.
        place: number of the piece that is shown.
        in_code: whether its code, with its numbers, stands beside the picture.

    """

    def __init__(self, context: Context, exhibit: Exhibit, grip: Grip | None = None) -> None:
        super().__init__(context)
        self.record, self.explained = StepRecord(exhibit, grip), Explained()
        self._outlines, self.in_code = Outlines(self.record.exhibit.sprites), False
        self._follow(max(self.record.pairs, key=self._push, default=None))
        self.form.focus(self._slider)

    def _push(self, pair: Pair) -> float:
        """Return the impulse between two shapes, -1 if they do not touch."""
        contacts = self.record.contacts
        return -1.0 if contacts is None or pair.contact is None else float(contacts.impulse[pair.contact, :2].sum())

    def describe(self, panel: Panel) -> None:
        panel.aside(texts.STEP_TITLE)
        self._kinds = list(dict.fromkeys(piece.kind for piece in self.pieces))
        words, chosen = [texts.STEP_PIECES[kind][0] for kind in self._kinds], self._kinds.index(self.piece.kind)
        self._tabs = panel.choice("", words, chosen, self._turn_to_kind)
        panel.add(self._write_sentence)
        last = len(self.pieces) - 1
        count = partial(_counted, last + 1)
        self._slider = panel.slider(texts.STEP_PIECE, self.place, (0, last), self._turn_to, step=1, figure=count)
        left, *right = panel.beside((1, 1) if self.in_code else (1,), least=_LEAST, apart=40.0)
        left.picture(lambda width: min(_PICTURE, _LOW * width), self._draw_picture)
        left.add(self._write_legend)
        for column in right:
            column.picture(_LISTING, self._draw_code)
        panel.words([
            *([(texts.STEP_OTHER, lambda: self._other_pair(1))] if len(self.record.pairs) > 1 else []),
            (texts.STEP_CODE[self.in_code], self._show_code),
        ])  # fmt: skip

    # What is chosen

    @property
    def piece(self) -> Piece:
        return self.pieces[self.place]

    def _follow(self, pair: Pair | None, kind: str = "") -> None:
        """Follow a pair, from the first piece of a kind on, if it has one."""
        self.pair, self.pieces = pair, self.record.pieces(pair)
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
        return [
            Action(Command.STEP, lambda: self._slider.set(self.place + 1), texts.HINT_NEXT_PIECE),
            *([self.explained.action()] if self._terms else []),
            self.form.goes_back(texts.HINT_BACK),
            Action(Command.NEXT, lambda: self._other_pair(1)),
            Action(Command.PREVIOUS, lambda: self._other_pair(-1)),
        ]

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        return None if self.explained.handle_event(event) else super().handle_event(event)

    def update(self) -> Transition | None:
        self.explained.update()
        return super().update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        super().draw(canvas, alpha)
        self.explained.draw(canvas)

    # What is said

    @property
    def _terms(self) -> tuple[str, ...]:
        return _TERMS.get(self.piece.kind, ())

    def _write_sentence(self, cursor: Cursor) -> None:
        """Write what happens, in plain words; what stands below stays where it is."""
        below = cursor.y + _LINES * LEADING * TEXT
        cursor.text(self.record.sentence(self.piece, self.pair))
        cursor.y = max(cursor.y, below)
        self._write_terms(cursor)

    def _write_terms(self, cursor: Cursor) -> None:
        """Write the field's words for what is shown, each explained to whoever points at it."""
        if canvas := cursor.canvas:
            x = cursor.left
            for term in self._terms:
                word, meaning = texts.STEP_TERMS[term]
                box = canvas.text(word, (x, cursor.in_style(SMALL).baseline), size=SMALL, colour=NET)
                canvas.line((box.left, box.bottom), (box.right, box.bottom), NET, 1, 0.5)
                canvas.explain(box, meaning)
                x = box.right + _APART
        cursor.gap(LEADING * SMALL + 4)

    # The code

    def _draw_code(self, canvas: Canvas, box: pygame.FRect) -> None:
        piece, source = self.piece, source_of(self.piece.function)
        if source is None:
            Cursor(box.left, box.top, box.width, canvas.scale, canvas).aside(texts.LESSON_NO_SOURCE)
            return
        draw_listing(canvas, box, source, piece.line, piece.notes)

    # The picture: the bodies near a contact, and what the engine has found out about them there

    def _draw_picture(self, canvas: Canvas, box: pygame.FRect) -> None:
        record, pair, kind = self.record, self.pair, self.piece.kind
        view = self._view(canvas.scale, box)
        poses = record.after[0] if kind in ("motion", "end") else record.before[0]
        with canvas.clipped(box):
            self._draw_walls(canvas, view)
            self._outlines.draw(canvas, view, poses)
            if kind == "boxes":
                self._draw_boxes(canvas, view)
            if pair is None:
                return
            if kind == "axes":
                self._draw_axes(canvas, view, box, pair)
            if kind in ("contact", "impulses"):
                self._draw_contact(canvas, view, pair, with_normal=kind == "contact")
            for letter, body, way in zip("AB", pair.bodies, (-pair.to_b, pair.to_b), strict=True):
                x, y = view.points(poses[body, :2]).tolist()
                if not record.can_move(body):  # its middle may be far away
                    (x, y), (right, up) = view.points(self._middle(pair)).tolist(), way.tolist()
                    x, y = x + _INSIDE * right, y - _INSIDE * up
                canvas.text(letter, (x - 14, y + 5), size=TEXT, colour=INK, align="centre")
            if self.piece.impulse and (scale := self._impulses):
                self._draw_impulse(canvas, view, self.piece.impulse, pair, scale)
            if (motion := record.motion(self.piece, pair)) and (scale := self._motions):
                for which, body in enumerate(pair.bodies):
                    for velocity, colour, width in zip(motion, (MUTE, INK), (3, 1.5), strict=True):
                        if record.can_move(body):
                            reach = velocity[which, :2] * scale[1] / scale[0]
                            _arrow_from(canvas, view, poses[body, :2], reach, colour, width)

    def _view(self, scale: float, box: pygame.FRect) -> View:
        record, pair, boxes = self.record, self.pair, self.record.boxes
        if pair is None:
            wide = record.exhibit.width
            return View.within(box, scale, (0.0, 4.0), box.width / wide)
        small = [body for body in pair.bodies if (boxes[body, 2:] - boxes[body, :2]).max() < _LARGE]
        both = boxes[[body for body in pair.bodies if record.can_move(body)] or small]
        low, high = both[:, :2].min(axis=0), both[:, 2:].max(axis=0)
        wider = _WIDER if self.piece.kind == "boxes" else 1.0
        return View.within(box, scale, (low + high) / 2, box.height * _SHARE / float((high - low).max()) / wider)

    def _draw_walls(self, canvas: Canvas, view: View) -> None:
        wide = self.record.exhibit.width / 2
        for start, end in (((-wide, 0), (wide, 0)), ((-wide, 0), (-wide, 50)), ((wide, 0), (wide, 50))):
            (x0, y0), (x1, y1) = view.points((start, end)).tolist()
            canvas.line((max(x0, -9), min(y0, 9e3)), (min(x1, 9e3), max(y1, -9)), MUTE, 1)

    def _draw_boxes(self, canvas: Canvas, view: View) -> None:
        near = {body for each in self.record.pairs for body in each.bodies}
        for body, (left, low, right, high) in enumerate(self.record.boxes.tolist()):
            if right - left > _LARGE or high - low > _LARGE:
                continue
            (x, y), (end, bottom) = view.points(((left, high), (right, low))).tolist()
            followed = self.pair is not None and body in self.pair.bodies
            colour = NET if followed else MUTE if body in near else LINE
            canvas.outline((x, y, end - x, bottom - y), 0, colour)

    def _draw_axes(self, canvas: Canvas, view: View, box: pygame.FRect, pair: Pair) -> None:
        for number, axis in enumerate(pair.axes):
            if number != pair.chosen:
                _arrow(canvas, *_reach(view, axis, axis.start), MUTE)
        chosen = pair.axes[pair.chosen]
        start, end = _reach(view, chosen, chosen.start)
        if not box.collidepoint(start):  # a long face, such as the ground's
            start, end = _reach(view, chosen, self._middle(pair))
        _arrow(canvas, start, end, NET, 2)
        canvas.text(str(pair.chosen + 1), (end[0] + 8, end[1] + 4), size=SMALL, colour=NET)

    def _draw_contact(self, canvas: Canvas, view: View, pair: Pair, *, with_normal: bool) -> None:
        contacts, row = self.record.contacts, pair.contact
        assert contacts is not None
        assert row is not None
        for number in np.flatnonzero(contacts.valid[row]).tolist():
            x, y = view.points(contacts.points[row, number]).tolist()
            if with_normal:
                _arrow_from(canvas, view, contacts.points[row, number], _NORMAL * contacts.normal[row], NET)
            canvas.dot((x, y), 3.5, NET)
            canvas.text(str(number + 1), (x + 8, y + 15), size=SMALL, colour=NET)

    def _middle(self, pair: Pair) -> Array:
        """Return the middle of the points of contact, or of the face nearest to the other shape."""
        contacts = self.record.contacts
        if contacts is None or pair.contact is None:
            return pair.axes[pair.chosen].start
        middle: Array = contacts.points[pair.contact][contacts.valid[pair.contact]].mean(axis=0)
        return middle

    def _draw_impulse(self, canvas: Canvas, view: View, impulse: Impulse, pair: Pair, scale: Scale) -> None:
        """Draw the accumulated impulses on B, or on A if B cannot move."""
        contacts, row = self.record.contacts, impulse.contact
        assert contacts is not None
        size, length = scale
        parts = impulse.after * (length / size if self.record.can_move(pair.bodies[1]) else -length / size)
        for number in np.flatnonzero(contacts.valid[row]).tolist():
            _arrow_from(canvas, view, contacts.points[row, number], contacts.normal[row] * parts[number], NET)
        _arrow_from(canvas, view, self._middle(pair), right_of(contacts.normal[row]) * parts[2], NET)

    # Scales: of impulses one for the whole step, of velocities one for all pieces of a pair

    @cached_property
    def _impulses(self) -> Scale | None:
        return _scale([each.after for each in self.record.impulses])

    @property
    def _motions(self) -> Scale | None:
        record, bodies = self.record, list(self.pair.bodies) if self.pair else []
        every = [each[bodies, :2] for each in (record.before[1], record.fallen, record.warm, record.after[1])]
        return _scale([np.hypot(*each.T) for each in every if len(each)])

    def _legend(self) -> Legend:
        if self.pair is None:
            return []
        legend: Legend = []
        if self.piece.impulse and (scale := self._impulses):
            on = "B" if self.record.can_move(self.pair.bodies[1]) else "A"
            legend.append((NET, scale[1], texts.STEP_SCALE["impulse"].format(size=written(scale[0]), body=on)))
        if self.record.motion(self.piece, self.pair) and (scale := self._motions):
            legend.append((MUTE, scale[1], texts.STEP_SCALE["before"].format(size=written(scale[0]))))
            legend.append((INK, 24.0, texts.STEP_SCALE["after"]))
        return legend

    def _write_legend(self, cursor: Cursor) -> None:
        below = cursor.y + _ROWS * LEADING * SMALL
        for colour, length, words in self._legend():
            if cursor.canvas:
                y = cursor.in_style(SMALL).baseline - 4
                _arrow(cursor.canvas, (cursor.left, y), (cursor.left + length, y), colour, 2)
            cursor.styled(words, SMALL, MUTE, indent=_ARROW + 12)
        cursor.y = max(cursor.y, below)


def _counted(total: int, place: float) -> str:
    return texts.STEP_PLACE.format(count=place + 1, total=total)


def _scale(values: list[Array]) -> Scale | None:
    """Return a round number up to the greatest of some values, and how long it is drawn, so that that has full length.

    None if all are next to nothing, or there are none.
    """
    most = max((float(np.abs(each).max()) for each in values), default=0.0)
    if most < 1e-4:
        return None
    power = 10.0 ** math.floor(math.log10(most))
    size = next(factor * power for factor in (5.0, 2.0, 1.0) if factor * power <= most * (1 + 1e-9))
    return size, _ARROW * size / most


def _reach(view: View, axis: Axis, place: Array) -> tuple[Point, Point]:
    x, y = view.points(place).tolist()
    right, up = axis.direction.tolist()
    return (x, y), (x + _NORMAL * right, y - _NORMAL * up)


def _arrow_from(canvas: Canvas, view: View, place: Array, reach: Array, colour: Colour, width: float = 2) -> None:
    """Draw an arrow from a place in metres, `reach` in points, y up."""
    x, y = view.points(place).tolist()
    right, up = reach.tolist()
    if math.hypot(right, up) > 1:
        _arrow(canvas, (x, y), (x + right, y - up), colour, width)


def _arrow(canvas: Canvas, start: Point, end: Point, colour: Colour, width: float = 1) -> None:
    canvas.line(start, end, colour, width)
    way = pygame.Vector2(end) - pygame.Vector2(start)
    size = min(_HEAD, way.length() / 2)
    for degrees in (150, -150):
        side = way.rotate(degrees)
        side.scale_to_length(size)
        canvas.line(end, (end[0] + side.x, end[1] + side.y), colour, width)
